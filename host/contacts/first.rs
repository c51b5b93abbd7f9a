//! The first contact of a step.

/// First contact of a step: the answer to an earliest query.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FirstContact {
    /// Time, in \[0, 1\] of the step. A certified solver's time is never later than the first
    /// contact.
    pub toi: f64,
    /// Whether the pair at that time is undecided and no contact begins then.
    pub is_undecided: bool,
}
