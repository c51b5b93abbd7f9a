//! The nearest triangles: which candidates share a point, and the nearest pair of the others.

use super::{AnswerLists, DiscreteNarrow, Features, Narrow, NarrowContext};
use crate::contacts::Entries;
use crate::device::{Ahead, Device};
use crate::error::Error;
use crate::pipeline::counts::Counts;
use crate::pipeline::launch;
use crate::pipeline::list::{GrowableOutput, List, Named};
use crate::pipeline::order::Ordering;
use crate::pipeline::precision::Precision;
use crate::pipeline::typed::Listed;
use crate::query::TriangleTest;
use nearmiss_kernels::abi::{LeastArgs, NearestHit, Span, counter};

/// A step of the phase.
#[derive(Clone, Copy)]
enum Step {
    /// Lists the candidates that share a point.
    Decide,
    /// Finds the least distance.
    Least,
    /// Finds the pair that has it.
    Nearest,
}

impl Step {
    /// All steps, in order.
    const ALL: [Step; 3] = [Step::Decide, Step::Least, Step::Nearest];
}

/// The lists of a distance query.
pub struct DistanceNarrow {
    /// Candidates that share a point.
    meeting: DiscreteNarrow,
    /// The nearest pair, if there is one.
    nearest: List<NearestHit>,
}

impl DistanceNarrow {
    /// Allocates the lists for positions of this precision, with room for `few` candidates that
    /// share a point.
    ///
    /// # Errors
    /// Device errors.
    pub fn new<R: Precision>(device: &Device, few: usize) -> Result<Self, Error> {
        Ok(DistanceNarrow {
            meeting: DiscreteNarrow::new::<R>(device, TriangleTest::default(), few)?,
            nearest: List::new(device, "the nearest pair", counter::NEAREST_PAIRS, 1)?,
        })
    }

    fn args<R: Precision>(&self, given: &NarrowContext<R>) -> LeastArgs<R> {
        LeastArgs {
            positions: given.frames.still,
            faces: given.faces,
            pairs: given.pairs,
            meeting: self.meeting.contacts.output(given.counters),
            nearest: self.nearest.output(given.counters),
            counters: given.counters,
        }
    }
}

impl<R: Precision> Narrow<R> for DistanceNarrow {
    fn steps(&self) -> Vec<&'static str> {
        let name = |step| match step {
            Step::Decide => "decide",
            Step::Least => "least",
            Step::Nearest => "nearest",
        };
        Step::ALL.map(name).into()
    }

    fn run(&mut self, step: usize, given: &NarrowContext<R>) -> Result<(), Error> {
        let (device, args) = (given.device, self.args(given));
        let capacity = given.pairs.room() as usize;
        match Step::ALL[step] {
            Step::Decide => self.meeting.decide(given),
            Step::Least => launch::striding::<R::Least>(device, capacity, &args),
            Step::Nearest => {
                launch::striding::<R::Witness>(device, capacity, &args)?;
                launch::blocks::<R::Nearest>(device, 1, &args)
            }
        }
    }

    fn lists<'a>(&'a mut self, step: usize, _: &'a mut Features) -> Vec<&'a mut dyn GrowableOutput> {
        match Step::ALL[step] {
            Step::Decide => self.meeting.all_lists(),
            Step::Least => Vec::new(),
            Step::Nearest => vec![&mut self.nearest],
        }
    }

    fn between<'a>(&'a self, _: &'a Features) -> Vec<Named<'a>> {
        self.meeting.uncertain()
    }

    fn ordering(&mut self) -> Option<&mut dyn Ordering> {
        None
    }

    fn order(&mut self, _: &NarrowContext<R>, _: bool) -> Result<(), Error> {
        Ok(())
    }

    fn ahead(&self, last: &Counts) -> Vec<Ahead<'_>> {
        vec![self.nearest.ahead(last)]
    }

    fn gather(&self, counters: &Counts) -> Result<Listed<'_>, Error> {
        Ok(Listed::Nearest(self.nearest.view(counters)?))
    }

    fn answer(&self, _: &Features) -> AnswerLists {
        AnswerLists {
            entries: Entries::Nearest,
            lists: vec![(self.nearest.entries().addr(), 1)],
            is_ordered: true,
            counters: vec![self.nearest.counter()],
            earliest: None,
            crossing: None,
            edges: Span::EMPTY,
        }
    }
}
