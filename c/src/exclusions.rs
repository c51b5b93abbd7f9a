//! Pairs of features that are left out.

use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given, refused};
use crate::rows::{NearmissNumber, NearmissRows, items};
use nearmiss::Error;
use nearmiss::scene::{BodyId, Exclusions, RestShape, Scene};
use std::mem::MaybeUninit;
use std::ptr::null;

/// Pairs of features of a body that are not tested against each other, and faces that take no
/// part. A feature is a vertex, an edge or a face. Begin with `nearmiss_exclusions()`. Calls
/// copy everything that it points to.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissExclusions {
    /// The rest shape, a point a vertex, in memory of the host. NULL data: the place of the
    /// body, at t = 0.
    pub rest: NearmissRows,
    /// Indices of faces that take no part, and with them vertices and edges of no other face.
    pub faces: *const u32,
    /// Number of these.
    pub face_count: usize,
    /// A length from 0. Pairs of features that are nearer than this in the rest shape are left
    /// out. 0 leaves out none.
    pub within: f64,
    /// A pair of features is left out if a vertex of one and a vertex of the other have at most
    /// `ring - 1` edges between them. All queries leave out pairs of ring 1, except a discrete
    /// one that keeps adjacent triangles. 0 for no ring.
    pub ring: u32,
    /// Zero.
    pub pad: u32,
}

/// No exclusions.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_exclusions() -> NearmissExclusions {
    let number = NearmissNumber::NEARMISS_F32 as u32;
    NearmissExclusions {
        rest: NearmissRows { data: null(), count: 0, stride: 0, number },
        faces: null(),
        face_count: 0,
        within: 0.0,
        ring: 0,
        pad: 0,
    }
}

impl NearmissExclusions {
    /// The library's exclusions of a body.
    ///
    /// # Safety
    /// Its pointers point to what the header says.
    unsafe fn of_body(&self, scene: &Scene, id: BodyId) -> Result<Exclusions, Error> {
        if self.pad != 0 {
            return Err(refused(format!("pad of the exclusions is {}", self.pad), "keep it 0"));
        }
        let has_rest = !self.rest.data.is_null() || self.rest.count > 0;
        if has_rest && self.within == 0.0 {
            return Err(refused("rest shape without a distance", "set within too, or leave rest empty"));
        }
        // SAFETY: the caller's promise.
        let faces = unsafe { items(self.faces, self.face_count, "faces") }?.to_vec();
        let positions = if self.within == 0.0 {
            None
        } else if !has_rest {
            scene.get(id).map(|body| body.positions_t0().clone())
        } else {
            // SAFETY: the caller's promise.
            Some(unsafe { self.rest.points("rest") }?.positions()?)
        };
        let rest = positions.map(|positions| RestShape { within: self.within, positions });
        Ok(Exclusions { ring: (self.ring != 0).then_some(self.ring), rest, faces })
    }
}

/// Replaces the exclusions of a body, from the next query on, which rebuilds. Queries of
/// features and of triangles obey. Those of distances and of pairs of bodies fail if there are
/// exclusions. A body that is removed or replaced loses its exclusions: its vertices may have
/// other numbers. Other exclusions end the preparation of submissions.
///
/// Fails with `NEARMISS_INVALID_ARGUMENT` for a body or a face that does not exist, a length
/// that is negative or not finite, and a rest shape of another number of vertices. Fails with
/// `NEARMISS_INPUT` for positions that are not finite. Then nothing has changed.
///
/// # Safety
/// Memory that the exclusions point to is there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_exclude(
    detector: Option<&mut NearmissDetector>,
    body: u32,
    exclusions: Option<&NearmissExclusions>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let (exclusions, id) = (given(exclusions, "exclusions")?, own.body(body)?);
        if exclusions.within != 0.0 && exclusions.rest.data.is_null() {
            own.detector.download_positions()?;
        }
        // SAFETY: the caller's promise.
        let exclusions = unsafe { exclusions.of_body(own.detector.scene(), id) }?;
        own.detector.exclude(id, exclusions)
    })
}

/// Replaces the list of pairs of vertices of two bodies, or of one with itself, of which
/// features are not tested against each other. `pairs` has `count` pairs: a vertex of body `a`,
/// and one of body `b`. Order and repeats do not matter; a count of 0 leaves out none. A body
/// that is removed or replaced takes its lists with it.
///
/// Fails with `NEARMISS_INVALID_ARGUMENT` for a body or a vertex that does not exist, and for a
/// vertex with itself. Then the list is as before.
///
/// # Safety
/// `pairs` points to that many pairs of numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_exclude_pairs(
    detector: Option<&mut NearmissDetector>,
    a: u32,
    b: u32,
    pairs: *const u32,
    count: usize,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let bodies = [own.body(a)?, own.body(b)?];
        // SAFETY: the caller's promise.
        let pairs = unsafe { items(pairs.cast::<[u32; 2]>(), count, "pairs") }?;
        own.detector.exclude_pairs(bodies, pairs)
    })
}
