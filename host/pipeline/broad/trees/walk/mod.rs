//! Traverse: the walks from the trees to candidates. Each walk is a strategy with its own memory;
//! all give one set.

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
use nearmiss_kernels::abi::{Counters, FilterArgs, Output, Pair, PairArgs, Positions, Span, TraverseFlags};
use nearmiss_kernels::entry::{Entry, Kernels};
use per_leaf::PerLeaf;
use queue::Queue;
use steal::Steal;

/// Inputs and outputs of a walk: the device, the trees, and the lists of candidates.
pub struct WalkContext<'a, R: Precision, V> {
    /// The device.
    pub device: &'a Device,
    /// The trees and their volumes.
    pub forest: &'a Forest<V>,
    /// Positions.
    pub frames: Positions<R>,
    /// Vertex indices of every triangle.
    pub faces: Span<[u32; 3]>,
    /// Filters of the bodies, without nodes.
    pub filters: FilterArgs,
    /// Out: candidate triangle pairs.
    pub pairs: Output<Pair>,
    /// Out, with [`TraverseFlags::FRONT`]: pairs of nodes at which the descent ended.
    pub ends: Output<Pair>,
    /// The frame's counters.
    pub counters: Counters,
    /// Options of the walk.
    pub flags: TraverseFlags,
}

impl<R: Precision, V: Kernels> WalkContext<'_, R, V> {
    /// Returns the filters of the pairs.
    fn filters(&self) -> FilterArgs {
        self.forest.filters(self.filters)
    }

    /// Returns the arguments of a walk by pairs of nodes, with queues of `local` units on chip.
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

/// Returns the best number of blocks for a kernel by pairs of nodes: a quarter of the device's
/// lanes. On an H200 that is 8 blocks of 64 lanes a processor. With 6 and 10 most volumes are
/// slower, with 16 all are (measured, `benches/NOTES.md`).
fn resident<E: Entry>(device: &Device) -> u32 {
    device.blocks_striding::<E>(u32::MAX as usize).div_ceil(4)
}

/// A walk through the trees.
pub trait Walk<R: Precision, V>: Send {
    /// Launches the walk. All counters are zero before.
    ///
    /// # Errors
    /// Device errors.
    fn launch(&mut self, given: &WalkContext<R, V>) -> Result<(), Error>;

    /// Returns its own lists. One that turns out too short grows, and the walk is launched again.
    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        Vec::new()
    }

    /// Ends an answered frame: results may be kept for the next one.
    ///
    /// # Errors
    /// Device errors.
    fn finish(&mut self, _counters: &Counts) -> Result<(), Error> {
        Ok(())
    }

    /// Returns whether the next launch can run without the host, else the reason.
    ///
    /// # Errors
    /// The reason why it needs the host.
    fn without_host(&self) -> Result<(), &'static str> {
        Ok(())
    }

    /// Returns whether the last finished frame dropped its front, or had none though the query uses
    /// one.
    fn front_dropped(&self) -> bool {
        false
    }

    /// Discards kept results: the trees were rebuilt.
    fn invalidate(&mut self) {}

    /// Returns the milliseconds that the last launch spent on balancing; waits for it.
    ///
    /// # Errors
    /// Device errors.
    fn balance_ms(&self) -> Result<f64, Error> {
        Ok(0.0)
    }
}

/// Returns the walk of a query, with memory for trees of `triangles` triangles in all.
///
/// # Errors
/// Device errors.
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
