//! Every tolerance and rounding constant of the kernels: name, unit, reason. None lives anywhere else.

/// Unit roundoff of f32: half the distance from 1 to the next f32. Relative.
pub const U32: f32 = f32::EPSILON / 2.0;
/// Unit roundoff of f64: half the distance from 1 to the next f64. Relative.
pub const U64: f64 = f64::EPSILON / 2.0;

/// The constants that depend on the precision. Below, `u` is the unit roundoff and `eta` half the smallest
/// subnormal: the most that one product can lose to underflow (sums and differences lose nothing to it).
pub trait Tolerance: Sized {
    /// Error of a computed 3x3 determinant of differences, relative to its computed permanent: `8u(1 + 32u)`.
    /// Eight roundings lie on the longest path (two inputs, product, difference, input, product, two sums);
    /// `32u` covers the roundings of the permanent and of the bound itself. Derived in `prim::orient`.
    const ORIENT3D_RELATIVE: Self;
    /// Added to each 2x2 permanent of the 3x3 test: `2 eta / ORIENT3D_RELATIVE`, rounded up to a power of two.
    /// Charges the underflow of the inner products, which the third difference multiplies. Length squared.
    const ORIENT3D_INNER_UNDERFLOW: Self;
    /// Error of a computed 2x2 determinant of differences, relative to its permanent: `4u(1 + 16u)`.
    const ORIENT2D_RELATIVE: Self;
    /// Underflow of the outermost products, of the permanent and of the bound: `8 eta`. Length cubed (or squared).
    const ORIENT_OUTER_UNDERFLOW: Self;
    /// Error of the outer Bernstein coefficients of the coplanarity cubic: `12u`, relative to the permanent of the
    /// largest components. `gamma_8` is the longest path (as in `ORIENT3D_RELATIVE`, on maxima); differences of
    /// doubles that are then rounded to f32 add less than one, the permanent and the bound the rest.
    const CUBIC_OUTER: Self;
    /// The same for three times the inner coefficients: each sums three such determinants, two of them with one
    /// more rounding, so `gamma_10` of three permanents is `30u`; `40u` with the permanent and the bound.
    const CUBIC_INNER: Self;
    /// Error of a value of the cubic within [0, 1]: a convex mixture of the above (`10u`) and six roundings of the
    /// evaluation, `20u` in all. A value below it counts as zero if the features are then also close.
    const CUBIC_VALUE: Self;
    /// Underflow of the cubic's products, whose factors are at most about `CUBIC_SCALE`. Length cubed.
    const CUBIC_UNDERFLOW: Self;
    /// How far outside of the face, or from the other edge, a vertex or edge may be at a root of the cubic and
    /// still count, relative to the largest difference of positions. A root is known to about `u` divided by
    /// the slope of the cubic, so sharper would miss contacts on shared edges; wider makes false alarms.
    const CUBIC_INSIDE: Self;
    /// A squared sine below which two directions count as parallel: there the direction of their cross product has
    /// no correct digit (its relative error is `u` over the sine). `16 u^2`, ratio.
    const PARALLEL: Self;
}

impl Tolerance for f32 {
    const ORIENT3D_RELATIVE: f32 = 8.0 * U32 * (1.0 + 32.0 * U32);
    const ORIENT3D_INNER_UNDERFLOW: f32 = f32::from_bits(1 << 22);
    const ORIENT2D_RELATIVE: f32 = 4.0 * U32 * (1.0 + 16.0 * U32);
    const ORIENT_OUTER_UNDERFLOW: f32 = f32::from_bits(4);
    const CUBIC_OUTER: f32 = 12.0 * U32;
    const CUBIC_INNER: f32 = 40.0 * U32;
    const CUBIC_VALUE: f32 = 20.0 * U32;
    const CUBIC_UNDERFLOW: f32 = f32::from_bits(7 << 23);
    const CUBIC_INSIDE: f32 = 64.0 * U32;
    const PARALLEL: f32 = 16.0 * U32 * U32;
}

impl Tolerance for f64 {
    const ORIENT3D_RELATIVE: f64 = 8.0 * U64 * (1.0 + 32.0 * U64);
    const ORIENT3D_INNER_UNDERFLOW: f64 = f64::from_bits(1 << 51);
    const ORIENT2D_RELATIVE: f64 = 4.0 * U64 * (1.0 + 16.0 * U64);
    const ORIENT_OUTER_UNDERFLOW: f64 = f64::from_bits(4);
    const CUBIC_OUTER: f64 = 12.0 * U64;
    const CUBIC_INNER: f64 = 40.0 * U64;
    const CUBIC_VALUE: f64 = 20.0 * U64;
    const CUBIC_UNDERFLOW: f64 = f64::from_bits(63 << 52);
    const CUBIC_INSIDE: f64 = 131072.0 * U64;
    const PARALLEL: f64 = 16.0 * U64 * U64;
}

/// Largest extent, and one over the smallest, that a continuous test computes with as it is; outside, differences
/// are first scaled by a power of two (exactly). `2^20`, so that cubes stay clear of both ends of f32. Length.
pub const CUBIC_SCALE: f64 = 1048576.0;
