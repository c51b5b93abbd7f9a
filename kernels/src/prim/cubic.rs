//! The paper's continuous tests: vertex against face and edge against edge, by the roots of the
//! coplanarity cubic (thesis, section 6.2.5).
//!
//! Let `a`, `b` be the two edge vectors and `c` the offset, all linear in time. The four points are
//! coplanar if `(a x b) . c` is zero: a cubic. Its roots in [0, 1] are visited in ascending order.
//! The first at which the features are together is the time of impact. The cubic may vanish
//! identically: motion within a plane, parallel edges, faces without area. Then the events at which
//! a point passes a segment are visited instead.
//!
//! # Misses
//!
//! The test has tolerances ([`crate::math::tolerance`], `CUBIC_*`) in place of bounds, so it
//! guarantees nothing. A contact is missed, or its time is late, at an ill-conditioned root: nearly
//! coplanar motion, slivers, double roots. Then the features move by more than `CUBIC_INSIDE`
//! within the uncertainty of the root. False alarms are gaps below the same tolerance: 1.5e-11 of
//! the local extent in f64, 4e-6 in f32.
//!
//! `docs/internals/accuracy.md` has the measured misses and false alarms, `tests/kernels/limits.rs` an input for each
//! class.
//!
//! The rejection by signs alone (the common case) is proven: it misses nothing in either precision.
//! Times are in [0, 1], never -0.0 and never NaN for finite input.

use super::poly::{Cubic, quadratic};
use crate::math::tolerance::CUBIC_SCALE;
use crate::math::{Real, Vec3};
use bytemuck::{Pod, Zeroable};

/// A vertex at the start and at the end of a step. In between it moves on the straight line, at
/// constant speed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Moving<R> {
    /// The position at time 0.
    pub t0: Vec3<R>,
    /// The position at time 1.
    pub t1: Vec3<R>,
}

// SAFETY: two of a type that is Zeroable.
unsafe impl<R: Real> Zeroable for Moving<R> {}
// SAFETY: repr(C), two of one type that is Pod: no padding.
unsafe impl<R: Real> Pod for Moving<R> {}

impl<R: Real> Moving<R> {
    /// Whether both ends are [`Real::is_single`].
    #[inline(always)]
    pub fn is_single(&self) -> bool {
        self.t0.is_single() && self.t1.is_single()
    }
    /// In f32: exact for single numbers.
    #[inline(always)]
    pub fn narrow(&self) -> Moving<f32> {
        Moving { t0: self.t0.narrow(), t1: self.t1.narrow() }
    }
}

/// The first time in [0, 1] at which the vertex meets the closed face, computed in `S`. Touching at
/// 0 gives 0. Unproven: see the module text. About 130 operations if signs reject, else 400 to
/// 1500.
pub fn vf_toi<R: Real, S: Real>(v: Moving<R>, f: [Moving<R>; 3]) -> Option<S> {
    first::<S>(&Relative::new([(f[1], f[0]), (f[2], f[0]), (v, f[0])]), Kind::VertexFace)
}

/// The same for two closed edges `ea` and `eb`.
pub fn ee_toi<R: Real, S: Real>(ea: [Moving<R>; 2], eb: [Moving<R>; 2]) -> Option<S> {
    first::<S>(&Relative::new([(ea[1], ea[0]), (eb[1], eb[0]), (eb[0], ea[0])]), Kind::EdgeEdge)
}

#[derive(Clone, Copy)]
enum Kind {
    /// The face 0, a, b and the vertex c.
    VertexFace,
    /// The edge from 0 to a and the edge from c to c + b.
    EdgeEdge,
}

/// A vector that changes linearly with time.
#[derive(Clone, Copy)]
struct Linear<S>(Vec3<S>, Vec3<S>);

impl<S: Real> Linear<S> {
    #[inline]
    fn at(&self, t: S) -> Vec3<S> {
        self.0 * (S::ONE - t) + self.1 * t
    }
    #[inline]
    fn plus(&self, o: &Self) -> Self {
        Linear(self.0 + o.0, self.1 + o.1)
    }
    #[inline]
    fn minus(&self, o: &Self) -> Self {
        Linear(self.0 - o.0, self.1 - o.1)
    }
    /// The larger magnitude of both ends, per component.
    #[inline]
    fn reach(&self) -> Vec3<S> {
        self.0.map(S::abs).max(self.1.map(S::abs))
    }
}

/// Whether vertex and face certainly do not meet within the step, by signs alone, for any `S`. Then
/// no solver is needed. Either the relative motion stays on one side of a coordinate plane, or the
/// cubic has no root. Both are proven beyond rounding. About 150 operations.
#[inline]
pub fn vf_apart<R: Real, S: Real>(v: Moving<R>, f: [Moving<R>; 3]) -> bool {
    // The vertex is on one side of all three corners, at both ends of the step. Differences are
    // linear in time and in the corners' weights. A computed difference has the sign of the exact
    // one (or is 0, which proves nothing).
    if separated([
        [v.t0 - f[0].t0, v.t1 - f[0].t1],
        [v.t0 - f[1].t0, v.t1 - f[1].t1],
        [v.t0 - f[2].t0, v.t1 - f[2].t1],
    ]) {
        return true;
    }
    Relative::<S>::new([(f[1], f[0]), (f[2], f[0]), (v, f[0])]).apart()
}

/// Whether two edges certainly do not meet within the step; as [`vf_apart`].
#[inline]
pub fn ee_apart<R: Real, S: Real>(ea: [Moving<R>; 2], eb: [Moving<R>; 2]) -> bool {
    let between = |a: Moving<R>, b: Moving<R>| [a.t0 - b.t0, a.t1 - b.t1];
    if separated([between(ea[0], eb[0]), between(ea[0], eb[1]), between(ea[1], eb[0]), between(ea[1], eb[1])])
    {
        return true;
    }
    Relative::<S>::new([(ea[1], ea[0]), (eb[1], eb[0]), (eb[0], ea[0])]).apart()
}

/// The coplanarity cubic of a motion in Bernstein form, its inner coefficients times three, and
/// their error bounds. The motion is scaled if its extent is beyond [`CUBIC_SCALE`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coplanarity<S> {
    /// The coefficients.
    pub k: [S; 4],
    /// The most that the first and the last err.
    pub outer: S,
    /// The most that the others err.
    pub inner: S,
}

/// The coplanarity cubic of a vertex and a face, as signs reject by it.
#[inline]
pub fn vf_coplanarity<R: Real, S: Real>(v: Moving<R>, f: [Moving<R>; 3]) -> Coplanarity<S> {
    Relative::new([(f[1], f[0]), (f[2], f[0]), (v, f[0])]).coplanarity()
}

/// The coplanarity cubic of two edges, as signs reject by it.
#[inline]
pub fn ee_coplanarity<R: Real, S: Real>(ea: [Moving<R>; 2], eb: [Moving<R>; 2]) -> Coplanarity<S> {
    Relative::new([(ea[1], ea[0]), (eb[1], eb[0]), (eb[0], ea[0])]).coplanarity()
}

/// Whether on some axis all differences are strictly of one sign.
#[inline]
fn separated<R: Real, const N: usize>(differences: [[Vec3<R>; 2]; N]) -> bool {
    let (mut low, mut high) = (differences[0][0], differences[0][0]);
    for [start, end] in differences {
        low = low.min(start).min(end);
        high = high.max(start).max(end);
    }
    (0..3).any(|k| low[k] > R::ZERO || high[k] < R::ZERO)
}

/// The four points relative to one: edges `a`, `b`, offset `c`; their largest component. edges `a`
/// and `b`, offset `c`; and the largest component of all.
struct Relative<S> {
    a: Linear<S>,
    b: Linear<S>,
    c: Linear<S>,
    extent: S,
}

impl<S: Real> Relative<S> {
    /// Differences in the wider of both precisions, rounded once to `S`. They are in f32 alone only
    /// if `S` and the positions are f32. Then scaled by a power of two if cubes could leave the
    /// range.
    #[inline]
    fn new<R: Real>(pairs: [(Moving<R>, Moving<R>); 3]) -> Self {
        let [a, b, c] = if R::WIDE {
            let d = pairs.map(|(x, y)| Linear(x.t0.wide() - y.t0.wide(), x.t1.wide() - y.t1.wide()));
            scaled(d).map(|d| Linear(d.0.map(S::of), d.1.map(S::of)))
        } else {
            let to = |x: Vec3<R>| x.map(|x| S::of(x.wide()));
            scaled(pairs.map(|(x, y)| Linear(to(x.t0) - to(y.t0), to(x.t1) - to(y.t1))))
        };
        let extent = extent(&[a, b, c]);
        Relative { a, b, c, extent }
    }
}

#[inline]
fn extent<T: Real>(d: &[Linear<T>; 3]) -> T {
    let m = d[0].reach().max(d[1].reach()).max(d[2].reach());
    m[0].max(m[1]).max(m[2])
}

/// The same motion at an extent within [`CUBIC_SCALE`] of one. Times do not depend on the scale.
#[inline]
fn scaled<T: Real>(d: [Linear<T>; 3]) -> [Linear<T>; 3] {
    let w = extent(&d).wide();
    if w == 0.0 || (w <= CUBIC_SCALE && w * CUBIC_SCALE >= 1.0) {
        return d;
    }
    let p = w.parts();
    let k = T::pow2(-(p.exponent + 64 - p.mantissa.leading_zeros() as i32));
    d.map(|x| Linear(x.0 * k, x.1 * k))
}

impl<S: Real> Relative<S> {
    /// The coplanarity cubic in Bernstein form, and the permanent that bounds errors.
    #[inline]
    fn cubic(&self) -> ([S; 4], S) {
        let (a, b, c) = (&self.a, &self.b, &self.c);
        let (n0, n1) = (a.0.cross(b.0), a.1.cross(b.1));
        let mix = a.0.cross(b.1) + a.1.cross(b.0);
        let k = [n0.dot(c.0), mix.dot(c.0) + n0.dot(c.1), mix.dot(c.1) + n1.dot(c.0), n1.dot(c.1)];
        let (a, b, c) = (a.reach(), b.reach(), c.reach());
        let two = |i: usize, j: usize| a[i] * b[j] + a[j] * b[i];
        (k, two(1, 2) * c[0] + two(2, 0) * c[1] + two(0, 1) * c[2])
    }

    /// The coefficients, and the most that they err.
    #[inline]
    fn coplanarity(&self) -> Coplanarity<S> {
        let (k, permanent) = self.cubic();
        let outer = S::CUBIC_OUTER * permanent + S::CUBIC_UNDERFLOW;
        let inner = S::CUBIC_INNER * permanent + S::CUBIC_UNDERFLOW;
        Coplanarity { k, outer, inner }
    }

    /// Whether the cubic certainly has no root in [0, 1]. It is in the hull of its coefficients,
    /// and those have one sign beyond their rounding errors. Proven; a contact is never rejected.
    #[inline]
    fn apart(&self) -> bool {
        let Coplanarity { k, outer, inner } = self.coplanarity();
        (k[0] > outer && k[3] > outer && k[1] > inner && k[2] > inner)
            || (k[0] < -outer && k[3] < -outer && k[1] < -inner && k[2] < -inner)
    }
}

/// The shared walk over the roots.
fn first<S: Real>(m: &Relative<S>, kind: Kind) -> Option<S> {
    if m.apart() {
        return None;
    }
    let (k, permanent) = m.cubic();
    let (f, tiny) = (Cubic(k), S::CUBIC_VALUE * permanent + S::CUBIC_UNDERFLOW);
    let together = |t: S, rooted: bool| match kind {
        Kind::VertexFace => vertex_at_face(m, t, rooted),
        Kind::EdgeEdge => edges_at(m, t, rooted),
    };
    let (mut found, mut flat) = (None, false);
    let (mut before, mut value) = (S::ZERO, f.at(S::ZERO));
    for (i, t) in f.pieces().into_iter().enumerate() {
        if i > 0 && t <= before {
            continue;
        }
        let here = f.at(t);
        if (value < S::ZERO && here > S::ZERO) || (value > S::ZERO && here < S::ZERO) {
            let root = f.root(before, t, value < S::ZERO);
            if together(root, true) {
                found = Some(root);
                break;
            }
        }
        // An end, or an extremum that may touch zero.
        if here.abs() <= tiny {
            flat |= i > 0 && value.abs() <= tiny;
            if together(t, false) {
                found = Some(t);
                break;
            }
        }
        (before, value) = (t, here);
    }
    if flat { earlier(found, events(m, kind, together)) } else { found }
}

#[inline]
fn earlier<S: Real>(a: Option<S>, b: Option<S>) -> Option<S> {
    match (a, b) {
        (Some(x), Some(y)) => Some(x.min(y)),
        (x, None) => x,
        (None, y) => y,
    }
}

/// The earliest time at which a point passes a segment and the features are together: for motion in
/// a plane. The first contact of such a motion is one of these or at time 0.
#[cold]
#[inline(never)]
fn events<S: Real>(m: &Relative<S>, kind: Kind, together: impl Fn(S, bool) -> bool) -> Option<S> {
    let c_a = m.c.minus(&m.a);
    let pairs = match kind {
        Kind::VertexFace => {
            let c_b = m.c.minus(&m.b);
            [(m.c, c_a), (c_a, c_b), (c_b, m.c), (m.c, c_a)]
        }
        Kind::EdgeEdge => {
            let d = m.c.plus(&m.b);
            let d_a = d.minus(&m.a);
            [(m.c, c_a), (d, d_a), (m.c, d), (c_a, d_a)]
        }
    };
    let mut best = None;
    let mut visit = |t: S| {
        // NaN and infinity fail. Adding zero turns -0.0 into 0.0.
        if t >= S::ZERO && t <= S::ONE && best.is_none_or(|b| t < b) && together(t, false) {
            best = Some(t + S::ZERO);
        }
    };
    visit(S::ZERO);
    for (x, y) in pairs {
        // On one line with both ends: the cross product vanishes, each component a quadratic.
        let (k0, k2) = (x.0.cross(y.0), x.1.cross(y.1));
        let mix = x.0.cross(y.1) + x.1.cross(y.0);
        for axis in 0..3 {
            let k = [k0[axis], mix[axis] - (k0[axis] + k0[axis]), k0[axis] - mix[axis] + k2[axis]];
            quadratic(k).into_iter().for_each(&mut visit);
        }
        // Nearest to either end.
        for z in [x, y] {
            let d = z.1 - z.0;
            visit(-z.0.dot(d) / d.dot(d));
        }
    }
    visit(S::ONE);
    best
}

/// The plane of `a` and `b`: their cross product and its square, if they are not parallel.
#[inline]
fn spanned<S: Real>(a: Vec3<S>, b: Vec3<S>) -> Option<(Vec3<S>, S)> {
    let n = a.cross(b);
    let square = n.dot(n);
    (square > S::PARALLEL * (a.dot(a) * b.dot(b))).then_some((n, square))
}

/// Whether at `t` the vertex is at the face: inside, or within `CUBIC_INSIDE`. At a root distances
/// are measured in the plane, as the one along the normal is rounding; else in space.
fn vertex_at_face<S: Real>(m: &Relative<S>, t: S, rooted: bool) -> bool {
    let (a, b, c) = (m.a.at(t), m.b.at(t), m.c.at(t));
    let near = S::CUBIC_INSIDE * m.extent;
    let near = near * near;
    let mut p = c;
    if let Some((n, square)) = spanned(a, b) {
        let height = n.dot(c) / square;
        if rooted || height * height * square <= near {
            p = c - n * height;
            let (u, v) = (c.cross(b).dot(n), a.cross(c).dot(n));
            if u >= S::ZERO && v >= S::ZERO && u + v <= square {
                return true;
            }
        }
    }
    let o = Vec3([S::ZERO; 3]);
    distance(p, o, a) <= near || distance(p, o, b) <= near || distance(p, a, b) <= near
}

/// Whether at `t` the edges are together, as [`vertex_at_face`]. For parallel edges: whether an end
/// is at the other edge.
fn edges_at<S: Real>(m: &Relative<S>, t: S, rooted: bool) -> bool {
    let (a, b, c) = (m.a.at(t), m.b.at(t), m.c.at(t));
    let near = S::CUBIC_INSIDE * m.extent;
    let near = near * near;
    let mut p = c;
    if let Some((n, square)) = spanned(a, b) {
        let height = n.dot(c) / square;
        if rooted || height * height * square <= near {
            p = c - n * height;
            let (u, v) = (c.cross(b).dot(n), c.cross(a).dot(n));
            if u >= S::ZERO && u <= square && v >= S::ZERO && v <= square {
                return true;
            }
        }
    }
    let (o, q) = (Vec3([S::ZERO; 3]), p + b);
    distance(p, o, a) <= near
        || distance(q, o, a) <= near
        || distance(o, p, q) <= near
        || distance(a, p, q) <= near
}

/// The squared distance of `p` from the closed segment `ab`, which may be a point.
#[inline]
pub(super) fn distance<S: Real>(p: Vec3<S>, a: Vec3<S>, b: Vec3<S>) -> S {
    let (d, q) = (b - a, p - a);
    let (along, square) = (q.dot(d), d.dot(d));
    let s = if along <= S::ZERO {
        S::ZERO
    } else if along >= square {
        S::ONE
    } else {
        along / square
    };
    let r = q - d * s;
    r.dot(r)
}
