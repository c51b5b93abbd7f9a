//! Narrow: from candidates to contacts. Each kind of query has a file here; the pipeline depends on
//! none.

mod answer;
mod bodies;
mod capacities;
mod continuous;
mod cull;
mod discrete;
mod distance;
mod exclude;
mod features;
mod left;
mod near;
mod rung;
mod rungs;
mod start;
mod thin;
mod turning;

pub use answer::{AnswerLists, RowSpans};
pub use capacities::Capacities;
pub use continuous::ContinuousNarrow;
pub use discrete::DiscreteNarrow;
pub use exclude::Exclusions;
pub use features::Features;

use super::broad::Placeable;
use super::counts::{Counts, FrameCounters};
use super::layout::Layout;
use super::list::{GrowableOutput, Named};
use super::order::Ordering;
use super::precision::Precision;
use super::typed::Listed;
use crate::device::{Ahead, Device};
use crate::error::Error;
use crate::query::Query;
use crate::scene::Body;
use bodies::BodiesNarrow;
use distance::DistanceNarrow;
use near::NearNarrow;
use nearmiss_kernels::abi::{
    BodyRecord, BodyTolerance, Counters, ExclusionTables, Output, Pair, Point, Positions, Span,
};

/// Inputs of every step of the stage.
pub struct NarrowContext<'a, R: Precision> {
    /// The device.
    pub device: &'a Device,
    /// Positions.
    pub frames: Positions<R>,
    /// Vertices of rigid bodies, as they are without a pose.
    pub rest: Span<Point<R>>,
    /// Vertex indices of every triangle.
    pub faces: Span<[u32; 3]>,
    /// Candidate triangle pairs.
    pub pairs: Output<Pair>,
    /// Records of the bodies for the kernels; empty if there is only one body.
    pub bodies: Span<BodyRecord>,
    /// The frame's counters.
    pub counters: Counters,
    /// Edges, owned features, and candidates; empty without a query of features.
    pub features: &'a Features,
    /// Pairs of features that the scene excludes.
    pub excluded: ExclusionTables,
    /// Meshes and bodies, if candidates are those of instances.
    pub placeable: Option<Placeable>,
    /// Whether memory may be taken; not while launches are listed.
    pub may_grow: bool,
    /// Whether candidates are those of a sample, which gives a bound.
    pub is_sample: bool,
}

/// The narrow phase of a kind of query: its steps, their lists, and its answer.
pub trait Narrow<R: Precision>: Send {
    /// Returns the names of the steps, in order; each reads the lists of the one before.
    fn steps(&self) -> Vec<&'static str>;

    /// Launches step number `step`.
    ///
    /// # Errors
    /// Device errors.
    fn run(&mut self, step: usize, given: &NarrowContext<R>) -> Result<(), Error>;

    /// Allocates memory for samples, if they help. Called if the broad phase can sample.
    ///
    /// # Errors
    /// Device errors.
    fn take_samples(&mut self, _device: &Device) -> Result<(), Error> {
        Ok(())
    }

    /// Returns whether a sample bounds the candidates.
    fn samples(&self) -> bool {
        false
    }

    /// Returns the place of the time that bounds the candidates, of a sample or given; `None` if
    /// there is none.
    fn bound(&self) -> Option<Span<u64>> {
        None
    }

    /// Takes or releases the memory of a second pass of submissions, for the contacts at the earliest
    /// time. Returns whether it has one. Then its rows are these contacts.
    ///
    /// # Errors
    /// Device errors.
    fn take_second(&mut self, _device: &Device, _wanted: bool) -> Result<bool, Error> {
        Ok(false)
    }

    /// Launches the second pass, behind all steps.
    ///
    /// # Errors
    /// Device errors.
    fn second(&mut self, _given: &NarrowContext<R>) -> Result<(), Error> {
        Ok(())
    }

    /// Returns the counters of the second pass, if there is one.
    fn counters_of_second(&self) -> Option<&FrameCounters> {
        None
    }

    /// Returns the lists that the second pass fills, by its own counters.
    fn lists_of_second(&mut self) -> Vec<&mut dyn GrowableOutput> {
        Vec::new()
    }

    /// Returns whether it counts the triangle pairs that share a point at the start of the step.
    fn checks_start(&self) -> bool {
        false
    }

    /// Sets the numbers of another query of the same shape: distances, tolerances, limits.
    ///
    /// # Errors
    /// Device errors.
    fn set(&mut self, _device: &Device, _query: &Query, _tolerances: &[BodyTolerance]) -> Result<(), Error> {
        Ok(())
    }

    /// Returns the lists that step number `step` fills.
    fn lists<'a>(&'a mut self, step: usize, features: &'a mut Features) -> Vec<&'a mut dyn GrowableOutput>;

    /// Returns the lists between candidates and contacts, with names: for comparing machines. Lists
    /// that depend on the order of lanes are left out.
    fn between<'a>(&'a self, features: &'a Features) -> Vec<Named<'a>>;

    /// Updates for new positions: the size of the bodies may matter.
    fn place(&mut self, _bodies: &[Body], _layout: &Layout) {}

    /// Returns the device's ordering; none if there is nothing to order.
    fn ordering(&mut self) -> Option<&mut dyn Ordering>;

    /// Makes the device order its results, with room for `room` of them at first.
    ///
    /// # Errors
    /// Device errors.
    fn order_on(&mut self, device: &Device, layout: &Layout, room: usize) -> Result<(), Error> {
        self.ordering().map_or(Ok(()), |ordering| ordering.begin(device, layout, room))
    }

    /// Returns the lists of the device's ordering; none if the host orders.
    fn ordered(&mut self) -> Vec<&mut dyn GrowableOutput> {
        self.ordering().map_or(Vec::new(), Ordering::lists)
    }

    /// Launches the ordering, if the device orders. `is_submitted` is whether the caller's kernels
    /// read contacts in order.
    ///
    /// # Errors
    /// Device errors.
    fn order(&mut self, given: &NarrowContext<R>, is_submitted: bool) -> Result<(), Error>;

    /// Returns the memory that [`Narrow::gather`] will read, by the counters of the last frame.
    fn ahead(&self, last: &Counts) -> Vec<Ahead<'_>>;

    /// Returns the results, by the frame's counters.
    ///
    /// # Errors
    /// Device errors.
    fn gather(&self, counters: &Counts) -> Result<Listed<'_>, Error>;

    /// Returns the place of the answer.
    fn answer(&self, features: &Features) -> AnswerLists;

    /// Returns the rows for kernels that follow; `None` if there are none of pairs.
    fn rows(&self, _: Counters) -> Option<RowSpans> {
        None
    }
}

/// Returns the narrow phase of a query, with room for `few` of its candidates at first.
///
/// # Errors
/// Device errors.
pub fn narrow<R: Precision>(
    device: &Device,
    layout: &Layout,
    query: &Query,
    few: usize,
) -> Result<Box<dyn Narrow<R>>, Error> {
    let excludes = !layout.excluded.is_empty();
    let mut narrow: Box<dyn Narrow<R>> = match query {
        Query::Discrete(query) => {
            let mut narrow =
                DiscreteNarrow::new::<R>(device, query.test, few)?.only_crossing(query.only_crossing);
            if excludes {
                narrow.exclude(device, few)?;
            }
            Box::new(narrow)
        }
        Query::Continuous(continuous) => {
            let mut narrow = ContinuousNarrow::all(device, continuous.solver, layout, few)?;
            if continuous.until.is_some() {
                narrow.take_bound(device)?;
            }
            Box::new(in_motion::<R>(narrow, device, (query.checks_start(), excludes), few)?)
        }
        Query::Earliest(earliest) => {
            let narrow = ContinuousNarrow::first(device, earliest.solver, layout, few)?;
            Box::new(in_motion::<R>(narrow, device, (query.checks_start(), excludes), few)?)
        }
        Query::Near(query) => Box::new(NearNarrow::new(device, query.distance, layout, few)?),
        Query::Distance(_) => Box::new(DistanceNarrow::new::<R>(device, few)?),
        Query::BodyPairs(query) => Box::new(BodiesNarrow::pairs(device, query.first, few)?),
        Query::BodyDistances(_) => Box::new(BodiesNarrow::distances(device, few)?),
    };
    if device.is_gpu() {
        narrow.order_on(device, layout, few / 4)?;
    }
    Ok(narrow)
}

/// Adds the parts that a query in motion needs: the check of its start, and lists of a scene that
/// excludes pairs.
fn in_motion<R: Precision>(
    mut narrow: ContinuousNarrow,
    device: &Device,
    (checks_start, excludes): (bool, bool),
    few: usize,
) -> Result<ContinuousNarrow, Error> {
    if checks_start {
        narrow = narrow.checking_start::<R>(device, few / 4)?;
    }
    if excludes {
        narrow.exclude(device, few)?;
    }
    Ok(narrow)
}

/// Returns lists as outputs that can grow.
fn growable<'a, T: GrowableOutput + 'a>(
    lists: impl IntoIterator<Item = &'a mut T>,
) -> impl Iterator<Item = &'a mut dyn GrowableOutput> {
    lists.into_iter().map(|list| list as &mut dyn GrowableOutput)
}
