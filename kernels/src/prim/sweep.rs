//! The boxes around the features of two triangles, or around their ways, and which of them come
//! within a gap. Without branches: some lane of a GPU would take each, and a CPU makes vectors of
//! it. Some 500 operations.

use super::cubic::Moving;
use super::isolate::pair::Window;
use crate::math::tolerance::{SINGLE_MOST, Tolerance};
use crate::math::{Real, Vec3};

/// Tests of two triangles.
pub const MOST: u32 = 15;
/// Their bits.
const ALL: u32 = (1 << MOST) - 1;

/// A closed box.
#[derive(Clone, Copy)]
struct Swept<R> {
    lo: Vec3<R>,
    hi: Vec3<R>,
}

impl<R: Real> Swept<R> {
    #[inline(always)]
    fn merge(self, o: Self) -> Self {
        Swept { lo: self.lo.lesser(o.lo), hi: self.hi.greater(o.hi) }
    }
    /// In bit 31, whether two boxes share no point. The upper ends of [`swept`] are never -0, so a
    /// difference of two equal ends is +0.
    #[inline(always)]
    fn apart(&self, o: &Self) -> u32 {
        let (x, y) = (o.hi - self.lo, self.hi - o.lo);
        signs(x, y)
    }
    /// In bit 31, whether two boxes are farther apart on an axis than a gap above 0.
    #[inline(always)]
    fn apart_by(&self, o: &Self, gap: R) -> u32 {
        let gap = Vec3([gap; 3]);
        signs(gap - (self.lo - o.hi), gap - (o.lo - self.hi))
    }
}

/// In bit 31, whether any component is below 0.
#[inline(always)]
fn signs<R: Real>(x: Vec3<R>, y: Vec3<R>) -> u32 {
    x[0].sign() | y[0].sign() | x[1].sign() | y[1].sign() | x[2].sign() | y[2].sign()
}

/// The corners of a triangle.
pub type Corners<R> = [Moving<R>; 3];

/// Boxes around the paths of the corners of two triangles, over a part of the step. Also whether
/// there is such a part, and before that whether numbers are far from overflow: if not, nothing
/// else holds. In the part the boxes around the triangles come within the gap, and it ends at
/// the horizon. Boxes of the first triangle grow by the gap and by all roundings.
///
/// Corners are differences that were rounded: `SWEPT_ROUNDED` of the largest for each of both
/// triangles. The window's numbers err by as much, and its own roundings are relative to itself. A
/// corner at a time of the part errs by `3.1u` more, of the larger of its ends: the complement, two
/// products, a sum. Growing adds `u`: `INCLUSION_INPUT`. A number that underflows is within
/// `INCLUSION_UNDERFLOW`.
///
/// With a horizon, a pair may be left out in two cases. The boxes that `Pair::window` moves with
/// its features first meet behind the horizon. Or they never meet, which that window finds, too.
/// Those boxes mix the least coordinates of both ends. So at `t` they reach beyond the corners
/// there by at most `t` of the extent at the end. Boxes grow by that much, until the horizon. The
/// part begins `3 ISOLATE_WINDOW` sooner. Suppose boxes of features meet only before the part, and
/// those of their triangles only behind that. Then their windows are empty by more than they are
/// widened. Behind the end of the part a query without a horizon leaves them out by the same end.
#[inline(always)]
fn swept(p: &Corners<f32>, q: &Corners<f32>, gap: f32, horizon: f32) -> (bool, bool, [[Swept<f32>; 3]; 2]) {
    let mut window = Window::new();
    let (cut, sooner) =
        if horizon < 1.0 { (horizon * f32::INCLUSION_UP, 3.0 * f32::ISOLATE_WINDOW) } else { (0.0, 0.0) };
    // One axis after the other, each by a constant number: nothing goes to memory on the GPU.
    let (x, y, z) = (
        axis(0, &mut window, p, q, (gap, cut)),
        axis(1, &mut window, p, q, (gap, cut)),
        axis(2, &mut window, p, q, (gap, cut)),
    );
    let grow = Vec3([x, y, z]);
    // An axis grows by more than a part of its reach; a number that is none is not below.
    let most = SINGLE_MOST as f32 * f32::SWEPT_ROUNDED;
    let is_finite = (x < most) & (y < most) & (z < most);
    let whole = window.within(1.0);
    let begins = whole.is_some_and(|part| part.0 <= horizon);
    let (from, to) = whole.unwrap_or((0.0, 1.0));
    let part = ((from - sooner).greater(0.0), to.lesser(horizon));
    (is_finite, begins, [ways(p, part, grow), ways(q, part, Vec3([0.0; 3]))])
}

/// Clips the part of the step by one axis; by how much boxes grow on it: the gap, roundings, and
/// that part of the extents at the end of the step.
#[inline(always)]
fn axis(
    k: usize,
    window: &mut Window<f32>,
    p: &Corners<f32>,
    q: &Corners<f32>,
    (gap, part): (f32, f32),
) -> f32 {
    let (p, q) = (range(p, k), range(q, k));
    let reach = reach(p) + reach(q);
    let gap = gap + reach * f32::SWEPT_ROUNDED + f32::INCLUSION_UNDERFLOW;
    window.clip([p[0].1 - q[0].0 + gap, p[1].1 - q[1].0 + gap]);
    window.clip([q[0].1 - p[0].0 + gap, q[1].1 - p[1].0 + gap]);
    let extents = (p[1].1 - p[1].0) + (q[1].1 - q[1].0);
    reach * f32::INCLUSION_INPUT + extents * part + gap
}

/// The least and the largest coordinate of three corners, at both ends of the step.
#[inline(always)]
fn range<R: Real>([x, y, z]: &Corners<R>, k: usize) -> [(R, R); 2] {
    let least = |x: R, y: R, z: R| x.lesser(y).lesser(z);
    let most = |x: R, y: R, z: R| x.greater(y).greater(z);
    [
        (least(x.t0[k], y.t0[k], z.t0[k]), most(x.t0[k], y.t0[k], z.t0[k])),
        (least(x.t1[k], y.t1[k], z.t1[k]), most(x.t1[k], y.t1[k], z.t1[k])),
    ]
}

/// The largest magnitude.
#[inline(always)]
fn reach<R: Real>([start, end]: [(R, R); 2]) -> R {
    (-start.0.lesser(end.0)).greater(start.1.greater(end.1))
}

/// Boxes around the ways of three corners.
#[inline(always)]
fn ways<R: Real>([x, y, z]: &Corners<R>, part: (R, R), by: Vec3<R>) -> [Swept<R>; 3] {
    [way(x, part, by), way(y, part, by), way(z, part, by)]
}

/// A box around the way of a corner.
#[inline(always)]
fn way<R: Real>(c: &Moving<R>, (from, to): (R, R), by: Vec3<R>) -> Swept<R> {
    let x = c.t0 * (R::ONE - from) + c.t1 * from;
    let y = c.t0 * (R::ONE - to) + c.t1 * to;
    Swept { lo: x.lesser(y) - by, hi: x.greater(y) + by }
}

/// By how much boxes of one of two triangles grow: a little more than the gap, or not at all.
pub fn more<R: Real>(gap: f64) -> R {
    if gap > 0.0 { R::of(gap) * R::INCLUSION_UP + R::INCLUSION_UNDERFLOW } else { R::ZERO }
}

/// The tests of two triangles whose features' boxes come within a gap, and not first behind the
/// horizon. The gap is [`more`] of the given one; the horizon is a time in (0, 1].
///
/// In f32, by differences from the middle of both first corners, which moves from one end of the
/// step to the other. Boxes that move with features move with it, and share points at the same
/// times. So neither a distant origin nor a common motion costs anything.
#[inline(always)]
pub fn meeting<R: Real>(p: &Corners<R>, q: &Corners<R>, gap: f32, horizon: f32) -> u32 {
    let middle = |a: Vec3<R>, b: Vec3<R>| (a + b) * R::of(0.5);
    let (from, to) = (middle(p[0].t0, q[0].t0), middle(p[0].t1, q[0].t1));
    let of = |x: Moving<R>| Moving { t0: (x.t0 - from).narrow(), t1: (x.t1 - to).narrow() };
    let (p, q) = ([of(p[0]), of(p[1]), of(p[2])], [of(q[0]), of(q[1]), of(q[2])]);
    let (is_finite, meet, boxes) = swept(&p, &q, gap, horizon);
    if !is_finite {
        ALL
    } else if meet {
        sharing(&boxes, Swept::apart)
    } else {
        0
    }
}

/// The same of two triangles at rest, by their corners; the gap is above 0, and [`more`] of it.
/// Boxes do not grow, so the number of candidates does not depend on the distance from the origin.
/// A difference within the gap rounds to at most the gap.
#[inline(always)]
pub fn meeting_at_rest<R: Real>(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3], gap: R) -> u32 {
    sharing(&[points(p), points(q)], |x, y| x.apart_by(y, gap))
}

/// Boxes around corners at rest.
#[inline(always)]
fn points<R: Real>(&[x, y, z]: &[Vec3<R>; 3]) -> [Swept<R>; 3] {
    [Swept { lo: x, hi: x }, Swept { lo: y, hi: y }, Swept { lo: z, hi: z }]
}

/// The tests whose features' boxes share a point. Bits 0 to 2: a vertex of p and q. Bits 3 to 5: a
/// vertex of q and p. Bits 6 + 3 i + j: edge i of p and edge j of q. By signs of differences, since
/// only half of a GPU's lanes compare at a time.
#[inline(always)]
fn sharing<R: Real>([p, q]: &[[Swept<R>; 3]; 2], apart_of: impl Fn(&Swept<R>, &Swept<R>) -> u32) -> u32 {
    let (of_p, of_q) = (p[0].merge(p[1]).merge(p[2]), q[0].merge(q[1]).merge(q[2]));
    let mut apart = 0;
    for k in 0..3 {
        apart |= (apart_of(&p[k], &of_q) >> 31) << k;
        apart |= (apart_of(&q[k], &of_p) >> 31) << (3 + k);
    }
    let (of_p, of_q) = (edges(p), edges(q));
    for (i, p) in of_p.iter().enumerate() {
        for (j, q) in of_q.iter().enumerate() {
            apart |= (apart_of(p, q) >> 31) << (6 + 3 * i + j);
        }
    }
    !apart & ALL
}

/// Boxes around the ways of the edges of three corners.
#[inline(always)]
fn edges<R: Real>([x, y, z]: &[Swept<R>; 3]) -> [Swept<R>; 3] {
    [x.merge(*y), y.merge(*z), z.merge(*x)]
}
