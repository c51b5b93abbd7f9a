//! Questions with exact answers.
#![allow(dead_code, reason = "each binary uses a part")]

pub mod frames;
pub mod queries;
