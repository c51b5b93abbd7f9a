//! The constants of turning bodies.

use super::U64;

/// Error of a computed `sinc` or cosine of a half angle in [0, pi]: `4u`. Reduction: `u` of the
/// distance to pi/2 or pi. Series: `u` for the last difference, `0.6u` for the others, the rest for
/// the remainder. A product and a division. Derived in `math::angle`. Absolute.
pub const ANGLE: f64 = 4.0 * U64;
/// Error of a point that is turned: `40u` of its distance from the pivot. With the angle `w`, at
/// most 2 pi: `w S` errs by `6u` and `w^2 C` by `12u`. Two vector products have `2 sqrt 2 u` each,
/// of at most `w S` and twice of `w^2 C`, at most 2. The angle is half a square root of three
/// products, `2u` of it. Sums have two roundings. Relative to the distance.
pub const TURN: f64 = 40.0 * U64;
/// Error of the rotation vector between two unit quaternions: `32u`. Its vector part errs by
/// `5.2u` and its scalar part by `4u`, times at most pi; the factor of it errs by `4u`, times pi.
/// Absolute, in radians.
pub const TURN_BETWEEN: f64 = 32.0 * U64;
/// Factor of a sum of positive products that makes it at least the true one: `1 + 16u`. Ratio.
pub const TURN_UP: f64 = 1.0 + 16.0 * U64;
/// Underflow of the square of an angle, an eighth of it: below `2^-1021`. Radians squared.
pub const TURN_FAINT: f64 = f64::from_bits(2 << 52);
/// Error of a control vector of two turning features: `192u` of the pair's reach, the sum of the
/// largest distances of the pivots from one another and of the features from their pivots.
///
/// - Of the point of the first side: [`TURN`] twice, `3u` for the mixture of its ends, `2u` for
///   sums.
/// - Of its pivot: [`TURN`] once, `5u` for a difference and a mixture. Of the point of the second
///   side: `4u`.
/// - Of what is given: `16u` for a placed point of each side, [`TURN_BETWEEN`] for each rotation
///   vector. So a point on the first side has `165u` and all else less.
///
/// The rest is room. Relative.
pub const TURNING_PLACE: f64 = 192.0 * U64;
/// How far a control vector may be from a curve through its computed places, but for the curve's
/// own deviation: [`TURNING_PLACE`] times this. A parabola through three places has 1.25 of their
/// errors, of which `85u` are those of computing, and `15u` of the middle's time; `80u` are those
/// of what is given. Products with a direction add `48u`. In all `265u`. Ratio.
pub const TURNING_CURVE: f64 = 2.0;
/// Factor of a bound of a derivative: at most twenty roundings of positive terms, `1 + 64u`.
/// Ratio.
pub const TURNING_UP: f64 = 1.0 + 64.0 * U64;
/// Error of a computed triple product of two edges and a control vector, relative to the product of
/// their lengths: `16u`. A difference each (`u`), a vector product (`3u`), a product (`4u`).
pub const TURNING_VOLUME: f64 = 16.0 * U64;
/// Part of a direction's length that counts as across an axis that is known to `4u`: `32u`. Ratio.
pub const TURNING_AXIS: f64 = 32.0 * U64;
/// A direction shorter than this proves nothing: its square might lose digits. `2^-400`. Length to
/// the third power.
pub const TURNING_FAINT: f64 = f64::from_bits((1023 - 400) << 52);
/// The least tolerance, in errors of a control vector: 64. Ratio.
pub const TURNING_FINEST: f64 = 64.0;
/// The shortest slice: nine roundings of a time near 1. Fraction of the step.
pub const TURNING_SHORTEST: f64 = 9.0 * U64;
