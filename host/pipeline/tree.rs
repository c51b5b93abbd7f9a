//! Construct, fit and refit: a tree of one body, kept on the device.

use super::precision::Precision;
use crate::device::{Buffer, Device};
use crate::error::Error;
use nearmiss_kernels::abi::{
    FitArgs, Frames, Inner, MortonArgs, NONE, Node, RefitArgs, SortArgs, Span, TreeArgs,
};
use nearmiss_kernels::entry::{self, Entry};
use nearmiss_kernels::exec::BINS;
use nearmiss_kernels::stage::construct::MAX_LEVELS;

/// Keys of a lane in a tile of the radix sort: a tile is 1,024 keys, 90 tiles on cloth-ball, so that most of a card's
/// processors have one.
const ROUNDS: u32 = 4;
/// Levels of up to this many nodes are refitted together by one block: four nodes a lane, a few hundred nanoseconds
/// a level, where a launch costs microseconds.
const ONE_BLOCK: u32 = 4 * entry::refit_levels::LANES;

/// A level-ordered tree.
pub struct Tree {
    /// The nodes; see [`nearmiss_kernels::stage::construct::tree`].
    pub nodes: Buffer<Node>,
    /// Each leaf's node.
    pub leaf_nodes: Buffer<u32>,
    /// Number of levels, then where each begins, then where the last ends.
    levels: Buffer<u32>,
    /// The same, as the host needs it to launch.
    starts: Vec<u32>,
    first: u32,
    count: u32,
}

impl Tree {
    /// Builds the hierarchy of `count` triangles (at least one) from `first` on, all on the device. The boxes are
    /// not set yet. Cost: 27 launches of a radix sort and 8 more; linear memory, freed at the end.
    ///
    /// # Errors
    /// Those of the device.
    pub fn construct<R: Precision>(
        device: &Device,
        frames: Frames<R>,
        faces: Span<[u32; 3]>,
        (first, count): (u32, u32),
    ) -> Result<Tree, Error> {
        let n = count as usize;
        let (mut keys, mut values) =
            ([device.buffer(n)?, device.buffer(n)?], [device.buffer(n)?, device.buffer(n)?]);
        let mut bounds = device.buffer(6)?;
        bounds.clear()?;
        let morton = MortonArgs {
            positions: frames.t0,
            faces,
            first,
            count,
            bounds: bounds.span(),
            keys: keys[0].span(),
            values: values[0].span(),
        };
        device.launch::<R::Bounds>(device.blocks_striding::<R::Bounds>(n), &morton)?;
        device.launch::<R::Morton>(device.blocks_striding::<R::Morton>(n), &morton)?;
        let sorter = Sorter::new(device, count)?;
        for byte in 0..8 {
            sorter.pass(device, &keys, &values, count, 8 * byte)?;
            keys.swap(0, 1);
            values.swap(0, 1);
        }

        let tree = Tree {
            nodes: device.buffer(2 * n)?,
            leaf_nodes: device.buffer(n)?,
            levels: device.buffer(MAX_LEVELS as usize + 2)?,
            starts: Vec::new(),
            first,
            count,
        };
        let inner = n - 1;
        let inner_nodes = device.buffer::<Inner>(inner)?;
        let (parents, places) = (device.buffer(inner)?, device.buffer(inner)?);
        let (depth_keys, depth_values) = (device.buffer(inner)?, device.buffer(inner)?);
        let (sorted_keys, ordered) = (device.buffer(inner)?, device.buffer(inner)?);
        let args = TreeArgs {
            codes: keys[0].span(),
            triangles: values[0].span(),
            inner: inner_nodes.span(),
            parents: parents.span(),
            depth_keys: depth_keys.span(),
            depth_values: depth_values.span(),
            ordered: ordered.span(),
            places: places.span(),
            totals: sorter.totals.span(),
            levels: tree.levels.span(),
            nodes: tree.nodes.span(),
            leaf_nodes: tree.leaf_nodes.span(),
            leaves: count,
            first,
        };
        device.launch::<entry::construct_tree>(device.blocks_for::<entry::construct_tree>(inner), &args)?;
        device.launch::<entry::construct_depth>(device.blocks_for::<entry::construct_depth>(inner), &args)?;
        let by_depth = ([depth_keys, sorted_keys], [depth_values, ordered]);
        if inner > 0 {
            sorter.pass(device, &by_depth.0, &by_depth.1, inner as u32, 0)?;
        }
        device.launch::<entry::construct_place>(device.blocks_for::<entry::construct_place>(inner), &args)?;
        device.launch::<entry::construct_levels>(1, &args)?;
        device.launch::<entry::construct_emit>(
            device.blocks_for::<entry::construct_emit>(inner.max(1)),
            &args,
        )?;
        tree.known()
    }

    /// Reads how many levels there are: the only thing about a tree that the host must know.
    fn known(mut self) -> Result<Tree, Error> {
        let levels = self.levels.read(self.levels.len())?;
        let count = levels[0] as usize;
        self.starts = levels.get(1..count + 2).unwrap_or_default().to_vec();
        if self.starts.last() != Some(&(2 * self.count)) {
            return Err(Error::Bug {
                what: format!("a tree of {} triangles has the levels {levels:?}", self.count),
            });
        }
        Ok(self)
    }

    /// How many levels the tree has.
    pub fn depth(&self) -> usize {
        self.starts.len() - 1
    }

    /// Fits the boxes of the leaves.
    ///
    /// # Errors
    /// Those of the device.
    pub fn fit<R: Precision>(
        &self,
        device: &Device,
        frames: Frames<R>,
        faces: Span<[u32; 3]>,
    ) -> Result<(), Error> {
        let args = FitArgs { frames, faces, leaf_nodes: self.leaf_nodes.span(), nodes: self.nodes.span() };
        device.launch::<R::Fit>(device.blocks_for::<R::Fit>(self.count as usize), &args)
    }

    /// Refits all other boxes, a launch a level; runs of narrow levels share one.
    ///
    /// # Errors
    /// Those of the device.
    pub fn refit(&self, device: &Device) -> Result<(), Error> {
        let width = |level: usize| self.starts[level + 1] - self.starts[level];
        // The deepest level holds only leaves.
        let mut to = self.depth() - 1;
        while to > 0 {
            let mut from = to - 1;
            if width(from) <= ONE_BLOCK {
                while from > 0 && width(from - 1) <= ONE_BLOCK {
                    from -= 1;
                }
            }
            let narrow = width(to - 1) <= ONE_BLOCK;
            let blocks =
                if narrow { 1 } else { device.blocks_for::<entry::refit_levels>(width(from) as usize) };
            let args = RefitArgs {
                nodes: self.nodes.span(),
                levels: self.levels.span(),
                from: from as u32,
                to: to as u32,
            };
            device.launch::<entry::refit_levels>(blocks, &args)?;
            to = from;
        }
        Ok(())
    }

    /// Everything on the host, for the checker: nodes, levels, leaf nodes, first triangle.
    ///
    /// # Errors
    /// Those of the device.
    pub fn download(&self) -> Result<(Vec<Node>, Vec<u32>, Vec<u32>, u32), Error> {
        let nodes = {
            // Node 0 is not used and nothing writes it.
            let mut nodes = self.nodes.read(self.nodes.len())?;
            nodes[0] = Node { link: NONE, ..Node::default() };
            nodes
        };
        Ok((
            nodes,
            self.levels.read(self.starts.len() + 1)?,
            self.leaf_nodes.read(self.leaf_nodes.len())?,
            self.first,
        ))
    }
}

/// The memory of a radix sort.
struct Sorter {
    counts: Buffer<u32>,
    totals: Buffer<u32>,
}

impl Sorter {
    fn new(device: &Device, count: u32) -> Result<Sorter, Error> {
        let tiles = Self::tiles(device, count);
        Ok(Sorter { counts: device.buffer((BINS * tiles) as usize)?, totals: device.buffer(BINS as usize)? })
    }

    fn tiles(device: &Device, count: u32) -> u32 {
        count.div_ceil(ROUNDS * device.lanes::<entry::construct_sort_scatter>()).max(1)
    }

    /// Sorts the first of each pair of buffers into the second, by one byte of the keys.
    fn pass(
        &self,
        device: &Device,
        keys: &[Buffer<u64>; 2],
        values: &[Buffer<u32>; 2],
        count: u32,
        shift: u32,
    ) -> Result<(), Error> {
        let tiles = Self::tiles(device, count);
        let args = SortArgs {
            keys: keys[0].span(),
            values: values[0].span(),
            keys_out: keys[1].span(),
            values_out: values[1].span(),
            counts: self.counts.span(),
            totals: self.totals.span(),
            count,
            tiles,
            shift,
            rounds: ROUNDS,
        };
        device.launch::<entry::construct_sort_count>(tiles, &args)?;
        device.launch::<entry::construct_sort_scan>(BINS, &args)?;
        device.launch::<entry::construct_sort_scatter>(tiles, &args)
    }
}
