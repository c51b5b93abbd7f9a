//! Judges of answers by the exact ones, by kinds of queries.

pub mod distance;
pub mod near;
