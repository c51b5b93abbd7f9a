//! Fit and refit: the bounding volume of each node.

use super::tree::Tree;
use super::treelets::{Plan, RefitPlan};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::broad::{Checked, broken};
use crate::pipeline::launch;
use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::{
    FitArgs, GroupsArgs, Growth, Link, Node, Positions, RefitArgs, Span, TreeletsArgs,
};
use nearmiss_kernels::bvh;
use nearmiss_kernels::entry::{self, Entry, Kernels};

/// The volumes of a tree, kept on the device.
pub struct Volumes<V> {
    /// The nodes, in the tree's order.
    pub nodes: Buffer<Node<V>>,
    /// Growth of the volumes.
    pub growth: Growth,
}

impl<V: Kernels> Volumes<V> {
    /// Allocates the volumes of a tree. They hold everything within `growth` of the triangles.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, tree: &Tree, growth: Growth) -> Result<Self, Error> {
        let leaves = tree.leaves() + tree.room().others() as usize;
        Ok(Volumes { nodes: device.buffer(2 * leaves)?, growth })
    }

    /// Fits the volumes of the leaves, unless treelets do that in [`Volumes::refit`]. Also fits the
    /// nodes of few leaves, which are not merged.
    ///
    /// # Errors
    /// Device errors.
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
                growth: self.growth,
            };
            launch::each::<entry::fit<R, V>>(device, tree.leaves(), &args)?;
        }
        if V::GROUP == 0 {
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
            growth: self.growth,
            root: tree.root(),
            pad: 0,
        };
        // One pair of siblings per inner node, behind the root.
        let inner = tree.firsts.len() - tree.root().div_ceil(2) as usize;
        launch::each::<entry::fit_groups<R, V>>(device, inner, &args)
    }

    /// Refits all other volumes, by the tree's own plan; positions are those of [`Volumes::fit`].
    ///
    /// # Errors
    /// Device errors.
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
        }
    }

    /// Refits all volumes, leaves included, in one launch.
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
            growth: self.growth,
        };
        launch::blocks::<entry::refit_treelets<R, V>>(device, plan.blocks(), &args)
    }

    /// Refits by levels, one launch each. Runs of narrow levels share a launch: levels of up to
    /// four nodes a lane. In one block such a level takes a few hundred nanoseconds, and a launch
    /// takes microseconds.
    fn levels(&self, device: &Device, tree: &Tree) -> Result<(), Error> {
        let one_block = 4 * entry::refit_levels::<V>::LANES;
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
            let blocks =
                if narrow { 1 } else { device.blocks_for::<entry::refit_levels<V>>(width(from) as usize) };
            let args = RefitArgs {
                links: tree.links.span(),
                nodes: self.nodes.span(),
                levels: tree.levels.span(),
                firsts: tree.firsts.span(),
                from: from as u32,
                to: to as u32,
            };
            launch::blocks::<entry::refit_levels<V>>(device, blocks, &args)?;
            to = from;
        }
        Ok(())
    }

    /// Downloads the nodes.
    ///
    /// # Errors
    /// Device errors.
    pub fn download(&self) -> Result<Vec<Node<V>>, Error> {
        let mut nodes = self.nodes.read(self.nodes.len())?;
        // Node 0 is unused and never written. If nothing is grafted, neither is memory behind the
        // tree.
        nodes[0] = bytemuck::Zeroable::zeroed();
        Ok(nodes)
    }

    /// Checks the volumes on the device: leaves against their triangles, merges against children,
    /// and nodes of few leaves against the points below them. `frames` has the positions that they
    /// were fitted to, at t = 0 and, if anything moves, at t = 1.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; device errors.
    pub fn check<R: Precision>(
        &self,
        tree: &Tree,
        faces: &[[u32; 3]],
        frames: &Checked<R>,
    ) -> Result<(), Error> {
        let leaves = tree.leaf_nodes.read(tree.leaves())?;
        let nodes = &self.download()?[..tree.root() as usize - 1 + 2 * tree.leaves()];
        let swell = |face| frames.swell(face);
        self.check_nodes(
            (&tree.download()?, nodes, &leaves),
            (tree.root(), self.growth, &swell),
            faces,
            frames,
        )
    }

    /// Checks nodes against the links and the leaves' nodes of their tree. `nodes` ends with the
    /// last leaf.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation.
    pub fn check_nodes<R: Precision>(
        &self,
        (links, nodes, leaves): (&[Link], &[Node<V>], &[u32]),
        (root, growth, swell): (u32, Growth, &dyn Fn([u32; 3]) -> f32),
        faces: &[[u32; 3]],
        frames: &Checked<R>,
    ) -> Result<(), Error> {
        let grown = |triangle: u32| {
            let face = faces[triangle as usize];
            (frames.grown(face, growth), swell(face))
        };
        let leaf = |triangle: u32| {
            let (margin, swell) = grown(triangle);
            frames.leaf::<V>(faces[triangle as usize], margin + swell)
        };
        let fitted = |first: u32, last: u32| {
            if last - first >= V::GROUP {
                return None;
            }
            let triangles =
                leaves[first as usize..=last as usize].iter().map(|&at| links[at as usize].triangle());
            let most = |[x, y]: [f32; 2], (own_x, own_y): (f32, f32)| [x.max(own_x), y.max(own_y)];
            let [margin, swell] = triangles.clone().map(grown).fold([growth.margin, 0.0], most);
            let vertices = triangles.flat_map(|t| faces[t as usize]);
            let points = vertices.flat_map(|v| frames.iter().map(move |frame| frame[v as usize]));
            let volume = V::of_points(&*points.collect::<Vec<_>>());
            Some(volume.near(margin + swell))
        };
        bvh::check_volumes(links, nodes, root, leaf, fitted).map_err(broken)
    }
}
