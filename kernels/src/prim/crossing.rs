//! Whether two triangles cross, by signs of determinants alone.
//!
//! Two triangles *cross* if their insides share a point and one plane does not hold both. The
//! inside of a segment is the segment without its ends. They still cross after every small enough
//! displacement of the corners; a touch ends after some arbitrarily small one.
//!
//! # The law
//!
//! Let both have area. They cross if and only if the plane of each has corners of the other
//! strictly on both sides, and the two chords overlap in more than a point. The chords are on the
//! common line of both planes. A chord has its ends on the edges from one corner, the *lone* one,
//! which is strictly on one side: the other two corners are strictly on the other side or on the
//! plane.
//!
//! Let `a` be the lone corner of `p`, `b` the far corner of the edge with the end `i`, and `d`,
//! `e`, `j` those of `q`. Then `b = a + s (i - a)` and `e = d + r (j - d)` with `s, r >= 1`. So
//! `orient(a, b, d, e) = s r orient(a, i, d, j)`, which is `i - j` along the line times a number
//! whose sign `a` and `d` determine. The four signs of both ends of `p` about both ends of `q` are
//! therefore the order of the ends, up to a common sign. Chords overlap in more than a point if and
//! only if one sign is above 0 and one below. They share a point unless all are above or all below.
//!
//! Let `p` have no area. It crosses `q` if the plane of `q` has corners of `p` strictly on both
//! sides, and the line from one to the other passes all edges of `q` strictly on one side.

use super::signs::Signs;
use crate::math::{Real, Vec3};

/// The points of a triangle on a plane that does not hold it: a corner, an edge, or a chord.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chord {
    /// A corner strictly on one side of the plane.
    pub lone: usize,
    /// For each end of the chord a corner: the edge from the lone corner to it has the end. If this
    /// corner is on the plane, it is the end. The ends of a chord that is a point are equal.
    pub far: [usize; 2],
    /// Whether corners are strictly on both sides.
    pub is_through: bool,
}

impl Chord {
    /// Of a triangle whose corners have these sides. `None` if all are strictly on one side, or all
    /// on the plane.
    pub fn of(side: [i32; 3]) -> Option<Chord> {
        let is_through = side.contains(&1) && side.contains(&-1);
        let is_far = |lone: usize, k: usize| side[lone] != 0 && side[lone] * side[k] <= 0;
        let mut touching = None;
        for lone in 0..3 {
            let (b, c) = ((lone + 1) % 3, (lone + 2) % 3);
            match (is_far(lone, b), is_far(lone, c)) {
                (true, true) => return Some(Chord { lone, far: [b, c], is_through }),
                (true, false) => touching = Some(Chord { lone, far: [b, b], is_through }),
                (false, true) => touching = Some(Chord { lone, far: [c, c], is_through }),
                (false, false) => {}
            }
        }
        touching
    }
}

/// Whether the closed triangles `p` and `q` cross; `None` only if a needed sign is. It does not
/// depend on the order of corners and triangles.
pub fn crosses<R: Real, S: Signs<R>>(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3]) -> Option<bool> {
    let p_of_q = S::sides(q, p);
    let q_of_p = S::sides(p, q);
    if never_through(p_of_q) && never_through(q_of_p) {
        return Some(false);
    }
    let (p_side, q_side) = (known(p_of_q)?, known(q_of_p)?);
    match (Chord::of(p_side), Chord::of(q_side)) {
        (Some(of_p), Some(of_q)) if of_p.is_through && of_q.is_through => {
            overlap::<R, S>((p, of_p), (q, of_q))
        }
        // No corner of q is off a plane of p: so p has no area.
        (Some(of_p), None) if of_p.is_through && q_side == [0; 3] => stabs::<R, S>(p, of_p, q),
        (None, Some(of_q)) if of_q.is_through && p_side == [0; 3] => stabs::<R, S>(q, of_q, p),
        _ => Some(false),
    }
}

/// The orders of the ends of two chords along the line of both, up to a common sign: `orders[i][j]`
/// of end `i` of `p` and end `j` of `q`. 0 if they are one point.
pub fn order<R: Real, S: Signs<R>>(
    (p, of_p): (&[Vec3<R>; 3], Chord),
    (q, of_q): (&[Vec3<R>; 3], Chord),
    i: usize,
    j: usize,
) -> Option<i32> {
    S::orient3d(p[of_p.lone], p[of_p.far[i]], q[of_q.lone], q[of_q.far[j]])
}

/// Whether two chords overlap in more than a point.
fn overlap<R: Real, S: Signs<R>>(p: (&[Vec3<R>; 3], Chord), q: (&[Vec3<R>; 3], Chord)) -> Option<bool> {
    let (mut above, mut below, mut unsure) = (false, false, false);
    for k in 0..4 {
        match order::<R, S>(p, q, k / 2, k % 2) {
            Some(sign) => {
                above |= sign > 0;
                below |= sign < 0;
            }
            None => unsure = true,
        }
        if above && below {
            return Some(true);
        }
    }
    if unsure { None } else { Some(false) }
}

/// Whether the line through both sides of a segment passes the inside of `q`, which has area.
fn stabs<R: Real, S: Signs<R>>(segment: &[Vec3<R>; 3], of: Chord, q: &[Vec3<R>; 3]) -> Option<bool> {
    let side = |k: usize| S::orient3d(segment[of.lone], segment[of.far[0]], q[k], q[(k + 1) % 3]);
    let first = side(0)?;
    Some(first != 0 && side(1)? == first && side(2)? == first)
}

/// Whether three corners are certainly not strictly on both sides.
fn never_through(side: [Option<i32>; 3]) -> bool {
    let all = |is: fn(i32) -> bool| side.iter().all(|sign| sign.is_some_and(is));
    all(|sign| sign >= 0) || all(|sign| sign <= 0)
}

fn known(side: [Option<i32>; 3]) -> Option<[i32; 3]> {
    Some([side[0]?, side[1]?, side[2]?])
}
