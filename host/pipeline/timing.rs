//! Time by stage.

/// Milliseconds of each stage of a frame, on the device's own clock. `construct` is that of the last build.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Stages {
    /// Positions to level-ordered tree, all bodies.
    pub construct: f64,
    /// Volumes of the leaves; 0 by treelets, whose one launch makes all volumes.
    pub fit: f64,
    /// All other volumes; by treelets all volumes.
    pub refit: f64,
    /// Candidates, without balancing.
    pub traverse: f64,
    /// Evening out the queues of work between the rounds of the traversal, where that is a step of its own.
    pub balance: f64,
    /// Contacts.
    pub narrow: f64,
    /// From positions to contacts, runs that were repeated for want of room included, construction not.
    pub total: f64,
}
