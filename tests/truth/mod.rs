//! Questions with exact answers, for the tests and for `examples/accuracy.rs`, which prints how each solver does.
#![allow(dead_code, reason = "each binary uses a part")]

pub mod built;
pub mod frames;
pub mod motions;
pub mod queries;
