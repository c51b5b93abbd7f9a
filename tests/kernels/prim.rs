//! The narrow tests against exact answers, by kinds of truth: known answers, the rational oracle, public data, laws.

#![allow(
    clippy::unwrap_used,
    clippy::type_complexity,
    reason = "tests: a failure should stop, a case is a row"
)]

mod adjacent;
mod cases;
mod crossing;
mod cubic;
mod cubic_bounds;
mod discrete;
mod inclusion;
mod inclusion_bounds;
mod inclusion_extremes;
mod inclusion_public;
mod public;
mod signs;

use support::triangles::{ORDERS, anywhere, corners, on_grid, random, seen};
