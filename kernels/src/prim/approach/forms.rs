//! Polynomials whose signs decide whether two features approach. Each is written once, for numbers
//! with a bound of their error and for integers.
//!
//! `x` are the control vectors: `x[k]` is the difference of a vertex of each feature. The points of
//! their hull at a time are all differences of the features' points ([`crate::prim::isolate`]).
//! `p` is the point of the hull that is nearest to the origin at the start. It is at a corner, along
//! a side, or inside. All lengths below are multiplied by positive numbers, so that no form has a
//! quotient.

/// Numbers that are added and subtracted.
pub trait Ring: Sized {
    /// The result of a form: the number, or its sign alone.
    type Out;
    /// The sum.
    fn plus(&self, other: &Self) -> Self;
    /// The difference.
    fn minus(&self, other: &Self) -> Self;
    /// The result.
    fn out(self) -> Self::Out;
}

/// Control vectors, component by component, and products of them. Products of so many components
/// have a type of their own: integers have no more digits than their degree needs.
pub trait Vectors {
    /// The result of a form.
    type Out;
    /// Their components, and sums of these.
    type One: Ring<Out = Self::Out>;
    /// Sums of products of two.
    type Two: Ring<Out = Self::Out>;
    /// Sums of products of three.
    type Three: Ring<Out = Self::Out>;
    /// Sums of products of four.
    type Four: Ring<Out = Self::Out>;
    /// Sums of products of six.
    type Six: Ring<Out = Self::Out>;
    /// Sums of products of seven.
    type Seven: Ring<Out = Self::Out>;
    /// A component of `x[k]`, at the start or at the end.
    fn component(&self, at: Place, axis: u32) -> Self::One;
    /// A product of two.
    fn two(a: &Self::One, b: &Self::One) -> Self::Two;
    /// A product of three.
    fn three(a: &Self::Two, b: &Self::One) -> Self::Three;
    /// A product of four.
    fn four(a: &Self::Two, b: &Self::Two) -> Self::Four;
    /// A product of six.
    fn six(a: &Self::Two, b: &Self::Four) -> Self::Six;
    /// A product of seven.
    fn seven(a: &Self::Four, b: &Self::Three) -> Self::Seven;
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
    /// `|n|^2` times the weight of a side, at the point of the plane nearest to the origin: that of
    /// `x[k] - x[0]`, for `k` of 1 or 2.
    Weight {
        /// Which side.
        k: u32,
    },
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
    /// Its value, or its sign.
    #[inline(always)]
    pub fn value<V: Vectors>(self, x: &V) -> V::Out {
        match self {
            Form::Corner { a, to } => dot::<V>(|i| x.component(start(a), i), |i| less(x, to, a, i)).out(),
            Form::CornerSquare { a } => {
                dot::<V>(|i| x.component(start(a), i), |i| x.component(start(a), i)).out()
            }
            Form::Along { side, at } => along(x, side, at).out(),
            Form::Side { side, to } => above_side(x, side, |i| less(x, to, side[0], i)).out(),
            Form::SideHeight { side } => above_side(x, side, |i| x.component(start(side[0]), i)).out(),
            Form::SideSquare { side: [a, b] } => {
                dot::<V>(|i| less(x, start(b), a, i), |i| less(x, start(b), a, i)).out()
            }
            Form::SideRate { side } => {
                let [a, b] = side;
                let rate = |k: u32| above_side(x, side, |i| less(x, end(k), a, i));
                // The weights of both ends are proportional to b . e and -a . e.
                let of_a = V::six(&along(x, side, b), &rate(a));
                of_a.minus(&V::six(&along(x, side, a), &rate(b))).out()
            }
            Form::Plane { to } => above_plane(x, &normal(x), |i| less(x, to, 0, i)).out(),
            Form::PlaneHeight => above_plane(x, &normal(x), |i| x.component(start(0), i)).out(),
            Form::PlaneSquare => square(x).out(),
            Form::PlaneRate => plane_rate(x).out(),
            Form::Weight { k } => weight(x, k).out(),
            Form::Normal { axis } => of_normal(x, axis).out(),
            Form::Motion { k, axis } => less(x, end(k), k, axis).minus(&less(x, end(0), 0, axis)).out(),
        }
    }
}

/// A component of a vector less that of `x[a]` at the start.
#[inline(always)]
fn less<V: Vectors>(x: &V, to: Place, a: u32, axis: u32) -> V::One {
    x.component(to, axis).minus(&x.component(start(a), axis))
}

/// An inner product.
#[inline(always)]
fn dot<V: Vectors>(u: impl Fn(u32) -> V::One, v: impl Fn(u32) -> V::One) -> V::Two {
    V::two(&u(0), &v(0)).plus(&V::two(&u(1), &v(1))).plus(&V::two(&u(2), &v(2)))
}

#[inline(never)]
fn along<V: Vectors>(x: &V, [a, b]: [u32; 2], at: u32) -> V::Two {
    dot::<V>(|i| x.component(start(at), i), |i| less(x, start(b), a, i))
}

/// `|e|^2 (a . w) - (a . e)(e . w)`.
#[inline(always)]
fn above_side<V: Vectors>(x: &V, [a, b]: [u32; 2], w: impl Fn(u32) -> V::One) -> V::Four {
    let e = |i| less(x, start(b), a, i);
    let base = |i| x.component(start(a), i);
    V::four(&dot::<V>(e, e), &dot::<V>(base, &w)).minus(&V::four(&dot::<V>(base, e), &dot::<V>(e, &w)))
}

/// A component of `n`.
#[inline(never)]
fn of_normal<V: Vectors>(x: &V, axis: u32) -> V::Two {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let side = |k: u32, axis: u32| less(x, start(k), 0, axis);
    V::two(&side(1, i), &side(2, j)).minus(&V::two(&side(1, j), &side(2, i)))
}

#[inline(always)]
fn normal<V: Vectors>(x: &V) -> [V::Two; 3] {
    [of_normal(x, 0), of_normal(x, 1), of_normal(x, 2)]
}

/// `n . w`.
#[inline(always)]
fn above_plane<V: Vectors>(_: &V, [a, b, c]: &[V::Two; 3], w: impl Fn(u32) -> V::One) -> V::Three {
    V::three(a, &w(0)).plus(&V::three(b, &w(1))).plus(&V::three(c, &w(2)))
}

/// The products of both sides with each other: `|n|^2` by Lagrange.
#[inline(never)]
fn square<V: Vectors>(x: &V) -> V::Four {
    let side = |k: u32| move |i| less(x, start(k), 0, i);
    let cross = dot::<V>(side(1), side(2));
    V::four(&dot::<V>(side(1), side(1)), &dot::<V>(side(2), side(2))).minus(&V::four(&cross, &cross))
}

/// With `r = x[0]`, `p` and `q` the sides: the point of the plane nearest to the origin is
/// `r + s p + t q`. `|n|^2 s = (r.q)(p.q) - (r.p)(q.q)`, and `t` likewise.
#[inline(never)]
fn weight<V: Vectors>(x: &V, k: u32) -> V::Four {
    let other = 3 - k;
    let side = |k: u32| move |i| less(x, start(k), 0, i);
    let base = |i| x.component(start(0), i);
    V::four(&dot::<V>(base, side(other)), &dot::<V>(side(k), side(other)))
        .minus(&V::four(&dot::<V>(base, side(k)), &dot::<V>(side(other), side(other))))
}

/// The height of that point rises by `n . (r' + s p' + t q')`, and `n . w` is that of a corner's
/// motion: heights at the start are equal.
#[inline(always)]
fn plane_rate<V: Vectors>(x: &V) -> V::Seven {
    let n = normal(x);
    let rate = |k: u32| above_plane(x, &n, |i| less(x, end(k), 0, i));
    let first = rate(0);
    // For a side: |n|^2 times its weight, times the difference of rates.
    let part = |k: u32| V::seven(&weight(x, k), &rate(k).minus(&first));
    V::seven(&square(x), &first).plus(&part(1)).plus(&part(2))
}
