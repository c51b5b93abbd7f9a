//! Caveats: limits that affected an answer or its cost.

use crate::scene::BodyId;
use crate::words::counted;
use std::fmt;

/// Limit that affected an answer or its cost. No contact of the straight motion is missed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(tag = "reason", rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Caveat {
    /// Pairs that come nearer than the tolerance, with neither contact nor separation proven.
    /// Earliest queries report [`Caveat::EarliestUndecided`] instead.
    Undecided {
        /// Number of pairs.
        pairs: u64,
    },
    /// The earliest time is that of an undecided pair, and no contact begins then. An earliest
    /// query does not test pairs that begin later, so it cannot count them.
    EarliestUndecided,
    /// Pairs that reached [`with_max_iterations`](crate::Continuous::with_max_iterations). They are
    /// listed, and their times may be far too early. An earliest query does not count them.
    Iterations {
        /// Number of pairs.
        pairs: u64,
    },
    /// Listed pairs so large that rounding in the solver's precision exceeds the tolerance. A
    /// larger tolerance applies to them: 64 roundings of their extent. A tolerance of 0 means
    /// exactly that bound, and never gives this caveat.
    ToleranceBelowPrecision {
        /// Number of pairs; `None` if pairs are not listed.
        pairs: Option<u64>,
    },
    /// Listed pairs of a near query that may exceed its distance, by rounding alone.
    DistanceBelowPrecision {
        /// Number of pairs.
        pairs: u64,
    },
    /// A rigid body that turns by more than [`TURN_DEGREES`] between the two poses of a step. Its
    /// vertices move in straight lines, which leave their arcs. Contacts along the arcs may be
    /// missed or early, by up to the bulge.
    Turned {
        /// The body.
        body: BodyId,
        /// Angle, in degrees up to 180.
        degrees: f64,
        /// Largest distance of a vertex from its arc, in scene units: `r (1 - cos(angle / 2))`. `r`
        /// is the distance of the farthest vertex from the axis of the turn.
        bulge: f64,
    },
    /// The front cost more than it saved: it was dropped, or is not in use again yet. The answer is
    /// complete.
    FrontDropped,
}

/// Largest turn of a rigid body in a step without a caveat, in degrees. At this turn a vertex
/// leaves its arc by at most 3.5 % of its distance from the axis: `1 - cos(15 degrees)`.
pub const TURN_DEGREES: f64 = 30.0;

impl Caveat {
    /// Whether the caveat concerns the answer itself, not only its cost.
    pub fn affects_answer(&self) -> bool {
        !matches!(self, Caveat::FrontDropped)
    }

    /// Merges the same caveat of two parts of a frame; `None` if the caveats differ.
    pub(super) fn and(&self, other: Caveat) -> Option<Caveat> {
        Some(match (*self, other) {
            (Caveat::Undecided { pairs: a }, Caveat::Undecided { pairs: b }) => {
                Caveat::Undecided { pairs: a + b }
            }
            (Caveat::Iterations { pairs: a }, Caveat::Iterations { pairs: b }) => {
                Caveat::Iterations { pairs: a + b }
            }
            (Caveat::ToleranceBelowPrecision { pairs: a }, Caveat::ToleranceBelowPrecision { pairs: b }) => {
                Caveat::ToleranceBelowPrecision { pairs: a.zip(b).map(|(a, b)| a + b) }
            }
            (Caveat::DistanceBelowPrecision { pairs: a }, Caveat::DistanceBelowPrecision { pairs: b }) => {
                Caveat::DistanceBelowPrecision { pairs: a + b }
            }
            (Caveat::EarliestUndecided, Caveat::EarliestUndecided) => Caveat::EarliestUndecided,
            (Caveat::FrontDropped, Caveat::FrontDropped) => Caveat::FrontDropped,
            (Caveat::Turned { body: a, .. }, Caveat::Turned { body: b, .. }) if a == b => other,
            _ => return None,
        })
    }
}

impl fmt::Display for Caveat {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Caveat::Undecided { pairs } => {
                let pairs = counted(*pairs, "pair", "pairs");
                write!(f, "{pairs} nearer than the tolerance, with neither contact nor separation proven")
            }
            Caveat::EarliestUndecided => {
                write!(f, "the earliest time is that of an undecided pair")
            }
            Caveat::Iterations { pairs } => {
                let pairs = counted(*pairs, "pair", "pairs");
                write!(
                    f,
                    "{pairs} whose iterations ended, with times that may be too early; raise their number"
                )
            }
            Caveat::ToleranceBelowPrecision { pairs } => {
                let pairs = pairs.map_or("some pairs".to_owned(), |n| counted(n, "pair", "pairs"));
                write!(f, "{pairs} too large for the tolerance in the solver's precision")
            }
            Caveat::DistanceBelowPrecision { pairs } => {
                let pairs = counted(*pairs, "pair", "pairs");
                write!(f, "{pairs} listed, within the distance or by a rounding of doubles beyond it")
            }
            Caveat::Turned { body, degrees, bulge } => {
                write!(
                    f,
                    "body {body} turns by {degrees:.1} degrees; its vertices move in straight lines, up to {bulge:e} off their arcs; \
                     divide the step"
                )
            }
            Caveat::FrontDropped => {
                write!(f, "the front cost more than it saved and was dropped; the answer is complete")
            }
        }
    }
}
