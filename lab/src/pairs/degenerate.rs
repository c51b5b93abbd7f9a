//! Motions with one kind of degeneracy in degrees, in integers, so that the answer is known. Half
//! of them meet at t = 1/2; the others come as near as one unit.

use super::built::{Built, Motion, Point, case};
use crate::case::Features;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// Kind of degeneracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Degeneracy {
    /// Two edges at an angle of 10^-k.
    Angle,
    /// A vertex and a face 10^k times as long as wide.
    Aspect,
    /// A vertex and a face, with displacements of 10^k edges.
    Displacement,
}

impl Degeneracy {
    /// All kinds.
    pub const ALL: [Degeneracy; 3] = [Degeneracy::Angle, Degeneracy::Aspect, Degeneracy::Displacement];

    /// Returns the kind's name.
    pub fn name(self) -> &'static str {
        match self {
            Degeneracy::Angle => "edge angle 10^-k",
            Degeneracy::Aspect => "triangle aspect 10^k",
            Degeneracy::Displacement => "displacement over edge 10^k",
        }
    }
}

/// Largest degree: integers stay below 2^53.
pub const MOST: u32 = 13;

/// Returns `n` motions of degree `k`, at most [`MOST`].
///
/// # Panics
/// If `k` is larger.
pub fn degenerate(seed: u64, kind: Degeneracy, k: u32, n: usize) -> Vec<Built> {
    assert!(k <= MOST, "degree must be at most {MOST}, got {k}");
    let mut r = SmallRng::seed_from_u64(seed);
    let one = |i: usize| {
        let meets = i.is_multiple_of(2);
        let (motion, features) = motion(&mut r, kind, 10i64.pow(k), meets);
        Built {
            name: format!("{}, k = {k}", kind.name()),
            case: case(&motion, features),
            toi: meets.then_some(0.5),
        }
    };
    (0..n).map(one).collect()
}

/// Returns a first feature that passes through the other from above, or stops one unit above it.
fn motion(r: &mut SmallRng, kind: Degeneracy, long: i64, meets: bool) -> (Motion, Features) {
    let short = r.random_range(1..4);
    let height = match kind {
        Degeneracy::Displacement => 8 * long,
        _ => r.random_range(2..64),
    };
    let slide = |r: &mut SmallRng| [r.random_range(-3..4), r.random_range(-3..4), 0];
    let (features, points): (Features, [Point; 4]) = match kind {
        Degeneracy::Angle => {
            // They cross at the origin, at different places along each edge.
            let (p, q) = (r.random_range(1..4), r.random_range(1..4));
            let b = [[-4 * long * q, -short * q, 0], [4 * long * p, short * p, 0]];
            (Features::EdgeEdge, [[-3 * long * p, 0, 0], [5 * long * q, 0, 0], b[0], b[1]])
        }
        _ => {
            // The vertex is above the origin, inside the face.
            let long = if kind == Degeneracy::Aspect { 4 * long } else { 4 };
            let face = [[-long, -short, 0], [long, -short, 0], [short, 2 * short, 0]];
            (Features::VertexFace, [[0; 3], face[0], face[1], face[2]])
        }
    };
    let moving = if features == Features::VertexFace { 1 } else { 2 };
    // Both features slide along their plane together; their shape stays.
    let by = slide(r);
    let end = |sign: i64| {
        let z = if sign < 0 || meets { -sign * height } else { 1 };
        let mut at = points.map(|p| std::array::from_fn(|c| p[c] + sign * by[c]));
        at[..moving].iter_mut().for_each(|p: &mut Point| p[2] = z);
        at
    };
    let mut both: Motion = [end(-1), end(1)];
    // Out of the planes of the axes.
    let shear: [i64; 2] = std::array::from_fn(|_| r.random_range(-2..3));
    both.iter_mut().flatten().for_each(|p| {
        let [x, y, z] = *p;
        *p = [x + shear[0] * z, y + shear[1] * z, z + shear[1] * (x + shear[0] * z)];
    });
    (both, features)
}
