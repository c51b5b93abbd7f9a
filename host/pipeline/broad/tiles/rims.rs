//! Rims of tiles: volumes of the edges opposite to hubs; see `nearmiss_kernels::stage::fit::rims`.

use super::{MOVING, Tiles};
use crate::error::Error;
use crate::pipeline::broad::{BroadContext, Checked, broken};
use crate::pipeline::launch;
use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::RimsArgs;
use nearmiss_kernels::bvh::{rims, tiles};
use nearmiss_kernels::entry::{self, Kernels};

impl<V: Kernels> Tiles<V> {
    /// Fits the rims of the moving nodes.
    ///
    /// # Errors
    /// Device errors.
    pub(super) fn fit_rims<R: Precision>(&self, given: &BroadContext<R>) -> Result<(), Error> {
        if self.rims.is_empty() {
            return Ok(());
        }
        for level in 0..self.levels.count {
            let [own, below] = self.own_and_below(level, MOVING);
            let args = RimsArgs {
                frames: given.frames,
                faces: given.faces,
                triangles: self.sorted.triangles(),
                hubs: self.hubs.span(),
                rims: self.rims.span(),
                first: own.first,
                count: own.count,
                below: below.first,
                below_count: below.count,
                growth: self.growth,
            };
            launch::each::<entry::fit_rims<R, V>>(given.device, own.count as usize, &args)?;
        }
        Ok(())
    }

    /// Checks the hubs and the rims of all nodes, if there are any.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; device errors.
    pub(super) fn check_rims<R: Precision>(
        &self,
        tiles: &tiles::Tiles<V>,
        faces: &[[u32; 3]],
        frames: &Checked<R>,
    ) -> Result<(), Error> {
        if self.rims.is_empty() {
            return Ok(());
        }
        let (nodes, hubs) = (self.rims.read(self.rims.len())?, self.hubs.read(self.hubs.len())?);
        let face = |triangle: u32| (faces[triangle as usize], hubs[triangle as usize]);
        let ends = |v: u32| [&frames[0], &frames[frames.len() - 1]].map(|at| at[v as usize].wide());
        rims::check(tiles, &nodes, face, ends).map_err(broken)
    }
}
