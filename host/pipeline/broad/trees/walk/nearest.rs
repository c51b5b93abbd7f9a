//! Nearest first: a bound of the least distance from samples, then a walk a leaf into what is not farther.

use super::{Walk, WalkContext};
use crate::error::Error;
use crate::pipeline::launch;
use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::{Counter, NearestArgs, Output, TraverseArgs, counter};
use nearmiss_kernels::entry::{self, Kernels};

/// Samples of each round, pairs that each measures at most, and which counter takes the bound: some that go down to one leaf, then
/// many, of which most end at the root. More find bounds that are hardly better (`benches/NOTES.md`).
const ROUNDS: [(u32, u32, Counter); 2] = [(256, 1, counter::SAMPLED), (4096, 2, counter::SAMPLED_AGAIN)];
/// Pairs of siblings that a sample looks at: several ways down any tree, so that none is long. What ends is a bound that is less good.
const STEPS: u32 = 128;

/// See [`crate::query::Traversal::NearestFirst`].
pub struct NearestFirst;

impl<R: Precision, V: Kernels> Walk<R, V> for NearestFirst {
    fn launch(&mut self, given: &WalkContext<R, V>) -> Result<(), Error> {
        let (forest, device) = (given.forest, given.device);
        let leaves = forest.tree.leaves();
        let (nodes, leaf_nodes) = (forest.volumes.nodes.span(), forest.tree.leaf_nodes.span());
        let mut from = counter::UNKNOWN;
        for (most, measures, to) in ROUNDS {
            let samples = most.min(leaves as u32);
            let args = NearestArgs {
                positions: given.frames.still,
                faces: given.faces,
                nodes,
                leaf_nodes,
                filters: given.filters(),
                counters: given.counters,
                samples,
                measures,
                steps: STEPS,
                flags: given.flags,
                from,
                to,
            };
            launch::each::<entry::traverse_sample<R, V>>(device, samples as usize, &args)?;
            from = to;
        }
        let args = TraverseArgs {
            nodes,
            leaf_nodes,
            filters: given.filters(),
            faces: given.faces,
            units: Output::EMPTY,
            spilled: Output::EMPTY,
            pairs: given.pairs,
            counters: given.counters,
            budget: u32::MAX,
            flags: given.flags,
        };
        let blocks = if device.is_gpu() {
            device.blocks_for::<entry::traverse_within<V>>(leaves)
        } else {
            device.blocks_striding::<entry::traverse_within<V>>(leaves)
        };
        launch::blocks::<entry::traverse_within<V>>(device, blocks, &args)
    }
}
