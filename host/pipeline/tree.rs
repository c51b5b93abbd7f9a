//! Construct: the tree over some bodies, kept on the device.

use super::layout::Layout;
use super::precision::Precision;
use super::prefix::{self, Weight};
use super::sorter::{counted, sort, words};
use super::treelets::RefitPlan;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::{launch, purpose};
use crate::query::Refit;
use nearmiss_kernels::abi::{
    BodyRecord, Inner, Link, MOVING_ROOT, MortonArgs, NodeFilter, Positions, ROOT, Span, TreeArgs, TreeBody,
};
use nearmiss_kernels::bvh::{self, CODE_BITS, MAX_LEVELS};
use nearmiss_kernels::entry;
use nearmiss_kernels::math::ordered;
use nearmiss_kernels::stage::construct::morton;

/// The bytes of a Morton code, which lies above its triangle. As many as there are: the sort ends where it began.
const BYTES: [u32; 4] = [32, 40, 48, 56];
const _: () = assert!(8 * BYTES.len() as u32 == CODE_BITS && BYTES.len().is_multiple_of(2));
/// Keys of the box of a body's centres.
const BOUNDS: usize = morton::BOUNDS as usize;

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
    /// Whose triangles lie below each node; empty where that does not matter.
    pub filters: Buffer<NodeFilter>,
    /// How it is refitted.
    pub way: RefitPlan,
    /// The same, as the host needs it to launch.
    starts: Vec<u32>,
    /// The bodies, in the order of their triangles, and what the kernels know of them all.
    bodies: Vec<TreeBody>,
    records: Vec<BodyRecord>,
    table: Buffer<TreeBody>,
    count: u32,
    room: Room,
    scratch: Scratch,
}

/// Memory of the construction, about 36 bytes a triangle; kept, so that building again takes none.
struct Scratch {
    /// What must be zero when a construction begins: the boxes of the bodies' centres; counts of each byte of the codes, and of the
    /// depths; what the treelets count.
    zeroed: Buffer<u64>,
    items: [Buffer<u64>; 2],
    inner: Buffer<Inner>,
    parents: Buffer<u32>,
    depths: Buffer<u32>,
    places: Buffer<u32>,
}

/// Where in the memory for nodes a tree lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Room {
    /// All of it.
    Alone,
    /// Below one root with a tree of so many leaves that will be grafted behind it.
    Beside(u32),
}

impl Room {
    /// The root's index.
    pub fn root(self) -> u32 {
        match self {
            Room::Alone => ROOT,
            Room::Beside(_) => MOVING_ROOT,
        }
    }

    /// Leaves of the other tree.
    pub fn others(self) -> u32 {
        match self {
            Room::Alone => 0,
            Room::Beside(leaves) => leaves,
        }
    }
}

/// What a tree is built over, and for what.
#[derive(Clone, Copy)]
pub struct TreeSpec<'a> {
    /// The bodies.
    pub layout: &'a Layout,
    /// Which of them, ascending, each with triangles; at least one.
    pub bodies: &'a [usize],
    /// Where it lies.
    pub room: Room,
    /// How it will be refitted.
    pub refit: Refit,
    /// Whether nodes of few leaves are fitted.
    pub groups: bool,
}

impl<'a> TreeSpec<'a> {
    /// A tree over everything of a layout that moves, by itself.
    pub fn alone(layout: &'a Layout, refit: Refit, groups: bool) -> TreeSpec<'a> {
        TreeSpec { layout, bodies: &layout.trees[0], room: Room::Alone, refit, groups }
    }
}

impl Tree {
    /// Takes the memory of a tree, and of its refit.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(device: &Device, plan: &TreeSpec) -> Result<Tree, Error> {
        let TreeSpec { layout, bodies, room, refit, groups } = *plan;
        let mut count = 0;
        let table = bodies.iter().map(|&body| {
            let (triangle, triangles) = layout.triangles(body);
            count += triangles;
            TreeBody { triangle, before: count - triangles, ..TreeBody::default() }
        });
        let table: Vec<TreeBody> = table.collect();
        let (n, inner) = (count as usize, count as usize - 1);
        // Pairs of siblings begin behind the root; what is not used before it is counted too.
        let pairs = n + room.root() as usize / 2;
        let all = n + room.others() as usize;
        let way = RefitPlan::new(&device.of(purpose::REFIT), refit, count, pairs)?;
        let (boxes, scratch) = (BOUNDS * table.len(), device.of(purpose::SCRATCH));
        let zeroed = boxes + (BYTES.len() + 1) * words(device, count) + way.zeroed();
        Ok(Tree {
            links: device.buffer(room.root() as usize - 1 + 2 * n)?,
            pair_parents: device.buffer(all.max(pairs))?,
            leaf_nodes: device.buffer(n)?,
            firsts: device.buffer(if groups { pairs } else { 0 })?,
            levels: device.buffer(MAX_LEVELS as usize + 2)?,
            filters: device.of(purpose::FILTERS).buffer(if layout.has_filters() { 2 * all } else { 0 })?,
            way,
            starts: Vec::new(),
            records: bodies.iter().map(|&body| layout.records[body]).collect(),
            table: device.upload(&table)?,
            bodies: table,
            count,
            room,
            scratch: Scratch {
                zeroed: scratch.buffer(zeroed)?,
                items: [scratch.buffer(n)?, scratch.buffer(n)?],
                inner: scratch.buffer(inner)?,
                parents: scratch.buffer(inner)?,
                depths: scratch.buffer(inner)?,
                places: scratch.buffer(inner)?,
            },
        })
    }

    /// Builds the hierarchy, all on the device but for an order of the bodies, where there are more than one;
    /// [`Tree::learn_levels`] ends it. It has no volumes yet. `records` is what the kernels know of all bodies of the scene, empty
    /// where there are no filters. Cost: ten launches, four of them a radix sort, and one for treelets where those are asked
    /// for; linear memory. Of more bodies a wait for their boxes.
    ///
    /// # Errors
    /// Those of the device.
    pub fn construct<R: Precision>(
        &mut self,
        device: &Device,
        frames: Positions<R>,
        (faces, records): (Span<[u32; 3]>, Span<BodyRecord>),
    ) -> Result<(), Error> {
        let (n, inner) = (self.count as usize, self.count as usize - 1);
        let s = &mut self.scratch;
        s.zeroed.clear()?;
        let zeroed = s.zeroed.span();
        let boxes = BOUNDS * self.bodies.len();
        let (at, lists) = (boxes as u64, ((BYTES.len() + 1) * words(device, self.count)) as u64);
        let counts = zeroed.part(at, lists);
        let [begins, tops] = self.way.parts(zeroed.part(at + lists, zeroed.len() - at - lists));
        let morton = MortonArgs {
            frames,
            faces,
            bodies: self.table.span(),
            bounds: zeroed.part(0, at),
            items: s.items[0].span(),
            tiles: counted(device, counts, self.count, 0),
            count: self.count,
            pad: 0,
        };
        let lanes = n.div_ceil(morton::TOGETHER as usize);
        launch::striding::<R::Bounds>(device, lanes, &morton)?;
        if self.bodies.len() > 1 {
            let weights = weights(&s.zeroed.read(boxes)?, &self.bodies, self.count);
            prefix::prefixes(&mut self.bodies, &weights, &self.records);
            self.table.write(&self.bodies)?;
        }
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
            filters: self.filters.span(),
            bodies: records,
            leaf_places: self.way.leaf_places(),
            begins,
            tops,
            leaves: self.count,
            root: self.root(),
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
        if self.starts.last() != Some(&(self.root() + 2 * self.count - 1)) {
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
        // Nodes before the root are not used and nothing writes them.
        links[..self.root() as usize].fill(Link::default());
        Ok(links)
    }

    /// Triangles in leaf order: the lower halves.
    pub fn triangles(&self) -> Span<u64> {
        self.scratch.items[0].span()
    }

    /// The root's index.
    pub fn root(&self) -> u32 {
        self.room.root()
    }

    /// Where it lies.
    pub fn room(&self) -> Room {
        self.room
    }

    /// Checks the tree as it lies on the device, whose triangles lie below each node, too.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; those of the device.
    pub fn check(&self) -> Result<(), Error> {
        let tree = bvh::Tree {
            links: &self.download()?,
            pair_parents: &self.pair_parents.read(self.pair_parents.len())?,
            levels: &self.levels.read(self.starts.len() + 1)?,
            leaf_nodes: &self.leaf_nodes.read(self.leaf_nodes.len())?,
            root: self.root(),
            place: &|triangle| place(&self.bodies, self.count, triangle),
        };
        bvh::check(&tree, &mut vec![false; self.leaves()]).map_err(broken)
    }

    /// The tree's bodies.
    pub fn bodies(&self) -> &[TreeBody] {
        &self.bodies
    }
}

/// The place of a triangle among those of a tree's bodies, `count` in all; `None` for that of another body.
pub fn place(bodies: &[TreeBody], count: u32, triangle: u32) -> Option<usize> {
    let at = bodies.partition_point(|body| body.triangle <= triangle).checked_sub(1)?;
    let end = bodies.get(at + 1).map_or(count, |next| next.before);
    let place = triangle - bodies[at].triangle + bodies[at].before;
    (place < end).then_some(place as usize)
}

/// The bodies' boxes, of their keys, and how many triangles each has.
fn weights(keys: &[u64], bodies: &[TreeBody], count: u32) -> Vec<Weight> {
    let ends = bodies.iter().skip(1).map(|next| next.before).chain([count]);
    let boxes = keys.chunks_exact(BOUNDS).map(|keys| {
        let upper = [0, 1, 2].map(|k| ordered::number(keys[k]));
        [[0, 1, 2].map(|k| ordered::number(!keys[k + 3])), upper]
    });
    let weight =
        |((body, end), bounds): ((&TreeBody, u32), _)| Weight { bounds, triangles: end - body.before };
    bodies.iter().zip(ends).zip(boxes).map(weight).collect()
}

/// A broken tree, as an error.
pub fn broken(violation: bvh::Violation) -> Error {
    Error::Bug { what: format!("a tree is broken: {violation:?}") }
}
