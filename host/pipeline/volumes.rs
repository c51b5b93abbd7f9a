//! Fit and refit: the bounding volume of each node.

use super::precision::Precision;
use super::tree::{Tree, broken};
use super::treelets::{Plan, RefitPlan};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::launch;
use nearmiss_kernels::abi::{
    BottomUpArgs, FitArgs, FrontArgs, GraftArgs, GroupsArgs, Link, Node, Positions, QueueArgs, RefitArgs,
    Span, StealArgs, TraverseArgs, TreeletsArgs,
};
use nearmiss_kernels::bv::{Aabb, Axes, Linear, Obb, Volume};
use nearmiss_kernels::bvh;
use nearmiss_kernels::entry::{self, Entry};
use nearmiss_kernels::math::{Vec3, round};

/// A bounding volume, with its kernels.
pub trait Kernels: Volume {
    /// A tree that does not change, into the memory of another.
    type Graft: Entry<Args = GraftArgs<Self>>;
    /// Volumes of the leaves.
    type Fit<R: Precision>: Entry<Args = FitArgs<R, Self>>;
    /// All other volumes, a launch a level.
    type Levels: Entry<Args = RefitArgs<Self>>;
    /// All volumes, a block a treelet.
    type Treelets<R: Precision>: Entry<Args = TreeletsArgs<R, Self>>;
    /// All other volumes, by whoever comes second to a pair.
    type BottomUp: Entry<Args = BottomUpArgs<Self>>;
    /// A walk a leaf.
    type Leaves: Entry<Args = TraverseArgs<Self>>;
    /// A walk a unit that was left over.
    type Units: Entry<Args = TraverseArgs<Self>>;
    /// A pass over the last frame's front.
    type Front: Entry<Args = FrontArgs<Self>>;
    /// A round of work queues.
    type Queue: Entry<Args = QueueArgs<Self>>;
    /// Work queues that help each other out.
    type Steal: Entry<Args = StealArgs<Self>>;

    /// Fits the inner nodes that are not merged, for volumes that have such (see [`Volume::group`]).
    ///
    /// # Errors
    /// Those of the device.
    fn fit_groups<R: Precision>(_: &Device, _: &GroupsArgs<R, Self>) -> Result<(), Error> {
        Ok(())
    }

    /// The volume of such a node, from the points below it; none for volumes that have no such nodes.
    fn of<R: Precision>(_: &[Vec3<R>]) -> Option<Self> {
        None
    }
}

impl Kernels for Aabb {
    type Graft = entry::construct_graft_aabb;
    type Fit<R: Precision> = R::FitAabb;
    type Levels = entry::refit_levels_aabb;
    type Treelets<R: Precision> = R::TreeletsAabb;
    type BottomUp = entry::refit_bottom_up_aabb;
    type Leaves = entry::traverse_leaves_aabb;
    type Units = entry::traverse_units_aabb;
    type Front = entry::traverse_front_aabb;
    type Queue = entry::traverse_queue_aabb;
    type Steal = entry::traverse_steal_aabb;
}

impl Kernels for Linear {
    type Graft = entry::construct_graft_linear;
    type Fit<R: Precision> = R::FitLinear;
    type Levels = entry::refit_levels_linear;
    type Treelets<R: Precision> = R::TreeletsLinear;
    type BottomUp = entry::refit_bottom_up_linear;
    type Leaves = entry::traverse_leaves_linear;
    type Units = entry::traverse_units_linear;
    type Front = entry::traverse_front_linear;
    type Queue = entry::traverse_queue_linear;
    type Steal = entry::traverse_steal_linear;
}

impl Kernels for Obb {
    type Graft = entry::construct_graft_obb;
    type Fit<R: Precision> = R::FitObb;
    type Levels = entry::refit_levels_obb;
    type Treelets<R: Precision> = R::TreeletsObb;
    type BottomUp = entry::refit_bottom_up_obb;
    type Leaves = entry::traverse_leaves_obb;
    type Units = entry::traverse_units_obb;
    type Front = entry::traverse_front_obb;
    type Queue = entry::traverse_queue_obb;
    type Steal = entry::traverse_steal_obb;

    fn fit_groups<R: Precision>(device: &Device, args: &GroupsArgs<R, Self>) -> Result<(), Error> {
        // One pair of siblings for each inner node, behind the root.
        let inner = args.firsts.len() as usize - args.root.div_ceil(2) as usize;
        launch::each::<R::GroupsObb>(device, inner, args)
    }
    fn of<R: Precision>(points: &[Vec3<R>]) -> Option<Self> {
        Some(Obb::of(points))
    }
}

/// How much each of two volumes grows so that what is listed makes them meet: half of the distance within which it comes,
/// rounded up.
pub fn growth(distance: f64) -> f32 {
    let half = round::up(0.5 * distance);
    if 2.0 * f64::from(half) < distance { half.next_up() } else { half }
}

/// The volumes of a tree, kept on the device.
pub struct Volumes<V> {
    /// The nodes, in the tree's order.
    pub nodes: Buffer<Node<V>>,
    axes: Axes,
    /// How much they grow: half the separation, rounded up.
    pub margin: f32,
}

impl<V: Kernels> Volumes<V> {
    /// Which axes merged boxes take.
    pub fn axes(&self) -> Axes {
        self.axes
    }

    /// Takes the memory for the volumes of a tree, which hold everything within `margin` of the triangles.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(device: &Device, tree: &Tree, (axes, margin): (Axes, f32)) -> Result<Self, Error> {
        let leaves = tree.leaves() + tree.room().others() as usize;
        Ok(Volumes { nodes: device.buffer(2 * leaves)?, axes, margin })
    }

    /// Fits the volumes of the leaves, unless treelets do that in [`Volumes::refit`], and of the nodes of few leaves that
    /// are not merged.
    ///
    /// # Errors
    /// Those of the device.
    pub fn fit<R: Precision>(
        &self,
        device: &Device,
        tree: &Tree,
        frames: Positions<R>,
        faces: Span<[u32; 3]>,
    ) -> Result<(), Error> {
        if !matches!(tree.way, RefitPlan::Treelets(_)) {
            let args = FitArgs {
                frames,
                faces,
                leaf_nodes: tree.leaf_nodes.span(),
                links: tree.links.span(),
                nodes: self.nodes.span(),
                margin: self.margin,
                pad: 0,
            };
            launch::each::<V::Fit<R>>(device, tree.leaves(), &args)?;
        }
        if V::group(self.axes) == 0 {
            return Ok(());
        }
        let args = GroupsArgs {
            frames,
            faces,
            triangles: tree.triangles(),
            links: tree.links.span(),
            pair_parents: tree.pair_parents.span(),
            firsts: tree.firsts.span(),
            nodes: self.nodes.span(),
            root: tree.root(),
            margin: self.margin,
        };
        V::fit_groups(device, &args)
    }

    /// Refits all other volumes, the way that the tree was made for; the positions are those of [`Volumes::fit`].
    ///
    /// # Errors
    /// Those of the device.
    pub fn refit<R: Precision>(
        &self,
        device: &Device,
        tree: &Tree,
        frames: Positions<R>,
        faces: Span<[u32; 3]>,
    ) -> Result<(), Error> {
        match &tree.way {
            RefitPlan::Levels => self.levels(device, tree),
            RefitPlan::Treelets(plan) => self.treelets(device, plan, frames, faces),
            RefitPlan::BottomUp(arrivals) => {
                let args = BottomUpArgs {
                    links: tree.links.span(),
                    pair_parents: tree.pair_parents.span(),
                    leaf_nodes: tree.leaf_nodes.span(),
                    firsts: tree.firsts.span(),
                    arrivals: arrivals.span(),
                    nodes: self.nodes.span(),
                    axes: self.axes,
                    root: tree.root(),
                };
                launch::each::<V::BottomUp>(device, tree.leaves(), &args)
            }
        }
    }

    /// All volumes, those of the leaves too, in one launch.
    fn treelets<R: Precision>(
        &self,
        device: &Device,
        plan: &Plan,
        frames: Positions<R>,
        faces: Span<[u32; 3]>,
    ) -> Result<(), Error> {
        let args = TreeletsArgs {
            frames,
            faces,
            treelets: plan.treelets.span(),
            leaf_places: plan.leaf_places.span(),
            merges: plan.merges.span(),
            top: plan.top.span(),
            top_starts: plan.top_starts.span(),
            ticket: plan.ticket.span(),
            nodes: self.nodes.span(),
            axes: self.axes,
            margin: self.margin,
        };
        launch::blocks::<V::Treelets<R>>(device, plan.blocks(), &args)
    }

    /// A launch a level; runs of narrow levels share one: levels of up to four nodes a lane,
    /// a few hundred nanoseconds each in one block, where a launch costs microseconds.
    fn levels(&self, device: &Device, tree: &Tree) -> Result<(), Error> {
        let one_block = 4 * V::Levels::LANES;
        let starts = tree.starts();
        let width = |level: usize| starts[level + 1] - starts[level];
        // The deepest level holds only leaves.
        let mut to = tree.depth() - 1;
        while to > 0 {
            let mut from = to - 1;
            if width(from) <= one_block {
                while from > 0 && width(from - 1) <= one_block {
                    from -= 1;
                }
            }
            let narrow = width(to - 1) <= one_block;
            let blocks = if narrow { 1 } else { device.blocks_for::<V::Levels>(width(from) as usize) };
            let args = RefitArgs {
                links: tree.links.span(),
                nodes: self.nodes.span(),
                levels: tree.levels.span(),
                firsts: tree.firsts.span(),
                from: from as u32,
                to: to as u32,
                axes: self.axes,
                pad: 0,
            };
            launch::blocks::<V::Levels>(device, blocks, &args)?;
            to = from;
        }
        Ok(())
    }

    /// The nodes as they lie on the device.
    ///
    /// # Errors
    /// Those of the device.
    pub fn download(&self) -> Result<Vec<Node<V>>, Error> {
        let mut nodes = self.nodes.read(self.nodes.len())?;
        // Node 0 is not used and nothing writes it; nor, where nothing is grafted, what lies behind the tree.
        nodes[0] = bytemuck::Zeroable::zeroed();
        Ok(nodes)
    }

    /// Checks the volumes as they lie on the device: leaves against their triangles, merges, and nodes of few leaves against
    /// the points below them.
    /// `frames` has the positions that they were fitted to, at t = 0 and, when anything moves, at t = 1.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; those of the device.
    pub fn check<R: Precision>(
        &self,
        tree: &Tree,
        faces: &[[u32; 3]],
        frames: &[Vec<Vec3<R>>],
    ) -> Result<(), Error> {
        let leaves = tree.leaf_nodes.read(tree.leaves())?;
        let nodes = &self.download()?[..tree.root() as usize - 1 + 2 * tree.leaves()];
        self.check_nodes((&tree.download()?, nodes, &leaves), tree.root(), faces, frames)
    }

    /// Checks nodes, the last leaf's the last of them, against the links and the leaves' nodes of their tree.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation.
    pub fn check_nodes<R: Precision>(
        &self,
        (links, nodes, leaves): (&[Link], &[Node<V>], &[u32]),
        root: u32,
        faces: &[[u32; 3]],
        frames: &[Vec<Vec3<R>>],
    ) -> Result<(), Error> {
        let leaf = |triangle: u32| {
            let corners = |frame: &Vec<Vec3<R>>| faces[triangle as usize].map(|v| frame[v as usize]);
            let volume = match frames {
                [t0, t1] => V::moving(corners(t0), corners(t1)),
                _ => V::still(corners(&frames[0])),
            };
            volume.near(self.margin)
        };
        let fitted = |first: u32, last: u32| {
            if last - first >= V::group(self.axes) {
                return None;
            }
            let triangles =
                leaves[first as usize..=last as usize].iter().map(|&at| links[at as usize].triangle());
            let vertices = triangles.flat_map(|t| faces[t as usize]);
            let points = vertices.flat_map(|v| frames.iter().map(move |frame| frame[v as usize]));
            let volume = V::of(&points.collect::<Vec<_>>())?;
            Some(volume.near(self.margin))
        };
        bvh::check_volumes(links, nodes, (root, self.axes), leaf, fitted).map_err(broken)
    }
}
