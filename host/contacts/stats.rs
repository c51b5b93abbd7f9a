//! Statistics of an answer's computation.

use super::{Front, Queues};
use crate::stages::Stages;

/// Statistics of an answer's computation. They are diagnostic and may change between versions.
/// Counts of an earliest query may differ between runs. Pairs that cannot be earlier are skipped,
/// and the order decides which.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Stats {
    /// Milliseconds by stage.
    pub stages: Stages,
    /// Triangle pairs whose volumes overlap.
    pub triangle_pairs: u64,
    /// Pairs of the narrow phase: triangles (discrete), or vertex/face and edge/edge pairs (other
    /// queries).
    pub candidates: u64,
    /// Candidates by kind: vertex/face, edge/edge. Zero for discrete queries.
    pub candidates_vf_ee: [u64; 2],
    /// Candidates of bodies that turn, tested on their arcs: vertex/face, edge/edge.
    pub turning_vf_ee: [u64; 2],
    /// Candidates that signs alone could not reject: vertex/face, edge/edge.
    pub survivors_vf_ee: [u64; 2],
    /// Candidates escalated from f32 to f64: vertex/face, edge/edge.
    pub escalated_vf_ee: [u64; 2],
    /// Candidates whose roots could not be isolated: vertex/face, edge/edge. With a minimum
    /// separation, those that the first step did not decide.
    pub open_vf_ee: [u64; 2],
    /// Open candidates that were cut into slices: vertex/face, edge/edge.
    pub sliced_vf_ee: [u64; 2],
    /// Triangle pairs left uncertain by the filter in the precision of the positions. A query in
    /// motion tests them at the start of the step.
    pub uncertain: u64,
    /// Uncertain pairs that f64 left uncertain too; none for f64 positions, which go straight to
    /// exact signs.
    pub uncertain_wide: u64,
    /// Pairs of sibling nodes that the traversal tested.
    pub steps: u64,
    /// Work units given up by long walks.
    pub spilled: u64,
    /// Reruns of a part of the frame after a list grew. They cost time; the answer is complete.
    pub reruns: u64,
    /// Slices of the frame: more than 1 if the lists of a whole one would exceed the memory.
    pub slices: u32,
    /// Statistics of the work queues.
    pub(crate) queues: Queues,
    /// Statistics of the front.
    pub(crate) front: Front,
}

impl Stats {
    /// Overlap tests of two volumes: two a step, and those of the front.
    pub fn overlap_tests(&self) -> u64 {
        2 * self.steps + self.front.tests
    }

    /// Adds the statistics of another share of the frame, except its times.
    pub(super) fn add(&mut self, share: &Stats) {
        let pairs =
            |own: &mut [u64; 2], other: [u64; 2]| own.iter_mut().zip(other).for_each(|(own, n)| *own += n);
        pairs(&mut self.candidates_vf_ee, share.candidates_vf_ee);
        pairs(&mut self.turning_vf_ee, share.turning_vf_ee);
        pairs(&mut self.survivors_vf_ee, share.survivors_vf_ee);
        pairs(&mut self.escalated_vf_ee, share.escalated_vf_ee);
        pairs(&mut self.open_vf_ee, share.open_vf_ee);
        pairs(&mut self.sliced_vf_ee, share.sliced_vf_ee);
        self.triangle_pairs += share.triangle_pairs;
        self.candidates += share.candidates;
        self.uncertain += share.uncertain;
        self.uncertain_wide += share.uncertain_wide;
        self.steps += share.steps;
        self.spilled += share.spilled;
        self.reruns += share.reruns;
        self.slices = self.slices.max(share.slices);
    }
}
