//! Differences that keep meshes from being frames of one body.

use super::{Mesh, Problem};

/// The first difference that keeps two meshes from being frames of one body.
pub(crate) fn difference(t0: &Mesh, t1: &Mesh) -> Option<Problem> {
    let first = || t0.name.clone();
    if t0.vertex_count() != t1.vertex_count() {
        return Some(Problem::FrameVertices { first: first(), t0: t0.vertex_count(), t1: t1.vertex_count() });
    }
    if t0.faces == t1.faces {
        let differ = |what, is_different: bool| {
            is_different.then(|| Problem::FrameElements { first: t0.name.clone(), what })
        };
        let edges = differ("edges", t0.loose.edges != t1.loose.edges);
        return edges.or_else(|| differ("points", t0.loose.points != t1.loose.points));
    }
    let [count_t0, count_t1] = [t0, t1].map(Mesh::face_count);
    if count_t0 != count_t1 {
        return Some(Problem::FrameFaces { first: first(), t0: count_t0, t1: count_t1 });
    }
    let face =
        t0.faces.iter().zip(&t1.faces).position(|(corners_t0, corners_t1)| corners_t0 != corners_t1)?;
    let [corners_t0, corners_t1] = [t0, t1].map(|mesh| mesh.faces[face].to_vec());
    Some(Problem::FrameFace { first: first(), face, t0: corners_t0, t1: corners_t1 })
}
