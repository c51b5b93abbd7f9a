//! Certified continuous tests by inclusion: vertex against face and edge against edge.
//!
//! The difference of two features is a function `F(t, u, v)`, affine in each parameter. So its
//! values on a box of parameters are in the hull of its eight corners. A box has no contact if its
//! corners are on one side of a plane through the origin ([`bound`]: beyond all rounding). Other
//! boxes are cut along their own directions to the part that may have a contact. They are split,
//! nearest first, until they are smaller than the tolerance ([`search`]). Before that the hull of
//! the whole motion rejects most pairs ([`filter`]).
//!
//! `docs/internals/isolation.md` explains how this follows [`isolate`](super::isolate).
//!
//! # Claims
//!
//! For positions as given, moving on straight lines, in real numbers; touching is contact;
//! distances are Euclidean.
//! 1. [`Answer::Separated`]: nowhere in `[0, end]` are the features within the separation.
//! 2. Otherwise the first contact, if there is one, is not before `toi`.
//! 3. [`Answer::Contact`]: there is a contact, and the first is in `[toi, toi_upper]`.
//! 4. [`Answer::Undecided`] and [`Answer::Contact`], unless [`Verdict::exhausted`]: at `toi` the
//!    features are within `separation + sqrt(3) (3 tolerance + 2 E)`. `E` is at most `20 u` of the
//!    largest difference of positions. A tolerance below `64 u` of that counts as `64 u`.
//!
//! The proof:
//! - (a) A computed corner errs by at most `E` per axis (`tolerance.rs`, INCLUSION_*). A computed
//!   inner product with a direction errs by at most the `bound` of [`search`]. At a contact the
//!   product is at most the separation times the direction's length. So a box beyond the bound has
//!   no contact.
//! - (b) Along one parameter, the others fixed, the product is linear. Its ends are in the ranges
//!   of the two opposite faces. A cut removes only a part in which that line is beyond the bound,
//!   and is rounded outward.
//! - (c) Together the halves, and the rest after a cut, cover everything that may have a contact.
//! - (d) Every box ends rejected, accepted, or skipped. The last two charge its start to `toi`. So
//!   does each box left when the iterations or the stack end. The box with the first contact is never
//!   rejected.
//! - (e) A box is skipped uncharged only if it starts after a certified contact.
//! - (f) Take three linearly independent directions, each for one parameter. Suppose their products
//!   have opposite strict signs, beyond the bound, on the two faces of that parameter. Then `F` has
//!   a zero in the box (Poincaré and Miranda).
//!
//! Only `+ - * /`, the square root and conversions are used, so every machine gives the same bits.
//! Comparisons are written so that NaN rejects nothing.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "comparisons that NaN fails")]
#![allow(clippy::needless_range_loop, reason = "loops by index unroll: nothing goes to memory on the GPU")]

pub mod bound;
pub mod cell;
pub mod direction;
pub mod filter;
pub mod local;
pub mod search;
mod verdict;

pub use cell::{Cell, Grid};
pub use local::{Edges, Face, Local};
pub use search::Search;
pub use verdict::{Answer, Params, Verdict};

use super::cubic::Moving;
use crate::math::Real;
use core::mem::MaybeUninit;

/// The largest number of boxes on the stack: depth first, each halving leaves one. Ranges that are
/// cut need few halvings. If more would be needed (motion along one line, to 1e-9), the answer
/// stays certain, but may be early.
pub const STACK: usize = 64;

/// Whether, and when, a vertex first comes within the separation of a closed face; positions in
/// `R`, computed in `S`. About 130 operations if the first filter rejects, 400 if the second does,
/// else 1,200 a box.
#[inline]
pub fn vf_certified<R: Real, S: Grid>(v: Moving<R>, f: [Moving<R>; 3], p: &Params) -> Verdict {
    certified(Face::<S>::new(v, f, p), p)
}

/// Whether, and when, two closed edges first come within the separation; as [`vf_certified`].
#[inline]
pub fn ee_certified<R: Real, S: Grid>(ea: [Moving<R>; 2], eb: [Moving<R>; 2], p: &Params) -> Verdict {
    certified(Edges::<S>::new(ea, eb, p), p)
}

#[inline]
fn certified<S: Grid, const N: usize>(m: Local<S, N>, p: &Params) -> Verdict {
    settled(m, p).0
}

/// The verdict, and whether it is final: more precision would not improve it for this query.
#[inline]
fn settled<S: Grid, const N: usize>(m: Local<S, N>, p: &Params) -> (Verdict, bool) {
    let mut stack = [const { MaybeUninit::uninit() }; STACK];
    let mut search = match Search::begin(m, p, &mut stack) {
        Ok(search) => search,
        Err(settled) => return settled,
    };
    loop {
        if let Some(settled) = search.step(p) {
            return settled;
        }
    }
}

/// [`vf_certified`], and whether the verdict is final: separated, or a contact whose time is within
/// the tolerance.
#[inline]
pub fn vf_settled<R: Real, S: Grid>(v: Moving<R>, f: [Moving<R>; 3], p: &Params) -> (Verdict, bool) {
    settled(Face::<S>::new(v, f, p), p)
}

/// [`ee_certified`], and whether the verdict is final.
#[inline]
pub fn ee_settled<R: Real, S: Grid>(ea: [Moving<R>; 2], eb: [Moving<R>; 2], p: &Params) -> (Verdict, bool) {
    settled(Edges::<S>::new(ea, eb, p), p)
}

/// The first of two passes over vertex and face, in f32: its verdict if final. `None`: use
/// [`vf_certified`] in f64.
#[inline]
pub fn vf_first<R: Real>(v: Moving<R>, f: [Moving<R>; 3], p: &Params) -> Option<Verdict> {
    let (verdict, settled) = vf_settled::<R, f32>(v, f, p);
    settled.then_some(verdict)
}

/// The first of two passes over two edges, in f32; as [`vf_first`].
#[inline]
pub fn ee_first<R: Real>(ea: [Moving<R>; 2], eb: [Moving<R>; 2], p: &Params) -> Option<Verdict> {
    let (verdict, settled) = ee_settled::<R, f32>(ea, eb, p);
    settled.then_some(verdict)
}
