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
