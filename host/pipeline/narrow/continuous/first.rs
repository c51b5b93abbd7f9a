//! The contacts at the earliest time, in a submission: lists and launches behind the solver.
//!
//! Pairs that the solver of an earliest query tested hold all that have the least time: others begin
//! later. Those that may begin at that time are solved again, for contacts. So there is no second
//! broad phase, and without a time every list is empty.

use super::{ContinuousNarrow, Tested};
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::counts::FrameCounters;
use crate::pipeline::launch;
use crate::pipeline::list::{GrowableOutput, List};
use crate::pipeline::narrow::left::{OfKinds, lists};
use crate::pipeline::narrow::thin::Thin;
use crate::pipeline::narrow::{NarrowContext, cull, growable};
use crate::pipeline::precision::Precision;
use crate::query::Certified;
use nearmiss_kernels::abi::{FirstHitsArgs, FirstPairsArgs, Hit, Pair, Span, counter};
use nearmiss_kernels::entry::narrow_first_hits;

/// Entries of each list for which there is room at first.
const FEW: usize = 1024;

/// Pairs at the earliest time.
const PAIRS: OfKinds = [
    ("", "vertex/face pairs at the earliest time", counter::VF_SURVIVORS),
    ("", "edge/edge pairs at the earliest time", counter::EE_SURVIVORS),
];
/// The same without a thickness.
const THIN: OfKinds = [
    ("", "thin vertex/face pairs at the earliest time", counter::VF_THIN),
    ("", "thin edge/edge pairs at the earliest time", counter::EE_THIN),
];
/// The same of bodies that turn.
const TURNING: OfKinds = [
    ("", "vertex/face pairs that turn, at the earliest time", counter::VF_TURNING),
    ("", "edge/edge pairs that turn, at the earliest time", counter::EE_TURNING),
];
/// Their contacts.
const HITS: OfKinds = [
    ("", "vertex/face contacts by the earliest time", counter::VF_HITS),
    ("", "edge/edge contacts by the earliest time", counter::EE_HITS),
];

/// Memory of the second pass; counters are its own, lists between rungs are those of the first pass.
pub struct SecondPass {
    counters: FrameCounters,
    /// Pairs that may begin at the earliest time.
    pairs: [List<Pair>; 2],
    /// Those without a thickness, in a scene in which the others have one.
    thin: Option<[List<Pair>; 2]>,
    /// Those of bodies that turn.
    turning: [List<Pair>; 2],
    /// Contacts of these pairs, also later ones.
    hits: [List<Hit>; 2],
}

impl SecondPass {
    fn new(device: &Device, is_mixed: bool) -> Result<SecondPass, Error> {
        let few = [FEW, FEW];
        Ok(SecondPass {
            counters: FrameCounters::new(device)?,
            pairs: lists(device, PAIRS, few)?,
            thin: is_mixed.then(|| lists(device, THIN, few)).transpose()?,
            turning: lists(device, TURNING, [0, 0])?,
            hits: lists(device, HITS, few)?,
        })
    }
}

impl ContinuousNarrow {
    /// Takes or releases the memory of the contacts at the earliest time. Returns whether there are
    /// such: of an earliest query.
    ///
    /// # Errors
    /// Device errors.
    pub(super) fn keep_second(&mut self, device: &Device, wanted: bool) -> Result<bool, Error> {
        if self.earliest.is_none() {
            return Ok(false);
        }
        if wanted && self.second.is_none() {
            self.second = Some(SecondPass::new(device, self.thin.is_some())?);
            [&mut self.vf_hits, &mut self.ee_hits]
                .into_iter()
                .try_for_each(|list| list.reserve(device, FEW))?;
        } else if !wanted && self.second.take().is_some() {
            [self.vf_hits, self.ee_hits] = ContinuousNarrow::hits(device, [0, 0])?;
        }
        Ok(wanted)
    }

    /// Returns the counters of the second pass.
    pub(super) fn second_counters(&self) -> Option<&FrameCounters> {
        self.second.as_ref().map(|second| &second.counters)
    }

    /// Returns the lists that the second pass fills, by these counters.
    pub(super) fn lists_of_second(&mut self) -> Vec<&mut dyn GrowableOutput> {
        let Some(SecondPass { pairs, thin, turning, hits, .. }) = &mut self.second else {
            return Vec::new();
        };
        let pairs = growable(pairs).chain(growable(thin.iter_mut().flatten())).chain(growable(turning));
        let rungs = self.rungs.lists().chain(self.thin.iter_mut().flat_map(Thin::left));
        pairs.chain(growable(hits)).chain(rungs).chain(self.turning.left()).collect()
    }

    /// Launches the second pass, behind the whole first one.
    ///
    /// # Errors
    /// Device errors.
    pub(super) fn run_second<R: Precision>(&mut self, given: &NarrowContext<R>) -> Result<(), Error> {
        let (Some(second), Some(earliest)) = (&mut self.second, &self.earliest) else { return Ok(()) };
        second.counters.clear()?;
        let (earliest, counters) = (earliest.span(), second.counters.counters());
        let Some(second) = &self.second else { return Ok(()) };
        let again = NarrowContext { counters, ..*given };
        let (pairs, turning) = (second.pairs.each_ref(), second.turning.each_ref());
        let cut = Cut { tested: self.tested(given.features), may: pairs, cuts: self.isolates() };
        self.cut(&again, given, (&cut, self.solver.certified()), earliest)?;
        if let (Some(of_thin), Some(may)) = (&self.thin, &second.thin) {
            let cut = Cut { tested: of_thin.tested(), may: may.each_ref(), cuts: true };
            self.cut(&again, given, (&cut, Some(of_thin.certified())), earliest)?;
        }
        if !given.frames.turns.is_empty() {
            let cut = Cut { tested: self.turning.tested(), may: turning, cuts: false };
            self.cut(&again, given, (&cut, self.solver.certified()), earliest)?;
        }
        let [vf, ee] = second.hits.each_ref();
        let tested = Tested { pairs, thin: second.thin.as_ref().map(<[_; 2]>::each_ref), turning };
        self.launch_solver(&again, &tested, ([vf, ee], Span::EMPTY))?;
        let args = FirstHitsArgs {
            vf: vf.output(counters),
            ee: ee.output(counters),
            first_vf: self.vf_hits.output(given.counters),
            first_ee: self.ee_hits.output(given.counters),
            earliest,
        };
        launch::striding::<narrow_first_hits>(given.device, vf.capacity() + ee.capacity(), &args)
    }

    /// Keeps tested pairs of the first pass that may begin at the earliest time.
    fn cut<R: Precision>(
        &self,
        again: &NarrowContext<R>,
        first: &NarrowContext<R>,
        (cut, certified): (&Cut, Option<&Certified>),
        earliest: Span<u64>,
    ) -> Result<(), Error> {
        let outputs = |lists: [&List<Pair>; 2], counters| lists.map(|list| list.output(counters));
        let lists = [outputs(cut.tested, first.counters), outputs(cut.may, again.counters)];
        let tested = cull::args(again, lists, certified, earliest);
        let capacity = cut.tested.iter().map(|list| list.capacity()).sum();
        let args = FirstPairsArgs { tested, all: u32::from(!cut.cuts), pad: 0 };
        launch::striding::<R::FirstPairs>(again.device, capacity, &args)
    }
}

/// Pairs of one solver.
struct Cut<'a> {
    /// Those of the first pass.
    tested: [&'a List<Pair>; 2],
    /// The lists of those that stay.
    may: [&'a List<Pair>; 2],
    /// Whether some are dropped; otherwise all stay.
    cuts: bool,
}
