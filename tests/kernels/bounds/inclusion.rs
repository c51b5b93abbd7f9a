//! The certified tests: `prim::inclusion`.

use super::cubic::four;
use super::exact::{Exact, Point, det, dot, dot_abs, larger, less, point};
use super::hunt::{Found, Hunt, argued, held, plain};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::bound::Image;
use nearmiss_kernels::prim::inclusion::direction::{Cuts, volume};
use nearmiss_kernels::prim::inclusion::{Cell, Edges, Face, Grid, Local, Params};
use rand::Rng;
use rand::rngs::SmallRng;

/// A pair's differences as a kernel holds them.
trait Pair<const N: usize>: Sized {
    fn of<R: Real>(x: &[Moving<R>; 4]) -> Self;
}
impl<S: Grid> Pair<3> for Face<S> {
    fn of<R: Real>(x: &[Moving<R>; 4]) -> Self {
        Face::new(x[0], [x[1], x[2], x[3]], &Params::new(0.0))
    }
}
impl<S: Grid> Pair<4> for Edges<S> {
    fn of<R: Real>(x: &[Moving<R>; 4]) -> Self {
        Edges::new([x[0], x[1]], [x[2], x[3]], &Params::new(0.0))
    }
}

/// The control vectors exactly, in the units of the kernel's.
fn controls<R: Real, S: Real, const N: usize>(x: &[Moving<R>; 4], m: &Local<S, N>) -> [[Point; 2]; N] {
    let p = x.map(|m| [point(m.t0), point(m.t1)]);
    let of = |i: usize| if N == 3 { (0, 1 + i) } else { (i / 2, 2 + i % 2) };
    let w: [[Point; 2]; N] = std::array::from_fn(|i| [0, 1].map(|t| less(&p[of(i).0][t], &p[of(i).1][t])));
    // The units are a power of two, found by the largest component, which lost at most a unit.
    let mut largest = (0.0, 1.0);
    for (said, truth) in m.w.iter().flatten().flat_map(|v| v.0).zip(w.iter().flatten().flatten()) {
        if said.wide().abs() > largest.0 {
            largest = (said.wide().abs(), Exact::of(said).over(truth));
        }
    }
    let unit = Exact::pow2(largest.1.abs().log2().round() as i64);
    w.map(|ends| ends.map(|v| v.map(|x| x * &unit)))
}

/// A parameter of the grid in [0, 1].
fn parameter<S: Grid>(x: f64) -> S {
    let x = x.abs();
    S::down(S::of(x - x.floor()))
}

/// An image of one point, with that point exactly; `x` holds four points in motion and t, u, v.
fn corner<R: Real, S: Grid, const N: usize>(x: &[f64]) -> (Image<S>, Point)
where
    Local<S, N>: Pair<N>,
{
    let points = four::<R>(x);
    let m = Local::<S, N>::of(&points);
    let at = Vec3([parameter::<S>(x[24]), parameter::<S>(x[25]), parameter::<S>(x[26])]);
    let image = m.image(&Cell { low: at, high: at });
    let one = Exact::of(1.0);
    let [t, u, v] = point(at);
    let weights: [Exact; N] = std::array::from_fn(|i| {
        let pick = |of: &Exact, upper: bool| if upper { of.clone() } else { &one - of };
        match (N, i) {
            (3, 0) => &one - &u - &v,
            (3, 1) => u.clone(),
            (3, _) => v.clone(),
            (_, i) => pick(&u, i / 2 == 1) * pick(&v, i % 2 == 1),
        }
    });
    let w = controls(&points, &m);
    let truth = [0, 1, 2].map(|k| {
        (0..N).fold(Exact::zero(), |sum, i| {
            sum + &weights[i] * &(&w[i][0][k] * &(&one - &t) + &w[i][1][k] * &t)
        })
    });
    (image, truth)
}

fn corners<R: Real, S: Grid, const N: usize>(constant: &str, of: &str)
where
    Local<S, N>: Pair<N>,
{
    let ratio = |x: &[f64]| {
        let (image, truth) = corner::<R, S, N>(x);
        let error = |k: usize| (Exact::of(image.f[0][k]) - &truth[k]).abs();
        (0..3).map(|k| error(k).over(&Exact::of(image.error[k]))).fold(0.0, f64::max)
    };
    held(constant, of, &Hunt::new(31).most::<R>(|r| plain(r, 27), ratio));
}

/// Measured: the error of a component of a corner of a vertex/face image, of its whole bound.
#[test]
fn inclusion_face() {
    corners::<f32, f32, 3>("INCLUSION_FACE", "f32");
    corners::<f64, f32, 3>("INCLUSION_FACE", "f64 in f32");
    corners::<f64, f64, 3>("INCLUSION_FACE", "f64");
}

/// Measured: the error of a component of a corner of an edge/edge image, of its whole bound.
#[test]
fn inclusion_edge() {
    corners::<f32, f32, 4>("INCLUSION_EDGE", "f32");
    corners::<f64, f32, 4>("INCLUSION_EDGE", "f64 in f32");
    corners::<f64, f64, 4>("INCLUSION_EDGE", "f64");
}

/// Measured: the error of a component of a control vector, and what the sum of its bound and of a separation as large
/// loses, of that bound.
#[test]
fn inclusion_input() {
    fn of<R: Real, S: Grid>() -> Found
    where
        Local<S, 4>: Pair<4>,
    {
        let ratio = |x: &[f64]| {
            let points = four::<R>(x);
            let m = Edges::<S>::of(&points);
            let mut most = 0f64;
            for (said, truth) in m.w.as_flattened().iter().zip(controls(&points, &m).as_flattened()) {
                for k in 0..3 {
                    let bound = S::INCLUSION_INPUT * m.reach[k] + S::INCLUSION_UNDERFLOW;
                    let sum = said[k].abs() + bound;
                    let lost = Exact::of(said[k].abs()) + Exact::of(bound) - Exact::of(sum);
                    let error = (Exact::of(said[k]) - &truth[k]).abs() + larger(lost, Exact::zero());
                    most = most.max(error.over(&Exact::of(bound)));
                }
            }
            most
        };
        Hunt::new(32).most::<R>(|r| plain(r, 24), ratio)
    }
    held("INCLUSION_INPUT", "f32", &of::<f32, f32>());
    held("INCLUSION_INPUT", "f64 in f32", &of::<f64, f32>());
    held("INCLUSION_INPUT", "f64", &of::<f64, f64>());
}

/// Measured: the error of the least product of a direction and a control vector, of its whole bound.
#[test]
fn inclusion_hull() {
    fn of<R: Real, S: Grid>() -> Found
    where
        Local<S, 4>: Pair<4>,
    {
        let ratio = |x: &[f64]| {
            let points = four::<R>(x);
            let m = Edges::<S>::of(&points);
            let d = Vec3([S::of(x[24]), S::of(x[25]), S::of(x[26])]);
            let (said, _, bound) = m.least(d);
            let along = controls(&points, &m)
                .as_flattened()
                .iter()
                .map(|w| dot(&point(d), w))
                .reduce(|a, b| if a <= b { a } else { b });
            (Exact::of(said) - along.expect("eight")).abs().over(&Exact::of(bound))
        };
        Hunt::new(33).most::<R>(|r| plain(r, 27), ratio)
    }
    held("INCLUSION_HULL", "f32", &of::<f32, f32>());
    held("INCLUSION_HULL", "f64 in f32", &of::<f64, f32>());
    held("INCLUSION_HULL", "f64", &of::<f64, f64>());
}

/// An image of these corners (24 numbers), exact ones: what errs is only the product with the direction after them.
fn image<S: Grid>(x: &[f64]) -> (Image<S>, Vec3<S>) {
    let f: [Vec3<S>; 8] = std::array::from_fn(|i| Vec3(std::array::from_fn(|k| S::of(x[3 * i + k]))));
    let (low, high) = (f.into_iter().reduce(Vec3::min), f.into_iter().reduce(Vec3::max));
    let error = Vec3([S::ZERO; 3]);
    let image = Image { f, low: low.expect("eight"), high: high.expect("eight"), error };
    (image, Vec3([S::of(x[24]), S::of(x[25]), S::of(x[26])]))
}

/// Measured: the error of a direction's product with corners that are exact, of what is left of the whole bound then.
#[test]
fn inclusion_shadow() {
    fn of<S: Grid>(name: &str) {
        let ratio = |x: &[f64]| {
            let (image, d) = image::<S>(x);
            let (said, bound) = image.projection(d, image.slack());
            let error = |i: usize| (Exact::of(said[i]) - dot(&point(d), &point(image.f[i]))).abs();
            (0..8).map(|i| error(i).over(&Exact::of(bound))).fold(0.0, f64::max)
        };
        held("INCLUSION_SHADOW", name, &Hunt::new(34).most::<S>(|r| plain(r, 27), ratio));
    }
    of::<f32>("f32");
    of::<f64>("f64");
}

/// How much of `1 + 8u` a computed number uses up that must not be below `truth`.
fn used_up<S: Grid>(said: S, truth: &Exact) -> f64 {
    let more = Exact::of(S::INCLUSION_UP) - Exact::of(1.0);
    (Exact::of(S::INCLUSION_UP) * truth - Exact::of(said)).over(&(more * truth))
}

/// Measured: how much of the factor roundings use up, where a sum of products bounds a projection's error, and where a
/// separation is taken along a direction (its square, so twice as much).
#[test]
fn inclusion_up() {
    fn of<S: Grid>(name: &str) {
        let sum = |x: &[f64]| {
            let (image, d) = image::<S>(x);
            let slack = image.slack();
            used_up(image.projection(d, slack).1, &dot_abs(&point(d), &point(slack)))
        };
        held("INCLUSION_UP", &format!("{name}, of a sum"), &Hunt::new(35).most::<S>(|r| plain(r, 27), sum));
        let length = |x: &[f64]| {
            let m = Face::<S>::of(&four::<S>(&x[3..]));
            let (m, d) = (Face { separation: S::of(x[27].abs()), ..m }, Vec3([x[0], x[1], x[2]].map(S::of)));
            // For the first order in u: (1 + e)^2 - 1 is 2e.
            let said = Exact::of(m.apart(d));
            let truth = Exact::of(m.separation) * Exact::of(m.separation) * dot(&point(d), &point(d));
            let up = Exact::of(S::INCLUSION_UP);
            let more = (Exact::of(S::INCLUSION_UP) - Exact::of(1.0)) * Exact::of(2.0) * &truth;
            (&(&up * &up) * &truth - &said * &said).over(&more)
        };
        let found = Hunt::new(36).most::<S>(|r| plain(r, 28), length);
        held("INCLUSION_UP", &format!("{name}, of a length"), &found);
    }
    of::<f32>("f32");
    of::<f64>("f64");
}

/// Measured: how much of the factor roundings use up, where a part of a range is cut off: from two computed products
/// with faces on either side of the origin to the new end of the range, taken where it is on the grid.
#[test]
fn inclusion_down() {
    fn of<S: Grid>(name: &str) {
        let one = Exact::of(1.0);
        let ratio = |x: &[f64]| {
            let [a, b, error] = [0, 1, 2].map(|i| S::of(x[i].abs()));
            let width = parameter::<S>(x[3]);
            let mut cuts = Cuts::none();
            let s: [S; 8] = std::array::from_fn(|i| if i % 2 == 0 { a } else { -b });
            let cell = Cell { low: Vec3([S::ZERO; 3]), high: Vec3([width, S::ONE, S::ONE]) };
            if !cuts.projection(&s, error, S::ZERO, 9) {
                return f64::NAN;
            }
            let [low, high] = cuts.parts();
            let Some(rest) = cell.without(low, high) else { return f64::NAN };
            // The line from a to -b, less twice the error, is not below zero up to here.
            let over = (Exact::of(a) - Exact::of(error) * Exact::of(2.0)) * Exact::of(width);
            let under = Exact::of(a) + Exact::of(b);
            let down = Exact::of(S::INCLUSION_DOWN);
            (Exact::of(rest.low[0]) * under - &down * &over).over(&((&one - &down) * over))
        };
        let start =
            |r: &mut SmallRng| [0.9, 0.1, 0.001, 0.99].iter().map(|x| x * r.random_range(0.9..1.0)).collect();
        held("INCLUSION_DOWN", name, &Hunt { starts: 12, ..Hunt::new(37) }.most::<S>(start, ratio));
    }
    of::<f32>("f32");
    of::<f64>("f64");
}

/// The allowance is a round power of two, far above a hundred halves of the smallest number, and what is lost is less: one
/// of the input, two of the point between the times, up to four of a mixture, for each axis of a direction and one more
/// for its product. Measured: the error of a product with corners that are faint on two axes and plain on the third, where
/// the direction has nothing; its relative bound does not cover it.
#[test]
fn inclusion_underflow() {
    fn of<R: Real, S: Grid, const N: usize>(name: &str, least: f64)
    where
        Local<S, N>: Pair<N>,
    {
        let half = Exact::of(least) * Exact::of(0.5);
        let ratio = |x: &[f64]| {
            let (image, truth) = corner::<R, S, N>(x);
            let d = Vec3([S::of(x[27].clamp(-1.0, 1.0)), S::of(x[28].clamp(-1.0, 1.0)), S::ZERO]);
            if N == 3 && parameter::<S>(x[25]) + parameter::<S>(x[26]) > S::ONE {
                return f64::NAN;
            }
            let (said, _) = image.projection(d, image.slack());
            // All relative bounds together are below that.
            let reach = point(image.low.map(S::abs).max(image.high.map(S::abs)));
            let covered = Exact::of(S::U) * Exact::of(20.0) * dot_abs(&point(d), &reach);
            ((Exact::of(said[0]) - dot(&point(d), &truth)).abs() - covered).over(&half)
        };
        // Two coordinates of each point are of few of the smallest numbers.
        let start = |r: &mut SmallRng| {
            let size = |i: usize| if i < 24 && i % 3 < 2 { least } else { 1.0 };
            (0..29).map(|i| size(i) * r.random_range(-9.0..9.0) / if i < 24 { 1.0 } else { 9.0 }).collect()
        };
        let found = Hunt { starts: 12, ..Hunt::new(38) }.most::<R>(start, ratio);
        let allowed = Exact::of(S::INCLUSION_UNDERFLOW).over(&half);
        argued("INCLUSION_UNDERFLOW", name, &found, 16.0, allowed / 100.0);
    }
    of::<f64, f32, 3>("f64 in f32, vertex/face", f64::from(f32::from_bits(1)));
    of::<f64, f32, 4>("f64 in f32, edge/edge", f64::from(f32::from_bits(1)));
    of::<f64, f64, 4>("f64, edge/edge", f64::from_bits(1));
}

/// Measured: the error of the determinant of three rows of components up to one, of what decides that it is not zero.
#[test]
fn inclusion_regular() {
    fn of<S: Grid>(name: &str) {
        let ratio = |x: &[f64]| {
            let rows: [Vec3<S>; 3] =
                std::array::from_fn(|i| Vec3(std::array::from_fn(|k| S::of(x[3 * i + k].clamp(-1.0, 1.0)))));
            let [a, b, c] = rows;
            let truth = det(&point(b), &point(c), &point(a));
            (Exact::of(volume(a, b, c)) - truth).abs().over(&Exact::of(S::INCLUSION_REGULAR))
        };
        let start = |r: &mut SmallRng| (0..9).map(|_| 0.999 * plain(r, 1)[0].signum()).collect();
        let found = Hunt { starts: 20, ..Hunt::new(39) }.most::<S>(start, ratio);
        held("INCLUSION_REGULAR", name, &found);
    }
    of::<f32>("f32");
    of::<f64>("f64");
}

/// Measured: a corner at a time, as `stage::narrow::sift` mixes it, of what its box grows by for it.
#[test]
fn inclusion_input_of_a_mixture() {
    fn of<R: Real>() -> Found {
        let ratio = |x: &[f64]| {
            let [t0, t1, a, b] = [0, 1, 2, 3].map(|i| R::of(x[i]));
            let t = a.abs() / (a.abs() + b.abs());
            let said = t0 * (R::ONE - t) + t1 * t;
            let [from, to, at] = [t0, t1, t].map(Exact::of);
            let truth = &from * &(Exact::of(R::ONE) - &at) + &to * &at;
            let bound = R::INCLUSION_INPUT * t0.abs().max(t1.abs()) + R::INCLUSION_UNDERFLOW;
            (Exact::of(said) - &truth).abs().over(&Exact::of(bound))
        };
        Hunt::new(33).most::<R>(|r| plain(r, 4), ratio)
    }
    held("INCLUSION_INPUT", "a mixture, f32", &of::<f32>());
    held("INCLUSION_INPUT", "a mixture, f64", &of::<f64>());
}
