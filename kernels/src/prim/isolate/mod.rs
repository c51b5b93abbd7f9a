//! Certified continuous tests in closed form: vertex against face and edge against edge. They
//! isolate the times at which the features can meet.
//!
//! `docs/internals/isolation.md` explains it, with the cubic, a picture and the certificate.
//!
//! The difference of two features is the hull of three or four vectors that move linearly
//! ([`Pair`]). The features meet if it contains the origin. Then the four points are coplanar: a
//! root of a cubic. So the step is cut at its roots.
//!
//! | file | step |
//! | --- | --- |
//! | [`pair`] | control vectors; the window in which the boxes overlap |
//! | [`cubic`] | the cubic; signs of Bernstein coefficients prove that there is no root |
//! | [`find`] | cuts the window, finds suspect times |
//! | [`suspect`] | the certificate around a suspect time |
//! | [`ladder`] | rungs, from f32 to f64, for pairs that signs leave uncertain |
//! | [`certified`] | all rungs, for one pair |
//! | [`separation`] | rungs of a minimum separation |
//! | [`advance`], [`hull`], [`nearest`] | supporting planes, for a separation |
//! | [`turning`], [`normal`] | planes that turn with the features |
//! | [`thick`] | features whose radii differ |
//!
//! The answers and their proofs are those of [`crate::prim::inclusion`]. No pair that meets is
//! separated, and no time is late. A contact is one. An undecided pair comes within the tolerance.
//! All bounds are in [`crate::math::tolerance`] (`ISOLATE_*`, `ADVANCE_*`).
//!
//! Only `+ - * /`, the square root and conversions are used, so every machine gives the same bits.
//! Comparisons are written so that NaN decides nothing.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "comparisons that NaN fails")]
#![allow(clippy::needless_range_loop, reason = "loops by index unroll: nothing goes to memory on the GPU")]

pub mod advance;
pub mod certified;
pub mod cubic;
pub mod find;
pub mod hull;
pub mod ladder;
pub mod nearest;
pub mod normal;
pub mod pair;
pub mod separation;
pub mod suspect;
pub mod thick;
pub mod turning;

pub use certified::{Rungs, ee_certified, vf_certified};
pub use pair::{Edges, Face, Pair};
