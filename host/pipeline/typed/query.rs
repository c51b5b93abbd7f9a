//! The memory of one query of a scene, and its way through the stages.

use super::scene::{SceneMemory, records};
use super::{QueryParts, Step, frame};
use crate::device::{Buffer, Replay};
use crate::error::Error;
use crate::pipeline::broad::{Share, Which, growth};
use crate::pipeline::counts::{Counts, FrameCounters};
use crate::pipeline::demand::Demand;
use crate::pipeline::layout::Layout;
use crate::pipeline::narrow::{Narrow, NarrowContext, narrow};
use crate::pipeline::precision::Precision;
use crate::pipeline::purpose;
use crate::pipeline::wear::Wear;
use crate::query::Query;
use crate::scene::Body;
use crate::stages::Stage;
use nearmiss_kernels::abi::{BodyRecord, FilterArgs, Growth, Span};
use std::sync::Arc;

/// Initial capacity, in candidates per triangle. Cloth at rest has 8, cloth swept over a step 50. A
/// list that is too short grows within the frame.
const PAIRS_A_TRIANGLE: usize = 16;
/// The same for a query in motion.
const SWEPT_PAIRS_A_TRIANGLE: usize = 64;
/// The same of instances, in candidates per body. A heap has 500, bodies that rest on a floor some
/// dozen.
const PAIRS_A_BODY: usize = 64;
/// Least room of every list: a scene of a few triangles may have all pairs.
const LEAST_ROOM: usize = 1 << 12;

/// The memory of one query.
pub struct QueryMemory<R: Precision> {
    /// The query without its numbers: another query of this shape uses the same memory.
    pub shape: Query,
    pub query: Query,
    pub layout: Arc<Layout>,
    records: Buffer<BodyRecord>,
    has_groups: bool,
    /// The index of its broad phase.
    pub broad: usize,
    /// Whether it reads bodies as instances.
    pub is_of_instances: bool,
    /// Whether it reads others, which deform, as vertices.
    pub is_mixed: bool,
    pub counters: FrameCounters,
    pub narrow: Box<dyn Narrow<R>>,
    pub reruns: u64,
    /// Counters of the last frame.
    pub last: Counts,
    /// Whether the lists were long enough for a whole frame: then the next one runs without waits
    /// between steps.
    pub settled: bool,
    /// Launches of a settled frame, and the marks of every frame.
    pub replay: Replay,
    /// Its share of the work.
    pub share: Share,
    /// Bounds of the answer's size.
    pub demand: Demand,
    /// Host time to launch this frame, in milliseconds.
    pub launch_ms: f64,
    pub wear: Wear,
    /// The placing that the narrow phase last used.
    seen: Option<u64>,
}

impl<R: Precision> QueryMemory<R> {
    /// Allocates the query's own memory, for a share of its work.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(scene: &mut SceneMemory<R>, parts: &QueryParts) -> Result<Self, Error> {
        let QueryParts { layout, query, share, is_of_instances, .. } = parts;
        let device = scene.device.clone();
        let shape = query.shape();
        let triangles = share.of(layout.moving_triangles() as u32).len();
        let a_triangle = if query.kind().is_at_rest() { PAIRS_A_TRIANGLE } else { SWEPT_PAIRS_A_TRIANGLE };
        let is_mixed = *is_of_instances && scene.mixes(query.kind());
        let deforming = scene.deforming.iter().map(|&body| layout.triangles(body).1 as usize);
        let (capacity, few) = if is_mixed {
            let (triangles, bodies) = (deforming.sum::<usize>(), PAIRS_A_BODY * layout.bodies());
            (LEAST_ROOM.max(a_triangle * triangles + bodies), LEAST_ROOM.max(4 * triangles + bodies))
        } else if *is_of_instances {
            let room = LEAST_ROOM.max(PAIRS_A_BODY * layout.bodies());
            (room, room)
        } else {
            (LEAST_ROOM.max(a_triangle * triangles), LEAST_ROOM.max(4 * triangles))
        };
        scene.reserve_pairs(capacity)?;
        if query.kind().is_of_features() {
            scene.features.reserve(&device, layout, [capacity, 2 * capacity])?;
        }
        let broad = scene.broad_of(&shape, parts)?;
        let mut narrow = narrow(&device, layout, query, few)?;
        if scene.broads[broad].phase.can_sample() {
            narrow.take_samples(&device)?;
        }
        Ok(QueryMemory {
            shape,
            query: *query,
            records: device.of(purpose::RECORDS).upload(records(layout))?,
            has_groups: layout.has_groups(),
            broad,
            is_of_instances: *is_of_instances,
            is_mixed,
            counters: FrameCounters::new(&device)?,
            narrow,
            reruns: 0,
            last: Counts::default(),
            settled: false,
            replay: frame::replay(&device)?,
            share: Share::WHOLE,
            demand: Demand::new(query),
            launch_ms: 0.0,
            wear: Wear::default(),
            seen: None,
            layout: layout.clone(),
        })
    }

    /// Sets the numbers of a query of the same shape; nothing is built.
    ///
    /// # Errors
    /// Device errors.
    pub fn set(&mut self, scene: &mut SceneMemory<R>, parts: &QueryParts) -> Result<(), Error> {
        self.narrow.set(&scene.device, &parts.query, &parts.tolerances)?;
        if self.query != parts.query {
            self.query = parts.query;
            scene.broads[self.broad].phase.set(&parts.query);
            let before = self.demand.before;
            self.demand = Demand::new(&parts.query);
            self.demand.before = before;
            self.seen = None;
            self.wear.forget_first();
        }
        Ok(())
    }

    /// Returns whether it reads only t = 0.
    pub fn is_at_rest(&self) -> bool {
        self.query.kind().is_at_rest()
    }

    /// Returns whether its candidates may be of bodies that are left out. Instances never list such.
    pub fn leaves_out(&self) -> bool {
        !self.is_of_instances || self.is_mixed
    }

    /// Returns the filters of the bodies, without nodes and pairs that are left out.
    pub fn filters(&self) -> FilterArgs {
        let bodies = if self.has_groups { self.records.span() } else { Span::EMPTY };
        FilterArgs { bodies, ..FilterArgs::NONE }
    }

    /// Returns the records of the bodies for the kernels.
    pub fn records(&self) -> Span<BodyRecord> {
        self.records.span()
    }

    /// Readies a frame: growth of the volumes, positions, and values that depend on positions.
    /// Returns whether tiles or trees must be built for it.
    ///
    /// # Errors
    /// Device errors.
    pub fn ready(&mut self, scene: &mut SceneMemory<R>, bodies: &[Body]) -> Result<bool, Error> {
        if self.seen != Some(scene.placings) {
            self.narrow.place(bodies, &self.layout);
            self.seen = Some(scene.placings);
        }
        if self.is_of_instances {
            scene.ready_instances(bodies, (&self.layout, self.query.kind()))?;
        } else {
            scene.ready(self.is_at_rest())?;
        }
        let growth = self.growth(scene);
        let broad = &mut scene.broads[self.broad];
        let grows = broad.phase.set_growth(growth);
        broad.is_built &= !grows;
        Ok(!broad.is_built)
    }

    /// Returns the growth of the volumes. A pair that turns may stay undecided within half a
    /// tolerance, and is then a candidate of every volume. Boxes of instances are of the meshes' frames:
    /// any pair that may stay undecided is to be a candidate.
    pub fn growth(&self, scene: &SceneMemory<R>) -> Growth {
        let turns = self.is_of_instances || scene.vertices.turns();
        let tolerance = self.query.certified().and_then(|certified| certified.tolerance);
        let margin = growth(self.query.listed_within() + tolerance.filter(|_| turns).unwrap_or(0.0));
        let is_thick = self.layout.is_thick() && self.query.kind().is_of_features();
        Growth { margin, is_thick: is_thick.into() }
    }

    /// Returns the indices of the narrow phase's steps.
    pub fn narrow_steps_at(&self) -> std::ops::Range<usize> {
        0..self.narrow.steps().len()
    }

    /// Runs a stage on the results of those before it.
    ///
    /// # Errors
    /// Device errors.
    pub fn run(&mut self, scene: &mut SceneMemory<R>, stage: Stage) -> Result<(), Error> {
        match stage {
            Stage::Construct => scene.broadly(self, |broad, given, layout| broad.construct(given, layout)),
            Stage::Fit => scene.broadly(self, |broad, given, _| broad.fit(given)),
            Stage::Refit => scene.broadly(self, |broad, given, _| broad.refit(given)),
            Stage::Traverse => {
                self.sample(scene)?;
                self.step(scene, Step::Traverse)
            }
            Stage::Narrow => self.narrow(scene, false),
            Stage::Order if self.narrow.ordered().is_empty() => Ok(()),
            Stage::Order => self.step(scene, Step::Order),
        }
    }

    /// Clears the bins of the order, at the same time as the walk and the narrow phase. Their end is
    /// [`Device::join`](crate::device::Device::join).
    ///
    /// # Errors
    /// Device errors.
    pub fn clear_order(&mut self, scene: &SceneMemory<R>) -> Result<(), Error> {
        if self.narrow.ordered().is_empty() {
            return Ok(());
        }
        scene.device.beside(|| self.narrow.ordering().map_or(Ok(()), |order| order.clear_ahead()))
    }

    /// Tests a sample, if its answer bounds the whole. Its counts are discarded: too little room
    /// gives a weaker bound, never a wrong one.
    fn sample(&mut self, scene: &mut SceneMemory<R>) -> Result<(), Error> {
        if !self.narrow.samples() {
            return Ok(());
        }
        self.step(scene, Step::Sample)?;
        self.narrow(scene, true)?;
        self.counters.clear()
    }

    /// Runs all steps of the narrow phase, on a sample or on all candidates.
    fn narrow(&mut self, scene: &mut SceneMemory<R>, is_sample: bool) -> Result<(), Error> {
        self.narrow_steps_at().try_for_each(|at| self.step(scene, Step::Narrow(at, is_sample)))
    }

    /// Runs a step. Until the lists have settled it waits for the step's demand. If a list was too
    /// short, it grows the list and runs the step again: no step works on a part of its input.
    ///
    /// # Errors
    /// Device errors.
    pub fn step(&mut self, scene: &mut SceneMemory<R>, step: Step) -> Result<(), Error> {
        loop {
            match step {
                Step::Sample => self.traverse(scene, Which::Sample)?,
                Step::Traverse => {
                    self.traverse(scene, self.narrow.bound().map_or(Which::All, Which::Before))?;
                }
                Step::Narrow(..) | Step::Order => {
                    let given = self.given(scene, matches!(step, Step::Narrow(_, true)));
                    if let Step::Narrow(at, _) = step {
                        self.narrow.run(at, &given)
                    } else {
                        self.narrow.order(&given, scene.is_submitting)
                    }?;
                }
            }
            if self.settled || !self.grow(scene, step)? {
                return Ok(());
            }
        }
    }

    /// Returns the inputs of the narrow phase.
    pub(super) fn given<'a>(&self, scene: &'a SceneMemory<R>, is_sample: bool) -> NarrowContext<'a, R> {
        let (frames, rest, faces) = scene.positions_of(self);
        let counters = self.counters.counters();
        NarrowContext {
            device: &scene.device,
            frames,
            rest,
            faces,
            pairs: scene.candidates(self).output(counters),
            bodies: self.records.span(),
            counters,
            features: &scene.features,
            excluded: scene.exclusions.tables(self.records.span()),
            placeable: scene.broads[self.broad].phase.placeable(),
            may_grow: !self.settled,
            is_sample,
        }
    }

    /// Grows the lists that a step found too short, and resets its counts. Returns whether there
    /// were any.
    fn grow(&mut self, scene: &mut SceneMemory<R>, step: Step) -> Result<bool, Error> {
        let mut counters = self.counters.read()?;
        self.refuse(scene, step, &counters)?;
        let device = scene.device.of(purpose::WALK);
        let lists = match step {
            Step::Sample | Step::Traverse => scene.lists_of_traversal(self.broad),
            Step::Narrow(at, _) => self.narrow.lists(at, &mut scene.features),
            Step::Order => self.narrow.ordered(),
        };
        let (mut grown, mut again) = (false, Vec::new());
        for list in lists {
            grown |= list.grow(&device, &counters)?;
            again.push(list.counter());
        }
        if !grown {
            return Ok(false);
        }
        self.reruns += 1;
        if let Step::Sample | Step::Traverse = step {
            // The first step: all counts so far are its own.
            self.counters.clear()?;
        } else {
            again.iter().for_each(|&at| counters[at] = 0);
            self.counters.write(&counters)?;
        }
        Ok(true)
    }
}
