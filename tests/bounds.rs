//! Bounds from both sides: what a proof allows for is measured against exact arithmetic on inputs that a search makes as
//! hostile as it can. The error must stay within the bound, and come to a twentieth of it: a bound that no test would
//! miss is a bound that nobody has read. Where it cannot come so near, the test says why and measures what is counted.
//!
//! Each constant of `tolerance.rs` that a proof rests on has a test of its name; [`list`] holds the others and why.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "NaN must fail")]

#[path = "bounds/apart.rs"]
mod apart;
#[path = "bounds/boxes.rs"]
mod boxes;
#[path = "bounds/cubic.rs"]
mod cubic;
#[path = "bounds/exact.rs"]
mod exact;
#[path = "bounds/hunt.rs"]
mod hunt;
#[path = "bounds/inclusion.rs"]
mod inclusion;
#[path = "bounds/isolate.rs"]
mod isolate;
#[path = "bounds/list.rs"]
mod list;
#[path = "bounds/merged.rs"]
mod merged;
#[path = "bounds/moving.rs"]
mod moving;
#[path = "bounds/near.rs"]
mod near;
#[path = "bounds/orient.rs"]
mod orient;
