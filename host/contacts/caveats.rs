//! What an answer, or its making, owes to a limit: said aloud, each by its reason.

use crate::scene::BodyId;
use crate::words::counted;
use std::fmt;

/// A way in which a frame came to less than all that was asked. Nothing is ever missed for any of them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(tag = "reason", rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Caveat {
    /// Pairs nearer than the tolerance that are neither certain to meet nor certain to stay apart.
    /// Not of an earliest query: see [`Caveat::EarliestUndecided`].
    Undecided {
        /// How many.
        pairs: u64,
    },
    /// The earliest time is that of a pair that is neither certain to meet nor certain to stay
    /// apart, and no contact begins then. An earliest query does not test pairs that begin later,
    /// so it cannot count them.
    EarliestUndecided,
    /// Pairs whose budget of boxes ended ([`Certified::budget`](crate::query::Certified::budget)): listed, but their times may be far too
    /// early. Not counted by an earliest query.
    Iterations {
        /// How many.
        pairs: u64,
    },
    /// Listed pairs so large that the solver's precision cannot tell as little as the tolerance: there a larger one counts,
    /// 64 roundings of their extent. A tolerance of 0 asks for no more than that, and is never below.
    ToleranceBelowPrecision {
        /// How many; `None` where pairs are not listed.
        pairs: Option<u64>,
    },
    /// Listed pairs of a near query that rounding cannot tell from such that are farther apart than the distance.
    DistanceBelowPrecision {
        /// How many.
        pairs: u64,
    },
    /// A rigid body that turns by more than [`TURN_DEGREES`] between the two poses of a step. Its
    /// vertices move in straight lines, which leave their arcs: contacts of the turning body itself
    /// may be missed or early by as much as the bulge.
    Turned {
        /// The body.
        body: BodyId,
        /// The angle, in degrees up to 180.
        degrees: f64,
        /// Largest distance of a vertex from its arc, a length: `r (1 - cos(angle / 2))`, with r
        /// the distance of the farthest vertex from the axis of the turn.
        bulge: f64,
    },
    /// The front did not pay: dropped, or not yet taken up again. The answer is whole.
    FrontDropped,
}

/// Largest turn of a rigid body in a step of which an answer says nothing, in degrees. There a
/// vertex is at most 3.5 % of its distance from the axis off its arc: `1 - cos(15 degrees)`.
pub const TURN_DEGREES: f64 = 30.0;

impl Caveat {
    /// Whether the answer itself is less than was asked, not only the time that it took.
    pub fn affects_answer(&self) -> bool {
        !matches!(self, Caveat::FrontDropped)
    }

    /// The same reason of two parts of a frame; `None` of two reasons.
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
                write!(f, "{pairs} nearer than the tolerance, neither certain to meet nor to stay apart")
            }
            Caveat::EarliestUndecided => {
                write!(f, "the earliest time is that of a pair neither certain to meet nor to stay apart")
            }
            Caveat::Iterations { pairs } => {
                let pairs = counted(*pairs, "pair", "pairs");
                write!(f, "{pairs} whose boxes ended, with times that may be too early; raise their number")
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
            Caveat::FrontDropped => write!(f, "the front did not pay and was dropped; the answer is whole"),
        }
    }
}
