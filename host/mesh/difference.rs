//! Meshes that are no frames of one.

use super::{Mesh, Problem};

/// What keeps two meshes from being frames of one; polygons are the same if their corners are, however they were cut.
pub(crate) fn difference(t0: &Mesh, t1: &Mesh) -> Option<Problem> {
    let first = || t0.name.clone();
    if t0.vertex_count() != t1.vertex_count() {
        return Some(Problem::FrameVertices { first: first(), t0: t0.vertex_count(), t1: t1.vertex_count() });
    }
    if t0.faces == t1.faces {
        return None;
    }
    let [count_t0, count_t1] = [t0, t1].map(Mesh::file_face_count);
    if count_t0 != count_t1 {
        return Some(Problem::FrameFaces { first: first(), t0: count_t0, t1: count_t1 });
    }
    let (mut a, mut b) = (Vec::new(), Vec::new());
    let face = (0..count_t0).find(|&face| {
        t0.polygons.corners(face, &t0.faces, &mut a);
        t1.polygons.corners(face, &t1.faces, &mut b);
        a != b
    })?;
    Some(Problem::FrameFace { first: first(), face, t0: a, t1: b })
}
