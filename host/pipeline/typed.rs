//! The pipeline: a frame from positions to contacts, in the order of the stages.

mod found;
mod frame;
#[cfg(test)]
mod in_order;
#[cfg(test)]
mod near;
mod refuse;
mod repeat;
mod submit;
#[cfg(test)]
mod submitted;

pub use found::{Found, Hits, Listed, in_order};
pub use submit::Submits;

use super::Pieces;
use super::broad::{BroadContext, BroadPhase, Share, Which, broad_phase, growth};
use super::counts::{Counts, FrameCounters};
use super::demand::Demand;
use super::layout::Layout;
use super::list::List;
use super::narrow::{Narrow, NarrowContext, narrow};
use super::placing::{Moved, Placing, Whereabouts};
use super::precision::Precision;
use super::purpose;
use crate::device::{Buffer, Device, Event, Replay};
use crate::error::Error;
use crate::query::Query;
use crate::scene::Body;
use crate::stages::{Stage, Stages};
use nearmiss_kernels::abi::{BodyRecord, Pair, counter};
use rayon::prelude::*;
use std::sync::Arc;
use xxhash_rust::xxh3::xxh3_64;

/// Candidates a triangle for which there is room at first. Cloth at rest has 8, swept over a step 50; a list that
/// turns out too short grows within the frame.
const PAIRS_A_TRIANGLE: usize = 16;
/// The same for a continuous query.
const SWEPT_PAIRS_A_TRIANGLE: usize = 64;
/// Room that every list has at least: a scene of a few triangles may have all pairs.
const LEAST_ROOM: usize = 1 << 12;

/// A step of a frame that fills lists; each reads what the one before filled.
#[derive(Clone, Copy)]
enum Step {
    /// Candidate triangle pairs of a sample.
    Sample,
    /// Candidate triangle pairs.
    Traverse,
    /// A step of the narrow phase, by its place; and whether it looks at a sample.
    Narrow(usize, bool),
    /// Contacts in canonical order, where the device does that.
    Order,
}

/// The memory of a query, and the way through it.
pub struct TypedPipeline<R: Precision> {
    device: Device,
    query: Query,
    layout: Arc<Layout>,
    faces: Buffer<[u32; 3]>,
    vertices: Placing<R>,
    /// What the kernels know of the bodies; empty where there is one alone.
    records: Buffer<BodyRecord>,
    broad: Box<dyn BroadPhase<R>>,
    counters: FrameCounters,
    pairs: List<Pair>,
    narrow: Box<dyn Narrow<R>>,
    reruns: u64,
    /// Around the placing of what was moved since the last frame.
    placing: Option<[Event; 2]>,
    /// Counters of the last frame.
    last: Counts,
    /// Whether the lists were long enough for a whole frame: then the next one runs without waiting between steps.
    settled: bool,
    /// What a settled frame launches, and the marks of every frame.
    replay: Replay,
    /// Its part of the work.
    share: Share,
    /// What is known of the answer's size.
    demand: Demand,
    /// What the host took to launch this frame.
    launch_ms: f64,
    /// What a frame needs that is submitted and not waited for.
    submission: Option<submit::Submission>,
}

/// A pipeline of any precision and any volume.
pub trait Pipeline: repeat::Again + submit::Submits + Send {
    /// Moves bodies to where they are now, those that are named, in ascending order.
    ///
    /// # Errors
    /// Those of the device.
    fn place(&mut self, bodies: &[Body], moved: &[Moved]) -> Result<(), Error>;
    /// Where all bodies are, as the device knows it.
    ///
    /// # Errors
    /// Those of the device.
    fn whereabouts(&self) -> Result<Whereabouts, Error>;
    /// Builds the tree over what moves anew, from the positions at t = 0; the milliseconds it took.
    ///
    /// # Errors
    /// Those of the device.
    fn construct(&mut self) -> Result<f64, Error>;
    /// One frame: volumes, candidates, contacts. Lists that were too short grow, and the frame runs again from there.
    ///
    /// # Errors
    /// Those of the device.
    fn frame(&mut self) -> Result<(Found<'_>, Stages), Error>;
    /// The next frame is a slice behind others, which have found so many rows.
    fn after(&mut self, rows: u64);
    /// From here on it finds what is its share.
    ///
    /// # Errors
    /// [`Error::Choice`] where work cannot be divided; those of the device.
    fn take(&mut self, share: Share) -> Result<(), Error>;
    /// What each tile of its share cost in the last frame, of all tiles; nothing where there is one share.
    ///
    /// # Errors
    /// Those of the device.
    fn work(&self) -> Result<Vec<u64>, Error>;
    /// How many tiles beyond its share it met in the last frame, or the device's error.
    fn met_beyond(&self) -> Result<u64, Error>;
    /// Levels of each tree.
    fn depths(&self) -> Vec<usize>;
    /// How often a list was too short and the frame was run again, so far.
    fn reruns(&self) -> u64;
    /// A hash of what each stage left in memory after the last frame, lists as sets: for comparing machines.
    ///
    /// # Errors
    /// Those of the device.
    fn fingerprints(&self) -> Result<Vec<(&'static str, u64)>, Error>;
    /// Checks every tree and its volumes.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; those of the device.
    fn check(&self) -> Result<(), Error>;
}

impl<R: Precision> TypedPipeline<R> {
    /// Takes the memory that a share of the query's work needs and uploads topology and positions. Something in the layout may meet.
    ///
    /// # Errors
    /// [`Error::Choice`] where work cannot be divided; those of the device.
    pub fn new(device: Device, bodies: &[Body], pieces: Pieces) -> Result<Self, Error> {
        let Pieces { layout, query, share, .. } = pieces;
        let triangles = share.of(layout.moving_triangles() as u32).len();
        let still = query.kind().is_at_rest();
        let a_triangle = if still { PAIRS_A_TRIANGLE } else { SWEPT_PAIRS_A_TRIANGLE };
        let capacity = LEAST_ROOM.max(a_triangle * triangles);
        let few = LEAST_ROOM.max(4 * triangles);
        let records: &[BodyRecord] = if layout.has_filters() { &layout.records } else { &[] };
        let mut pipeline = TypedPipeline {
            query,
            faces: device.of(purpose::FACES).upload(&layout.faces)?,
            vertices: Placing::new(&device.of(purpose::VERTICES), &layout, bodies, !still)?,
            records: device.of(purpose::RECORDS).upload(records)?,
            broad: broad_phase(&device, &layout, &query, growth(query.listed_within()))?,
            counters: FrameCounters::new(&device)?,
            pairs: List::new(&device, "candidate triangle pairs", counter::PAIRS, capacity)?,
            narrow: narrow(&device, &layout, &query, (capacity, few))?,
            reruns: 0,
            placing: None,
            last: Counts::default(),
            settled: false,
            replay: frame::replay(&device)?,
            share: Share::WHOLE,
            demand: Demand::new(&query),
            launch_ms: 0.0,
            submission: None,
            layout,
            device,
        };
        pipeline.take(share)?;
        pipeline.narrow.place(bodies);
        if pipeline.broad.can_sample() {
            pipeline.narrow.take_samples(&pipeline.device)?;
        }
        Ok(pipeline)
    }

    /// The places of the narrow phase's steps.
    fn narrow_steps_at(&self) -> std::ops::Range<usize> {
        0..self.narrow.steps().len()
    }

    /// Runs a stage on what those before it left.
    fn run(&mut self, stage: Stage) -> Result<(), Error> {
        match stage {
            Stage::Construct => self.construct().map(|_| ()),
            Stage::Fit => self.broadly(|broad, given, _| broad.fit(given)),
            Stage::Refit => self.broadly(|broad, given, _| broad.refit(given)),
            Stage::Traverse => {
                self.sample()?;
                self.step(Step::Traverse)
            }
            Stage::Narrow => self.narrow(false),
            Stage::Order if self.narrow.ordered().is_some() => self.step(Step::Order),
            Stage::Order => Ok(()),
        }
    }

    /// Asks a sample, where its answer bounds the whole. Nothing of it is counted: too little room would make the bound worse, and not wrong.
    fn sample(&mut self) -> Result<(), Error> {
        if self.narrow.bound().is_none() {
            return Ok(());
        }
        self.step(Step::Sample)?;
        self.narrow(true)?;
        self.counters.clear()
    }

    /// All steps of the narrow phase, of a sample or of all.
    fn narrow(&mut self, is_sample: bool) -> Result<(), Error> {
        self.narrow_steps_at().try_for_each(|at| self.step(Step::Narrow(at, is_sample)))
    }

    /// Runs a step. Until the lists have settled it waits for the step's demand and, where a list was too short, grows
    /// it and runs the step again: no step works on a part of its input.
    fn step(&mut self, step: Step) -> Result<(), Error> {
        loop {
            match step {
                Step::Sample => self.traverse(Which::Sample)?,
                Step::Traverse => self.traverse(self.narrow.bound().map_or(Which::All, Which::Before))?,
                Step::Narrow(..) | Step::Order => {
                    let given = NarrowContext {
                        device: &self.device,
                        frames: self.vertices.frames(),
                        faces: self.faces.span(),
                        pairs: self.pairs.output(self.counters.counters()),
                        bodies: self.records.span(),
                        counters: self.counters.counters(),
                        is_sample: matches!(step, Step::Narrow(_, true)),
                    };
                    if let Step::Narrow(at, _) = step {
                        self.narrow.run(at, &given)
                    } else {
                        self.narrow.order(&given)
                    }?;
                }
            }
            if self.settled {
                return Ok(());
            }
            let mut counters = self.counters.read()?;
            self.refuse(step, &counters)?;
            let mut grown = false;
            let mut again = Vec::new();
            let lists = match step {
                Step::Sample | Step::Traverse => {
                    let mut lists = self.broad.lists();
                    lists.push(&mut self.pairs);
                    lists
                }
                Step::Narrow(at, _) => self.narrow.lists(at),
                Step::Order => self.narrow.ordered().into_iter().collect(),
            };
            for list in lists {
                grown |= list.grow(&self.device.of(purpose::WALK), &counters)?;
                again.push(list.counter());
            }
            if !grown {
                return Ok(());
            }
            self.reruns += 1;
            if let Step::Sample | Step::Traverse = step {
                // The first step: everything that was counted so far is its own.
                self.counters.clear()?;
            } else {
                again.iter().for_each(|&at| counters[at] = 0);
                self.counters.write(&counters)?;
            }
        }
    }

    /// What the broad phase does with what it is given.
    fn broadly<T>(
        &mut self,
        what: impl FnOnce(&mut dyn BroadPhase<R>, &BroadContext<R>, &Layout) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let given = BroadContext {
            device: &self.device,
            frames: self.vertices.frames(),
            faces: self.faces.span(),
            records: self.records.span(),
        };
        what(&mut *self.broad, &given, &self.layout)
    }
}

impl<R: Precision> Pipeline for TypedPipeline<R> {
    fn place(&mut self, bodies: &[Body], moved: &[Moved]) -> Result<(), Error> {
        self.submission = None;
        self.narrow.place(bodies);
        let start = self.device.event()?;
        self.vertices.put(&self.device, &self.layout, bodies, moved)?;
        self.placing = Some([start, self.device.event()?]);
        Ok(())
    }

    fn whereabouts(&self) -> Result<Whereabouts, Error> {
        self.vertices.whereabouts()
    }

    fn construct(&mut self) -> Result<f64, Error> {
        self.submission = None;
        let start = self.device.event()?;
        self.broadly(|broad, given, layout| broad.construct(given, layout))?;
        let end = self.device.event()?;
        self.broad.learn()?;
        start.to(&end)
    }

    fn frame(&mut self) -> Result<(Found<'_>, Stages), Error> {
        self.submission = None;
        let reruns = self.reruns;
        self.launch_ms = 0.0;
        let mut fits = true;
        loop {
            self.device.goes_on()?;
            self.launch(fits)?;
            fits = false;
            self.read_ahead()?;
            let counters = self.counters.read()?;
            self.demand.counted(&counters, &self.device)?;
            if self.has_overflowed(&counters) {
                // Some list, somewhere: find out step by step.
                self.settled = false;
                self.reruns += 1;
                continue;
            }
            self.settled = true;
            self.broad.finish(&counters)?;
            let stages = self.marked()?;
            self.last.clone_from(&counters);
            return Ok((self.gather(counters, self.reruns - reruns)?, stages));
        }
    }

    fn after(&mut self, rows: u64) {
        self.demand.before = rows;
    }

    fn take(&mut self, share: Share) -> Result<(), Error> {
        self.submission = None;
        if share != Share::WHOLE {
            self.broad.divide(&self.device)?;
        }
        self.share = share;
        Ok(())
    }

    fn work(&self) -> Result<Vec<u64>, Error> {
        self.broad.work()
    }

    fn met_beyond(&self) -> Result<u64, Error> {
        self.broad.met_beyond()
    }

    fn depths(&self) -> Vec<usize> {
        self.broad.depths()
    }

    fn reruns(&self) -> u64 {
        self.reruns
    }

    fn fingerprints(&self) -> Result<Vec<(&'static str, u64)>, Error> {
        let mut prints = self.broad.fingerprints()?;
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

    fn check(&self) -> Result<(), Error> {
        let faces = self.faces.read(self.faces.len())?;
        self.broad.check(&self.layout, &faces, &self.vertices.positions()?)
    }
}
