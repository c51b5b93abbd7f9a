//! Pairs of bodies: which share a point, and the least distance of each pair.

use super::{AnswerLists, Features, Narrow, NarrowContext};
use crate::contacts::Entries;
use crate::device::{Ahead, Device};
use crate::error::Error;
use crate::pipeline::counts::Counts;
use crate::pipeline::launch;
use crate::pipeline::list::{GrowableOutput, List, Named};
use crate::pipeline::order::Ordering;
use crate::pipeline::precision::Precision;
use crate::pipeline::typed::Listed;
use crate::query::Query;
use nearmiss_kernels::abi::{BodiesNarrowArgs, BodyTolerance, NearestHit, Output, Pair, Span, counter};
use nearmiss_kernels::entry;

/// The rows of a query.
enum Rows {
    /// Pairs of bodies that share a point, and how many are wanted.
    Meeting(List<Pair>, Option<u32>),
    /// The nearest triangles of each pair of bodies.
    Nearest(List<NearestHit>),
}

/// The lists of a query of pairs of bodies.
pub struct BodiesNarrow {
    rows: Rows,
}

impl BodiesNarrow {
    /// Allocates the lists of pairs that share a point, with room for `few`.
    ///
    /// # Errors
    /// Device errors.
    pub fn pairs(device: &Device, first: Option<u32>, few: usize) -> Result<Self, Error> {
        let meeting = List::new(device, "bodies that share a point", counter::MEETING_BODIES, few)?;
        Ok(BodiesNarrow { rows: Rows::Meeting(meeting, first) })
    }

    /// Allocates the lists of distances, with room for `few`.
    ///
    /// # Errors
    /// Device errors.
    pub fn distances(device: &Device, few: usize) -> Result<Self, Error> {
        let nearest = List::new(device, "nearest triangles of bodies", counter::NEAR_BODIES, few)?;
        Ok(BodiesNarrow { rows: Rows::Nearest(nearest) })
    }

    /// Arguments over candidates, and of distances over those left of bodies that share a point.
    fn args<R: Precision>(&self, given: &NarrowContext<R>) -> Result<[BodiesNarrowArgs; 2], Error> {
        let Some(placeable) = given.placeable else {
            return Err(Error::Bug { what: "pairs of bodies are instances, and there are none".into() });
        };
        let (meeting, nearest) = match &self.rows {
            Rows::Meeting(list, _) => (list.output(given.counters), Output::EMPTY),
            Rows::Nearest(list) => (Output::EMPTY, list.output(given.counters)),
        };
        let all = BodiesNarrowArgs {
            tables: placeable.tables,
            relations: given.counters.output(placeable.relations, counter::RELATIONS),
            tile_pairs: placeable.tile_pairs,
            words: placeable.words,
            pairs: given.pairs,
            meeting,
            nearest,
            any: matches!(self.rows, Rows::Meeting(..)).into(),
            of_touching: 0,
        };
        let (left, tile_pairs) = placeable.left;
        let pairs = given.counters.output(left, counter::TOUCHING_PAIRS);
        Ok([all, BodiesNarrowArgs { pairs, tile_pairs, of_touching: 1, ..all }])
    }
}

impl<R: Precision> Narrow<R> for BodiesNarrow {
    fn steps(&self) -> Vec<&'static str> {
        match self.rows {
            Rows::Meeting(..) => vec!["decide", "rows"],
            Rows::Nearest(_) => vec!["decide", "least", "rows"],
        }
    }

    fn run(&mut self, step: usize, given: &NarrowContext<R>) -> Result<(), Error> {
        let (device, [args, left]) = (given.device, self.args(given)?);
        let [candidates, of_left] = [args, left].map(|args| args.pairs.room() as usize);
        match (&self.rows, step) {
            (Rows::Meeting(..), 0) => {
                launch::striding::<entry::narrow_bodies_exact>(device, candidates, &args)
            }
            (Rows::Meeting(..), _) => {
                let relations = args.relations.room() as usize;
                launch::striding::<entry::narrow_bodies_meeting>(device, relations, &args)
            }
            (Rows::Nearest(_), 0) => launch::striding::<entry::narrow_bodies_exact>(device, of_left, &left),
            (Rows::Nearest(_), 1) => {
                launch::striding::<entry::narrow_bodies_least>(device, candidates, &args)?;
                launch::striding::<entry::narrow_bodies_first>(device, candidates, &args)
            }
            (Rows::Nearest(_), _) => {
                launch::striding::<entry::narrow_bodies_nearest>(device, of_left, &left)?;
                launch::striding::<entry::narrow_bodies_nearest>(device, candidates, &args)
            }
        }
    }

    fn set(&mut self, _: &Device, query: &Query, _: &[BodyTolerance]) -> Result<(), Error> {
        if let (Rows::Meeting(_, first), Query::BodyPairs(query)) = (&mut self.rows, query) {
            *first = query.first;
        }
        Ok(())
    }

    fn lists<'a>(&'a mut self, step: usize, _: &'a mut Features) -> Vec<&'a mut dyn GrowableOutput> {
        match (&mut self.rows, step) {
            (Rows::Meeting(..), 0) | (Rows::Nearest(_), 0 | 1) => Vec::new(),
            (Rows::Meeting(list, _), _) => vec![list],
            (Rows::Nearest(list), _) => vec![list],
        }
    }

    /// Its lists depend on the order of lanes.
    fn between<'a>(&'a self, _: &'a Features) -> Vec<Named<'a>> {
        Vec::new()
    }

    /// The host orders rows: a pair of bodies has one.
    fn ordering(&mut self) -> Option<&mut dyn Ordering> {
        None
    }

    fn order(&mut self, _: &NarrowContext<R>, _: bool) -> Result<(), Error> {
        Ok(())
    }

    fn ahead(&self, last: &Counts) -> Vec<Ahead<'_>> {
        match &self.rows {
            Rows::Meeting(list, _) => vec![list.ahead(last)],
            Rows::Nearest(list) => vec![list.ahead(last)],
        }
    }

    fn gather(&self, counters: &Counts) -> Result<Listed<'_>, Error> {
        Ok(match &self.rows {
            Rows::Meeting(list, first) => Listed::BodyPairs { pairs: list.view(counters)?, first: *first },
            Rows::Nearest(list) => Listed::BodyDistances(list.view(counters)?),
        })
    }

    /// Its rows as entries without an order.
    fn answer(&self, _: &Features) -> AnswerLists {
        let (entries, list, counter) = match &self.rows {
            Rows::Meeting(list, _) => {
                (Entries::BodyPairs, (list.entries().addr(), list.capacity()), list.counter())
            }
            Rows::Nearest(list) => {
                (Entries::Nearest, (list.entries().addr(), list.capacity()), list.counter())
            }
        };
        AnswerLists {
            entries,
            lists: vec![list],
            is_ordered: false,
            counters: vec![counter],
            earliest: None,
            crossing: None,
            edges: Span::EMPTY,
        }
    }
}
