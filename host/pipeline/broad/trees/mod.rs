//! Trees: a moving one, refitted every frame, and a fixed one, traversed by one of several walks.

mod forest;
mod tree;
mod treelets;
mod volumes;
mod walk;

pub use tree::{Tree, TreeSpec};
pub use volumes::Volumes;

use super::{BroadContext, CandidateSearch, Candidates};
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::broad::Checked;
use crate::pipeline::counts::Counts;
use crate::pipeline::layout::Layout;
use crate::pipeline::list::GrowableOutput;
use crate::pipeline::precision::Precision;
use crate::pipeline::purpose;
use crate::query::Query;
use forest::Forest;
use nearmiss_kernels::abi::{Growth, Output};
use nearmiss_kernels::entry::Kernels;
use walk::{Walk, WalkContext, walk};
use xxhash_rust::xxh3::xxh3_64;

/// The trees of a scene, and the walk of a query.
pub struct Trees<R: Precision, V> {
    forest: Forest<V>,
    walk: Box<dyn Walk<R, V>>,
}

impl<R: Precision, V: Kernels> Trees<R, V> {
    /// Allocates the trees over the bodies of a layout, and the walk of a query.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, layout: &Layout, query: &Query, growth: Growth) -> Result<Self, Error> {
        let refit = query.refit_on(device.is_gpu());
        Ok(Trees {
            forest: Forest::new(&device.of(purpose::TREE), layout, refit, growth)?,
            walk: walk(&device.of(purpose::WALK), query, layout.moving_triangles())?,
        })
    }
}

impl<R: Precision, V: Kernels> CandidateSearch<R> for Trees<R, V> {
    fn construct(&mut self, given: &BroadContext<R>, layout: &Layout) -> Result<(), Error> {
        self.walk.invalidate();
        self.forest.construct(given, layout)
    }

    fn set_growth(&mut self, growth: Growth) -> bool {
        self.forest.set_growth(growth)
    }

    fn learn(&mut self) -> Result<(), Error> {
        self.forest.tree.learn_levels()
    }

    fn fit(&mut self, given: &BroadContext<R>) -> Result<(), Error> {
        self.forest.volumes.fit(given.device, &self.forest.tree, given.frames, given.faces)
    }

    fn refit(&mut self, given: &BroadContext<R>) -> Result<(), Error> {
        self.forest.volumes.refit(given.device, &self.forest.tree, given.frames, given.faces)
    }

    fn traverse(&mut self, given: &BroadContext<R>, candidates: &Candidates) -> Result<(), Error> {
        self.walk.launch(&WalkContext {
            device: given.device,
            forest: &self.forest,
            frames: given.frames,
            faces: given.faces,
            filters: given.filters,
            pairs: candidates.pairs,
            ends: Output::EMPTY,
            counters: candidates.counters,
            flags: candidates.flags | self.forest.flags(),
        })
    }

    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        self.walk.lists()
    }

    fn finish(&mut self, counters: &Counts) -> Result<(), Error> {
        self.walk.finish(counters)
    }

    fn without_host(&self) -> Result<(), &'static str> {
        self.walk.without_host()
    }

    fn front_dropped(&self) -> bool {
        self.walk.front_dropped()
    }

    fn balance_ms(&self) -> Result<f64, Error> {
        self.walk.balance_ms()
    }

    fn depths(&self) -> Vec<usize> {
        self.forest.depths()
    }

    fn fingerprints(&self) -> Result<Vec<(&'static str, u64)>, Error> {
        let (mut leaves, mut inner) = (Vec::new(), Vec::new());
        for node in self.forest.volumes.download()? {
            if node.is_leaf() { leaves.push(node.volume) } else { inner.push(node.volume) }
        }
        Ok(vec![
            ("construct", xxh3_64(bytemuck::cast_slice(&self.forest.tree.download()?))),
            ("fit", xxh3_64(bytemuck::cast_slice(&leaves))),
            ("refit", xxh3_64(bytemuck::cast_slice(&inner))),
        ])
    }

    fn check(&self, layout: &Layout, faces: &[[u32; 3]], frames: &Checked<R>) -> Result<(), Error> {
        self.forest.check(layout, faces, frames)
    }
}
