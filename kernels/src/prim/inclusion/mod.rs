//! Continuous tests that are certain: vertex against face and edge against edge, by inclusion.
//!
//! The difference of two features is a function `F(t, u, v)`, affine in each parameter, so its
//! values on a box of parameters lie in the hull of its eight corners. A box whose corners lie on
//! one side of a plane through the origin, beyond rounding ([`bound`]), holds no contact. Boxes are
//! cut to what may hold one along their own directions, and split, nearest first, until they are
//! smaller than the tolerance ([`search`]). Before that most pairs are rejected by the hull of the
//! whole motion ([`filter`]).
//!
//! # What is proven
//!
//! For positions as given, moving on straight lines, in real numbers; touching is contact;
//! distances Euclidean.
//! 1. [`Answer::Separated`]: nowhere in `[0, end]` are the features within the separation.
//! 2. Otherwise the first contact, if there is one, is not before `toi`.
//! 3. [`Answer::Contact`]: there is a contact, and the first lies in `[toi, toi_hi]`.
//! 4. [`Answer::Unresolved`] and [`Answer::Contact`] unless [`Verdict::exhausted`]: at `toi` the
//!    features are within `separation + sqrt(3) (3 tolerance + 2 E)`, where `E` is at most `20 u`
//!    of the largest difference of positions, and a tolerance below `64 u` of that counts as
//!    `64 u`.
//!
//! The proof. (a) A computed corner errs by at most `E` per axis (`tolerance.rs`, INCLUSION_*), a
//! computed inner product with a direction by at most the `bound` of [`search`]; at a contact the
//! product is at most the separation times the direction's length. So a box beyond the bound has no
//! contact. (b) Along one parameter, the others fixed, the product is linear, with ends in the
//! ranges of the two opposite faces; a cut removes only where that line is beyond the bound, and is
//! rounded outward. (c) The halves and what a cut leaves cover what may hold a contact. (d) Every
//! box ends rejected, accepted, or skipped, and the last two charge its start to `toi`; so does
//! each box left when the budget or the stack ends. The box with the first contact is never
//! rejected. (e) A box is skipped uncharged only if it starts after a certified contact. (f) If
//! three directions, linearly independent, have products of opposite strict signs, beyond the
//! bound, on the two faces of one parameter each, `F` has a zero in the box (Poincaré and Miranda).
//!
//! Only `+ - * /`, the square root and conversions are used, so that every machine gives the same
//! bits. Comparisons are written so that NaN rejects nothing.
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

/// The largest number of boxes that wait: depth first, each halving leaves one. Ranges that are cut
/// need few halvings; where more would wait (motion along one line, asked to 1e-9) the answer stays
/// certain, but may be early.
pub const STACK: usize = 64;

/// Whether, and when, a vertex first comes within the separation of a closed face; positions in
/// `R`, computed in `S`. About 130 operations where the first filter rejects, 400 where the second
/// does, 1,200 a box beyond.
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

/// The verdict, and whether more precision would tell nothing that was asked.
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

/// [`vf_certified`], and whether more precision would tell nothing that was asked: separated, or a
/// contact whose time is known as well as the tolerance demands.
#[inline]
pub fn vf_settled<R: Real, S: Grid>(v: Moving<R>, f: [Moving<R>; 3], p: &Params) -> (Verdict, bool) {
    settled(Face::<S>::new(v, f, p), p)
}

/// [`ee_certified`], and whether more precision would tell nothing that was asked.
#[inline]
pub fn ee_settled<R: Real, S: Grid>(ea: [Moving<R>; 2], eb: [Moving<R>; 2], p: &Params) -> (Verdict, bool) {
    settled(Edges::<S>::new(ea, eb, p), p)
}

/// The first of two passes over vertex and face, in f32: what it is sure of, or `None`: ask
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
