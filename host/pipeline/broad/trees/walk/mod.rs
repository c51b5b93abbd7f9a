//! Traverse: the ways from the trees to candidates. Each is a strategy with its own memory; all give one set.

mod front;
mod nearest;
mod per_leaf;
mod queue;
mod segments;
mod steal;

use super::forest::Forest;
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::counts::Counts;
use crate::pipeline::list::GrowableOutput;
use crate::pipeline::precision::Precision;
use crate::query::{Query, Traversal};
use front::Front;
use nearest::NearestFirst;
use nearmiss_kernels::abi::{
    BodyRecord, Counters, FilterArgs, Output, Pair, PairArgs, Positions, Span, TraverseFlags,
};
use nearmiss_kernels::entry::{Entry, Kernels};
use per_leaf::PerLeaf;
use queue::Queue;
use steal::Steal;

/// What a walk is given: the machine, the trees, and where candidates go.
pub struct WalkContext<'a, R: Precision, V> {
    /// The machine.
    pub device: &'a Device,
    /// The trees and their volumes.
    pub forest: &'a Forest<V>,
    /// Positions.
    pub frames: Positions<R>,
    /// Vertex indices of every triangle.
    pub faces: Span<[u32; 3]>,
    /// What the kernels know of the bodies.
    pub records: Span<BodyRecord>,
    /// Out: candidate triangle pairs.
    pub pairs: Output<Pair>,
    /// Out, with [`TraverseFlags::FRONT`]: pairs of nodes where the descent ended.
    pub ends: Output<Pair>,
    /// The frame's counters.
    pub counters: Counters,
    /// What every walk is told.
    pub flags: TraverseFlags,
}

impl<R: Precision, V: Kernels> WalkContext<'_, R, V> {
    /// Which pairs are asked at all.
    fn filters(&self) -> FilterArgs {
        self.forest.filters(self.records)
    }

    /// What a walk by pairs of nodes is told, with queues of `local` units on chip.
    fn pair_args(&self, local: u32) -> PairArgs<V> {
        PairArgs {
            nodes: self.forest.volumes.nodes.span(),
            filters: self.filters(),
            faces: self.faces,
            pairs: self.pairs,
            ends: self.ends,
            counters: self.counters,
            flags: self.flags,
            local,
        }
    }
}

/// Blocks of a kernel by pairs of nodes that a machine works with best: a quarter of what its lanes allow. On an H200 that
/// is 8 of 64 lanes a processor; 6 and 10 are slower for most volumes, 16 for all (measured, `benches/NOTES.md`).
fn resident<E: Entry>(device: &Device) -> u32 {
    device.blocks_striding::<E>(u32::MAX as usize).div_ceil(4)
}

/// A way through the trees.
pub trait Walk<R: Precision, V>: Send {
    /// Launches it. All counters are zero before.
    ///
    /// # Errors
    /// Those of the device.
    fn launch(&mut self, given: &WalkContext<R, V>) -> Result<(), Error>;

    /// Its own lists, which may turn out too short: then they grow and it is launched again.
    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        Vec::new()
    }

    /// The frame is answered: what was learnt may be kept for the next one.
    ///
    /// # Errors
    /// Those of the device.
    fn finish(&mut self, _counters: &Counts) -> Result<(), Error> {
        Ok(())
    }

    /// Whether the next launch does without the host: else why not.
    ///
    /// # Errors
    /// What it needs the host for.
    fn without_host(&self) -> Result<(), &'static str> {
        Ok(())
    }

    /// Whether the last frame, once finished, had no front though one was asked for, or dropped it.
    fn front_dropped(&self) -> bool {
        false
    }

    /// The trees were built anew: what was kept is worth nothing.
    fn invalidate(&mut self) {}

    /// Milliseconds that the last launch spent on balancing; waits for it.
    ///
    /// # Errors
    /// Those of the device.
    fn balance_ms(&self) -> Result<f64, Error> {
        Ok(0.0)
    }
}

/// The walk that a query asks for, with memory for trees of `triangles` triangles in all.
///
/// # Errors
/// Those of the device.
pub fn walk<R: Precision, V: Kernels>(
    device: &Device,
    query: &Query,
    triangles: usize,
) -> Result<Box<dyn Walk<R, V>>, Error> {
    Ok(match query.traversal_on(device.is_gpu()) {
        Traversal::PerLeaf { budget } => Box::new(PerLeaf::new(device, budget, triangles)?),
        Traversal::Queue(shape) => Box::new(Queue::new::<V>(device, shape)?),
        Traversal::Steal(shape) => Box::new(Steal::new::<V>(device, shape)?),
        Traversal::Front(shape) => Box::new(Front::new::<V>(device, shape, triangles)?),
        Traversal::NearestFirst => Box::new(NearestFirst),
    })
}
