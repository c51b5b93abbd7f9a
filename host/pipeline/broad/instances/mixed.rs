//! The search of scenes of rigid bodies and of few that deform: in two parts, which list candidates one
//! behind the other.
//!
//! Pairs with a rigid body go down two meshes, as in [`super::motion`]. The mesh of a body that
//! deforms is refitted each frame, around the step. Pairs of two that deform, and triangles of one
//! body, go by the tiles of these bodies alone.

use super::descent::CLOSE;
use super::motion::{MotionSearch, motion};
use super::without_instances;
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::broad::tiles::Tiles;
use crate::pipeline::broad::{BroadContext, CandidateSearch, Candidates, Checked, Which};
use crate::pipeline::counts::Counts;
use crate::pipeline::layout::Layout;
use crate::pipeline::list::GrowableOutput;
use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::{Growth, Positions, Span};
use nearmiss_kernels::entry::Kernels;
use xxhash_rust::xxh3::xxh3_64;

/// Bodies in groups, and tiles of those that deform.
pub struct MixedSearch<V> {
    bodies: MotionSearch,
    is_at_rest: bool,
    /// `None` if no two triangles of bodies that deform are tested against each other.
    own: Option<Own<V>>,
}

/// Tiles of bodies that deform, and the layout in which the scene has no other bodies.
struct Own<V> {
    tiles: Tiles<V>,
    layout: Layout,
}

impl<V: Kernels> MixedSearch<V> {
    /// Allocates both parts, for a query at rest or in motion. `deforming` are the bodies that deform,
    /// in ascending order; there is one.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(
        device: &Device,
        (layout, deforming): (&Layout, &[usize]),
        is_at_rest: bool,
        growth: Growth,
    ) -> Result<Self, Error> {
        // Both parts count at once: tiles of meshes have the counters that distances of bodies have.
        let bodies = MotionSearch::new(device, layout, CLOSE, (is_at_rest, growth.margin))?;
        let alone = Layout { trees: [deforming.to_vec(), Vec::new()], ..layout.clone() };
        let own = if alone.may_meet() {
            Some(Own { tiles: Tiles::new(device, &alone, growth)?, layout: alone })
        } else {
            None
        };
        Ok(MixedSearch { bodies, is_at_rest, own })
    }

    /// Copies this frame's vertices of bodies that deform to those of candidates.
    fn spread<R: Precision>(&self, given: &BroadContext<R>) -> Result<(), Error> {
        let instances = given.instances.ok_or_else(without_instances)?;
        let (from, _) = R::in_f64(given.frames, Span::EMPTY);
        instances.spread(given.device, from, self.is_at_rest)
    }

    /// Returns the context of the tiles: vertices and triangles by their numbers in the scene.
    fn in_scene<'a, R: Precision>(&self, given: &BroadContext<'a, R>) -> Result<BroadContext<'a, R>, Error> {
        let motion = motion(given)?;
        let (frames, _) = R::of_f64(motion.vertices(self.is_at_rest), Span::EMPTY);
        // None of these bodies turns.
        let frames = Positions { turns: Span::EMPTY, ..frames };
        Ok(BroadContext { frames, faces: motion.faces(), ..*given })
    }
}

/// One hash of two.
fn both(a: u64, b: u64) -> u64 {
    xxh3_64(bytemuck::cast_slice(&[a, b]))
}

impl<R: Precision, V: Kernels> CandidateSearch<R> for MixedSearch<V> {
    fn construct(&mut self, given: &BroadContext<R>, layout: &Layout) -> Result<(), Error> {
        CandidateSearch::<R>::construct(&mut self.bodies, given, layout)?;
        self.spread(given)?;
        let given = &self.in_scene(given)?;
        let Some(Own { tiles, layout }) = &mut self.own else { return Ok(()) };
        tiles.construct(given, layout)
    }

    fn learn(&mut self) -> Result<(), Error> {
        Ok(())
    }

    fn set_growth(&mut self, growth: Growth) -> bool {
        let tiles = self.own.as_mut().map(|own| &mut own.tiles as &mut dyn CandidateSearch<R>);
        let of_tiles = tiles.is_some_and(|tiles| tiles.set_growth(growth));
        CandidateSearch::<R>::set_growth(&mut self.bodies, growth) | of_tiles
    }

    fn fit(&mut self, given: &BroadContext<R>) -> Result<(), Error> {
        self.spread(given)?;
        let instances = given.instances.ok_or_else(without_instances)?;
        instances.sweep(given.device, self.is_at_rest)?;
        CandidateSearch::<R>::fit(&mut self.bodies, given)?;
        let given = &self.in_scene(given)?;
        self.own.as_mut().map_or(Ok(()), |own| CandidateSearch::fit(&mut own.tiles, given))
    }

    fn refit(&mut self, given: &BroadContext<R>) -> Result<(), Error> {
        CandidateSearch::<R>::refit(&mut self.bodies, given)?;
        self.own.as_mut().map_or(Ok(()), |own| CandidateSearch::refit(&mut own.tiles, given))
    }

    fn traverse(&mut self, given: &BroadContext<R>, candidates: &Candidates) -> Result<(), Error> {
        // The last launch of the first part names candidates by their triangles in the scene. So it is
        // before the second part, which lists such triangles.
        self.bodies.traverse(given, candidates)?;
        let given = &self.in_scene(given)?;
        let candidates = Candidates { which: Which::All, ..*candidates };
        self.own.as_mut().map_or(Ok(()), |own| own.tiles.traverse(given, &candidates))
    }

    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        let mut all = CandidateSearch::<R>::lists(&mut self.bodies);
        all.extend(self.own.iter_mut().flat_map(|own| CandidateSearch::<R>::lists(&mut own.tiles)));
        all
    }

    fn finish(&mut self, counters: &Counts) -> Result<(), Error> {
        CandidateSearch::<R>::finish(&mut self.bodies, counters)
    }

    fn depths(&self) -> Vec<usize> {
        CandidateSearch::<R>::depths(&self.bodies)
    }

    fn fingerprints(&self) -> Result<Vec<(&'static str, u64)>, Error> {
        let mut all = CandidateSearch::<R>::fingerprints(&self.bodies)?;
        let own = self.own.as_ref().map(|own| CandidateSearch::<R>::fingerprints(&own.tiles));
        for ((_, print), (_, own)) in all.iter_mut().zip(own.transpose()?.unwrap_or_default()) {
            *print = both(*print, own);
        }
        Ok(all)
    }

    fn check(&self, layout: &Layout, faces: &[[u32; 3]], frames: &Checked<R>) -> Result<(), Error> {
        self.bodies.check(layout, faces, frames)?;
        self.own.as_ref().map_or(Ok(()), |own| own.tiles.check(&own.layout, faces, frames))
    }
}
