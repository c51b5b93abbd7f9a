//! The oriented box: three slabs about a centre.
//!
//! A point p is in the box iff `|a_i . (p - c)| <= h_i` for i = 0, 1, 2. This is exact arithmetic
//! on the stored numbers; `a_2` is the *rounded* cross product of `a_0` and `a_1`. Containment
//! holds for any axes. Below, u is the unit roundoff of f32 and `A A^T = I + E`. Axes are only
//! taken if `|E_ij| <= mu = 16u` (`axes::frame`).
//!
//! **A child in its parent.** Points of the child with axes B are `c' + B^-1 y`, `|y_k| <= g_k`,
//! and `a . B^-1 y = (B^-T a) . y`. Now `B^-T = (B B^T)^-1 B`, which is `(I - F) B` with
//! `|F_ij| <= 1.01 mu`. So the component k of `B^-T a` is at most `|a . b_k| + 1.76 mu`. So the
//! child reaches at most `sum g_k |a . b_k| + 28u sum g_k` from the image of its centre. Rounded
//! dot products of unit vectors err by 3.1u, sums of three products by `3.1u sum g`.
//!
//! **Separating axes.** Slab boxes are convex, so any direction may separate them. Boxes that share
//! a point have `|L . T| <= r_A + r_B`, with `T = c_B - c_A` and radii
//! `r_A = sum h_i |(A^-T L)_i|`. Let S be the sum of all half extents.
//! - `L = a_i`: `r_A` is `h_i` exactly, `r_B` as above. Boxes that share a point have
//!   `|T| <= 1.01 S`. So roundings of `a_i . T` are 4.2u S, of `r` 8u S. Sum: 41u S.
//! - `L = R_1j a_2 - R_2j a_1` (and its two like), with `R_ij` the computed `a_i . b_j`. It is a
//!   combination of A's axes, so `r_A = h_1 |R_2j| + h_2 |R_1j|` exactly. `L . T` is the same
//!   combination of the `a_i . T`: 9u S. `r_B` needs the `b_k . L`, cofactors of R. For orthonormal
//!   axes they are entries of R (0 for k = j). Let `A = (I + E/2) P` and `B = (I + G/2) Q` up to
//!   terms of mu², with P and Q orthogonal. Then `cof R` differs from `+-P Q^T` by
//!   `(tr E/2 - E) P Q^T + P Q^T (tr G/2 - G)`. That is at most `6.5 mu`: 104u. Add `28u` as above,
//!   and 11u of roundings in R and in the sums. Sum: 152u S.
//!
//! `BOX_APART` is 256u. Multiplying it, adding it and comparing it with a difference loses less
//! than 4u.

use super::axes::{self, Frame, three};
use super::contain::within;
use super::{Contain, FillsNode, GROUP, Points, Volume, fills_node};
use crate::math::tolerance::{
    APART_DOWN, BOX_APART, BOX_APART_UNDERFLOW, BOX_CHILD, BOX_LENGTH, BOX_LIMIT, BOX_POINT, BOX_UNDERFLOW,
    BOX_UP,
};
use crate::math::{Real, Vec3};
use bytemuck::{Pod, Zeroable};

/// An oriented box: slabs `|a_i . (p - c)| <= h_i`. 56 bytes; with a node's two words, 64.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Obb {
    /// The centre.
    pub c: [f32; 3],
    /// The first axis; about a unit vector.
    pub a0: [f32; 3],
    /// The second axis. The third is the rounded cross product of both.
    pub a1: [f32; 3],
    /// Half extents along the three axes; infinite in the box of everything.
    pub h: [f32; 3],
    /// `BOX_APART` of the sum of the half extents, and the underflow: this box's share of the slack
    /// of an overlap test.
    pub slack: f32,
    /// Zero.
    pub pad: u32,
}
const _: () = assert!(size_of::<Obb>() == 56 && fills_node::<Obb>());
// SAFETY: asserted above.
unsafe impl FillsNode for Obb {}

impl Obb {
    /// Holds every point.
    pub const EVERYTHING: Obb = Obb {
        c: [0.0; 3],
        a0: axes::WORLD[0].0,
        a1: axes::WORLD[1].0,
        h: [f32::INFINITY; 3],
        slack: f32::INFINITY,
        pad: 0,
    };

    /// The three axes.
    #[inline]
    pub fn axes(&self) -> [Vec3<f32>; 3] {
        three([Vec3(self.a0), Vec3(self.a1)])
    }

    /// From its parts; the box of everything if one is too large for sums of products, or NaN.
    #[inline]
    pub(super) fn new(c: Vec3<f32>, frame: Frame, h: Vec3<f32>) -> Obb {
        let fits = |x: f32| x.abs() <= BOX_LIMIT;
        if !(fits(c[0]) & fits(c[1]) & fits(c[2]) & fits(h[0]) & fits(h[1]) & fits(h[2])) {
            return Obb::EVERYTHING;
        }
        let slack = BOX_APART * (h[0] + h[1] + h[2]) + BOX_APART_UNDERFLOW;
        Obb { c: c.0, a0: frame[0].0, a1: frame[1].0, h: h.0, slack, pad: 0 }
    }

    /// The box of points with these axes. Each point's difference to the centre is taken in the
    /// points' precision. The extents are measured about the centre as rounded.
    ///
    /// `s = a . q` errs by at most four roundings (five, the first tiny, for f64) and, near zero,
    /// six underflows.
    #[inline]
    fn around<R: Real>(points: &[Vec3<R>; 3], frame: Frame) -> Obb {
        let a = three(frame);
        let base = points[0];
        let (mut lo, mut hi) = (Vec3([0.0; 3]), Vec3([0.0; 3]));
        for &p in &points[1..] {
            let d = (p - base).narrow();
            let s = Vec3([a[0].dot(d), a[1].dot(d), a[2].dot(d)]);
            (lo, hi) = (lo.min(s), hi.max(s));
        }
        let mid = (lo + hi) * 0.5;
        let middle = a[0] * mid[0] + a[1] * mid[1] + a[2] * mid[2];
        let c = (base + middle.map(|x| R::of(x.wide()))).narrow();
        let (mut most, mut reach) = (Vec3([0.0; 3]), Vec3([0.0; 3]));
        for &p in points {
            let q = (p - c.map(|x| R::of(x.wide()))).narrow();
            let s = Vec3([a[0].dot(q), a[1].dot(q), a[2].dot(q)]);
            (most, reach) = (most.max(s.map(Real::abs)), reach.max(q.map(Real::abs)));
        }
        let h = |i: usize| (most[i] + BOX_POINT * a[i].map(Real::abs).dot(reach) + BOX_UNDERFLOW) * BOX_UP;
        // A comparison would drop NaN, which only an infinity begets: it is found in the sum.
        let whole = points.iter().fold(R::ZERO, |sum, p| sum + (p[0].abs() + p[1].abs() + p[2].abs()));
        let h = if whole.wide() <= BOX_LIMIT.wide() {
            Vec3([h(0), h(1), h(2)])
        } else {
            Vec3([f32::INFINITY; 3])
        };
        Obb::new(c, frame, h)
    }

    /// The box around this one and another, with the axes of this one: `r` is how far the other
    /// reaches along them from its centre.
    #[inline]
    fn union(&self, o: &Obb, r: Vec3<f32>) -> Obb {
        let (a, c, h) = (self.axes(), Vec3(self.c), Vec3(self.h));
        let along = |t: Vec3<f32>| Vec3([a[0].dot(t), a[1].dot(t), a[2].dot(t)]);
        let t = along(Vec3(o.c) - c);
        let mid = (h.max(t + r) + (-h).min(t - r)) * 0.5;
        let c = c + (a[0] * mid[0] + a[1] * mid[1] + a[2] * mid[2]);
        let reach = |b: &Obb, r: Vec3<f32>| {
            let (x, pad) = b.reach(a, c, r);
            x.map(|x| (x + pad) * BOX_UP)
        };
        Obb::new(c, [Vec3(self.a0), Vec3(self.a1)], reach(self, h).max(reach(o, r)))
    }

    /// The computed reach of the box from a point `c` along three axes, and its largest shortfall.
    /// `r` is its reach along them from its own centre.
    #[inline]
    pub fn reach(&self, a: [Vec3<f32>; 3], c: Vec3<f32>, r: Vec3<f32>) -> (Vec3<f32>, f32) {
        let t = Vec3(self.c) - c;
        let [x, y, z] = t.map(Real::abs).0;
        let pad = BOX_CHILD * ((self.h[0] + self.h[1] + self.h[2]) + (x + y + z)) + BOX_UNDERFLOW;
        (Vec3([a[0].dot(t), a[1].dot(t), a[2].dot(t)]).map(Real::abs) + r, pad)
    }
}

/// The corners of a triangle at both ends of the step, gone through without a loop: they stay in
/// registers.
struct Corners<R>([Vec3<R>; 6]);

impl<R: Real> Points<R> for Corners<R> {
    #[inline(always)]
    fn first(&self) -> Vec3<R> {
        self.0[0]
    }
    #[inline(always)]
    fn each(&self, mut visit: impl FnMut(Vec3<R>)) {
        let [p, s, q, t, r, u] = self.0;
        visit(p);
        visit(s);
        visit(q);
        visit(t);
        visit(r);
        visit(u);
    }
}

/// The surface, up to a factor and without paddings, of a box around two sets of slabs: half
/// extents h about the origin, r about t.
#[inline]
fn surface(h: Vec3<f32>, r: Vec3<f32>, t: Vec3<f32>) -> f32 {
    let t = t.map(Real::abs);
    let e = h.max(r + t) + h.max(r - t);
    e[0] * e[1] + e[1] * e[2] + e[2] * e[0]
}

/// One of two, word by word: a machine may select one without keeping either in memory.
#[inline]
fn select(first: bool, x: [f32; 3], y: [f32; 3]) -> [f32; 3] {
    let one = |k: usize| if first { x[k] } else { y[k] };
    [one(0), one(1), one(2)]
}

impl Volume for Obb {
    const NESTS: bool = false;
    const GROUP: u32 = GROUP;

    /// The axes are the longest edge, across it, and the normal: no rectangle around a triangle is
    /// smaller, and they cost no rotations.
    #[inline]
    fn still<R: Real>(corners: [Vec3<R>; 3]) -> Self {
        let [p, q, r] = corners;
        let e = scaled([(q - p).narrow(), (r - q).narrow(), (p - r).narrow()]);
        Obb::around(&corners, axes::of_edges(e))
    }

    /// The hull of both triangles holds the moving one: fitted as a group is, to six points.
    #[inline(always)]
    fn moving<R: Real>([p, q, r]: [Vec3<R>; 3], [s, t, u]: [Vec3<R>; 3]) -> Self {
        Obb::of(&Corners([p, s, q, t, r, u]))
    }

    /// The box takes the axes of the child whose axes have less surface. Along its own axes a box
    /// reaches as far as its extents. So only the other's reach is
    /// computed, for both choices from the same nine products. Sizes beyond `2^60` or below `2^-60`
    /// may take the axes with more surface.
    #[inline]
    fn merge(&self, o: &Self) -> Self {
        if (self.slack == f32::INFINITY) | (o.slack == f32::INFINITY) {
            return Obb::EVERYTHING;
        }
        let (a, b) = (self.axes(), o.axes());
        let (g, h, t) = (Vec3(self.h), Vec3(o.h), Vec3(o.c) - Vec3(self.c));
        let q = a.map(|a| Vec3([a.dot(b[0]).abs(), a.dot(b[1]).abs(), a.dot(b[2]).abs()]));
        let column = |j: usize| Vec3([q[0][j], q[1][j], q[2][j]]);
        let theirs = Vec3([h.dot(q[0]), h.dot(q[1]), h.dot(q[2])]);
        let mine = Vec3([g.dot(column(0)), g.dot(column(1)), g.dot(column(2))]);
        let along = |a: [Vec3<f32>; 3]| Vec3([a[0].dot(t), a[1].dot(t), a[2].dot(t)]);
        let first = surface(g, theirs, along(a)) <= surface(h, mine, along(b));
        let pick = |x: [f32; 3], y: [f32; 3]| select(first, x, y);
        let of = |p: &Obb, q: &Obb| Obb {
            c: pick(p.c, q.c),
            a0: pick(p.a0, q.a0),
            a1: pick(p.a1, q.a1),
            h: pick(p.h, q.h),
            slack: 0.0,
            pad: 0,
        };
        of(self, o).union(&of(o, self), Vec3(pick(theirs.0, mine.0)))
    }

    /// A step of length `by` goes along an axis as far as `by` times the axis is long.
    #[inline]
    fn grown(&self, by: f32) -> Self {
        let h = self.h.map(|h| (h + by * BOX_LENGTH + BOX_UNDERFLOW) * BOX_UP);
        Obb::new(Vec3(self.c), [Vec3(self.a0), Vec3(self.a1)], Vec3(h))
    }

    /// No component of an axis is above 1 by more than a rounding. The centre's part outweighs that
    /// unless it is zero.
    #[inline]
    fn reach(&self) -> f32 {
        let (c, h) = (Vec3(self.c).map(Real::abs), Vec3(self.h));
        (Real::max(c[0], Real::max(c[1], c[2])) + (h[0] + h[1] + h[2])) * BOX_UP
    }

    #[inline(always)]
    fn of_points<R: Real>(points: &(impl Points<R> + ?Sized)) -> Obb {
        Obb::of(points)
    }

    /// Faces first, all six at once: they separate nearly all boxes that are apart. The slack is
    /// for all axes alike; see the module's text. Every comparison with NaN is false, which the box
    /// of everything relies on.
    #[inline]
    fn overlaps(&self, o: &Self) -> bool {
        let (a, b) = (self.axes(), o.axes());
        let (g, h) = (Vec3(self.h), Vec3(o.h));
        let t = Vec3(o.c) - Vec3(self.c);
        let slack = self.slack + o.slack;
        let r = a.map(|a| Vec3([a.dot(b[0]), a.dot(b[1]), a.dot(b[2])]));
        let q = r.map(|r| r.map(Real::abs));
        let s = Vec3([a[0].dot(t), a[1].dot(t), a[2].dot(t)]);
        let mut apart = false;
        for i in 0..3 {
            let column = Vec3([q[0][i], q[1][i], q[2][i]]);
            apart |= s[i].abs() - (g[i] + h.dot(q[i])) > slack;
            apart |= b[i].dot(t).abs() - (h[i] + g.dot(column)) > slack;
        }
        if apart {
            return false;
        }
        for i in 0..3 {
            let (k, l) = ((i + 1) % 3, (i + 2) % 3);
            for j in 0..3 {
                let (m, n) = ((j + 1) % 3, (j + 2) % 3);
                let along = (s[l] * r[k][j] - s[k] * r[l][j]).abs();
                let mine = g[k] * q[l][j] + g[l] * q[k][j];
                let other = h[m] * q[i][n] + h[n] * q[i][m];
                apart |= along - (mine + other) > slack;
            }
        }
        !apart
    }

    /// The largest gap along the six face normals, less the slack of [`Obb::overlaps`] and
    /// `4.2u |T|` more. No sum of extents bounds that difference of centres here. `|T|` is at most
    /// the distance and `1.01 S`. So `4.2u` of the distance is needed beyond the slack. An axis is
    /// longer than 1 by less than `8u`. Every comparison with NaN is false, on which the box of
    /// everything relies.
    #[inline]
    fn apart(&self, o: &Self) -> f32 {
        let (a, b) = (self.axes(), o.axes());
        let (g, h) = (Vec3(self.h), Vec3(o.h));
        let t = Vec3(o.c) - Vec3(self.c);
        let slack = self.slack + o.slack;
        let mut gap = 0.0;
        for i in 0..3 {
            let row = Vec3([a[i].dot(b[0]), a[i].dot(b[1]), a[i].dot(b[2])]).map(Real::abs);
            let column = Vec3([a[0].dot(b[i]), a[1].dot(b[i]), a[2].dot(b[i])]).map(Real::abs);
            let mine = a[i].dot(t).abs() - (g[i] + h.dot(row)) - slack;
            let other = b[i].dot(t).abs() - (h[i] + g.dot(column)) - slack;
            gap = if mine > gap { mine } else { gap };
            gap = if other > gap { other } else { gap };
        }
        gap * APART_DOWN
    }
}

/// The vectors, divided by their largest component, so that squares neither overflow nor vanish.
#[inline]
fn scaled(v: [Vec3<f32>; 3]) -> [Vec3<f32>; 3] {
    let most = v.iter().fold(Vec3([0.0; 3]), |most, x| most.max(x.map(Real::abs)));
    let most = Real::max(Real::max(most[0], most[1]), most[2]);
    v.map(|x| x.map(|x| x / most))
}

impl Contain for Obb {
    /// Both ends are enough: the box is convex.
    fn holds(&self, t0: Vec3<f64>, t1: Vec3<f64>) -> bool {
        let axes = self.axes();
        [t0, t1].iter().all(|&p| (0..3).all(|i| within(axes[i], p, self.c, self.h[i])))
    }
}
