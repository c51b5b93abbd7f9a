//! The trees of a scene: a moving tree, refitted every frame, and a fixed tree, built and fitted
//! once.
//!
//! Both share one memory and one root, so that one walk finds all pairs: moving with moving, and
//! moving with fixed. See `nearmiss_kernels::stage::construct::graft`.

use super::tree::{Room, Tree, TreeSpec};
use super::volumes::Volumes;
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::broad::sorted::place;
use crate::pipeline::broad::{BroadContext, Checked, broken};
use crate::pipeline::layout::Layout;
use crate::pipeline::precision::Precision;
use crate::pipeline::{launch, purpose};
use crate::query::Refit;
use nearmiss_kernels::abi::{
    FilterArgs, GraftArgs, Growth, Link, Node, NodeFilter, ROOT, TraverseFlags, TreeBody, grafted,
};
use nearmiss_kernels::bvh;
use nearmiss_kernels::entry::{self, Kernels};

/// The trees of a scene.
pub struct Forest<V> {
    /// The moving tree.
    pub tree: Tree,
    /// Volumes of both trees.
    pub volumes: Volumes<V>,
    fixed: Option<Fixed>,
}

/// A fixed tree, as it was built.
struct Fixed {
    bodies: Vec<usize>,
    layout: (Vec<TreeBody>, u32),
    /// Start of each level; empty before the tree is built.
    starts: Vec<u32>,
    refit: Refit,
    /// Growth of its volumes.
    growth: Growth,
}

impl<V: Kernels> Forest<V> {
    /// Allocates the trees over the bodies of a layout. At least one body moves.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, layout: &Layout, refit: Refit, growth: Growth) -> Result<Forest<V>, Error> {
        let [moving, fixed] = &layout.trees;
        let leaves: u32 = fixed.iter().map(|&body| layout.triangles(body).1).sum();
        let room = if leaves > 0 { Room::Beside(leaves) } else { Room::Alone };
        let groups = V::GROUP > 0;
        let tree = Tree::new(device, &TreeSpec { layout, bodies: moving, room, refit, groups })?;
        let volumes = Volumes::new(&device.of(purpose::VOLUMES), &tree, growth)?;
        let fixed = (leaves > 0).then(|| Fixed {
            bodies: fixed.clone(),
            layout: (Vec::new(), leaves),
            starts: Vec::new(),
            refit,
            growth,
        });
        Ok(Forest { tree, volumes, fixed })
    }

    /// Builds the moving tree and, the first time, the fixed one.
    ///
    /// # Errors
    /// Device errors.
    pub fn construct<R: Precision>(&mut self, given: &BroadContext<R>, layout: &Layout) -> Result<(), Error> {
        let BroadContext { device, frames, faces, records, .. } = *given;
        self.tree.construct::<R>(device, frames, (faces, records))?;
        match &mut self.fixed {
            Some(fixed) if fixed.starts.is_empty() => {
                let groups = V::GROUP > 0;
                let Fixed { bodies, refit, .. } = &*fixed;
                let plan = TreeSpec { layout, bodies, room: Room::Alone, refit: *refit, groups };
                let mut tree = Tree::new(device, &plan)?;
                tree.construct::<R>(device, frames, (faces, records))?;
                tree.learn_levels()?;
                let volumes = Volumes::<V>::new(device, &tree, fixed.growth)?;
                let frames = given.of_fixed().frames;
                volumes.fit(device, &tree, frames, faces)?;
                volumes.refit(device, &tree, frames, faces)?;
                let args = GraftArgs {
                    from: volumes.nodes.span(),
                    from_filters: tree.filters.span(),
                    nodes: self.volumes.nodes.span(),
                    pair_parents: self.tree.pair_parents.span(),
                    filters: self.tree.filters.span(),
                    leaves: self.tree.leaves() as u32,
                    pad: 0,
                };
                launch::each::<entry::construct_graft<V>>(device, volumes.nodes.len() - 1, &args)?;
                fixed.starts = tree.starts().to_vec();
                fixed.layout = (tree.bodies().to_vec(), tree.leaves() as u32);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Sets the growth of volumes from the next fit on. Returns whether the fixed tree must be
    /// built again for it.
    pub fn set_growth(&mut self, growth: Growth) -> bool {
        self.volumes.growth = growth;
        let Some(fixed) = self.fixed.as_mut().filter(|fixed| !fixed.growth.serves(growth)) else {
            return false;
        };
        fixed.growth = fixed.growth.or(growth);
        fixed.starts.clear();
        true
    }

    /// Returns the filters of a walk's pairs; `of_bodies` has no nodes.
    pub fn filters(&self, of_bodies: FilterArgs) -> FilterArgs {
        FilterArgs { nodes: self.tree.filters.span(), ..of_bodies }
    }

    /// Returns the flags that a walk over these trees needs.
    pub fn flags(&self) -> TraverseFlags {
        TraverseFlags::GRAFTED.when(self.fixed.is_some())
    }

    /// Returns the number of levels of the moving tree and, if there is one, of the fixed tree.
    pub fn depths(&self) -> Vec<usize> {
        let fixed = self.fixed.as_ref().map(|fixed| fixed.starts.len().saturating_sub(1));
        std::iter::once(self.tree.depth()).chain(fixed).collect()
    }

    /// Checks both trees and their volumes.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; device errors.
    pub fn check<R: Precision>(
        &self,
        layout: &Layout,
        faces: &[[u32; 3]],
        frames: &Checked<R>,
    ) -> Result<(), Error> {
        self.tree.check()?;
        let filters = self.tree.filters.read(self.tree.filters.len())?;
        let all: Vec<NodeFilter> = layout.whose().collect();
        let whose = |triangle: u32| all[triangle as usize];
        let check_filters = |links: &[Link], filters: &[NodeFilter], root: u32| {
            if filters.is_empty() {
                return Ok(());
            }
            bvh::check_filters(links, filters, root, whose).map_err(broken)
        };
        check_filters(&self.tree.download()?, &filters, self.tree.root())?;
        self.volumes.check(&self.tree, faces, frames)?;
        let Some(fixed) = &self.fixed else { return Ok(()) };
        let (nodes, pair_parents) = self.ungrafted(fixed)?;
        let links: Vec<Link> = nodes.iter().map(|node| Link { link: node.link, last: node.last }).collect();
        let (bodies, count) = &fixed.layout;
        let mut leaf_nodes = vec![0; *count as usize];
        for (node, link) in links.iter().enumerate().skip(ROOT as usize).filter(|(_, link)| link.is_leaf()) {
            if let Some(at) = leaf_nodes.get_mut(link.last as usize) {
                *at = node as u32;
            }
        }
        let levels: Vec<u32> =
            std::iter::once(fixed.starts.len() as u32 - 1).chain(fixed.starts.iter().copied()).collect();
        let tree = bvh::Tree {
            links: &links,
            pair_parents: &pair_parents,
            levels: &levels,
            leaf_nodes: &leaf_nodes,
            root: ROOT,
            place: &|triangle| place(bodies, *count, triangle),
        };
        bvh::check(&tree, &mut vec![false; *count as usize]).map_err(broken)?;
        let own = self.tree.leaves() as u32;
        let filters: Vec<NodeFilter> =
            (0..2 * count).map(|node| filters[grafted(node, own) as usize]).collect();
        check_filters(&links, &filters, ROOT)?;
        // Fixed volumes were fitted once, without turns.
        let swell = |_| 0.0;
        self.volumes.check_nodes((&links, &nodes, &leaf_nodes), (ROOT, fixed.growth, &swell), faces, frames)
    }

    /// Returns the nodes of the fixed tree as they were before they were grafted, and the parents
    /// of their pairs.
    fn ungrafted(&self, fixed: &Fixed) -> Result<(Vec<Node<V>>, Vec<u32>), Error> {
        let (own, count) = (self.tree.leaves() as u32, fixed.layout.1);
        let nodes = self.volumes.download()?;
        let parents = self.tree.pair_parents.read(self.tree.pair_parents.len())?;
        // Maps a node back to the fixed tree's own numbers; a wrong number stays wrong, and a
        // check fails.
        let back = |at: u32| if at == grafted(ROOT, own) { ROOT } else { at.wrapping_sub(2 * own) };
        let mut all = vec![bytemuck::Zeroable::zeroed(); 2 * count as usize];
        for node in ROOT..2 * count {
            let mut link = nodes[grafted(node, own) as usize];
            link.last = link.last.wrapping_sub(own);
            if !link.is_leaf() {
                link.link = back(link.link);
            }
            all[node as usize] = link;
        }
        let pair = |k: u32| back(parents[(grafted(2 * k, own) / 2) as usize]);
        Ok((all, std::iter::once(0).chain((1..count).map(pair)).collect()))
    }
}
