//! Motions that other libraries got wrong, as reported in public, with exact answers.

pub use nearmiss::extremes::MOTIONS;
