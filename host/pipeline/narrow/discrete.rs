//! Triangles at one time: their lists, and the launches from triangle pairs to those that meet.

use super::answer::rows_of;
use super::exclude::exclude_triangles;
use super::{AnswerLists, Features, Narrow, NarrowContext, RowSpans, growable};
use crate::contacts::Entries;
use crate::device::{Ahead, Device};
use crate::error::Error;
use crate::pipeline::broad::Placeable;
use crate::pipeline::counts::Counts;
use crate::pipeline::launch;
use crate::pipeline::list::{GrowableOutput, List, Named, named};
use crate::pipeline::order::{Order, Ordering, Unordered};
use crate::pipeline::precision::Precision;
use crate::pipeline::typed::{Hits, Listed};
use crate::query::TriangleTest;
use nearmiss_kernels::abi::{
    Counters, DiscreteArgs, DiscreteFlags, Output, Pair, PlacedArgs, Positions, Span, counter,
};
use nearmiss_kernels::entry::{narrow_exact_placed, narrow_filter_placed};
use nearmiss_kernels::stage::narrow::certain::LANES_A_PAIR;

/// The lists of a discrete query.
pub struct DiscreteNarrow {
    /// Flags of the exact test.
    flags: DiscreteFlags,
    /// Pairs that meet.
    pub contacts: List<Pair>,
    /// Those that meet with those that are excluded, in a scene that excludes some.
    all: Option<List<Pair>>,
    /// Pairs that each filter left to the next, the last one to exact signs; only for the exact
    /// test.
    uncertain: Vec<List<Pair>>,
    /// The contacts in order, if the device orders them.
    ordered: Option<Order<Pair>>,
}

impl DiscreteNarrow {
    /// Allocates the lists for positions of this precision, with room for `few` contacts.
    ///
    /// # Errors
    /// Device errors.
    pub fn new<R: Precision>(device: &Device, test: TriangleTest, few: usize) -> Result<Self, Error> {
        let mut uncertain = Vec::new();
        match test {
            TriangleTest::Exact { .. } => {
                uncertain.push(List::new(device, "uncertain pairs", counter::UNCERTAIN, few)?);
                if R::WIDENS {
                    let at = counter::UNCERTAIN_WIDE;
                    uncertain.push(List::new(device, "pairs uncertain in f64", at, few / 4)?);
                }
            }
            TriangleTest::Moller => {}
        }
        let contacts = List::new(device, "contacts", counter::CONTACTS, few)?;
        let flags = DiscreteFlags::KEEP_ADJACENT.when(test.has_adjacent());
        Ok(DiscreteNarrow { flags, contacts, all: None, uncertain, ordered: None })
    }

    /// Returns the lists of a query that leaves out what touches without crossing, or not.
    #[must_use]
    pub fn only_crossing(self, is_only: bool) -> Self {
        DiscreteNarrow { flags: self.flags | DiscreteFlags::ONLY_CROSSING.when(is_only), ..self }
    }

    /// Drops pairs that are excluded, behind the test; with room for `few` contacts.
    ///
    /// # Errors
    /// Device errors.
    pub fn exclude(&mut self, device: &Device, few: usize) -> Result<(), Error> {
        self.all = Some(List::new(device, "contacts, with those excluded", counter::ALL_CONTACTS, few)?);
        Ok(())
    }

    /// Returns the list of the pairs that the test finds.
    fn found(&self) -> &List<Pair> {
        self.all.as_ref().unwrap_or(&self.contacts)
    }

    /// Returns the lists that the test fills.
    pub fn all_lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        let found = self.all.as_mut().unwrap_or(&mut self.contacts);
        let contacts = std::iter::once(found as &mut dyn GrowableOutput);
        contacts.chain(growable(&mut self.uncertain)).collect()
    }

    /// Returns the pairs that each filter left to the next, with names.
    pub fn uncertain(&self) -> Vec<Named<'_>> {
        ["narrow: uncertain", "narrow: uncertain in f64"]
            .into_iter()
            .zip(&self.uncertain)
            .map(|(name, list)| named(name, list))
            .collect()
    }

    /// Launches the one step: a floating-point test, or the exact test. The exact test has filters
    /// with an error bound in f32 and in f64, and exact signs for the uncertain pairs.
    ///
    /// # Errors
    /// Device errors.
    pub fn decide<R: Precision>(&self, given: &NarrowContext<R>) -> Result<(), Error> {
        if let Some(placeable) = &given.placeable {
            return self.decide_placed(given, placeable);
        }
        let args = |pairs: Output<Pair>, uncertain: Option<&List<Pair>>| DiscreteArgs {
            frames: given.frames,
            faces: given.faces,
            pairs,
            contacts: self.found().output(given.counters),
            uncertain: uncertain.map_or(Output::EMPTY, |list| list.output(given.counters)),
            flags: self.flags,
            pad: 0,
        };
        let (device, capacity) = (given.device, given.pairs.room() as usize);
        let candidates = args(given.pairs, self.uncertain.first());
        let (first, last) = match &*self.uncertain {
            [] => return launch::striding::<R::Moller>(device, capacity, &candidates),
            [first, .., last] => (first, Some(last)),
            [first] => (first, None),
        };
        // A block that finds nothing costs its start: there are as many as run at once.
        launch::at_once::<R::Filter>(device, capacity, &candidates)?;
        let left = args(first.output(given.counters), last);
        let Some(last) = last else { return launch::at_once::<R::Exact>(device, lanes(first), &left) };
        launch::at_once::<R::Wide>(device, lanes(first), &left)?;
        launch::at_once::<R::Exact>(device, lanes(last), &args(last.output(given.counters), None))
    }
}

impl DiscreteNarrow {
    /// Launches the exact test over candidates of instances, whose vertices are placed as they are
    /// read. Two bodies have no common vertex.
    fn decide_placed<R: Precision>(
        &self,
        given: &NarrowContext<R>,
        placeable: &Placeable,
    ) -> Result<(), Error> {
        let Placeable { tables, relations, tile_pairs, .. } = *placeable;
        let args = |pairs: Output<Pair>, uncertain: Output<Pair>| PlacedArgs {
            lists: DiscreteArgs {
                frames: Positions { still: Span::EMPTY, moving: Span::EMPTY, turns: Span::EMPTY },
                faces: Span::EMPTY,
                pairs,
                contacts: self.found().output(given.counters),
                uncertain,
                flags: DiscreteFlags::ONLY_CROSSING.when(self.flags.has(DiscreteFlags::ONLY_CROSSING)),
                pad: 0,
            },
            tables,
            relations,
            tile_pairs,
        };
        let [left] = &*self.uncertain else {
            return Err(Error::Bug { what: "instances are tested by exact signs in f64 only".into() });
        };
        let (device, uncertain) = (given.device, left.output(given.counters));
        let candidates = args(given.pairs, uncertain);
        launch::striding::<narrow_filter_placed>(device, given.pairs.room() as usize, &candidates)?;
        launch::striding::<narrow_exact_placed>(device, lanes(left), &args(uncertain, Output::EMPTY))
    }
}

/// Returns the lanes that pairs of a list can use: one a sign where they are few.
pub fn lanes(uncertain: &List<Pair>) -> usize {
    uncertain.capacity() * LANES_A_PAIR as usize
}

impl<R: Precision> Narrow<R> for DiscreteNarrow {
    fn steps(&self) -> Vec<&'static str> {
        if self.all.is_some() { vec!["decide", "exclude"] } else { vec!["decide"] }
    }

    fn run(&mut self, step: usize, given: &NarrowContext<R>) -> Result<(), Error> {
        match &self.all {
            Some(all) if step == 1 => exclude_triangles(given, all, self.contacts.output(given.counters)),
            _ => self.decide(given),
        }
    }

    fn lists<'a>(&'a mut self, step: usize, _: &'a mut Features) -> Vec<&'a mut dyn GrowableOutput> {
        if step == 1 { vec![&mut self.contacts] } else { self.all_lists() }
    }

    fn between<'a>(&'a self, _: &'a Features) -> Vec<Named<'a>> {
        let all = self.all.iter().map(|all| named("narrow: contacts, with those excluded", all));
        self.uncertain().into_iter().chain(all).collect()
    }

    fn ordering(&mut self) -> Option<&mut dyn Ordering> {
        Some(&mut self.ordered)
    }

    fn order(&mut self, given: &NarrowContext<R>, is_submitted: bool) -> Result<(), Error> {
        let Some(order) = &mut self.ordered else { return Ok(()) };
        let unordered = Unordered { first: &self.contacts, second: None, decided: 0, is_submitted };
        order.run(given.device, &unordered, given.counters)
    }

    fn ahead(&self, last: &Counts) -> Vec<Ahead<'_>> {
        Hits::ahead(&[&self.contacts], self.ordered.as_ref(), last)
    }

    fn gather(&self, counters: &Counts) -> Result<Listed<'_>, Error> {
        Ok(Listed::Pairs(Hits::of(&[&self.contacts], self.ordered.as_ref(), counters)?))
    }

    fn rows(&self, counters: Counters) -> Option<RowSpans> {
        Some(RowSpans::Pairs(rows_of(&[&self.contacts], self.ordered.as_ref(), counters)))
    }

    fn answer(&self, _: &Features) -> AnswerLists {
        AnswerLists::of(Entries::TrianglePairs, &[&self.contacts], self.ordered.as_ref())
    }
}
