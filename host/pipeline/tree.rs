//! Construct: the tree of one body, kept on the device.

use super::precision::Precision;
use super::sorter::{counted, sort, words};
use super::treelets::RefitPlan;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::launch;
use crate::query::Refit;
use nearmiss_kernels::abi::{Inner, Link, MortonArgs, Positions, Span, TreeArgs};
use nearmiss_kernels::bvh::{self, CODE_BITS, MAX_LEVELS};
use nearmiss_kernels::entry;
use nearmiss_kernels::stage::construct::morton;

/// The bytes of a Morton code, which lies above its triangle. As many as there are: the sort ends where it began.
const BYTES: [u32; 4] = [32, 40, 48, 56];
const _: () = assert!(8 * BYTES.len() as u32 == CODE_BITS && BYTES.len().is_multiple_of(2));
/// Keys of the box of all centres.
const BOUNDS: usize = 6;

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
    pub way: RefitPlan,
    /// The same, as the host needs it to launch.
    starts: Vec<u32>,
    first: u32,
    count: u32,
    scratch: Scratch,
}

/// Memory of the construction, about 36 bytes a triangle; kept, so that building again takes none.
struct Scratch {
    /// What must be zero when a construction begins: the box of all centres; counts of each byte of the codes, and of the
    /// depths; what the treelets count.
    zeroed: Buffer<u64>,
    items: [Buffer<u64>; 2],
    inner: Buffer<Inner>,
    parents: Buffer<u32>,
    depths: Buffer<u32>,
    places: Buffer<u32>,
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
        let way = RefitPlan::new(device, refit, count)?;
        let zeroed = BOUNDS + (BYTES.len() + 1) * words(device, count) + way.zeroed();
        Ok(Tree {
            links: device.buffer(2 * n)?,
            pair_parents: device.buffer(n)?,
            leaf_nodes: device.buffer(n)?,
            firsts: device.buffer(if groups { n } else { 0 })?,
            levels: device.buffer(MAX_LEVELS as usize + 2)?,
            way,
            starts: Vec::new(),
            first,
            count,
            scratch: Scratch {
                zeroed: device.buffer(zeroed)?,
                items: [device.buffer(n)?, device.buffer(n)?],
                inner: device.buffer(inner)?,
                parents: device.buffer(inner)?,
                depths: device.buffer(inner)?,
                places: device.buffer(inner)?,
            },
        })
    }

    /// Builds the hierarchy, all on the device; [`Tree::learn_levels`] ends it. It has no volumes yet. Cost: ten launches, four
    /// of them a radix sort, and one for treelets where those are asked for; linear memory.
    ///
    /// # Errors
    /// Those of the device.
    pub fn construct<R: Precision>(
        &mut self,
        device: &Device,
        frames: Positions<R>,
        faces: Span<[u32; 3]>,
    ) -> Result<(), Error> {
        let (n, inner) = (self.count as usize, self.count as usize - 1);
        let s = &mut self.scratch;
        s.zeroed.clear()?;
        let zeroed = s.zeroed.span();
        let (at, lists) = (BOUNDS as u64, ((BYTES.len() + 1) * words(device, self.count)) as u64);
        let counts = zeroed.part(at, lists);
        let [begins, tops] = self.way.parts(zeroed.part(at + lists, zeroed.len() - at - lists));
        let morton = MortonArgs {
            frames,
            faces,
            first: self.first,
            count: self.count,
            bounds: zeroed.part(0, at),
            items: s.items[0].span(),
            tiles: counted(device, counts, self.count, 0),
        };
        let lanes = n.div_ceil(morton::TOGETHER as usize);
        launch::striding::<R::Bounds>(device, lanes, &morton)?;
        launch::striding::<R::Morton>(device, n, &morton)?;
        sort(device, s.items.each_ref(), (self.count, Span::EMPTY), counts, &BYTES)?;
        let args = TreeArgs {
            items: s.items[0].span(),
            inner: s.inner.span(),
            parents: s.parents.span(),
            depths: s.depths.span(),
            tiles: counted(device, counts, self.count, BYTES.len()),
            places: s.places.span(),
            levels: self.levels.span(),
            links: self.links.span(),
            pair_parents: self.pair_parents.span(),
            leaf_nodes: self.leaf_nodes.span(),
            firsts: self.firsts.span(),
            leaf_places: self.way.leaf_places(),
            begins,
            tops,
            leaves: self.count,
            first: self.first,
        };
        let gaps = inner.max(1);
        launch::each::<entry::construct_tree>(device, gaps, &args)?;
        launch::each::<entry::construct_depth>(device, gaps, &args)?;
        launch::blocks::<entry::construct_places>(device, args.tiles.count, &args)?;
        launch::each::<entry::construct_emit>(device, gaps, &args)?;
        self.way.prepare(device, &args)
    }

    /// Reads how many levels there are, of a tree that was just built: the only thing about it that the host must know.
    ///
    /// # Errors
    /// [`Error::Bug`] for levels that are none; those of the device.
    pub fn learn_levels(&mut self) -> Result<(), Error> {
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

    /// Triangles in leaf order, counted from the body's first: the lower halves.
    pub fn triangles(&self) -> Span<u64> {
        self.scratch.items[0].span()
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
