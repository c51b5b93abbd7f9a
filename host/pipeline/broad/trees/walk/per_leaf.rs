//! A walk per leaf, then rounds over the units that longer walks left.

use super::{Walk, WalkContext};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::counts::Counts;
use crate::pipeline::launch;
use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::{Output, ROUNDS, TraverseArgs, Unit, counter};
use nearmiss_kernels::entry::{self, Kernels};

/// The walk of [`crate::query::Traversal::PerLeaf`].
pub struct PerLeaf {
    device: Device,
    budget: Option<u32>,
    /// Units that a round reads, and those that it leaves; only for walks with a budget.
    units: Option<[Buffer<Unit>; 2]>,
}

impl PerLeaf {
    /// Allocates walks of `triangles` leaves.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, budget: Option<u32>, triangles: usize) -> Result<Self, Error> {
        let units = || Ok::<_, Error>([device.buffer(4 * triangles)?, device.buffer(4 * triangles)?]);
        Ok(PerLeaf { device: device.clone(), budget, units: budget.map(|_| units()).transpose()? })
    }
}

impl<R: Precision, V: Kernels> Walk<R, V> for PerLeaf {
    fn launch(&mut self, given: &WalkContext<R, V>) -> Result<(), Error> {
        let (forest, device) = (given.forest, given.device);
        // The units that a round leaves, and their counter.
        let spilled = |units: &[Buffer<Unit>; 2], round: u32| {
            let round = round as usize;
            given.counters.output(units[round % 2].span(), counter::SPILLED[round])
        };
        let mut args = TraverseArgs {
            nodes: forest.volumes.nodes.span(),
            leaf_nodes: forest.tree.leaf_nodes.span(),
            filters: given.filters(),
            faces: given.faces,
            units: Output::EMPTY,
            spilled: self.units.as_ref().map_or(Output::EMPTY, |units| spilled(units, 0)),
            pairs: given.pairs,
            counters: given.counters,
            budget: self.budget.unwrap_or(u32::MAX),
            flags: given.flags,
        };
        let leaves = forest.tree.leaves();
        let blocks = if device.is_gpu() {
            device.blocks_for::<entry::traverse_leaves<V>>(leaves)
        } else {
            device.blocks_striding::<entry::traverse_leaves<V>>(leaves)
        };
        launch::blocks::<entry::traverse_leaves<V>>(device, blocks, &args)?;
        let Some(units) = &self.units else { return Ok(()) };
        let blocks = device.blocks_striding::<entry::traverse_units<V>>(units[0].len());
        for round in 0..ROUNDS {
            args.units = args.spilled;
            if round + 1 == ROUNDS {
                // No walk is that long: no unit is left.
                (args.budget, args.spilled) = (u32::MAX, Output::EMPTY);
            } else {
                args.spilled = spilled(units, round + 1);
            }
            launch::blocks::<entry::traverse_units<V>>(device, blocks, &args)?;
        }
        Ok(())
    }

    /// Lanes finished the units that had no room, which is correct and slow: the next frame has
    /// room for them.
    fn finish(&mut self, counters: &Counts) -> Result<(), Error> {
        let Some(units) = &mut self.units else { return Ok(()) };
        let most = counter::SPILLED.iter().map(|&round| counters[round]).max().unwrap_or(0) as usize;
        if most > units[0].len() {
            for list in units {
                *list = self.device.buffer(most + most / 8)?;
            }
        }
        Ok(())
    }
}
