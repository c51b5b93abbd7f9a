//! The exact answer about two moving features: against answers that need no computing, public data, linear programs and
//! laws.
#![allow(clippy::unwrap_used, reason = "tests")]

mod known;
mod laws;
mod sets;

use nearmiss_lab::{Case, Features};

const TRIANGLE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// A vertex that moves, and a face at rest.
fn falling(from: [f64; 3], to: [f64; 3], face: [[f64; 3]; 3]) -> Case {
    let [a, b, c] = face;
    Case { features: Features::VertexFace, positions_t0: [from, a, b, c], positions_t1: [to, a, b, c] }
}

fn case(features: Features, positions_t0: [[f64; 3]; 4], positions_t1: [[f64; 3]; 4]) -> Case {
    Case { features, positions_t0, positions_t1 }
}
