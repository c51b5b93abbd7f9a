//! Construct: the tree of one body, kept on the device.

use super::precision::Precision;
use super::treelets::Way;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::query::Refit;
use nearmiss_kernels::abi::{Frames, Inner, Link, MortonArgs, SortArgs, Span, TreeArgs};
use nearmiss_kernels::bvh::{self, MAX_LEVELS};
use nearmiss_kernels::entry;
use nearmiss_kernels::exec::BINS;

/// Keys of a lane in a tile of the radix sort: a tile is 1,024 keys, 90 tiles on cloth-ball, so that most of a card's
/// processors have one.
const ROUNDS: u32 = 4;

/// A level-ordered tree without volumes, and what building it again needs.
pub struct Tree {
    /// The nodes; see [`nearmiss_kernels::stage::construct::tree`].
    pub links: Buffer<Link>,
    /// The parent of each pair of siblings.
    pub pair_parents: Buffer<u32>,
    /// Each leaf's node.
    pub leaf_nodes: Buffer<u32>,
    /// The first leaf below each pair of siblings; empty where all nodes are merged.
    pub firsts: Buffer<u32>,
    /// Number of levels, then where each begins, then where the last ends.
    pub levels: Buffer<u32>,
    /// How it is refitted.
    pub way: Way,
    /// The same, as the host needs it to launch.
    starts: Vec<u32>,
    first: u32,
    count: u32,
    scratch: Scratch,
}

/// Memory of the construction, about 100 bytes a triangle; kept, so that building again takes none.
struct Scratch {
    bounds: Buffer<u64>,
    codes: [Buffer<u64>; 2],
    triangles: [Buffer<u32>; 2],
    inner: Buffer<Inner>,
    parents: Buffer<u32>,
    places: Buffer<u32>,
    depths: [Buffer<u64>; 2],
    ordered: [Buffer<u32>; 2],
    sorter: Sorter,
}

impl Tree {
    /// Takes the memory of a tree over `count` triangles (at least one) from `first` on, and of its refit; `groups` tells
    /// whether nodes of few leaves are fitted.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(
        device: &Device,
        (first, count): (u32, u32),
        refit: Refit,
        groups: bool,
    ) -> Result<Tree, Error> {
        let (n, inner) = (count as usize, count as usize - 1);
        Ok(Tree {
            links: device.buffer(2 * n)?,
            pair_parents: device.buffer(n)?,
            leaf_nodes: device.buffer(n)?,
            firsts: device.buffer(if groups { n } else { 0 })?,
            levels: device.buffer(MAX_LEVELS as usize + 2)?,
            way: Way::new(device, refit, count)?,
            starts: Vec::new(),
            first,
            count,
            scratch: Scratch {
                bounds: device.buffer(6)?,
                codes: [device.buffer(n)?, device.buffer(n)?],
                triangles: [device.buffer(n)?, device.buffer(n)?],
                inner: device.buffer(inner)?,
                parents: device.buffer(inner)?,
                places: device.buffer(inner)?,
                depths: [device.buffer(inner)?, device.buffer(inner)?],
                ordered: [device.buffer(inner)?, device.buffer(inner)?],
                sorter: Sorter::new(device, count)?,
            },
        })
    }

    /// Builds the hierarchy, all on the device. It has no volumes yet. Cost: 34 launches, 27 of them a radix sort,
    /// and two for treelets where those are asked for; linear memory.
    ///
    /// # Errors
    /// Those of the device.
    pub fn construct<R: Precision>(
        &mut self,
        device: &Device,
        frames: Frames<R>,
        faces: Span<[u32; 3]>,
    ) -> Result<(), Error> {
        let (n, inner) = (self.count as usize, self.count as usize - 1);
        let s = &mut self.scratch;
        s.bounds.clear()?;
        let morton = MortonArgs {
            frames,
            faces,
            first: self.first,
            count: self.count,
            bounds: s.bounds.span(),
            keys: s.codes[0].span(),
            values: s.triangles[0].span(),
        };
        device.launch::<R::Bounds>(device.blocks_striding::<R::Bounds>(n), &morton)?;
        device.launch::<R::Morton>(device.blocks_striding::<R::Morton>(n), &morton)?;
        for byte in 0..8 {
            // An even number of passes: the last one ends where the first began.
            let (from, to) = (byte % 2, (byte + 1) % 2);
            s.sorter.pass(
                device,
                (s.codes[from].span(), s.codes[to].span()),
                (s.triangles[from].span(), s.triangles[to].span()),
                self.count,
                8 * byte as u32,
            )?;
        }
        let args = TreeArgs {
            codes: s.codes[0].span(),
            triangles: s.triangles[0].span(),
            inner: s.inner.span(),
            parents: s.parents.span(),
            depth_keys: s.depths[0].span(),
            depth_values: s.ordered[0].span(),
            ordered: s.ordered[1].span(),
            places: s.places.span(),
            totals: s.sorter.totals.span(),
            levels: self.levels.span(),
            links: self.links.span(),
            pair_parents: self.pair_parents.span(),
            leaf_nodes: self.leaf_nodes.span(),
            firsts: self.firsts.span(),
            leaves: self.count,
            first: self.first,
        };
        device.launch::<entry::construct_tree>(device.blocks_for::<entry::construct_tree>(inner), &args)?;
        device.launch::<entry::construct_depth>(device.blocks_for::<entry::construct_depth>(inner), &args)?;
        if inner > 0 {
            s.sorter.pass(
                device,
                (s.depths[0].span(), s.depths[1].span()),
                (s.ordered[0].span(), s.ordered[1].span()),
                inner as u32,
                0,
            )?;
        }
        device.launch::<entry::construct_place>(device.blocks_for::<entry::construct_place>(inner), &args)?;
        device.launch::<entry::construct_levels>(1, &args)?;
        device.launch::<entry::construct_emit>(
            device.blocks_for::<entry::construct_emit>(inner.max(1)),
            &args,
        )?;
        self.way.prepare(device, &args)?;
        self.learn_levels()
    }

    /// Reads how many levels there are: the only thing about a tree that the host must know.
    fn learn_levels(&mut self) -> Result<(), Error> {
        let levels = self.levels.read(self.levels.len())?;
        let count = levels[0] as usize;
        self.starts = levels.get(1..count + 2).unwrap_or_default().to_vec();
        if self.starts.last() != Some(&(2 * self.count)) {
            return Err(Error::Bug {
                what: format!("a tree of {} triangles has the levels {levels:?}", self.count),
            });
        }
        Ok(())
    }

    /// How many levels the tree has.
    pub fn depth(&self) -> usize {
        self.starts.len() - 1
    }

    /// How many leaves the tree has: at least one.
    pub fn leaves(&self) -> usize {
        self.count as usize
    }

    /// Where each level begins, the root's first, and where the last ends.
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// The nodes as they lie on the device.
    ///
    /// # Errors
    /// Those of the device.
    pub fn download(&self) -> Result<Vec<Link>, Error> {
        let mut links = self.links.read(self.links.len())?;
        // Node 0 is not used and nothing writes it.
        links[0] = Link::default();
        Ok(links)
    }

    /// Triangles in leaf order, counted from the body's first.
    pub fn triangles(&self) -> Span<u32> {
        self.scratch.triangles[0].span()
    }

    /// The body's first triangle.
    pub fn first(&self) -> u32 {
        self.first
    }

    /// Checks the tree as it lies on the device.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; those of the device.
    pub fn check(&self) -> Result<(), Error> {
        let tree = bvh::Tree {
            links: &self.download()?,
            pair_parents: &self.pair_parents.read(self.pair_parents.len())?,
            levels: &self.levels.read(self.starts.len() + 1)?,
            leaf_nodes: &self.leaf_nodes.read(self.leaf_nodes.len())?,
            first: self.first,
        };
        bvh::check(&tree, &mut vec![false; self.leaves()]).map_err(broken)
    }
}

/// A broken tree, as an error.
pub fn broken(violation: bvh::Violation) -> Error {
    Error::Bug { what: format!("a tree is broken: {violation:?}") }
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

    /// Sorts keys and values from the first span of each pair into the second, by one byte of the keys.
    fn pass(
        &self,
        device: &Device,
        keys: (Span<u64>, Span<u64>),
        values: (Span<u32>, Span<u32>),
        count: u32,
        shift: u32,
    ) -> Result<(), Error> {
        let tiles = Self::tiles(device, count);
        let args = SortArgs {
            keys: keys.0,
            values: values.0,
            keys_out: keys.1,
            values_out: values.1,
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
