//! What a refit needs beside the tree: the plan of its treelets, or counters of arrivals.

use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::query::Refit;
use nearmiss_kernels::abi::{Merge, PlanArgs, Seat, TreeArgs, Treelet};
use nearmiss_kernels::bvh::{MAX_LEVELS, TREELET};
use nearmiss_kernels::entry;

/// How a tree is refitted, with the memory for it.
pub enum Way {
    /// A launch a level.
    Levels,
    /// A block a treelet.
    Treelets(Plan),
    /// Whoever comes second to a pair goes on: how many came by each pair, in all frames.
    BottomUp(Buffer<u64>),
}

impl Way {
    /// Takes the memory for a tree of `count` leaves (at least one).
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(device: &Device, refit: Refit, count: u32) -> Result<Way, Error> {
        Ok(match refit {
            Refit::Levels => Way::Levels,
            Refit::Treelets => Way::Treelets(Plan::new(device, count)?),
            Refit::BottomUp => Way::BottomUp(device.buffer(count as usize)?),
        })
    }

    /// Prepares for a tree that was just built.
    ///
    /// # Errors
    /// Those of the device.
    pub fn prepare(&mut self, device: &Device, tree: &TreeArgs) -> Result<(), Error> {
        match self {
            Way::Levels => Ok(()),
            Way::Treelets(plan) => plan.make(device, tree),
            Way::BottomUp(arrivals) => arrivals.clear(),
        }
    }
}

/// The treelets of a tree: see `nearmiss_kernels::stage::construct::treelet`. About 30 bytes a leaf.
pub struct Plan {
    /// The treelets, one a chunk of leaves.
    pub treelets: Buffer<Treelet>,
    /// The leaves' places.
    pub seats: Buffer<Seat>,
    /// Merges of the treelets.
    pub merges: Buffer<Merge>,
    /// Merges of the nodes that span treelets.
    pub top: Buffer<Merge>,
    /// How many depths of them there are, and where each begins.
    pub top_starts: Buffer<u32>,
    /// Tickets drawn by blocks of refits so far.
    pub ticket: Buffer<u64>,
    begins: Buffer<u64>,
    tops: Buffer<u64>,
}

impl Plan {
    fn new(device: &Device, count: u32) -> Result<Plan, Error> {
        let (leaves, treelets) = (count as usize, count.div_ceil(TREELET) as usize);
        // The nodes of one depth have different leaves, those of the top more than TREELET each.
        let a_depth = leaves / (TREELET as usize + 1);
        Ok(Plan {
            treelets: device.buffer(treelets)?,
            seats: device.buffer(leaves)?,
            merges: device.buffer(leaves)?,
            top: device.buffer((a_depth * MAX_LEVELS as usize).min(leaves))?,
            top_starts: device.buffer(MAX_LEVELS as usize + 1)?,
            ticket: device.upload(&[0])?,
            begins: device.buffer(treelets)?,
            tops: device.buffer(2 * MAX_LEVELS as usize)?,
        })
    }

    fn make(&mut self, device: &Device, tree: &TreeArgs) -> Result<(), Error> {
        self.begins.clear()?;
        self.tops.clear()?;
        let args = PlanArgs {
            inner: tree.inner,
            places: tree.places,
            depths: tree.depth_keys,
            by_gap: tree.depth_values,
            links: tree.links,
            pair_parents: tree.pair_parents,
            leaf_nodes: tree.leaf_nodes,
            begins: self.begins.span(),
            tops: self.tops.span(),
            treelets: self.treelets.span(),
            seats: self.seats.span(),
            merges: self.merges.span(),
            top: self.top.span(),
            top_starts: self.top_starts.span(),
            leaves: tree.leaves,
            pad: 0,
        };
        let inner = self.seats.len() - 1;
        device.launch::<entry::construct_mark>(
            device.blocks_for::<entry::construct_mark>(inner.max(1)),
            &args,
        )?;
        device.launch::<entry::construct_treelets>(self.blocks(), &args)
    }

    /// Blocks of a refit: one a treelet.
    pub fn blocks(&self) -> u32 {
        // There are fewer than leaves, which 32 bits count.
        self.treelets.len() as u32
    }
}
