//! The single cases of the catalogue: two features, one extreme, and the required answer.

mod edges;
mod face;
mod limits;
mod reported;
mod scales;

pub use reported::{MOTIONS, Reported, reported_motions};

use super::question::{Expect, Question};
use crate::case::Features;

/// Four points.
type Four = [[f64; 3]; 4];
/// An id, the extreme, the first feature's start and end, and the required answer.
type Row<P> = (&'static str, &'static str, P, P, Expect);

/// Returns all cases.
pub fn questions() -> Vec<Question> {
    let mut all = face::questions();
    all.extend(edges::questions());
    all.extend(limits::questions());
    all.extend(scales::questions());
    all.extend(reported_motions());
    all
}

/// A face of side 8 in the plane z = 0.
const FACE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0]];
/// An edge of 4 along x.
const EDGE: [[f64; 3]; 2] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0]];

fn with(p: [f64; 3], f: [[f64; 3]; 3]) -> Four {
    [p, f[0], f[1], f[2]]
}

fn and(a: [[f64; 3]; 2], b: [[f64; 3]; 2]) -> Four {
    [a[0], a[1], b[0], b[1]]
}

/// Makes a case of a vertex and a face.
fn vf(name: (&'static str, &'static str), t0: Four, t1: Four, expect: Expect) -> Question {
    Question::new(name, Features::VertexFace, [t0, t1], expect)
}

/// Makes a case of two edges.
fn ee(name: (&'static str, &'static str), t0: Four, t1: Four, expect: Expect) -> Question {
    Question::new(name, Features::EdgeEdge, [t0, t1], expect)
}
