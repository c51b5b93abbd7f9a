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
        /// Contacts in canonical order, on a GPU; on a CPU the host orders them.
        Order = "order",
    }
}

/// Milliseconds of each stage of a frame, by the device's clock, and of the whole call. `construct`
/// is that of the last build. On a GPU `fit`, `refit`, `traverse` and `narrow` are 0 unless
/// [stages are timed](crate::research::DetectorExt::time_stages).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Stages {
    /// Placing of the bodies that moved, with their uploads; 0 if none moved, or the frame is
    /// queried again.
    pub place: f64,
    /// Positions to level-ordered tree, all bodies.
    pub construct: f64,
    /// Volumes of the leaves; 0 with treelets, whose one launch computes all volumes.
    pub fit: f64,
    /// All other volumes; with treelets all volumes.
    pub refit: f64,
    /// Candidates, without balancing.
    pub traverse: f64,
    /// Balancing of the work queues between rounds of the traversal, if it is a step of its own.
    pub balance: f64,
    /// Contacts.
    pub narrow: f64,
    /// Contacts in canonical order, on a GPU. Zero if the host orders them, or if there is nothing
    /// to order.
    pub order: f64,
    /// From positions to contacts, with reruns after a list grew. Placing, construction and
    /// ordering are not included.
    pub total: f64,
    /// Host time until a GPU has the whole frame, without placing. Zero if the host computes the
    /// frame.
    pub launch: f64,
    /// Time of a call of [`Detector::step`](crate::Detector::step) or
    /// [`Detector::query`](crate::Detector::query), by the host's clock: placing, `total`,
    /// ordering, launching, and reading the contacts.
    pub wall: f64,
}

impl Stages {
    /// Applies `of` to the getter of each stage: for means and medians over many frames.
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

    /// These times, with the stages of other frames, whose marks make them longer.
    #[must_use]
    pub fn with_stages(self, of: &Stages) -> Stages {
        let Stages { fit, refit, traverse, balance, narrow, .. } = *of;
        Stages { fit, refit, traverse, balance, narrow, ..self }
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
