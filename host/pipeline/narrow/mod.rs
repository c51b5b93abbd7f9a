//! Narrow: from candidates to contacts. Each kind of query has a file here; the pipeline knows of none.

mod answer;
mod continuous;
mod discrete;
mod distance;
mod features;
mod near;
mod rungs;
mod start;

pub use answer::AnswerLists;
pub use continuous::{Capacities, ContinuousNarrow};
pub use discrete::DiscreteNarrow;
pub use features::Features;

use super::counts::Counts;
use super::layout::Layout;
use super::list::{GrowableOutput, List};
use super::order::Ordering;
use super::precision::Precision;
use super::typed::Listed;
use crate::device::{Ahead, Device};
use crate::error::Error;
use crate::query::Query;
use crate::scene::Body;
use distance::DistanceNarrow;
use near::NearNarrow;
use nearmiss_kernels::abi::{BodyRecord, BodyTolerance, Counters, Output, Pair, Positions, Span};

/// What every step of the stage is given.
pub struct NarrowContext<'a, R: Precision> {
    /// The machine.
    pub device: &'a Device,
    /// Positions.
    pub frames: Positions<R>,
    /// Vertex indices of every triangle.
    pub faces: Span<[u32; 3]>,
    /// Candidate triangle pairs.
    pub pairs: Output<Pair>,
    /// What the kernels know of the bodies; empty where there is one alone.
    pub bodies: Span<BodyRecord>,
    /// The frame's counters.
    pub counters: Counters,
    /// Edges, what triangles own, and candidates; empty without a query of features.
    pub features: &'a Features,
    /// Whether candidates are those of a sample, which is asked for a bound.
    pub is_sample: bool,
}

/// The narrow phase of a kind of query: its steps, the lists that they fill, and what it hands over.
pub trait Narrow<R: Precision>: Send {
    /// The names of the steps, in their order; each reads what the one before filled.
    fn steps(&self) -> Vec<&'static str>;

    /// Launches the step of that place.
    ///
    /// # Errors
    /// Those of the device.
    fn run(&mut self, step: usize, given: &NarrowContext<R>) -> Result<(), Error>;

    /// There can be samples: takes what they need, where they help.
    ///
    /// # Errors
    /// Those of the device.
    fn take_samples(&mut self, _device: &Device) -> Result<(), Error> {
        Ok(())
    }

    /// Where the bound of the earliest time lies that a sample finds. None where there is none.
    fn bound(&self) -> Option<Span<u64>> {
        None
    }

    /// Whether it counts the triangle pairs that share a point at the start of the step.
    fn checks_start(&self) -> bool {
        false
    }

    /// Takes the numbers of another query of the same shape: distances, tolerances, limits.
    ///
    /// # Errors
    /// Those of the device.
    fn set(&mut self, _device: &Device, _query: &Query, _tolerances: &[BodyTolerance]) -> Result<(), Error> {
        Ok(())
    }

    /// The lists that the step of that place fills.
    fn lists<'a>(&'a mut self, step: usize, features: &'a mut Features) -> Vec<&'a mut dyn GrowableOutput>;

    /// The lists between candidates and contacts, with names: for comparing machines. None of those that hang on the order in
    /// which lanes came.
    fn between<'a>(&'a self, features: &'a Features) -> Vec<(&'static str, &'a List<Pair>)>;

    /// The bodies are there now: how large they are may matter.
    fn place(&mut self, _bodies: &[Body]) {}

    /// How the device orders what is found; none where there is nothing to order.
    fn ordering(&mut self) -> Option<&mut dyn Ordering>;

    /// Has the device put into order what it finds, with room for so many at first.
    ///
    /// # Errors
    /// Those of the device.
    fn order_on(&mut self, device: &Device, layout: &Layout, room: usize) -> Result<(), Error> {
        self.ordering().map_or(Ok(()), |ordering| ordering.begin(device, layout, room))
    }

    /// What the device has put into order; none where the host does that.
    fn ordered(&mut self) -> Option<&mut dyn GrowableOutput> {
        self.ordering().and_then(Ordering::list)
    }

    /// Launches the ordering, where the device does that.
    ///
    /// # Errors
    /// Those of the device.
    fn order(&mut self, given: &NarrowContext<R>) -> Result<(), Error>;

    /// What [`Narrow::gather`] will look at, by the counters of the last frame.
    fn ahead(&self, last: &Counts) -> Vec<Ahead<'_>>;

    /// What was found, by the frame's counters, and whether it is in canonical order.
    ///
    /// # Errors
    /// Those of the device.
    fn gather(&self, counters: &Counts) -> Result<(Listed<'_>, bool), Error>;

    /// Where that lies.
    fn answer(&self, features: &Features) -> AnswerLists;
}

/// The narrow phase of a query, with room for `few` of its candidates at first.
///
/// # Errors
/// Those of the device.
pub fn narrow<R: Precision>(
    device: &Device,
    layout: &Layout,
    query: &Query,
    few: usize,
) -> Result<Box<dyn Narrow<R>>, Error> {
    let mut narrow: Box<dyn Narrow<R>> = match query {
        Query::Discrete(query) => Box::new(DiscreteNarrow::new::<R>(device, query.test, few)?),
        Query::Continuous(query) => {
            let narrow = ContinuousNarrow::all(device, query.solver, few)?;
            Box::new(if query.assume_free { narrow } else { narrow.checking_start::<R>(device, few / 4)? })
        }
        Query::Earliest(query) => {
            let narrow = ContinuousNarrow::first(device, query.solver, few)?;
            Box::new(if query.assume_free { narrow } else { narrow.checking_start::<R>(device, few / 4)? })
        }
        Query::Near(query) => Box::new(NearNarrow::new(device, query.distance, few)?),
        Query::Distance(_) => Box::new(DistanceNarrow::new::<R>(device, few)?),
    };
    if device.is_gpu() {
        narrow.order_on(device, layout, few / 4)?;
    }
    Ok(narrow)
}

/// Lists as what grows.
fn growable<'a, T: GrowableOutput + 'a>(
    lists: impl IntoIterator<Item = &'a mut T>,
) -> impl Iterator<Item = &'a mut dyn GrowableOutput> {
    lists.into_iter().map(|list| list as &mut dyn GrowableOutput)
}
