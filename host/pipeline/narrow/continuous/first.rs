//! The contacts at the earliest time, in a submission: lists and launches behind the solver.
//!
//! Pairs that the solver of an earliest query tested hold all that have the least time: others begin
//! later. Those that may begin at that time are solved again, for contacts. So there is no second
//! broad phase, and without a time every list is empty.

use super::ContinuousNarrow;
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::counts::FrameCounters;
use crate::pipeline::launch;
use crate::pipeline::list::{GrowableOutput, List};
use crate::pipeline::narrow::{NarrowContext, growable};
use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::{CullArgs, FirstHitsArgs, FirstPairsArgs, Hit, Pair, Span, counter};
use nearmiss_kernels::entry::narrow_first_hits;

/// Entries of each list for which there is room at first.
const FEW: usize = 1024;

/// Memory of the second pass; counters are its own, lists between rungs are those of the first pass.
pub struct SecondPass {
    counters: FrameCounters,
    /// Pairs that may begin at the earliest time.
    pairs: [List<Pair>; 2],
    /// Those of bodies that turn.
    turning: [List<Pair>; 2],
    /// Contacts of these pairs, also later ones.
    hits: [List<Hit>; 2],
}

impl SecondPass {
    fn new(device: &Device) -> Result<SecondPass, Error> {
        let pairs = |name, counter, room| List::<Pair>::new(device, name, counter, room);
        let hits = |name, counter| List::<Hit>::new(device, name, counter, FEW);
        Ok(SecondPass {
            counters: FrameCounters::new(device)?,
            pairs: [
                pairs("vertex/face pairs at the earliest time", counter::VF_SURVIVORS, FEW)?,
                pairs("edge/edge pairs at the earliest time", counter::EE_SURVIVORS, FEW)?,
            ],
            turning: [
                pairs("vertex/face pairs that turn, at the earliest time", counter::VF_TURNING, 0)?,
                pairs("edge/edge pairs that turn, at the earliest time", counter::EE_TURNING, 0)?,
            ],
            hits: [
                hits("vertex/face contacts by the earliest time", counter::VF_HITS)?,
                hits("edge/edge contacts by the earliest time", counter::EE_HITS)?,
            ],
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
            self.second = Some(SecondPass::new(device)?);
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
        let Some(SecondPass { pairs, turning, hits, .. }) = &mut self.second else { return Vec::new() };
        growable(pairs).chain(growable(turning)).chain(growable(hits)).chain(self.rungs.lists()).collect()
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
        let pairs = second.pairs.each_ref();
        let turning = second.turning.each_ref();
        self.keep_pairs(&again, (self.tested(given.features), given), (pairs, earliest), self.isolates())?;
        if !given.frames.turns.is_empty() {
            self.keep_pairs(&again, (self.turning.tested(), given), (turning, earliest), false)?;
        }
        let [vf, ee] = second.hits.each_ref();
        self.launch_solver(&again, [pairs, turning], ([vf, ee], Span::EMPTY))?;
        let args = FirstHitsArgs {
            vf: vf.output(counters),
            ee: ee.output(counters),
            first_vf: self.vf_hits.output(given.counters),
            first_ee: self.ee_hits.output(given.counters),
            earliest,
        };
        launch::striding::<narrow_first_hits>(given.device, vf.capacity() + ee.capacity(), &args)
    }

    /// Keeps tested pairs of the first pass that may begin at the earliest time; all of them unless
    /// `cuts`.
    fn keep_pairs<R: Precision>(
        &self,
        again: &NarrowContext<R>,
        ([vf, ee], first): ([&List<Pair>; 2], &NarrowContext<R>),
        ([may_vf, may_ee], earliest): ([&List<Pair>; 2], Span<u64>),
        cuts: bool,
    ) -> Result<(), Error> {
        let tested = CullArgs {
            frames: again.frames,
            faces: again.faces,
            edges: again.features.edges.span(),
            vf: vf.output(first.counters),
            ee: ee.output(first.counters),
            may_vf: may_vf.output(again.counters),
            may_ee: may_ee.output(again.counters),
            params: self.solver.certified().copied().unwrap_or_default().params(),
            known: earliest,
        };
        let args = FirstPairsArgs { tested, all: u32::from(!cuts), pad: 0 };
        launch::striding::<R::FirstPairs>(again.device, vf.capacity() + ee.capacity(), &args)
    }
}
