//! Certified continuous tests of features of bodies that turn: vertex against face and edge against
//! edge.
//!
//! A point is at `pivot(t) + Exp(t phi) r(t)`. The pivot and `r` move linearly, and `phi` is a
//! rotation vector of at most a full turn. A rigid body has one `r` for both ends. A body that
//! deforms, or does not turn, has `phi = 0`; its pivot is that of the other side, and `r` is a vertex
//! less the pivot, rounded once. So all kinds of bodies are one code.
//!
//! | file | step |
//! | --- | --- |
//! | [`motion`] | control vectors in the frame that turns with the second side |
//! | [`place`] | the pair at a time; directions in which it is apart |
//! | [`rates`] | bounds of their derivatives |
//! | [`slice`](mod@slice) | planes that prove that a slice of time is clear |
//! | [`window`] | the part of a slice in which boxes meet |
//! | [`certificate`] | a certain contact |
//! | [`ahead`] | a look for a certain contact of features that are near |
//! | [`common`] | the common case: one contact, and planes before it |
//! | [`solve`] | the walk through the step, turn by turn; `next` has the slices behind the first |
//! | [`chords`] | before all that: features of two triangles that planes keep apart, of small turns |
//! | [`apart`] | the same of all turns |
//! | [`heights`] | planes of both |
//!
//! # Claims
//!
//! For the true motion, in real numbers; touching is contact; distances are Euclidean. True is
//! every motion whose `r` are within `16u` of their length of the given ones, and whose rotation
//! vectors are within [`TURN_BETWEEN`](crate::math::tolerance::turning::TURN_BETWEEN). That covers
//! vertices that were placed by a quaternion, and rotation vectors between quaternions.
//! 1. Separated: nowhere in `[0, end]` are the features within the separation.
//! 2. Otherwise the first contact, if there is one, is not before `toi`.
//! 3. Contact: there is a contact, and the first is in `[toi, toi_upper]`.
//! 4. Undecided, unless exhausted: at `toi` the features are within the separation and half the
//!    tolerance. Exhausted are also edges almost parallel whose slices become too short, at
//!    tolerances near the least. A tolerance below 64 errors of a control vector counts as 64 errors
//!    (`TURNING_PLACE`, `TURNING_FINEST`).
//!
//! The proof:
//! - (a) Between two times a control vector is within the deviation and the error of a curve
//!   through its computed places ([`rates`], [`slice`](mod@slice)). So a slice with a plane has no
//!   contact.
//! - (b) Slices share their ends as the same doubles, and each begins where all before is clear.
//!   The part of a slice outside of its window is clear. So 1 and 2.
//! - (c) A certificate is a change of sign of the true volume, and holds at every moment at which
//!   the true control vectors are in one plane ([`certificate`]). With a separation it is a
//!   computed point of the hull within the separation, less its error. So 3.
//!
//! Only `+ - * /`, the square root and selects are used, so every machine gives the same bits.
//! Comparisons are written so that NaN proves nothing.

#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "comparisons that NaN fails")]
#![allow(clippy::needless_range_loop, reason = "loops by index unroll: nothing goes to memory on the GPU")]

pub mod ahead;
pub mod apart;
pub mod certificate;
pub mod chords;
pub mod common;
pub mod heights;
pub mod motion;
mod next;
pub mod place;
pub mod rates;
pub mod slice;
pub mod solve;
pub mod window;

pub use certificate::Contact;
pub use motion::Motion;
pub use place::Place;
pub use solve::{Walk, length};

use super::inclusion::{Params, Verdict};
use crate::math::Vec3;

/// A feature of one body: a point is at `pivot(t) + Exp(t phi) r(t)`. A vertex is `points[0]`, an
/// edge the first two, a face all three.
#[derive(Clone, Copy, Debug)]
pub struct Side {
    /// The body's turn, in world axes, at most 2 pi; zero for a body that does not turn.
    pub phi: Vec3<f64>,
    /// The pivot, at the start and at the end of the step. It moves linearly.
    pub pivot: [Vec3<f64>; 2],
    /// `r` of each point, at the start and at the end.
    pub points: [[Vec3<f64>; 2]; 3],
}

/// Whether, and when, a vertex first comes within the separation of a closed face.
#[inline]
pub fn vertex_face(v: &Side, f: &Side, p: &Params) -> Verdict {
    Motion::<3>::new(v, f).verdict(p)
}

/// Whether, and when, two closed edges first come within the separation. The same bits for both
/// orders of the sides.
#[inline]
pub fn edge_edge(a: &Side, b: &Side, p: &Params) -> Verdict {
    Motion::of_edges(a, b).verdict(p)
}

impl Motion<4> {
    /// The motion of two edges; the same for both orders.
    #[inline(always)]
    pub fn of_edges(a: &Side, b: &Side) -> Self {
        let (a, b) = if a.precedes(b) { (b, a) } else { (a, b) };
        Motion::new(a, b)
    }
}

impl Side {
    /// An order of two edges that depends on their numbers only: the one that turns less is first.
    #[inline]
    fn precedes(&self, other: &Side) -> bool {
        let (mut less, mut more) = (false, false);
        let mut compare = |a: f64, b: f64| {
            less |= !more & (a < b);
            more |= !less & (a > b);
        };
        compare(self.phi.dot(self.phi), other.phi.dot(other.phi));
        for k in 0..3 {
            compare(self.phi[k], other.phi[k]);
            for i in 0..2 {
                compare(self.pivot[i][k], other.pivot[i][k]);
                compare(self.points[0][i][k], other.points[0][i][k]);
                compare(self.points[1][i][k], other.points[1][i][k]);
            }
        }
        less
    }
}
