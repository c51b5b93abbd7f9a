//! The constants of turning bodies.

use super::{U32, U64};

/// Error of a computed `sinc` or cosine of a half angle in [0, pi]: `4u`. Reduction: `u` of the
/// distance to pi/2 or pi. Series: `u` for the last difference, `0.6u` for the others and the
/// remainder. A product, and a division by at least pi/4. Derived in `math::angle`. Absolute.
pub const ANGLE: f64 = 4.0 * U64;
/// Error of a point that is turned by at most `w`, up to 2 pi, relative to its distance from the
/// pivot: `64u`.
///
/// - Half the angle errs by `3.5u` of itself: three products, two sums, a root and the time. That
///   moves the point by at most seven times as much.
/// - Sine and cosine of the half angle err by `2.5u` each. So `w S` errs by `10u` and `w^2 C` by
///   `17u` with their products; both together, as components of a vector, by `20u`.
/// - A vector product errs by `2.5u`. One of at most `w S`, 1, and two of at most `w^2 C`, 2, are
///   `12.5u`.
/// - Products and sums of the three vectors: `6u`.
pub const TURN: f64 = 64.0 * U64;
/// Error of the rotation vector between two unit quaternions: `32u`. Its vector part errs by
/// `5.2u` and its scalar part by `4u`, times at most pi; the factor of it errs by `4u`, times pi.
/// Absolute, in radians.
pub const TURN_BETWEEN: f64 = 32.0 * U64;
/// The largest turn: a full one and a millionth of it, for one that was rounded up. Radians.
pub const TURN_MOST: f64 = core::f64::consts::TAU * (1.0 + 1.0 / 1048576.0);
/// Factor of a sum of positive products that makes it at least the true one: `1 + 16u`. Ratio.
pub const TURN_UP: f64 = 1.0 + 16.0 * U64;
/// Underflow of the square of an angle, an eighth of it: below `2^-1021`. Radians squared.
pub const TURN_FAINT: f64 = f64::from_bits(2 << 52);
/// Error of a control vector of two turning features: `256u` of the pair's reach, the sum of the
/// largest distances of the pivots from one another and of the features from their pivots.
///
/// - Computed, of the point of the first side: [`TURN`] twice, `3u` for the mixture of its ends,
///   `3u` for sums: `134u`.
/// - Computed, of its pivot: [`TURN`] once, `5u` for a difference and a mixture. The point of the
///   second side: `4u`.
/// - Of what is given: `16u` for a placed point, [`TURN_BETWEEN`] for each rotation vector: `80u`
///   at most.
///
/// Together `214u` at most. Relative.
pub const TURNING_PLACE: f64 = 256.0 * U64;
/// How far a control vector may be from a curve through its computed places, without the curve's
/// own deviation: [`TURNING_PLACE`] times this. A parabola through three places has 1.25 of their
/// errors, of which `134u` are those of computing, and `15u` of the middle's time. The given
/// numbers add `80u`, and products with a direction `48u`. In all `315u`. Ratio.
pub const TURNING_CURVE: f64 = 2.0;
/// Factor of a bound of a derivative: at most twenty roundings of positive terms, `1 + 64u`.
/// Ratio.
pub const TURNING_UP: f64 = 1.0 + 64.0 * U64;
/// Error of a computed triple product of two edges and a control vector, relative to the product of
/// their lengths: `16u`. A difference each (`u`), a vector product (`3u`), a product (`4u`).
pub const TURNING_VOLUME: f64 = 16.0 * U64;
/// Part of a vector's length that counts as across an axis in addition: `16u`. Two turns have a
/// common axis if the computed sine between them is at most `4u`, so `7u` at most. The axis errs by
/// `u`, and a vector product by `2.5u`. Ratio.
pub const TURNING_AXIS: f64 = 16.0 * U64;
/// A direction shorter than this proves nothing: its square might lose digits. `2^-400`. Length to
/// the third power.
pub const TURNING_FAINT: f64 = f64::from_bits((1023 - 400) << 52);
/// The least tolerance, in errors of a control vector: 64. Ratio.
pub const TURNING_FINEST: f64 = 64.0;
/// The shortest slice: nine roundings of a time near 1. Fraction of the step.
pub const TURNING_SHORTEST: f64 = 9.0 * U64;
/// The part of a pair's reach below which the direction of its nearest point is put across a
/// border: `2^-20`. Its roundings, `2^-50` of the reach, are an angle; times the reach they are less
/// than a larger distance. Ratio; a cost, proves nothing.
pub const TURNING_NEAR: f64 = 1.0 / 1048576.0;
/// The rounding of a nearest point that is put across a border: `2^-46` of a pair's reach. Ratio; a
/// cost, proves nothing.
pub const TURNING_ACROSS: f64 = 128.0 * U64;
/// Error of the difference of two heights in f32, relative to the longest difference of a corner from
/// the origin and to the direction's length: `16u` of f32, of which `14u` are needed. Derived in
/// `prim::turning::heights`. Ratio.
pub const TURNING_SINGLE: f32 = 16.0 * U32;
/// Factor of what such a height must exceed, for the roundings of that: `1 + 16u` of f32. Ratio.
pub const TURNING_SINGLE_UP: f32 = 1.0 + 16.0 * U32;
/// A direction of f32 shorter than this proves nothing: 2^-60. Its square is a normal number.
/// Length to the second power, in units of the reach.
pub const TURNING_SINGLE_FAINT: f32 = f32::from_bits((127 - 60) << 23);
