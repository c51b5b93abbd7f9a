//! What is wrong with an answer beside the exact one, by kinds of queries.

pub mod distance;
pub mod near;
