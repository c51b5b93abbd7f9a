//! Bounds from both sides: the allowance of a proof is measured against exact arithmetic, on the
//! most hostile inputs that a search finds. The error must stay within the bound, and reach a
//! twentieth of it: a bound that no test would miss is a bound without a reader. If it cannot come
//! so near, the test says why and measures what is counted.
//!
//! Each constant of `tolerance.rs` that a proof rests on has a test of its name; [`list`] holds the others and why.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "NaN must fail")]

mod apart;
mod boxes;
mod cubic;
mod exact;
mod farther;
mod hunt;
mod inclusion;
mod isolate;
mod list;
mod merged;
mod motion;
mod moving;
mod near;
mod orient;
mod relation;
mod turning;
