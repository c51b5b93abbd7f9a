//! Continuous tests that are certain, in closed form: vertex against face and edge against edge, by
//! isolating the times at which they can meet.
//!
//! The difference of two features is the hull of three or four vectors that move linearly
//! ([`Pair`]); they meet where it holds the origin. Then the four points lie in one plane: a root
//! of a cubic. So the step is cut at its roots; that nothing meets between them is proven by the
//! signs of Bernstein coefficients ([`cubic`]), and around each root one certificate tells whether
//! the hull holds the origin or misses it ([`suspect`], [`find`]). What signs cannot tell goes up a
//! [`ladder`]. A separation is asked by supporting planes ([`advance`]), in rungs of its own
//! ([`separation`]).
//!
//! What is proven is what [`crate::prim::inclusion`] says of its answers, whose words these are:
//! nothing that meets is called separated, no time is late, a contact is one, and what is listed as
//! unresolved comes within the tolerance. All bounds are in [`crate::math::tolerance`]
//! (`ISOLATE_*`, `ADVANCE_*`).
//!
//! Only `+ - * /`, the square root and conversions are used, so that every machine gives the same
//! bits. Comparisons are written so that NaN decides nothing.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "comparisons that NaN fails")]
#![allow(clippy::needless_range_loop, reason = "loops by index unroll: nothing goes to memory on the GPU")]

pub mod advance;
pub mod cubic;
pub mod find;
pub mod ladder;
pub mod nearest;
pub mod normal;
pub mod pair;
pub mod separation;
pub mod suspect;
pub mod turning;

pub use ladder::{Rungs, ee_certified, vf_certified};
pub use pair::{Edges, Face, Pair};
