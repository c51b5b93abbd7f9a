//! The corridor: a frame from positions to contacts, in the order of the stages.

use super::layout::Layout;
use super::narrow::{Given, Narrow, Step};
use super::precision::Precision;
use super::room::{Growing, List};
use super::timing::Stages;
use super::tree::Tree;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::mesh::Body;
use crate::query::{Motion, Query, Traversal};
use nearmiss_kernels::abi::{
    Frames, Hit, KEEP_ADJACENT, Motion as Ends, Pair, Point, ROUNDS, SELF, Span, TraverseArgs, Unit, counter,
};
use nearmiss_kernels::entry;
use rayon::prelude::*;
use xxhash_rust::xxh3::xxh3_64;

/// Candidates a triangle for which there is room at first. Cloth at rest has 8, swept over a step 50; a list that
/// turns out too short grows within the frame.
const PAIRS_A_TRIANGLE: usize = 16;
/// The same for a continuous query.
const SWEPT_PAIRS_A_TRIANGLE: usize = 64;
/// Room that every list has at least: a scene of a few triangles may have all pairs.
const LEAST_ROOM: usize = 1 << 12;

/// What the kernels found, still in the numbering of the memory that all bodies share.
pub struct Found {
    /// Triangle pairs, discrete.
    pub pairs: Vec<Pair>,
    /// Vertex/face contacts.
    pub vf: Vec<Hit>,
    /// Edge/edge contacts.
    pub ee: Vec<Hit>,
    /// The smallest toi, if that was asked for and there is one.
    pub earliest: Option<f64>,
    /// The frame's counters, see [`counter`].
    pub counters: Vec<u64>,
}

/// The memory of a query, and the way through it.
pub struct Corridor<R: Precision> {
    device: Device,
    query: Query,
    faces: Buffer<[u32; 3]>,
    vertices: Vertices<R>,
    trees: Vec<Tree>,
    counters: Buffer<u64>,
    pairs: List<Pair>,
    units: Option<[Buffer<Unit>; 2]>,
    narrow: Narrow,
    /// How often a list was too short and the frame was run again, so far.
    pub reruns: u64,
    /// Counters of the last frame.
    last: Vec<u64>,
    /// Whether the lists were long enough for a whole frame: then the next one runs without waiting between steps.
    settled: bool,
}

/// Positions, as the query needs them.
enum Vertices<R: Precision> {
    Still(Buffer<Point<R>>),
    Moving(Buffer<Ends<R>>),
}

impl<R: Precision> Corridor<R> {
    /// Takes the memory that the query needs, uploads topology and positions, and constructs the trees. `layout` has
    /// at least one triangle in every body.
    pub fn new(device: Device, bodies: &[Body], layout: &Layout, query: Query) -> Result<(Self, f64), Error> {
        let triangles = layout.faces.len();
        let continuous = query.motion != Motion::Discrete;
        let a_triangle = if continuous { SWEPT_PAIRS_A_TRIANGLE } else { PAIRS_A_TRIANGLE };
        let room = (a_triangle * triangles).max(LEAST_ROOM);
        let few = (4 * triangles).max(LEAST_ROOM);
        let narrow = Narrow::new(&device, layout, query, (room, few))?;
        let units = match Self::budget(&device, query) {
            None => None,
            Some(_) => Some([device.buffer(4 * triangles)?, device.buffer(4 * triangles)?]),
        };
        let vertices = layout.starts[layout.bodies()].vertex as usize;
        let mut corridor = Corridor {
            query,
            faces: device.upload(&layout.faces)?,
            vertices: if continuous {
                Vertices::Moving(device.buffer(vertices)?)
            } else {
                Vertices::Still(device.buffer(vertices)?)
            },
            trees: Vec::new(),
            counters: device.buffer(counter::COUNT as usize)?,
            pairs: List::new(&device, "candidate triangle pairs", counter::PAIRS, room)?,
            units,
            narrow,
            reruns: 0,
            last: Vec::new(),
            settled: false,
            device,
        };
        corridor.place(bodies)?;
        for body in 0..layout.bodies() {
            corridor.trees.push(Tree::new(&corridor.device, layout.triangles(body))?);
        }
        let start = corridor.device.mark()?;
        corridor.construct()?;
        let ms = start.to(&corridor.device.mark()?)?;
        Ok((corridor, ms))
    }

    /// Steps of a walk before it spills.
    fn budget(device: &Device, query: Query) -> Option<u32> {
        let Traversal::PerLeaf { budget } =
            query.traversal.unwrap_or(Traversal::default_for(device.is_card()));
        budget
    }

    /// Uploads positions. A body that stands still in a continuous query has the same positions at both ends.
    pub fn place(&mut self, bodies: &[Body]) -> Result<(), Error> {
        match &mut self.vertices {
            Vertices::Still(buffer) => {
                let mut points = Vec::with_capacity(buffer.len());
                for body in bodies {
                    points.extend(R::points(body.positions_t0()).map(Point::from));
                }
                buffer.write(&points)
            }
            Vertices::Moving(buffer) => {
                let mut ends = Vec::with_capacity(buffer.len());
                for body in bodies {
                    let (t0, t1) = (body.positions_t0(), body.positions_t1().unwrap_or(body.positions_t0()));
                    let both = R::points(t0).zip(R::points(t1));
                    ends.extend(both.map(|(t0, t1)| Ends { t0: t0.into(), t1: t1.into() }));
                }
                buffer.write(&ends)
            }
        }
    }

    /// Builds the trees anew, from the positions at t = 0.
    pub fn construct(&mut self) -> Result<(), Error> {
        let frames = self.frames();
        let faces = self.faces.span();
        self.trees.iter_mut().try_for_each(|tree| tree.construct::<R>(&self.device, frames, faces))
    }

    /// The trees, one a body.
    pub fn trees(&self) -> &[Tree] {
        &self.trees
    }

    fn frames(&self) -> Frames<R> {
        match &self.vertices {
            Vertices::Still(points) => Frames { still: points.span(), moving: Span::EMPTY },
            Vertices::Moving(motions) => Frames { still: Span::EMPTY, moving: motions.span() },
        }
    }

    /// One frame: volumes, candidates, contacts. Lists that were too short grow, and the frame runs again from there.
    pub fn frame(&mut self) -> Result<(Found, Stages), Error> {
        let start = self.device.mark()?;
        self.trees.iter().try_for_each(|tree| tree.fit(&self.device, self.frames(), self.faces.span()))?;
        let fitted = self.device.mark()?;
        self.trees.iter().try_for_each(|tree| tree.refit(&self.device))?;
        let refitted = self.device.mark()?;
        loop {
            self.counters.clear()?;
            let begun = self.device.mark()?;
            self.step(Step::Traverse)?;
            let traversed = self.device.mark()?;
            self.narrow.steps().iter().try_for_each(|&step| self.step(step))?;
            let end = self.device.mark()?;
            let counters = self.counters.read(counter::COUNT as usize)?;
            if self.is_short(&counters) {
                // Some list, somewhere: find out step by step.
                self.settled = false;
                self.reruns += 1;
                continue;
            }
            self.settled = true;
            let stages = Stages {
                construct: 0.0,
                fit: start.to(&fitted)?,
                refit: fitted.to(&refitted)?,
                traverse: begun.to(&traversed)?,
                narrow: traversed.to(&end)?,
                total: start.to(&end)?,
            };
            self.last.clone_from(&counters);
            return Ok((self.gather(counters)?, stages));
        }
    }

    /// Runs a step. Until the lists have settled it waits for the step's demand and, where a list was too short, grows
    /// it and runs the step again: no step works on a part of its input.
    fn step(&mut self, step: Step) -> Result<(), Error> {
        loop {
            match step {
                Step::Traverse => self.traverse()?,
                _ => {
                    let frames = self.frames();
                    let given = Given {
                        device: &self.device,
                        query: self.query,
                        frames,
                        faces: self.faces.span(),
                        pairs: self.pairs.span(),
                        counters: self.counters.span(),
                    };
                    self.narrow.run(step, &given)?;
                }
            }
            if self.settled {
                return Ok(());
            }
            let mut counters = self.counters.read(counter::COUNT as usize)?;
            let mut grown = false;
            let mut again = Vec::new();
            let lists = match step {
                Step::Traverse => vec![&mut self.pairs as &mut dyn Growing],
                _ => self.narrow.lists(step),
            };
            for list in lists {
                grown |= list.grow(&self.device, &counters)?;
                again.push(list.counter());
            }
            if !grown {
                return Ok(());
            }
            self.reruns += 1;
            if step == Step::Traverse {
                again.extend(counter::SPILLED..counter::COUNT);
                again.push(counter::STEPS);
            }
            again.iter().for_each(|&at| counters[at as usize] = 0);
            self.counters.write(&counters)?;
        }
    }

    /// Whether a list of any step had too little room.
    fn is_short(&mut self, counters: &[u64]) -> bool {
        let steps = self.narrow.steps();
        self.pairs.is_short(counters)
            || steps.iter().any(|&step| self.narrow.lists(step).iter().any(|list| list.is_short(counters)))
    }

    /// Candidates: a round of all leaves, then rounds of what longer walks left over.
    fn traverse(&self) -> Result<(), Error> {
        let (queries, target) = (&self.trees[0], &self.trees[self.trees.len() - 1]);
        let own = if self.trees.len() == 1 { SELF } else { 0 };
        // An elementary pair may be known by two adjacent triangles only: continuous queries keep them.
        let adjacent = self.query.adjacent || self.query.motion != Motion::Discrete;
        let budget = Self::budget(&self.device, self.query);
        let mut args = TraverseArgs {
            queries: queries.nodes.span(),
            query_leaves: queries.leaf_nodes.span(),
            nodes: target.nodes.span(),
            faces: self.faces.span(),
            units: Span::EMPTY,
            spilled: self.units.as_ref().map_or(Span::EMPTY, |units| units[0].span()),
            pairs: self.pairs.span(),
            counters: self.counters.span(),
            units_at: 0,
            spilled_at: counter::SPILLED,
            budget: budget.unwrap_or(u32::MAX),
            flags: own | if adjacent { KEEP_ADJACENT } else { 0 },
        };
        let leaves = queries.leaf_nodes.len();
        let blocks = if self.device.is_card() {
            self.device.blocks_for::<entry::traverse_leaves>(leaves)
        } else {
            self.device.blocks_striding::<entry::traverse_leaves>(leaves)
        };
        self.device.launch::<entry::traverse_leaves>(blocks, &args)?;
        let Some(units) = &self.units else { return Ok(()) };
        let blocks = self.device.blocks_striding::<entry::traverse_units>(units[0].len());
        for round in 0..ROUNDS {
            args.units = args.spilled;
            args.units_at = args.spilled_at;
            args.spilled = units[(round as usize + 1) % 2].span();
            args.spilled_at += 1;
            if round + 1 == ROUNDS {
                args.budget = u32::MAX;
                args.spilled_at = 0;
            }
            self.device.launch::<entry::traverse_units>(blocks, &args)?;
        }
        Ok(())
    }

    /// A hash of what each stage left in memory after the last frame, lists as sets: for comparing machines.
    pub fn fingerprints(&self) -> Result<Vec<(&'static str, u64)>, Error> {
        let mut prints = Vec::new();
        let (mut links, mut leaves, mut inner) = (Vec::new(), Vec::new(), Vec::new());
        for tree in &self.trees {
            for node in &tree.download()?.nodes {
                links.push([node.link, node.last]);
                let volume = [node.lo.map(f32::to_bits), node.hi.map(f32::to_bits)];
                if node.is_leaf() { leaves.push(volume) } else { inner.push(volume) }
            }
        }
        prints.push(("construct", xxh3_64(bytemuck::cast_slice(&links))));
        prints.push(("fit", xxh3_64(bytemuck::cast_slice(&leaves))));
        prints.push(("refit", xxh3_64(bytemuck::cast_slice(&inner))));
        let mut list = |name, list: &List<Pair>| -> Result<(), Error> {
            let mut pairs = list.read(&self.last)?;
            pairs.par_sort_unstable();
            prints.push((name, xxh3_64(bytemuck::cast_slice(&pairs))));
            Ok(())
        };
        list("traverse", &self.pairs)?;
        self.narrow.between().into_iter().try_for_each(|(name, pairs)| list(name, pairs))?;
        Ok(prints)
    }

    fn gather(&self, counters: Vec<u64>) -> Result<Found, Error> {
        let mut found = Found { pairs: Vec::new(), vf: Vec::new(), ee: Vec::new(), earliest: None, counters };
        match &self.narrow {
            Narrow::Discrete { contacts, .. } => found.pairs = contacts.read(&found.counters)?,
            Narrow::Continuous(c) => {
                found.vf = c.vf_hits.read(&found.counters)?;
                found.ee = c.ee_hits.read(&found.counters)?;
                if let Some(earliest) = &c.earliest {
                    let bits = earliest.read(1)?[0];
                    found.earliest = (bits != u64::MAX).then(|| f64::from_bits(bits));
                }
            }
        }
        Ok(found)
    }
}
