//! Checker of tiles: compares every volume with the positions, after download.

use super::{FIXED, MOVING, Tiles};
use crate::error::Error;
use crate::pipeline::broad::sorted::place;
use crate::pipeline::broad::{Checked, broken};
use crate::pipeline::layout::Layout;
use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::NodeFilter;
use nearmiss_kernels::bvh::tiles;
use nearmiss_kernels::entry::Kernels;

impl<V: Kernels> Tiles<V> {
    /// Checks tiles, and their rims if there are any.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; device errors.
    pub(super) fn check_tiles<R: Precision>(
        &self,
        layout: &Layout,
        faces: &[[u32; 3]],
        frames: &Checked<R>,
    ) -> Result<(), Error> {
        let filters = self.filters.read(self.filters.len())?;
        let whose: Vec<NodeFilter> = layout.whose().collect();
        let tiles = tiles::Tiles {
            levels: self.levels,
            triangles: self.triangles,
            leaves: &self.leaves.read(self.leaves.len())?,
            nodes: &self.nodes.read(self.nodes.len())?,
            filters: &filters,
        };
        let fixed = self.fixed.as_ref().map_or(&[][..], |fixed| &fixed.bodies);
        let bodies = [self.sorted.bodies(), fixed];
        let place = |triangle| {
            let of = |part: usize| place(bodies[part], self.triangles[part], triangle).map(|at| (part, at));
            of(MOVING).or_else(|| of(FIXED))
        };
        let is_static = |triangle: u32| place(triangle).is_some_and(|(part, _)| part == FIXED);
        let margin = |triangle| {
            let face = faces[triangle as usize];
            if is_static(triangle) {
                frames.grown(face, self.fixed_growth.fitted())
            } else {
                frames.grown(face, self.growth) + frames.swell(face)
            }
        };
        let leaf = |triangle: u32| frames.leaf::<V>(faces[triangle as usize], margin(triangle));
        let mut seen = self.triangles.map(|count| vec![false; count as usize]);
        let [moving, fixed] = &mut seen;
        tiles::check(&tiles, place, leaf, |triangle| whose[triangle as usize], [moving, fixed])
            .and_then(|()| {
                let ends = |v: u32| [&frames[0], &frames[frames.len() - 1]].map(|at| at[v as usize].wide());
                tiles::check_held(&tiles, |triangle| faces[triangle as usize].map(ends))
            })
            .map_err(broken)?;
        self.check_rims(&tiles, faces, frames)
    }
}
