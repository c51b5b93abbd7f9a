//! Motions and frames with exact answers.

pub mod built;
pub mod frames;
pub mod queries;
