//! Construct: the tree over some bodies, kept on the device.

use super::treelets::RefitPlan;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::broad::broken;
use crate::pipeline::broad::sorted::{Sorted, SortedFor, place};
use crate::pipeline::layout::Layout;
use crate::pipeline::precision::Precision;
use crate::pipeline::sorter::{counted, words};
use crate::pipeline::{launch, purpose};
use crate::query::Refit;
use nearmiss_kernels::abi::{
    BodyRecord, Inner, Link, MOVING_ROOT, NodeFilter, Positions, ROOT, Span, TreeArgs, TreeBody,
};
use nearmiss_kernels::bvh::{self, MAX_LEVELS};
use nearmiss_kernels::entry;

/// A level-ordered tree without volumes, and the memory to build it again.
pub struct Tree {
    /// The nodes; see [`nearmiss_kernels::stage::construct::tree`].
    pub links: Buffer<Link>,
    /// The parent of each pair of siblings.
    pub pair_parents: Buffer<u32>,
    /// Each leaf's node.
    pub leaf_nodes: Buffer<u32>,
    /// The first leaf below each pair of siblings; empty if all nodes are merged.
    pub firsts: Buffer<u32>,
    /// Number of levels, then the start of each, then the end of the last.
    pub levels: Buffer<u32>,
    /// Filters of the triangles below each node; empty if no filter applies.
    pub filters: Buffer<NodeFilter>,
    /// The hub of every triangle of the scene; empty without hubs.
    hubs: Buffer<u32>,
    /// How the tree is refitted.
    pub way: RefitPlan,
    /// The levels' starts, as the host needs them to launch.
    starts: Vec<u32>,
    /// Its sorted triangles. The extra zeroed words hold the counts of the depths, marks of nodes
    /// with different hubs, and the treelets' counts.
    sorted: Sorted,
    count: u32,
    room: Room,
    scratch: Scratch,
}

/// Memory of the construction except the sort, 16 bytes a triangle; kept, so that a rebuild
/// allocates none.
struct Scratch {
    inner: Buffer<Inner>,
    parents: Buffer<u32>,
    depths: Buffer<u32>,
    places: Buffer<u32>,
}

/// A tree's place in the memory for nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Room {
    /// All of the memory.
    Alone,
    /// Below one root with a tree of so many leaves, which will be grafted behind it.
    Beside(u32),
}

impl Room {
    /// Returns the root's index.
    pub fn root(self) -> u32 {
        match self {
            Room::Alone => ROOT,
            Room::Beside(_) => MOVING_ROOT,
        }
    }

    /// Returns the number of leaves of the other tree.
    pub fn others(self) -> u32 {
        match self {
            Room::Alone => 0,
            Room::Beside(leaves) => leaves,
        }
    }
}

/// Parameters of a tree.
#[derive(Clone, Copy)]
pub struct TreeSpec<'a> {
    /// The bodies.
    pub layout: &'a Layout,
    /// Indices of its bodies, ascending, each with triangles; at least one.
    pub bodies: &'a [usize],
    /// The tree's place.
    pub room: Room,
    /// How it will be refitted.
    pub refit: Refit,
    /// Whether nodes of few leaves are fitted.
    pub groups: bool,
}

impl<'a> TreeSpec<'a> {
    /// Returns the parameters of one tree over all moving bodies of a layout.
    pub fn alone(layout: &'a Layout, refit: Refit, groups: bool) -> TreeSpec<'a> {
        TreeSpec { layout, bodies: &layout.trees[0], room: Room::Alone, refit, groups }
    }
}

impl Tree {
    /// Allocates a tree, and its refit.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, plan: &TreeSpec) -> Result<Tree, Error> {
        let TreeSpec { layout, bodies, room, refit, groups } = *plan;
        let count = bodies.iter().map(|&body| layout.triangles(body).1).sum::<u32>();
        let (n, inner) = (count as usize, count as usize - 1);
        // Pairs of siblings begin behind the root; unused words before it count too.
        let pairs = n + room.root() as usize / 2;
        let all = n + room.others() as usize;
        let way = RefitPlan::new(&device.of(purpose::REFIT), refit, count)?;
        let scratch = device.of(purpose::SCRATCH);
        let mixed = if layout.hubs.is_empty() { 0 } else { inner };
        let zeroed = words(device, count) + mixed + way.zeroed();
        Ok(Tree {
            links: device.buffer(room.root() as usize - 1 + 2 * n)?,
            pair_parents: device.buffer(all.max(pairs))?,
            leaf_nodes: device.buffer(n)?,
            firsts: device.buffer(if groups { pairs } else { 0 })?,
            levels: device.buffer(MAX_LEVELS as usize + 2)?,
            filters: device.of(purpose::FILTERS).buffer(if layout.has_filters() { 2 * all } else { 0 })?,
            hubs: device.of(purpose::FILTERS).upload(&layout.hubs)?,
            way,
            starts: Vec::new(),
            sorted: Sorted::new(device, layout, bodies, SortedFor::Tree { extra: zeroed })?,
            count,
            room,
            scratch: Scratch {
                inner: scratch.buffer(inner)?,
                parents: scratch.buffer(inner)?,
                depths: scratch.buffer(inner)?,
                places: scratch.buffer(inner)?,
            },
        })
    }

    /// Builds the hierarchy, without volumes; [`Tree::learn_levels`] completes it. All work is on
    /// the device, except the order of the bodies: with more than one, it waits for their boxes.
    /// `records` has all bodies of the scene; it is empty if there are no filters. Cost: ten
    /// launches, four of them a radix sort, and one for treelets if the refit uses them; linear
    /// memory.
    ///
    /// # Errors
    /// Device errors.
    pub fn construct<R: Precision>(
        &mut self,
        device: &Device,
        frames: Positions<R>,
        (faces, records): (Span<[u32; 3]>, Span<BodyRecord>),
    ) -> Result<(), Error> {
        self.sorted.construct::<R>(device, frames, faces)?;
        let depths = words(device, self.count) as u64;
        let (s, zeroed) = (&self.scratch, self.sorted.zeroed());
        let mixed = if self.hubs.is_empty() { 0 } else { s.inner.len() as u64 };
        let before = depths + mixed;
        let [begins, tops] = self.way.parts(zeroed.part(before, zeroed.len() - before));
        let args = TreeArgs {
            items: self.sorted.triangles(),
            inner: s.inner.span(),
            parents: s.parents.span(),
            depths: s.depths.span(),
            tiles: counted(device, zeroed, self.count, 0),
            places: s.places.span(),
            levels: self.levels.span(),
            links: self.links.span(),
            pair_parents: self.pair_parents.span(),
            leaf_nodes: self.leaf_nodes.span(),
            firsts: self.firsts.span(),
            filters: self.filters.span(),
            bodies: records,
            hubs: self.hubs.span(),
            mixed: zeroed.part(depths, mixed),
            leaf_places: self.way.leaf_places(),
            begins,
            tops,
            leaves: self.count,
            root: self.root(),
        };
        let gaps = (self.count as usize - 1).max(1);
        launch::each::<entry::construct_tree>(device, gaps, &args)?;
        launch::each::<entry::construct_depth>(device, gaps, &args)?;
        launch::blocks::<entry::construct_places>(device, args.tiles.count, &args)?;
        launch::each::<entry::construct_emit>(device, gaps, &args)?;
        self.way.prepare(device, &args)
    }

    /// Reads the number of levels of a tree that was just built: the only value that the host must
    /// know.
    ///
    /// # Errors
    /// [`Error::Bug`] for invalid levels; device errors.
    pub fn learn_levels(&mut self) -> Result<(), Error> {
        let levels = self.levels.read(self.levels.len())?;
        let count = levels[0] as usize;
        self.starts = levels.get(1..count + 2).unwrap_or_default().to_vec();
        if self.starts.last() != Some(&(self.root() + 2 * self.count - 1)) {
            return Err(Error::Bug {
                what: format!("a tree of {} triangles has the levels {levels:?}", self.count),
            });
        }
        Ok(())
    }

    /// Returns the number of levels.
    pub fn depth(&self) -> usize {
        self.starts.len() - 1
    }

    /// Returns the number of leaves, at least one.
    pub fn leaves(&self) -> usize {
        self.count as usize
    }

    /// Returns the start of each level, the root's first, and the end of the last.
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// Downloads the nodes.
    ///
    /// # Errors
    /// Device errors.
    pub fn download(&self) -> Result<Vec<Link>, Error> {
        let mut links = self.links.read(self.links.len())?;
        // Nodes before the root are unused and never written.
        links[..self.root() as usize].fill(Link::default());
        Ok(links)
    }

    /// Returns the triangles in leaf order: the lower halves of the words.
    pub fn triangles(&self) -> Span<u64> {
        self.sorted.triangles()
    }

    /// Returns the root's index.
    pub fn root(&self) -> u32 {
        self.room.root()
    }

    /// Returns the tree's place.
    pub fn room(&self) -> Room {
        self.room
    }

    /// Checks the tree on the device, and the filters of its nodes.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; device errors.
    pub fn check(&self) -> Result<(), Error> {
        let tree = bvh::Tree {
            links: &self.download()?,
            pair_parents: &self.pair_parents.read(self.pair_parents.len())?,
            levels: &self.levels.read(self.starts.len() + 1)?,
            leaf_nodes: &self.leaf_nodes.read(self.leaf_nodes.len())?,
            root: self.root(),
            place: &|triangle| place(self.bodies(), self.count, triangle),
        };
        bvh::check(&tree, &mut vec![false; self.leaves()]).map_err(broken)
    }

    /// Returns the tree's bodies.
    pub fn bodies(&self) -> &[TreeBody] {
        self.sorted.bodies()
    }
}
