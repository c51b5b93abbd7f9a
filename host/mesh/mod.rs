//! Meshes, checked at the door.

/// What is wrong with an input (to be written).
#[derive(Debug, thiserror::Error)]
pub enum Problem {}
