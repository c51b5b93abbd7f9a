//! The constants of volumes and balls around bodies that turn.

use super::{U32, U64};

/// Growth of a triangle's volume in a scene with bodies that turn: `2^-37` of the largest
/// coordinate of the triangle and of its pivot. A pair of features that stays undecided is within
/// half a tolerance, and none is below 64 times `256u` of the pair's reach
/// ([`TURNING_PLACE`](super::turning::TURNING_PLACE)): the distance of two pivots and of both
/// features from theirs. Each side's part of that is at most `3 sqrt 3` of its largest coordinate,
/// so its part of half the tolerance is `2^-37.6`. Ratio.
pub const SWELL: f64 = 65536.0 * U64;
/// Factor that makes a computed swell at least the true one, behind its roundings in f64 and the
/// one to f32: `1 + 4u` of f32. Ratio.
pub const SWELL_UP: f64 = 1.0 + 4.0 * U32 as f64;
/// Slack of the advancement of balls, relative to their reach, their speed and each step: `2^-30`.
/// Lengths, sums and turns err by less than `100u`. Ratio.
pub const BALL: f64 = 8_388_608.0 * U64;
