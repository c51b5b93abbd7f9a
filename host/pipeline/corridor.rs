//! The corridor: a frame from positions to contacts, in the order of the stages.

use super::layout::Layout;
use super::precision::Precision;
use super::room::List;
use super::timing::Stages;
use super::tree::Tree;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::mesh::Body;
use crate::query::{Motion, Query, Solver, Traversal};
use nearmiss_kernels::abi::{
    DiscreteArgs, Frames, Hit, KEEP_ADJACENT, Motion as Ends, Pair, Point, ROUNDS, RejectArgs, SELF,
    SiftArgs, SolveArgs, Span, TraverseArgs, Unit, counter,
};
use nearmiss_kernels::entry;
use nearmiss_kernels::entry::Entry;
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
}

/// Positions, as the query needs them.
enum Vertices<R: Precision> {
    Still(Buffer<Point<R>>),
    Moving(Buffer<Ends<R>>),
}

/// What only one kind of query needs exists only there.
enum Narrow {
    Discrete { contacts: List<Pair>, undecided: Option<List<Pair>> },
    Continuous(Box<Continuous>),
}

struct Continuous {
    edges: Buffer<[u32; 2]>,
    face_edges: Buffer<[u32; 3]>,
    owners: Buffer<u32>,
    vf: List<Pair>,
    ee: List<Pair>,
    vf_survivors: List<Pair>,
    ee_survivors: List<Pair>,
    vf_hits: List<Hit>,
    ee_hits: List<Hit>,
    earliest: Option<Buffer<u64>>,
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
        let narrow = if continuous {
            let earliest = query.motion == Motion::Earliest;
            let hits = if earliest { 0 } else { few };
            Narrow::Continuous(Box::new(Continuous {
                edges: device.upload(&layout.edges)?,
                face_edges: device.upload(&layout.face_edges)?,
                owners: device.upload(&layout.owners)?,
                vf: List::new(&device, "vertex/face candidates", counter::VF, room)?,
                ee: List::new(&device, "edge/edge candidates", counter::EE, 2 * room)?,
                vf_survivors: List::new(&device, "vertex/face survivors", counter::VF_SURVIVORS, few)?,
                ee_survivors: List::new(&device, "edge/edge survivors", counter::EE_SURVIVORS, 2 * few)?,
                vf_hits: List::new(&device, "vertex/face contacts", counter::VF_HITS, hits)?,
                ee_hits: List::new(&device, "edge/edge contacts", counter::EE_HITS, hits)?,
                earliest: if earliest { Some(device.buffer(1)?) } else { None },
            }))
        } else {
            Narrow::Discrete {
                contacts: List::new(&device, "contacts", counter::CONTACTS, few)?,
                undecided: match query.solver() {
                    Solver::Exact => Some(List::new(&device, "undecided pairs", counter::UNDECIDED, few)?),
                    _ => None,
                },
            }
        };
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

    /// One frame: volumes, candidates, contacts. Runs again from the traversal on while a list is too short.
    pub fn frame(&mut self) -> Result<(Found, Stages), Error> {
        let start = self.device.mark()?;
        self.trees.iter().try_for_each(|tree| tree.fit(&self.device, self.frames(), self.faces.span()))?;
        let fitted = self.device.mark()?;
        self.trees.iter().try_for_each(|tree| tree.refit(&self.device))?;
        let refitted = self.device.mark()?;
        loop {
            self.counters.clear()?;
            let begun = self.device.mark()?;
            self.traverse()?;
            let traversed = self.device.mark()?;
            self.narrow()?;
            let end = self.device.mark()?;
            let counters = self.counters.read(counter::COUNT as usize)?;
            if self.grow(&counters)? {
                self.reruns += 1;
                continue;
            }
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

    /// Contacts.
    fn narrow(&mut self) -> Result<(), Error> {
        let frames = self.frames();
        match &mut self.narrow {
            Narrow::Discrete { contacts, undecided } => {
                let args = DiscreteArgs {
                    positions: frames.still,
                    faces: self.faces.span(),
                    pairs: self.pairs.span(),
                    contacts: contacts.span(),
                    undecided: undecided.as_ref().map_or(Span::EMPTY, List::span),
                    counters: self.counters.span(),
                    pairs_at: counter::PAIRS,
                    flags: if self.query.adjacent { KEEP_ADJACENT } else { 0 },
                };
                let room = self.pairs.room();
                let Some(undecided) = undecided else {
                    return launch_striding::<R::Moller>(&self.device, room, &args);
                };
                launch_striding::<R::Filter>(&self.device, room, &args)?;
                launch_striding::<R::Exact>(&self.device, undecided.room(), &args)
            }
            Narrow::Continuous(c) => {
                let frames = match &self.vertices {
                    Vertices::Still(points) => Frames { still: points.span(), moving: Span::EMPTY },
                    Vertices::Moving(motions) => Frames { still: Span::EMPTY, moving: motions.span() },
                };
                let sift = SiftArgs {
                    frames,
                    faces: self.faces.span(),
                    face_edges: c.face_edges.span(),
                    owners: c.owners.span(),
                    pairs: self.pairs.span(),
                    vf: c.vf.span(),
                    ee: c.ee.span(),
                    counters: self.counters.span(),
                };
                launch_striding::<R::Sift>(&self.device, self.pairs.room(), &sift)?;
                if let Some(earliest) = &mut c.earliest {
                    earliest.write(&[u64::MAX])?;
                }
                let reject = |candidates: &List<Pair>, survivors: &List<Pair>| RejectArgs {
                    frames,
                    faces: self.faces.span(),
                    edges: c.edges.span(),
                    candidates: candidates.span(),
                    survivors: survivors.span(),
                    counters: self.counters.span(),
                };
                launch_striding::<R::RejectVf>(&self.device, c.vf.room(), &reject(&c.vf, &c.vf_survivors))?;
                launch_striding::<R::RejectEe>(&self.device, c.ee.room(), &reject(&c.ee, &c.ee_survivors))?;
                let solve = |survivors: &List<Pair>, hits: &List<Hit>| SolveArgs {
                    frames,
                    faces: self.faces.span(),
                    edges: c.edges.span(),
                    survivors: survivors.span(),
                    hits: hits.span(),
                    earliest: c.earliest.as_ref().map_or(Span::EMPTY, Buffer::span),
                    counters: self.counters.span(),
                };
                let (vf, ee) = (solve(&c.vf_survivors, &c.vf_hits), solve(&c.ee_survivors, &c.ee_hits));
                let (of_vf, of_ee) = (c.vf_survivors.room(), c.ee_survivors.room());
                if self.query.solver() == Solver::CubicF32 {
                    launch_striding::<R::Vf32>(&self.device, of_vf, &vf)?;
                    launch_striding::<R::Ee32>(&self.device, of_ee, &ee)
                } else {
                    launch_striding::<R::Vf64>(&self.device, of_vf, &vf)?;
                    launch_striding::<R::Ee64>(&self.device, of_ee, &ee)
                }
            }
        }
    }

    /// Makes every list long enough for what was asked of it; whether one was not.
    fn grow(&mut self, counters: &[u64]) -> Result<bool, Error> {
        let device = &self.device;
        let mut grown = self.pairs.grow(device, counters)?;
        match &mut self.narrow {
            Narrow::Discrete { contacts, undecided } => {
                grown |= contacts.grow(device, counters)?;
                if let Some(undecided) = undecided {
                    grown |= undecided.grow(device, counters)?;
                }
            }
            Narrow::Continuous(c) => {
                grown |= c.vf.grow(device, counters)? | c.ee.grow(device, counters)?;
                grown |= c.vf_survivors.grow(device, counters)? | c.ee_survivors.grow(device, counters)?;
                grown |= c.vf_hits.grow(device, counters)? | c.ee_hits.grow(device, counters)?;
            }
        }
        Ok(grown)
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
        match &self.narrow {
            Narrow::Discrete { undecided: Some(undecided), .. } => list("narrow: undecided", undecided)?,
            Narrow::Discrete { .. } => {}
            Narrow::Continuous(c) => {
                list("narrow: vf", &c.vf)?;
                list("narrow: ee", &c.ee)?;
                list("narrow: vf that may meet", &c.vf_survivors)?;
                list("narrow: ee that may meet", &c.ee_survivors)?;
            }
        }
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

/// Launches a kernel over up to `room` items.
fn launch_striding<E: Entry>(device: &Device, room: usize, args: &E::Args) -> Result<(), Error> {
    device.launch::<E>(device.blocks_striding::<E>(room), args)
}
