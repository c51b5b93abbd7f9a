//! Polynomials whose signs decide whether two features approach. Each is written once, for numbers
//! with a bound of their error and for integers.
//!
//! `x` are the control vectors: `x[k]` is the difference of a vertex of each feature. The points of
//! their hull at a time are all differences of the features' points ([`crate::prim::isolate`]).
//! `p` is the point of the hull that is nearest to the origin at the start. It is at a corner, along
//! a side, or inside. All lengths below are multiplied by positive numbers, so that no form has a
//! quotient.

/// Numbers that are added, subtracted and multiplied.
pub trait Ring: Sized {
    /// The sum.
    fn plus(&self, other: &Self) -> Self;
    /// The difference.
    fn minus(&self, other: &Self) -> Self;
    /// The product.
    fn times(&self, other: &Self) -> Self;
}

/// Control vectors, component by component.
pub trait Vectors {
    /// Their components.
    type Number: Ring;
    /// A component of `x[k]`, at the start or at the end.
    fn component(&self, at: Place, axis: u32) -> Self::Number;
}

/// A control vector at the start, or at the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Which one.
    pub k: u32,
    /// At the end of the step.
    pub is_end: bool,
}

/// `x[k]` at the start.
#[inline(always)]
pub fn start(k: u32) -> Place {
    Place { k, is_end: false }
}

/// `x[k]` at the end.
#[inline(always)]
pub fn end(k: u32) -> Place {
    Place { k, is_end: true }
}

/// A polynomial. `a` and `b` are `x[a]` and `x[b]` at the start, `e = b - a`. `to` is a place, and `w`
/// its vector less `a`. `n` is `(x[1] - x[0]) cross (x[2] - x[0])` at the start.
#[derive(Clone, Copy, Debug)]
pub enum Form {
    /// `x[a] . w`, the height of a vector above the plane through `a`, at right angles to it.
    Corner {
        /// A corner.
        a: u32,
        /// The vector.
        to: Place,
    },
    /// `|x[a]|^2`: whether a corner is the origin.
    CornerSquare {
        /// A corner.
        a: u32,
    },
    /// `x[at] . e`: which end of a side is nearer.
    Along {
        /// A side.
        side: [u32; 2],
        /// One of its ends.
        at: u32,
    },
    /// `|e|^2 p . w`, the height of a vector above the plane through a side, at right angles to the
    /// point of its line nearest to the origin.
    Side {
        /// A side.
        side: [u32; 2],
        /// The vector.
        to: Place,
    },
    /// `|e|^2 |p|^2`: whether the line of a side contains the origin.
    SideHeight {
        /// A side.
        side: [u32; 2],
    },
    /// `|e|^2`.
    SideSquare {
        /// A side.
        side: [u32; 2],
    },
    /// `|e|^4 p . v`, of the velocity at the point of a side nearest to the origin.
    SideRate {
        /// A side.
        side: [u32; 2],
    },
    /// `n . w` with `a = x[0]`, the height of a vector above the hull.
    Plane {
        /// The vector.
        to: Place,
    },
    /// `n . x[0]`: on which side of the hull the origin is.
    PlaneHeight,
    /// `|n|^2`.
    PlaneSquare,
    /// `|n|^2 n . v`, of the velocity at the point of the hull's plane nearest to the origin.
    PlaneRate,
    /// A component of `n`.
    Normal {
        /// Which one.
        axis: u32,
    },
    /// A component of the motion of `x[k]` less that of `x[0]`.
    Motion {
        /// The vector.
        k: u32,
        /// Which one.
        axis: u32,
    },
}

impl Form {
    /// Its value.
    #[inline(always)]
    pub fn value<V: Vectors>(self, x: &V) -> V::Number {
        match self {
            Form::Corner { a, to } => dot(|i| x.component(start(a), i), |i| less(x, to, a, i)),
            Form::CornerSquare { a } => dot(|i| x.component(start(a), i), |i| x.component(start(a), i)),
            Form::Along { side, at } => along(x, side, at),
            Form::Side { side, to } => above_side(x, side, |i| less(x, to, side[0], i)),
            Form::SideHeight { side } => above_side(x, side, |i| x.component(start(side[0]), i)),
            Form::SideSquare { side: [a, b] } => {
                dot(|i| less(x, start(b), a, i), |i| less(x, start(b), a, i))
            }
            Form::SideRate { side } => {
                let [a, b] = side;
                let rate = |k: u32| above_side(x, side, |i| less(x, end(k), a, i));
                // The weights of both ends are proportional to b . e and -a . e.
                along(x, side, b).times(&rate(a)).minus(&along(x, side, a).times(&rate(b)))
            }
            Form::Plane { to } => above_plane(x, |i| less(x, to, 0, i)),
            Form::PlaneHeight => above_plane(x, |i| x.component(start(0), i)),
            Form::PlaneSquare => square(x),
            Form::PlaneRate => plane_rate(x),
            Form::Normal { axis } => normal(x, axis),
            Form::Motion { k, axis } => less(x, end(k), k, axis).minus(&less(x, end(0), 0, axis)),
        }
    }
}

/// A component of a vector less that of `x[a]` at the start.
#[inline(always)]
fn less<V: Vectors>(x: &V, to: Place, a: u32, axis: u32) -> V::Number {
    x.component(to, axis).minus(&x.component(start(a), axis))
}

/// An inner product.
#[inline(always)]
fn dot<N: Ring>(u: impl Fn(u32) -> N, v: impl Fn(u32) -> N) -> N {
    u(0).times(&v(0)).plus(&u(1).times(&v(1))).plus(&u(2).times(&v(2)))
}

#[inline(never)]
fn along<V: Vectors>(x: &V, [a, b]: [u32; 2], at: u32) -> V::Number {
    dot(|i| x.component(start(at), i), |i| less(x, start(b), a, i))
}

/// `|e|^2 (a . w) - (a . e)(e . w)`.
#[inline(always)]
fn above_side<V: Vectors>(x: &V, [a, b]: [u32; 2], w: impl Fn(u32) -> V::Number) -> V::Number {
    let e = |i| less(x, start(b), a, i);
    let base = |i| x.component(start(a), i);
    dot(e, e).times(&dot(base, &w)).minus(&dot(base, e).times(&dot(e, &w)))
}

/// A component of `n`.
#[inline(never)]
fn normal<V: Vectors>(x: &V, axis: u32) -> V::Number {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let side = |k: u32, axis: u32| less(x, start(k), 0, axis);
    side(1, i).times(&side(2, j)).minus(&side(1, j).times(&side(2, i)))
}

#[inline(always)]
fn above_plane<V: Vectors>(x: &V, w: impl Fn(u32) -> V::Number) -> V::Number {
    dot(|i| normal(x, i), w)
}

/// The products of both sides with each other: `|n|^2` by Lagrange.
#[inline(never)]
fn square<V: Vectors>(x: &V) -> V::Number {
    let side = |k: u32| move |i| less(x, start(k), 0, i);
    let cross = dot(side(1), side(2));
    dot(side(1), side(1)).times(&dot(side(2), side(2))).minus(&cross.times(&cross))
}

/// With `r = x[0]`, `p` and `q` the sides: the point of the plane nearest to the origin is
/// `r + s p + t q`. `|n|^2 s = (r.q)(p.q) - (r.p)(q.q)`, and `t` likewise. Its height rises by
/// `n . (r' + s p' + t q')`, and `n . w` is that of a corner's motion: heights at the start are equal.
#[inline(always)]
fn plane_rate<V: Vectors>(x: &V) -> V::Number {
    let rate = |k: u32| above_plane(x, |i| less(x, end(k), 0, i));
    let first = rate(0);
    // For a side and the other: |n|^2 times the parameter, times the difference of rates.
    let part = |k: u32, other: u32| {
        let side = |k: u32| move |i| less(x, start(k), 0, i);
        let base = |i| x.component(start(0), i);
        let parameter = dot(base, side(other))
            .times(&dot(side(k), side(other)))
            .minus(&dot(base, side(k)).times(&dot(side(other), side(other))));
        parameter.times(&rate(k).minus(&first))
    };
    square(x).times(&first).plus(&part(1, 2)).plus(&part(2, 1))
}
