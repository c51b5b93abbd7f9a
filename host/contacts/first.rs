//! The first contact of a step.

/// The first contact of a step: the answer to an earliest query.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FirstContact {
    /// Its time, in \[0, 1\] of the step; by a certified solver never later than the first contact.
    pub toi: f64,
    /// Whether the pair at that time is neither certain to meet nor certain to stay apart, and no contact begins then.
    pub is_undecided: bool,
}
