//! Every tolerance and rounding constant of the kernels: name, unit, reason. None lives anywhere
//! else.

use core::ops::RangeInclusive;

pub mod swell;
pub mod turning;

/// Unit roundoff of f32: half the distance from 1 to the next f32. Relative.
pub const U32: f32 = f32::EPSILON / 2.0;
/// Unit roundoff of f64: half the distance from 1 to the next f64. Relative.
pub const U64: f64 = f64::EPSILON / 2.0;

/// The constants that depend on the precision. Below, `u` is the unit roundoff and `eta` half the
/// smallest subnormal: the most that one product can lose to underflow (sums and differences lose
/// nothing to it).
pub trait Tolerance: Sized {
    /// Error of a computed 3x3 determinant of differences, relative to its computed permanent:
    /// `8u(1 + 32u)`. The longest path has eight roundings (two inputs, product, difference, input,
    /// product, two sums). `32u` covers the roundings of the permanent and of the bound itself.
    /// Derived in `prim::orient`.
    const ORIENT3D_RELATIVE: Self;
    /// Added to each 2x2 permanent of the 3x3 test: `2 eta / ORIENT3D_RELATIVE`, rounded up to a
    /// power of two. Charges the underflow of the inner products, which the third difference
    /// multiplies. Length squared.
    const ORIENT3D_INNER_UNDERFLOW: Self;
    /// Error of a computed 2x2 determinant of differences, relative to its permanent:
    /// `4u(1 + 16u)`.
    const ORIENT2D_RELATIVE: Self;
    /// Underflow of the outermost products, of the permanent and of the bound: `8 eta`. Length
    /// cubed (or squared).
    const ORIENT_OUTER_UNDERFLOW: Self;
    /// Error of the outer Bernstein coefficients of the coplanarity cubic: `12u`, relative to the
    /// permanent of the largest components. `gamma_8` is the longest path (as in
    /// `ORIENT3D_RELATIVE`, on maxima). Differences of doubles that are then rounded to f32 add
    /// less than one. The permanent and the bound add the rest.
    const CUBIC_OUTER: Self;
    /// The same for three times the inner coefficients. Each sums three such determinants, two of
    /// them with one more rounding. So `gamma_10` of three permanents is `30u`; `40u` with the
    /// permanent and the bound.
    const CUBIC_INNER: Self;
    /// Error of a value of the cubic within [0, 1]: a convex mixture of the above (`10u`) and six
    /// roundings of the evaluation, `20u` in all. A value below it counts as zero if the features
    /// are then also close.
    const CUBIC_VALUE: Self;
    /// Underflow in an inner coefficient of the cubic, whose factors are at most `CUBIC_SCALE`. In
    /// f32 there are 54 inputs (three of each of 18 products of three) that were rounded from f64.
    /// Each loses half the smallest number times `CUBIC_SCALE` squared, in all below 2^-104.
    /// Products lose less. So: 2^-100. In f64 there are 18 inner products, times `CUBIC_SCALE`
    /// each, in all below 2^-1050. So: 2^-960. Length cubed.
    const CUBIC_UNDERFLOW: Self;
    /// Allowance at a root of the cubic: for a vertex outside of the face, or edges apart. Relative
    /// to the largest difference of positions. A root is known to about `u` divided by the slope of
    /// the cubic. A sharper value would miss contacts on shared edges; a wider one makes false
    /// alarms.
    const CUBIC_INSIDE: Self;
    /// A squared sine below which two directions count as parallel: there the direction of their
    /// cross product has no correct digit (its relative error is `u` over the sine). `16 u^2`,
    /// ratio.
    const PARALLEL: Self;
    /// Error of a computed corner of a vertex/face image: `6.5u`. Relative to the largest control
    /// component of its axis, and to the sum of the weights' magnitudes. That sum is 1 within the
    /// face. Three roundings give the point between the two times (difference, product, sum). Three
    /// more give the mixture (product, two sums). The half covers `u^2` and the roundings of the
    /// bound.
    const INCLUSION_FACE: Self;
    /// The same for edge/edge: `7.5u`. Three roundings to the point between the times, two for each
    /// of two mixtures.
    const INCLUSION_EDGE: Self;
    /// Error of a difference of positions and of the sum that it is compared with: `4u`, relative
    /// to the largest of the axis. One rounding, or one and a 2^-29th of f64 differences rounded to
    /// f32; the sum with a separation adds two.
    const INCLUSION_INPUT: Self;
    /// Error of a direction's inner product with control vectors: `6u`. One rounding of the input,
    /// three of the product.
    const INCLUSION_HULL: Self;
    /// Error of a direction's inner product with computed corners: `4u`, relative to the sum of
    /// magnitudes. The longest path has three roundings.
    const INCLUSION_SHADOW: Self;
    /// The smallest tolerance: `64u` of the largest control component, eight errors of a corner. A
    /// box around a contact that was cut twice its bound is smaller. Below it, boxes around a
    /// contact could be neither excluded nor accepted. Their number would grow with the inverse
    /// square of the tolerance.
    const INCLUSION_FINEST: Self;
    /// Sums of few positive terms are below their computed value times this: `1 + 8u`. Ratio.
    const INCLUSION_UP: Self;
    /// A computed quotient of differences times this is below the exact one: `1 - 8u`. Two
    /// differences, the quotient, this product and the one with the width of a cell round. Ratio.
    const INCLUSION_DOWN: Self;
    /// Underflow, of the conversion of inputs and of all products: 2^-120 in f32, 2^-960 in f64.
    /// The loss is at most a hundred times half the smallest subnormal (2^-143, 2^-1068). Lengths,
    /// if the largest is about one.
    const INCLUSION_UNDERFLOW: Self;
    /// A determinant of three rows with components of magnitude at most 1 that exceeds this is not
    /// zero: `48u`. Its error is five roundings of a permanent of at most six, `30u`.
    const INCLUSION_REGULAR: Self;
    /// A direction whose largest component is below this is not used: it could not be scaled to
    /// one. Length cubed.
    const INCLUSION_FAINT: Self;
    /// Widening of a pair's window of time at each end: `16u`. An end errs by at most `5u` and half
    /// a subnormal: two differences, their sum and a quotient. Fraction of the step.
    const ISOLATE_WINDOW: Self;
    /// Widening of a window in which roots are isolated: 2^-12 in f32, 2^-26 in f64. So a window of
    /// no width shows a change of signs, too. Fraction of the step; a cost, not part of a proof.
    const ISOLATE_MARGIN: Self;
    /// Error of a Bernstein coefficient of the coplanarity cubic over any part of the step: `40u`.
    /// Relative to the permanent of the largest components. An outer coefficient of the step errs
    /// by `8u` (two inputs, product, difference, input, product, two sums). An inner one errs by
    /// `12u`: one sum more, the sum of two determinants, the third and its product. Each of three
    /// mixtures adds `3u`: `21u`. The rest covers the permanent's own roundings.
    const ISOLATE_CUBIC: Self;
    /// Error of the differences of positions whose paths are swept: `4u`. One rounding, or one and
    /// a 2^-29th of f64 differences rounded to f32. A window compares two, and extents have two;
    /// the rest is for the bound's own roundings. Relative to the largest of the axis.
    const SWEPT_ROUNDED: Self;
    /// How far a component of a computed control vector may be from the exact one, relative to the
    /// largest: `6u`. One rounding of the input, three of the mixture, and two for the computed
    /// motion within the time around it.
    const ISOLATE_PLACE: Self;
    /// Roundings of `n . (x cross y)`, relative to six times the largest component of `n` and the
    /// square of that of `x`: `10u`. Five roundings of a sum of six products are `5u`; as much
    /// again for the bound's own.
    const ISOLATE_TURN: Self;
    /// Roundings of an inner product with a direction: `6u`, three of the product and those of the
    /// bound. Relative to the sum of the direction's components times the largest component of the
    /// other vector.
    const ISOLATE_SIDE: Self;
    /// Underflow in the closed form: 2^-120 in f32, 2^-960 in f64. The largest component of a pair
    /// is in [1, 2). So products of up to six factors lose at most a thousand times half the
    /// smallest subnormal (2^-140, 2^-1065).
    const ISOLATE_UNDERFLOW: Self;
    /// Error of a component of the computed nearest point of a hull, relative to the largest:
    /// `16u`. The corners err by `4u`; mixing them adds `6u` (`prim::isolate::nearest`). A product
    /// with a direction adds `7u`.
    const ADVANCE_POINT: Self;
    /// The least slack of a separation, relative to the extent: `64u`, four errors of a point.
    /// Ratio.
    const ADVANCE_FINEST: Self;
}

impl Tolerance for f32 {
    const ORIENT3D_RELATIVE: f32 = 8.0 * U32 * (1.0 + 32.0 * U32);
    const ORIENT3D_INNER_UNDERFLOW: f32 = f32::from_bits(1 << 22);
    const ORIENT2D_RELATIVE: f32 = 4.0 * U32 * (1.0 + 16.0 * U32);
    const ORIENT_OUTER_UNDERFLOW: f32 = f32::from_bits(4);
    const CUBIC_OUTER: f32 = 12.0 * U32;
    const CUBIC_INNER: f32 = 40.0 * U32;
    const CUBIC_VALUE: f32 = 20.0 * U32;
    const CUBIC_UNDERFLOW: f32 = f32::from_bits(27 << 23);
    const CUBIC_INSIDE: f32 = 64.0 * U32;
    const PARALLEL: f32 = 16.0 * U32 * U32;
    const INCLUSION_FACE: f32 = 6.5 * U32;
    const INCLUSION_EDGE: f32 = 7.5 * U32;
    const INCLUSION_INPUT: f32 = 4.0 * U32;
    const INCLUSION_HULL: f32 = 6.0 * U32;
    const INCLUSION_SHADOW: f32 = 4.0 * U32;
    const INCLUSION_FINEST: f32 = 64.0 * U32;
    const INCLUSION_UP: f32 = 1.0 + 8.0 * U32;
    const INCLUSION_DOWN: f32 = 1.0 - 8.0 * U32;
    const INCLUSION_UNDERFLOW: f32 = f32::from_bits(7 << 23);
    const INCLUSION_REGULAR: f32 = 48.0 * U32;
    const INCLUSION_FAINT: f32 = f32::from_bits(27 << 23);
    const ISOLATE_WINDOW: f32 = 16.0 * U32;
    const ISOLATE_MARGIN: f32 = 1.0 / 4096.0;
    const ISOLATE_CUBIC: f32 = 40.0 * U32;
    const SWEPT_ROUNDED: f32 = 4.0 * U32;
    const ISOLATE_PLACE: f32 = 6.0 * U32;
    const ISOLATE_TURN: f32 = 10.0 * U32;
    const ISOLATE_SIDE: f32 = 6.0 * U32;
    const ISOLATE_UNDERFLOW: f32 = f32::from_bits(7 << 23);
    const ADVANCE_POINT: f32 = 16.0 * U32;
    const ADVANCE_FINEST: f32 = 64.0 * U32;
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
    const INCLUSION_FACE: f64 = 6.5 * U64;
    const INCLUSION_EDGE: f64 = 7.5 * U64;
    const INCLUSION_INPUT: f64 = 4.0 * U64;
    const INCLUSION_HULL: f64 = 6.0 * U64;
    const INCLUSION_SHADOW: f64 = 4.0 * U64;
    const INCLUSION_FINEST: f64 = 64.0 * U64;
    const INCLUSION_UP: f64 = 1.0 + 8.0 * U64;
    const INCLUSION_DOWN: f64 = 1.0 - 8.0 * U64;
    const INCLUSION_UNDERFLOW: f64 = f64::from_bits(63 << 52);
    const INCLUSION_REGULAR: f64 = 48.0 * U64;
    const INCLUSION_FAINT: f64 = f64::from_bits(223 << 52);
    const ISOLATE_WINDOW: f64 = 16.0 * U64;
    const ISOLATE_MARGIN: f64 = 1.0 / 67108864.0;
    const ISOLATE_CUBIC: f64 = 40.0 * U64;
    const SWEPT_ROUNDED: f64 = 4.0 * U64;
    const ISOLATE_PLACE: f64 = 6.0 * U64;
    const ISOLATE_TURN: f64 = 10.0 * U64;
    const ISOLATE_SIDE: f64 = 6.0 * U64;
    const ISOLATE_UNDERFLOW: f64 = f64::from_bits(63 << 52);
    const ADVANCE_POINT: f64 = 16.0 * U64;
    const ADVANCE_FINEST: f64 = 64.0 * U64;
}

/// Largest size of a coordinate that f32 is computed with, 2^60: dot products of differences stay
/// finite, 3 (2^61)^2 < 2^124. Length.
pub const SINGLE_MOST: f64 = f64::from_bits((1023 + 60) << 52);

/// Error of the difference of two heights of corners in a direction: `7u` of f32, relative to the
/// sum of the direction's components times that of all differences. Four roundings of each height
/// (difference, product, two sums) and two of their difference; the seventh is room for the
/// roundings of the bound itself, 40 `u` of it. Derived in `prim::direction`. Ratio.
pub const DIRECTION: f32 = 7.0 * U32;

/// Largest extent, and one over the smallest, that a continuous test takes without scaling. Beyond
/// them differences are first scaled by a power of two, exactly. `2^20`, so that cubes stay clear
/// of both ends of f32. Length.
pub const CUBIC_SCALE: f64 = 1048576.0;

/// The least tolerance that decides what is listed, relative to a pair's extent: `256 u` of f64.
/// Advancement to half of it leaves `128u`, four times the two errors of a nearest point. Ratio.
pub const NEAR_FINEST: f64 = 256.0 * U64;
/// Growth of volumes for it, relative to the largest coordinate in them. A pair's extent is at most
/// the sum of both coordinates, so each side's part is [`NEAR_FINEST`]. Twice that, for the
/// roundings of f32. `2^-44`. Ratio.
pub const NEAR_GROWTH: f32 = f32::from_bits((127 - 44) << 23);

/// Excess of a computed distance of two features at rest over the true one: at most `192u` of f64.
/// Relative to the largest component of the differences between the features. Derived in
/// `prim::near`: `88.5u sqrt 3`, and those of the bound itself. Volumes that grow by
/// [`NEAR_GROWTH`] cover everything listed for it: such a component is at most twice the larger of
/// both coordinates. Ratio.
pub const DISTANCE_ERROR: f64 = 192.0 * U64;
/// By how much it may be below the true one: `32u`, for `15.5u sqrt 3`. Ratio.
pub const DISTANCE_CERTAIN: f64 = 32.0 * U64;
/// Every listed pair is within the requested distance plus this: `256u`, the sum of both and of
/// their roundings. Ratio.
pub const DISTANCE_LISTED: f64 = 256.0 * U64;
/// Points of thick features count as nearest if none are nearer by more than this: `512u`, for twice
/// [`DISTANCE_ERROR`] between a side's computed distance and the shortest one. Ratio.
pub const DISTANCE_TIED: f64 = 512.0 * U64;
/// By how much a parameter along a side may be wrong, over the length of the side: `64u` of the reach,
/// for `30u sqrt 3`. Ratio.
pub const DISTANCE_WEIGHT: f64 = 64.0 * U64;
/// A sum and a product of positive terms are below their computed value times this, and so is its
/// square: `1 + 8u`. Ratio.
pub const DISTANCE_UP: f64 = 1.0 + 8.0 * U64;
/// Factor of a gap of two volumes that makes it at most the true one: `1 - 32u` of f32. Boxes take
/// at most `4u`, oriented ones `13u`: an axis may be longer than 1 by `8u`, and a difference of
/// centres errs by `4.2u`. Ratio.
pub const APART_DOWN: f32 = 1.0 - 32.0 * U32;
/// Differences whose largest component is below this are scaled by [`DISTANCE_SCALE`]: `2^-400`, so
/// that the square of `DISTANCE_ERROR` of it, 2^-892, is a normal number. Length.
pub const DISTANCE_SMALL: f64 = f64::from_bits((1023 - 400) << 52);
/// Range of the largest difference of a pair in which f32 may drop it. `2^-40`: `192u` of it,
/// 2^-56, and sixteen `u` of it, 2^-60, have squares that are normal numbers. `2^60`: squares are
/// finite. Length.
pub const DISTANCE_FILTERED: RangeInclusive<f32> =
    f32::from_bits((127 - 40) << 23)..=f32::from_bits((127 + 60) << 23);
/// Their scale: `2^900`. The largest become 2^500, whose squares are finite; the smallest subnormal
/// becomes 2^-174. Ratio.
pub const DISTANCE_SCALE: f64 = f64::from_bits((1023 + 900) << 52);

/// A cell that loses less than this part of every range is split, not clipped again. Ratio; costs,
/// proves nothing.
pub const INCLUSION_SHRUNK: f64 = 0.6;
/// A motion counts as flat if its directions span less than this part of their box. It is clipped
/// along its plane, too. Ratio; a cost, not part of a proof.
pub const INCLUSION_FLAT: f64 = 1.0 / 64.0;
/// Largest finite bound of a moving box; a bound beyond it becomes infinite. `2^125`, so that
/// differences of bounds and sums of two such differences stay finite. Length.
pub const MOVING_LIMIT: f32 = f32::from_bits((125 + 127) << 23);
/// Error of the two computed ends of an interval of time together, and of their comparison: `16u`
/// in all. Each end is a fraction in [0, 1] of which numerator and denominator are wrong by `3u`
/// together; the products that compare them add `4u`. Fraction of the step.
pub const MOVING_TIME: f32 = 16.0 * U32;

/// Error of a mixture of two bounds of a moving box: `8u`. The complement, two products and a sum
/// take `3.1u`; the rest is the rounding of its allowance. Ratio of the larger bound.
pub const MOVING_MIXTURE: f32 = 8.0 * U32;
/// Distance of the horizon `h` behind the earliest known time `k`. Take a pair of features whose
/// boxes, moving with them, first share a point behind `h`. None of its verdicts begins at `k` or
/// before. Fraction of the step.
///
/// Let `s` be the exact time at which those boxes first share a point. The volumes of the broad
/// phase hold the features at every time, and so do the boxes of their triangles. So a pair left
/// out there for `h` has `s > h`, too. The tests that leave pairs out are these:
/// - `overlaps` of volumes until `h`, which hold the features until then: at no time until `h` do
///   they share a point.
/// - The triangles' window and `rejected_before`: by a computed begin. It errs by less than the
///   `ISOLATE_WINDOW` that is subtracted.
/// - The features' own boxes until `h`, derived in `prim::sweep`.
///
/// A pair whose boxes never share a point is left out for `h` only if its window agrees. Then every
/// rung has it.
///
/// A verdict begins no sooner than the computed begin of its rung's window less `ISOLATE_MARGIN`
/// (`Pair::not_before`). That is at least `s - 7u - ISOLATE_WINDOW - ISOLATE_MARGIN`. In f32, the
/// worse, it is `s - 2^-19 - 2^-12`. So `h = k + 2^-12 + 2^-13` suffices.
///
/// A rung of f32 leaves a pair out itself if its own begin less the margin is not before `k`. Yet
/// the verdict would be that of a rung of f64. There the begin is at least `s - 2^-48`, and the
/// margin 2^-26. The begin of f32 is at most `s (1 + 7u)` less `ISOLATE_WINDOW` of f32, `16u`. So
/// f64 begins later.
///
/// An axis may not clip its window if control vectors are too short on it. That is less than 2^-60
/// (f32) or 2^-480 (f64) of the pair's extent. Products of two such lengths lose their digits. Then
/// `s` is that of the other axes, and volumes of f32 must not use this axis either.
pub const HORIZON_MARGIN: f64 = 1.0 / 4096.0 + 1.0 / 8192.0;

/// How far `a_i . a_j` may be from 1 (i = j) or 0 in an oriented box, as computed: `12u`. The
/// computation errs by less than `4u`, so the true value is within `16u`, on which the next three
/// rest. Ratio.
pub const BOX_AXES: f32 = 12.0 * U32;
/// No axis of an oriented box is longer: its square is within `16u` of 1, so its length within
/// `8u`; `16u` with the rounding of this product. Ratio.
pub const BOX_LENGTH: f32 = 1.0 + 16.0 * U32;
/// Error of `a . (p - c)`, relative to the sum of `|a_d| |p_d - c_d|`: four roundings (difference,
/// product, two sums), and one more for those of the bound itself. Ratio.
pub const BOX_POINT: f32 = 5.0 * U32;
/// Error of `a . (p - b) - a . (c - b)`, relative to the sum of
/// `|a_d| (|p_d - b_d| + |c_d - b_d|)`: `8u`. Each product of vectors has four roundings (five, the
/// first tiny, for f64). Their difference has one, and the bound its own: below `6u`. Ratio.
pub const BOX_GROUP: f32 = 8.0 * U32;
/// Underflow of the products in one such half extent: at most sixteen of half the smallest
/// subnormal each, twice over. Length.
pub const BOX_GROUP_UNDERFLOW: f32 = f32::from_bits(16);
/// Excess of a child's slabs over `sum g_k |a_i . b_k|` of its half extents g, relative to their
/// sum. `28u` for axes not quite orthonormal and `7u` for roundings. The error of `a_i . (c' - c)`
/// is `5u` of the distance of the centres. `64u` covers both. Ratio.
pub const BOX_CHILD: f32 = 64.0 * U32;
/// Error of a separating axis of two oriented boxes, relative to the sum of all six half extents:
/// `256u`. Axes not quite orthonormal take `132u` and roundings `20u`, derived in `bv::obb`. Ratio.
pub const BOX_APART: f32 = 256.0 * U32;
/// Every factor that a sum of positive terms needs so as not to fall below them: `1 + 4u` for up to
/// three roundings.
pub const BOX_UP: f32 = 1.0 + 4.0 * U32;
/// Underflow of the products in one half extent: at most eleven of half the smallest subnormal
/// each. Length.
pub const BOX_UNDERFLOW: f32 = f32::from_bits(8);
/// Underflow of the products in one separating axis, half of it for either box. Length.
pub const BOX_APART_UNDERFLOW: f32 = f32::from_bits(16);
/// Largest coordinate of the centre and largest half extent of an oriented box. Beyond it the box
/// is that of everything. `2^120`, so that sums of products with components of axes stay finite.
/// Length.
pub const BOX_LIMIT: f32 = f32::from_bits((120 + 127) << 23);
/// An entry off the diagonal of a covariance below which it counts as zero; the largest entry is 1.
/// `2^-40`: far below the roundings of the others, and its square does not underflow. Ratio.
pub const COVARIANCE_ZERO: f32 = f32::from_bits((127 - 40) << 23);
/// Error of a vertex or a volume of one rigid body in the frame of another: `32u` of f32. Relative
/// to the sum of both radii and of the sizes of the coordinates of one centre in the other frame.
/// Derived in `bvh::relation`. Ratio.
pub const RELATIVE_SLACK: f64 = 32.0 * U32 as f64;
/// The same for the roundings of placing: `16U` of f64. Relative to the sum of the sizes of all
/// coordinates of both translations and of both meshes' centres. Ratio.
pub const RELATIVE_FAR: f64 = 16.0 * U64;
/// Largest reach of two bodies, radii and distance, for which frames are computed: `2^100`. Beyond
/// it every volume overlaps every other. Sums stay finite. Length.
pub const RELATIVE_LIMIT: f64 = f64::from_bits((1023 + 100) << 52);
/// Factor of that error for oriented boxes of tiles: the root of 3, for directions are not axes of the
/// frame. Derived in `bvh::tile_box`. Ratio.
pub const TILE_SLACK: f32 = 1.75;
/// Error of a test of two oriented boxes of tiles, relative to the sum of all six half extents: `64u`.
/// Each half extent has this part of the sum of its box. Derived in `bvh::tile_box`. Ratio.
pub const TILE_BOX: f64 = 64.0 * U32 as f64;
/// Error of a half extent that is computed in f64, relative to the extent from the centre: `8U`.
/// Derived in `bvh::tile_box`. Ratio.
pub const TILE_EXTENT: f64 = 8.0 * U64;
/// Factor of that error for a difference of heights in a direction: the error itself, and `12u` of
/// the reach, of which it has `32u`. Derived in `prim::planes`. Ratio.
pub const PLANE_SLACK: f32 = 2.0;
/// Allowance of heights below which none of them overflows: `2^100`. Heights are at most `2^18` of
/// it. Length cubed.
pub const PLANE_LIMIT: f32 = f32::from_bits((100 + 127) << 23);
/// Growth of a placed body's box: `64U` of f64. Relative to the radius and the sizes of the
/// coordinates of translation and centre. Placing takes `2U`, `14U` and `7U` of them
/// (`bvh::relation`); centre and half extents of the box are three products and four sums each, `38U`
/// of the radius, `8U` of the others. Ratio.
pub const PLACED_BOX: f64 = 64.0 * U64;
/// A cell is tested again before the others if decoupling directions remove more than this part of
/// a range. Ratio; a cost, not part of a proof.
pub const INCLUSION_DEEP: f64 = 0.5;
/// Tolerance of the length of a rotation's quaternion about 1: a thousand roundings of f32, the
/// precision of simulators. A quaternion within it is divided by its length. Ratio.
pub const POSE_UNIT: f64 = 1000.0 * f32::EPSILON as f64;
