//! Time by stage.

use crate::query::named;

named! {
    /// A stage of the pipeline.
    pub enum Stage {
        /// Positions to level-ordered tree.
        Construct = "construct",
        /// Volumes of the leaves.
        Fit = "fit",
        /// All other volumes.
        Refit = "refit",
        /// Candidates, with balancing.
        Traverse = "traverse",
        /// Contacts.
        Narrow = "narrow",
        /// Contacts in canonical order, on a GPU; a CPU has none: the host orders them.
        Order = "order",
    }
}

/// Milliseconds of each stage of a frame, on the device's own clock, and of the caller's wait. `construct` is that of the
/// last build.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Stages {
    /// Vertices of the bodies that were moved, with what was uploaded for them; 0 where none were, and where the frame was asked
    /// again.
    pub place: f64,
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
    /// Contacts in canonical order, on a GPU. Zero where the host orders them, and where there is nothing to order.
    pub order: f64,
    /// From positions to contacts, runs that were repeated for want of room included; placing, construction and ordering not.
    pub total: f64,
    /// The host's own time until a GPU had the frame to do, the placing of what was moved not included. Zero where the host does it.
    pub launch: f64,
    /// The wait of a caller of [`Detector::step`](crate::Detector::step) or [`Detector::query`](crate::Detector::query),
    /// on the clock of the host: placing, `total`, ordering, launching, and reading the
    /// contacts.
    pub wall: f64,
}

impl Stages {
    /// Each stage put through `of`, which is given the stage's getter: for means and medians over many frames.
    pub fn each(of: impl Fn(fn(&Stages) -> f64) -> f64) -> Stages {
        Stages {
            place: of(|s| s.place),
            construct: of(|s| s.construct),
            fit: of(|s| s.fit),
            refit: of(|s| s.refit),
            traverse: of(|s| s.traverse),
            balance: of(|s| s.balance),
            narrow: of(|s| s.narrow),
            order: of(|s| s.order),
            total: of(|s| s.total),
            launch: of(|s| s.launch),
            wall: of(|s| s.wall),
        }
    }

    /// The milliseconds of one stage.
    pub fn of_mut(&mut self, stage: Stage) -> &mut f64 {
        match stage {
            Stage::Construct => &mut self.construct,
            Stage::Fit => &mut self.fit,
            Stage::Refit => &mut self.refit,
            Stage::Traverse => &mut self.traverse,
            Stage::Narrow => &mut self.narrow,
            Stage::Order => &mut self.order,
        }
    }
}
