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

/// Largest finite bound of a moving box; a bound beyond it becomes infinite. `2^125`, so that differences of bounds and
/// sums of two such differences stay finite. Length.
pub const MOVING_LIMIT: f32 = f32::from_bits((125 + 127) << 23);
/// What the computed ends of an interval of time may be wrong by, both together, and the sum that compares them: each
/// end is a quotient in [0, 1] of two roundings on either side, `5u`; `16u` in all. Fraction of the step.
pub const MOVING_TIME: f32 = 16.0 * U32;

/// How far `a_i . a_j` may be from 1 (i = j) or 0 in an oriented box, as computed: `12u`. The computation errs by less
/// than `4u`, so the true value is within `16u`, on which the next three rest. Ratio.
pub const BOX_AXES: f32 = 12.0 * U32;
/// Error of `a . (p - c)`, relative to the sum of `|a_d| |p_d - c_d|`: four roundings (difference, product, two sums),
/// and one more for those of the bound itself. Ratio.
pub const BOX_POINT: f32 = 5.0 * U32;
/// Error of `a . (p - b) - a . (c - b)`, relative to the sum of `|a_d| (|p_d - b_d| + |c_d - b_d|)`: four roundings of each
/// product of vectors (five, the first tiny, for f64), one of their difference, and those of the bound itself: below
/// `6u`. `8u`. Ratio.
pub const BOX_GROUP: f32 = 8.0 * U32;
/// Underflow of the products in one such half extent: at most sixteen of half the smallest subnormal each, twice
/// over. Length.
pub const BOX_GROUP_UNDERFLOW: f32 = f32::from_bits(16);
/// What a child's slabs may reach beyond `sum g_k |a_i . b_k|` of its half extents g, relative to their sum: `28u` for
/// axes not quite orthonormal and `7u` for roundings; and the error of `a_i . (c' - c)`, `5u` of the distance of the
/// centres. `64u` covers both. Ratio.
pub const BOX_CHILD: f32 = 64.0 * U32;
/// What a separating axis of two oriented boxes may be wrong by, relative to the sum of all six half extents: `132u`
/// for axes not quite orthonormal and `20u` for roundings, derived in `bv::obb`; `256u`. Ratio.
pub const BOX_APART: f32 = 256.0 * U32;
/// Every factor that a sum of positive terms needs so as not to fall below them: `1 + 4u` for up to three roundings.
pub const BOX_UP: f32 = 1.0 + 4.0 * U32;
/// Underflow of the products in one half extent: at most eleven of half the smallest subnormal each. Length.
pub const BOX_UNDERFLOW: f32 = f32::from_bits(8);
/// Underflow of the products in one separating axis, half of it for either box. Length.
pub const BOX_APART_UNDERFLOW: f32 = f32::from_bits(16);
/// Largest coordinate of the centre and largest half extent of an oriented box; what is larger gets the box of
/// everything. `2^120`, so that sums of products with components of axes stay finite. Length.
pub const BOX_LIMIT: f32 = f32::from_bits((120 + 127) << 23);
/// An entry off the diagonal of a covariance below which it counts as zero; the largest entry is 1. `2^-40`: far
/// below the roundings of the others, and its square does not underflow. Ratio.
pub const COVARIANCE_ZERO: f32 = f32::from_bits((127 - 40) << 23);
