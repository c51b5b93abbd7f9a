//! Nearest first: samples give a bound of the least distance, then a walk per leaf visits the nodes
//! that are no farther.

use super::{Walk, WalkContext};
use crate::error::Error;
use crate::pipeline::launch;
use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::{Counter, NearestArgs, Output, TraverseArgs, counter};
use nearmiss_kernels::entry::{self, Kernels};

/// The rounds of samples: their number, the most pairs that each measures, and the counter of the
/// bound. The first ones go down to one leaf; most of the later ones end at the root. More samples
/// hardly improve the bound (`benches/NOTES.md`).
const ROUNDS: [(u32, u32, Counter); 2] = [(256, 1, counter::SAMPLED), (4096, 2, counter::SAMPLED_AGAIN)];
/// Most pairs of siblings that a sample visits: several descents of any tree, so that no sample is
/// long. A sample that stops early only gives a weaker bound.
const STEPS: u32 = 128;

/// The walk of [`crate::query::Traversal::NearestFirst`].
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
