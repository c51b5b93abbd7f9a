//! The closed form: `prim::isolate`.

use super::cubic::{four, vectors};
use super::exact::{Exact, Point, cross, det, dot, dot_abs, larger, less, point};
use super::hunt::{Found, Hunt, argued, held, plain};
use nearmiss_kernels::math::tolerance::Tolerance;
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::{Grid, Params};
use nearmiss_kernels::prim::isolate::nearest::nearest;
use nearmiss_kernels::prim::isolate::{Edges, Face, Pair};
use rand::Rng;
use rand::rngs::SmallRng;

/// A pair as a kernel scales it.
trait Scaled<const N: usize>: Sized {
    fn of<R: Real>(x: &[Moving<R>; 4]) -> Self;
}
impl<S: Grid> Scaled<3> for Face<S> {
    fn of<R: Real>(x: &[Moving<R>; 4]) -> Self {
        Face::new(x[0], [x[1], x[2], x[3]], &Params::new(0.0))
    }
}
impl<S: Grid> Scaled<4> for Edges<S> {
    fn of<R: Real>(x: &[Moving<R>; 4]) -> Self {
        Edges::new([x[0], x[1]], [x[2], x[3]], &Params::new(0.0))
    }
}

/// The control vectors at both ends exactly, in the kernel's units.
fn controls<R: Real, S: Grid, const N: usize>(x: &[Moving<R>; 4], pair: &Pair<S, N>) -> [[Point; 2]; N] {
    let p = x.map(|m| [point(m.t0), point(m.t1)]);
    let scale = Exact::of(pair.scale);
    let of = |i: usize| if N == 3 { (0, 1 + i) } else { (i / 2, 2 + i % 2) };
    std::array::from_fn(|i| [0, 1].map(|t| less(&p[of(i).0][t], &p[of(i).1][t]).map(|x| x * &scale)))
}

/// A control vector at a time.
fn at([start, end]: &[Point; 2], t: &Exact) -> Point {
    let before = &Exact::of(1.0) - t;
    [0, 1, 2].map(|k| &start[k] * &before + &end[k] * t)
}

/// A time in [0, 1] of any precision.
fn time<S: Real>(x: f64) -> S {
    S::of(x.abs() - x.abs().floor())
}

/// The largest magnitude of a component.
fn largest(v: &Point) -> Exact {
    v.iter().map(|x| x.clone().abs()).fold(Exact::zero(), larger)
}

/// Five kinds are measured each time.
fn brief(seed: u64) -> Hunt {
    Hunt { starts: 4, steps: 700, ..Hunt::new(seed) }
}

/// Measures both kinds of pairs in f32, of f64 in f32, and in f64: of 24 coordinates and `more` numbers.
macro_rules! each_pair {
    ($constant:expr, $hunt:expr, $more:expr, $ratio:ident) => {
        for (of, found) in [
            ("f32, vertex/face", $hunt.most::<f32>(|r| plain(r, 24 + $more), $ratio::<f32, f32, 3>)),
            ("f32, edge/edge", $hunt.most::<f32>(|r| plain(r, 24 + $more), $ratio::<f32, f32, 4>)),
            ("f64 in f32, edge/edge", $hunt.most::<f64>(|r| plain(r, 24 + $more), $ratio::<f64, f32, 4>)),
            ("f64, vertex/face", $hunt.most::<f64>(|r| plain(r, 24 + $more), $ratio::<f64, f64, 3>)),
            ("f64, edge/edge", $hunt.most::<f64>(|r| plain(r, 24 + $more), $ratio::<f64, f64, 4>)),
        ] {
            held($constant, of, &found);
        }
    };
}

/// The errors of the four coefficients over a part of the step, and their bound.
fn coefficients<R: Real, S: Grid, const N: usize>(x: &[f64]) -> ([Exact; 4], Exact)
where
    Pair<S, N>: Scaled<N>,
{
    let points = four::<R>(x);
    let pair = Pair::<S, N>::of(&points);
    let (from, to) = (time::<S>(x[24]), time::<S>(x[25]));
    let cubic = pair.cubic();
    let said = cubic.part(from, to);
    let scale = Exact::of(pair.scale);
    let v = vectors(&points, N == 3).map(|ends| ends.map(|p| p.map(|x| x * &scale)));
    // The offset is to the first of the others in either case; for edges the kernel takes it the other way.
    let sign = if N == 3 { Exact::of(1.0) } else { Exact::of(-1.0) };
    let (s, t) = (Exact::of(from), Exact::of(to));
    // Six times the blossom.
    let blossom = |times: [&Exact; 3]| {
        let one = |i: usize, j: usize, k: usize| {
            det(&at(&v[0], times[i]), &at(&v[1], times[j]), &at(&v[2], times[k]))
        };
        (one(0, 1, 2) + one(0, 2, 1) + one(1, 0, 2) + one(1, 2, 0) + one(2, 0, 1) + one(2, 1, 0)) * &sign
    };
    let truths = [blossom([&s, &s, &s]), blossom([&s, &s, &t]), blossom([&s, &t, &t]), blossom([&t, &t, &t])];
    let six = Exact::of(6.0);
    let errors = std::array::from_fn(|i| (Exact::of(said[i]) * &six - &truths[i]).abs());
    (errors, Exact::of(cubic.error) * six)
}

/// Measured: the error of a coefficient over a part of the step, of its whole bound.
#[test]
fn isolate_cubic() {
    fn ratio<R: Real, S: Grid, const N: usize>(x: &[f64]) -> f64
    where
        Pair<S, N>: Scaled<N>,
    {
        let (errors, bound) = coefficients::<R, S, N>(x);
        errors.iter().map(|e| e.over(&bound)).fold(0.0, f64::max)
    }
    each_pair!("ISOLATE_CUBIC", brief(71), 2, ratio);
}

/// The allowance is a round power of two. Counted are, in a coefficient, the 18 inputs of six products of three, rounded from
/// f64 by half the smallest number each and met by two factors below two; products and mixtures lose less. Measured: what
/// is lost where one axis is faint, beyond the relative bound.
#[test]
fn isolate_underflow() {
    fn ratio<R: Real, S: Grid>(x: &[f64], half: &Exact) -> f64 {
        let (errors, bound) = coefficients::<R, S, 3>(x);
        let six = Exact::of(6.0);
        let covered = bound - Exact::of(S::ISOLATE_UNDERFLOW) * &six;
        let most = errors.into_iter().fold(Exact::zero(), larger);
        (most - covered).over(&(half * &six))
    }
    fn start(r: &mut SmallRng, least: f64) -> Vec<f64> {
        let size = |i: usize| if i < 24 && i.is_multiple_of(3) { least } else { 0.1 };
        (0..26).map(|i| size(i) * r.random_range(-9.0..9.0)).collect()
    }
    let least = f64::from(f32::from_bits(1));
    let half = Exact::pow2(-150);
    let hunt = Hunt { starts: support::cases(5, 16), ..Hunt::new(72) };
    let found = hunt.most::<f64>(|r| start(r, least), |x| ratio::<f64, f32>(x, &half));
    argued("ISOLATE_UNDERFLOW", "f64 in f32", &found, 72.0, Exact::of(f32::ISOLATE_UNDERFLOW).over(&half));
    let half = Exact::pow2(-1075);
    let least = f64::from_bits(1);
    let found = hunt.most::<f64>(|r| start(r, least), |x| ratio::<f64, f64>(x, &half));
    argued("ISOLATE_UNDERFLOW", "f64", &found, 72.0, Exact::of(f64::ISOLATE_UNDERFLOW).over(&half));
}

/// Measured: the error of a component of a control vector at a time, of what it may be beyond the motion.
#[test]
fn isolate_place() {
    fn ratio<R: Real, S: Grid, const N: usize>(x: &[f64]) -> f64
    where
        Pair<S, N>: Scaled<N>,
    {
        let points = four::<R>(x);
        let pair = Pair::<S, N>::of(&points);
        let t = time::<S>(x[24]);
        let bound = Exact::of(S::ISOLATE_PLACE) * Exact::of(pair.reach);
        let (said, w) = (pair.at(t), controls(&points, &pair));
        let error = |i: usize| largest(&less(&point(said[i]), &at(&w[i], &Exact::of(t))));
        (0..N).map(|i| error(i).over(&bound)).fold(0.0, f64::max)
    }
    each_pair!("ISOLATE_PLACE", brief(73), 1, ratio);
}

/// Premises of a look at the hull: corners as computed, a direction, and how far corners may be
/// from the exact ones within `half` of a time.
struct Looked<S: Real, const N: usize> {
    x: [Vec3<S>; N],
    n: Vec3<S>,
    reach: S,
    rho: S,
}

impl<S: Grid, const N: usize> Looked<S, N> {
    fn at(pair: &Pair<S, N>, t: S, half: S) -> Self {
        let x = pair.at(t);
        let reach = x.iter().flat_map(|v| v.0).map(S::abs).fold(S::ZERO, S::max);
        let rho = S::ISOLATE_PLACE * pair.reach + half * pair.speed * S::INCLUSION_UP;
        Looked { x, n: (x[1] - x[0]).cross(x[2] - x[0]), reach, rho }
    }
    fn around(&self, k: usize) -> [usize; 2] {
        let ring = |k: usize| if N == 3 { k % 3 } else { [0, 1, 3, 2][k % 4] };
        [ring(k), ring(k + 1)]
    }
    fn turn(&self, k: usize) -> S {
        let [i, j] = self.around(k);
        self.n.dot(self.x[i].cross(self.x[j]))
    }
}

/// Measured: the roundings of a turn, of what is allowed for them.
#[test]
fn isolate_turn() {
    fn ratio<R: Real, S: Grid, const N: usize>(x: &[f64]) -> f64
    where
        Pair<S, N>: Scaled<N>,
    {
        let pair = Pair::<S, N>::of(&four::<R>(x));
        let look = Looked::at(&pair, time::<S>(x[24]), S::ZERO);
        let (n, reach) = (point(look.n), Exact::of(look.reach));
        let bound = Exact::of(S::ISOLATE_TURN) * Exact::of(6.0) * largest(&n) * &reach * &reach;
        let error = |k: usize| {
            let [i, j] = look.around(k).map(|i| point(look.x[i]));
            (Exact::of(look.turn(k)) - dot(&n, &cross(&i, &j))).abs()
        };
        (0..N).map(|k| error(k).over(&bound)).fold(0.0, f64::max)
    }
    each_pair!("ISOLATE_TURN", Hunt::new(74), 1, ratio);
}

/// Measured: how far a turn is from that of the exact corners at either end of a time around it, of the whole bound that
/// says whether the hull holds the origin. Random pairs come to a twelfth; the search is led to motions that turn
/// corners as fast as they can.
#[test]
fn turns_around_a_time_stay_within_their_bound() {
    fn ratio<R: Real, S: Grid, const N: usize>(x: &[f64]) -> f64
    where
        Pair<S, N>: Scaled<N>,
    {
        let points = four::<R>(x);
        let pair = Pair::<S, N>::of(&points);
        let (t, half) = (time::<S>(x[24]), time::<S>(x[25]));
        let w = controls(&points, &pair);
        let look = Looked::at(&pair, t, half);
        let (n, rho, reach) = (point(look.n), Exact::of(look.rho), Exact::of(look.reach));
        let inner =
            Exact::of(2.0) * &rho * &reach + &rho * &rho + Exact::of(S::ISOLATE_TURN) * &reach * &reach;
        let bound = Exact::of(6.0) * largest(&n) * inner;
        let mut most = 0f64;
        for end in [Exact::of(t) - Exact::of(half), Exact::of(t) + Exact::of(half)] {
            for k in 0..N {
                let [y, z] = look.around(k).map(|i| at(&w[i], &end));
                let error = Exact::of(look.turn(k)) - dot(&n, &cross(&y, &z));
                most = most.max(error.abs().over(&bound));
            }
        }
        most
    }
    each_pair!("the whole bound of a turn", brief(75), 2, ratio);
}

/// Measured: the roundings of a direction's product with a corner, of what is allowed for them.
#[test]
fn isolate_side() {
    fn ratio<R: Real, S: Grid, const N: usize>(x: &[f64]) -> f64
    where
        Pair<S, N>: Scaled<N>,
    {
        let pair = Pair::<S, N>::of(&four::<R>(x));
        let look = Looked::at(&pair, time::<S>(x[24]), S::ZERO);
        let d = look.n.cross(look.x[1] - look.x[0]);
        let ones = [1.0; 3].map(Exact::of);
        let bound = Exact::of(S::ISOLATE_SIDE) * dot_abs(&point(d), &ones) * Exact::of(look.reach);
        let error = |i: usize| (Exact::of(d.dot(look.x[i])) - dot(&point(d), &point(look.x[i]))).abs();
        (0..N).map(|i| error(i).over(&bound)).fold(0.0, f64::max)
    }
    each_pair!("ISOLATE_SIDE", brief(76), 1, ratio);
}

/// Measured: how much of what a window is widened by is used up at either end, by its own roundings too.
#[test]
fn isolate_window() {
    fn ratio<R: Real, S: Grid, const N: usize>(x: &[f64]) -> f64
    where
        Pair<S, N>: Scaled<N>,
    {
        let points = four::<R>(x);
        let pair = Pair::<S, N>::of(&points);
        let Some((from, to)) = pair.window() else { return f64::NAN };
        if !(from > S::ZERO && to < S::ONE) {
            return f64::NAN;
        }
        let w = controls(&points, &pair);
        // Times as fractions: later ones bound the begin, earlier ones the end.
        let (mut begin, mut end) = (f64::INFINITY, f64::INFINITY);
        let (zero, width) = (Exact::zero(), Exact::of(S::ISOLATE_WINDOW));
        for k in 0..3 {
            for sign in [1.0, -1.0].map(Exact::of) {
                let most =
                    |t: usize| w.iter().map(|w| &w[t][k] * &sign).reduce(larger).expect("three or four");
                let (d0, d1) = (most(0), most(1));
                let (over, under) = if d0 < zero && d1 > zero {
                    (-&d0, &d1 - &d0)
                } else if d0 > zero && d1 < zero {
                    (d0.clone(), &d0 - &d1)
                } else {
                    continue;
                };
                let used = |said: S, late: f64| {
                    let late = Exact::of(late) * (Exact::of(said) * &under - &over);
                    late.over(&(&width * &under)) + 1.0
                };
                if d0 < zero { begin = begin.min(used(from, 1.0)) } else { end = end.min(used(to, -1.0)) }
            }
        }
        let most = begin.max(end);
        if most.is_finite() { most } else { f64::NAN }
    }
    each_pair!("ISOLATE_WINDOW", Hunt { starts: 12, ..brief(77) }, 0, ratio);
    // An axis on which differences underflow must not give a time.
    let faint = |r: &mut SmallRng| {
        let size = |i: usize| if i.is_multiple_of(3) { f64::from(f32::from_bits(4)) } else { 1.0 };
        plain(r, 24).into_iter().enumerate().map(|(i, x)| size(i) * x).collect()
    };
    let hunt = Hunt { starts: 40, ..brief(77) };
    held("ISOLATE_WINDOW", "f64 in f32, an axis faint", &hunt.most::<f64>(faint, ratio::<f64, f32, 3>));
}

/// Measured: the error of a direction's product with a control vector at a time, as a part of a
/// component's error times the direction's sum. In f32 also the distance of the computed nearest
/// point from the exact hull (computed in f64).
#[test]
fn advance_point() {
    fn ratio<R: Real, S: Grid, const N: usize>(x: &[f64]) -> f64
    where
        Pair<S, N>: Scaled<N>,
    {
        let points = four::<R>(x);
        let pair = Pair::<S, N>::of(&points);
        let (t, n) = (time::<S>(x[24]), Vec3([S::of(x[25]), S::of(x[26]), S::of(x[27])]));
        let (said, w) = (pair.at(t), controls(&points, &pair));
        let ones = [1.0; 3].map(Exact::of);
        let bound = Exact::of(S::ADVANCE_POINT) * Exact::of(pair.reach) * dot_abs(&point(n), &ones);
        let error = |i: usize| (Exact::of(n.dot(said[i])) - dot(&point(n), &at(&w[i], &Exact::of(t)))).abs();
        (0..N).map(|i| error(i).over(&bound)).fold(0.0, f64::max)
    }
    each_pair!("ADVANCE_POINT", brief(78), 4, ratio);
    fn off<const N: usize>(name: &str)
    where
        Pair<f32, N>: Scaled<N>,
    {
        let ratio = |x: &[f64]| {
            let points = four::<f32>(x);
            let pair = Pair::<f32, N>::of(&points);
            let t = time::<f32>(x[24]);
            let p = nearest(&pair.at(t)).wide();
            let exactly = controls(&points, &pair)
                .map(|w| Vec3(at(&w, &Exact::of(t)).map(|x| x.over(&Exact::of(1.0)))) - p);
            let gap = nearest(&exactly);
            gap.0.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
                / f64::from(f32::ADVANCE_POINT * pair.reach)
        };
        let found: Found = Hunt::new(79).most::<f32>(|r| plain(r, 25), ratio);
        held("ADVANCE_POINT", name, &found);
    }
    off::<3>("f32, the nearest point of a face");
    off::<4>("f32, the nearest point of two edges");
}
