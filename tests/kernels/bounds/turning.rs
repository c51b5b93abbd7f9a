//! Turning bodies: `math::angle`, `math::turn` and `prim::turning`, against enclosures of 106 bits.

use super::exact::{Exact, cross, dot, less, point};
use super::hunt::{Hunt, argued, held, plain};
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::math::angle::Angle;
use nearmiss_kernels::math::tolerance::U64;
use nearmiss_kernels::math::tolerance::turning::{
    ANGLE, TURN, TURN_BETWEEN, TURN_UP, TURNING_AXIS, TURNING_CURVE, TURNING_PLACE, TURNING_UP,
    TURNING_VOLUME,
};
use nearmiss_kernels::math::turn::{Turn, between, bulge};
use nearmiss_kernels::prim::turning::rates::Rates;
use nearmiss_kernels::prim::turning::{Motion, Place, Side};
use nearmiss_lab::oracle::turning::{Ball, Vector, sine_cosine, turned};
use rand::Rng;
use rand::rngs::SmallRng;
use std::f64::consts::{PI, TAU};

/// Three numbers as a vector.
fn three(x: &[f64]) -> Vec3<f64> {
    Vec3([x[0], x[1], x[2]])
}

/// A time in [0, 1].
fn time(x: f64) -> f64 {
    x.abs() - x.abs().floor()
}

/// A rotation vector of at most a full turn.
fn rotation(x: &[f64]) -> Option<Vec3<f64>> {
    let phi = three(x) * TAU;
    (phi.dot(phi) <= TAU * TAU).then_some(phi)
}

/// How far a computed vector is from the truth.
fn error(computed: Vec3<f64>, truth: Vector<Ball>) -> f64 {
    let off = Vector::of(computed.0) - truth;
    off.dot(off).at_most().sqrt()
}

/// The length of a vector.
fn length(x: Vec3<f64>) -> f64 {
    x.dot(x).sqrt()
}

/// Measured: the error of `sinc` and of the cosine of an angle in [0, pi].
#[test]
fn angle() {
    let ratio = |x: &[f64]| {
        let h = x[0].abs() * PI;
        if !(h > 0.0 && h <= PI) {
            return f64::NAN;
        }
        let (sine, cosine) = sine_cosine(Ball::of(h));
        let Angle { sinc, cos } = Angle::of(h);
        let off = [sine / Ball::of(h) - Ball::of(sinc), cosine - Ball::of(cos)].map(Ball::at_most);
        off[0].max(off[1]) / ANGLE
    };
    held("ANGLE", "f64", &Hunt::new(101).most::<f64>(|r| plain(r, 1), ratio));
    assert_eq!(Angle::of(0.0), Angle { sinc: 1.0, cos: 1.0 });
}

/// Measured: the error of a point that is turned on, and back.
#[test]
fn turn() {
    let ratio = |x: &[f64]| {
        let (Some(phi), r, t) = (rotation(x), three(&x[3..]), time(x[6])) else { return f64::NAN };
        let turn = Turn::new(phi);
        let on = error(turn.rotated(t, r), turned(phi.0, t, Vector::of(r.0)));
        let back = error(turn.rotated_back(t, r), turned((-phi).0, t, Vector::of(r.0)));
        on.max(back) / (TURN * length(r))
    };
    held("TURN", "f64", &Hunt::new(102).most::<f64>(|r| plain(r, 7), ratio));
}

/// Measured: the error of the rotation vector between two unit quaternions, by components.
#[test]
fn turn_between() {
    let ratio = |x: &[f64]| {
        let unit = |x: &[f64]| {
            let n = x.iter().map(|x| x * x).sum::<f64>().sqrt();
            [x[0] / n, x[1] / n, x[2] / n, x[3] / n]
        };
        let (q0, q1) = (unit(x), unit(&x[4..]));
        let ([a, b, c, d], [p, q, r, s]) = (q0.map(Ball::of), q1.map(Ball::of));
        let w = s * d + p * a + q * b + r * c;
        let v = Vector([
            p * d - s * a + (r * b - q * c),
            q * d - s * b + (p * c - r * a),
            r * d - s * c + (q * a - p * b),
        ]);
        let (w, v) = if w.is_negative() { (-w, v.times(Ball::of(-1.0))) } else { (w, v) };
        let sine = v.dot(v).sqrt();
        let whole = (w * w + v.dot(v)).sqrt();
        // The angle of the library, and what it lacks: a sine of 1e-16, next to its angle.
        let near = sine.middle().atan2(w.middle());
        let (s0, c0) = sine_cosine(Ball::of(near));
        let half = Ball::of(near) + (sine * c0 - w * s0) / whole;
        error(between(q0, q1), v.times((half + half) / sine)) / TURN_BETWEEN
    };
    held("TURN_BETWEEN", "f64", &Hunt::new(103).most::<f64>(|r| plain(r, 8), ratio));
}

/// Measured: how much of the factor the roundings of a bulge use up.
#[test]
fn turn_up() {
    let ratio = |x: &[f64]| {
        let angle = x[0].abs() * 3.0;
        if angle > 3.9 {
            return f64::NAN;
        }
        let truth = Exact::of(angle) * Exact::of(angle) * Exact::of(0.125);
        let more = Exact::of(TURN_UP) - Exact::of(1.0);
        (Exact::of(TURN_UP) * &truth - Exact::of(bulge(angle))).over(&(more * &truth))
    };
    held("TURN_UP", "f64", &Hunt::new(104).most::<f64>(|r| plain(r, 1), ratio));
}

/// Numbers of a pair and a time.
const NUMBERS: usize = 37;

/// A pair of which both sides turn: a vertex and a face, or two edges.
fn sides(x: &[f64]) -> Option<[Side; 2]> {
    let mut at = 0;
    let mut next = || {
        at += 3;
        three(&x[at - 3..])
    };
    let mut side = || {
        let phi = rotation(&next().0)?;
        let pivot = [next(), next()];
        let points = [next(), next(), next()].map(|p| [p, p]);
        Some(Side { phi, pivot, points })
    };
    Some([side()?, side()?])
}

/// The control vectors of a motion, exactly, in the frame of the second side and the motion's units.
fn truth<const N: usize>([a, b]: &[Side; 2], t: f64, scale: f64) -> [Vector<Ball>; N] {
    let mix = |x: &[Vec3<f64>; 2]| {
        let t = Ball::of(t);
        Vector::of(x[0].0).times(Ball::of(1.0) - t) + Vector::of(x[1].0).times(t)
    };
    let pivot = mix(&a.pivot) - mix(&b.pivot);
    std::array::from_fn(|i| {
        let (j, k) = if N == 3 { (0, i) } else { (i / 2, i % 2) };
        let y = pivot + turned(a.phi.0, t, mix(&a.points[j]));
        let w = turned((-b.phi).0, t, y) - mix(&b.points[k]);
        w.times(Ball::of(scale))
    })
}

/// Numbers of a pair that turns far: the worst that was found is a point that is turned twice, far from both pivots.
fn far(r: &mut SmallRng, n: usize) -> Vec<f64> {
    let mut x = plain(r, n);
    for at in [0, 18] {
        let phi = three(&x[at..]);
        let k = r.random_range(0.7..1.0) / length(phi);
        x[at..at + 3].copy_from_slice(&(phi * k).0);
        x[at + 3..at + 9].iter_mut().for_each(|x| *x *= 1e-3);
    }
    x[27..36].iter_mut().for_each(|x| *x *= 1e-3);
    x[36] = r.random_range(0.7..1.0);
    x
}

/// A longer search, from such pairs.
fn long(seed: u64) -> Hunt {
    Hunt { starts: 24, steps: 3_000, ..Hunt::new(seed) }
}

/// Counted are `134u` of the reach for what is computed; the rest is for what is given. Measured: the error of a control
/// vector of either kind.
#[test]
fn turning_place() {
    fn ratio<const N: usize>(x: &[f64]) -> f64 {
        let (Some(sides), t) = (sides(x), time(x[36])) else { return f64::NAN };
        let motion = Motion::<N>::new(&sides[0], &sides[1]);
        let (w, truth) = (motion.at(t).w, truth::<N>(&sides, t, motion.scale));
        let most = (0..N).map(|k| error(w[k], truth[k])).fold(0.0, f64::max);
        most / (motion.error / TURNING_PLACE) / U64
    }
    let found = long(105).most::<f64>(|r| far(r, NUMBERS), ratio::<3>);
    argued("TURNING_PLACE", "vertex/face", &found, 134.0, TURNING_PLACE / U64);
    let found = long(106).most::<f64>(|r| far(r, NUMBERS), ratio::<4>);
    argued("TURNING_PLACE", "edge/edge", &found, 134.0, TURNING_PLACE / U64);
    // An error of one unit would be far too little.
    assert!(found.ratio > 2.0);
}

/// The control vectors at three times, and the bounds over them.
struct Slice<const N: usize> {
    places: [Place<N>; 3],
    chord: f64,
    parabola: f64,
}

fn slice<const N: usize>(motion: &Motion<N>, from: f64, time: f64) -> Slice<N> {
    let places = [from, from + 0.5 * time, from + time].map(|t| motion.at(t));
    let bounds = motion.bounds(&places[0], &places[2]);
    Slice { places, chord: bounds.chord, parabola: bounds.parabola }
}

/// How far a vector is from the curves of a slice, at a part of it: from the chord, and from the parabola.
fn off<const N: usize>(s: &Slice<N>, k: usize, part: f64, w: Vector<Ball>) -> [f64; 2] {
    let [a, m, e] = [0, 1, 2].map(|i| Vector::of(s.places[i].w[k].0));
    let (t, half) = (Ball::of(part), Ball::of(0.5));
    let back = Ball::of(1.0) - t;
    let chord = a.times(back) + e.times(t);
    let middle = m + m - (a + e).times(half);
    let parabola = a.times(back * back) + middle.times(t * back + t * back) + e.times(t * t);
    [chord, parabola].map(|curve| {
        let off = w - curve;
        off.dot(off).at_most().sqrt()
    })
}

/// Counted are `1.25 (134u + 15u)` and some roundings, `190u`, for what is computed; the rest is for what is given and for
/// products. Measured: how far a control vector is from a parabola through its computed places, beyond the deviation.
#[test]
fn turning_curve() {
    fn ratio<const N: usize>(x: &[f64]) -> f64 {
        let (Some(sides), from, part) = (sides(x), time(x[36]), time(x[37])) else { return f64::NAN };
        let motion = Motion::<N>::new(&sides[0], &sides[1]);
        // So short that the deviation is less than the errors.
        let (from, time) = (0.9 * from, f64::from(1u32 << 10) * f64::EPSILON * f64::from(1u32 << 20));
        let s = slice(&motion, from, time);
        let t = from + part * time;
        let truth = truth::<N>(&sides, t, motion.scale);
        let part = (t - from) / time;
        let most = (0..N).map(|k| off(&s, k, part, truth[k])[1] - s.parabola).fold(0.0, f64::max);
        most / (motion.error / TURNING_PLACE) / U64
    }
    let allowed = TURNING_CURVE * TURNING_PLACE / U64;
    let found = long(107).most::<f64>(|r| far(r, NUMBERS + 1), ratio::<3>);
    argued("TURNING_CURVE", "vertex/face", &found, 190.0, allowed);
    let found = long(108).most::<f64>(|r| far(r, NUMBERS + 1), ratio::<4>);
    argued("TURNING_CURVE", "edge/edge", &found, 190.0, allowed);
}

/// Measured: how far a control vector leaves its chord and its parabola over a long slice, of what is allowed. Half of
/// it is reached, so bounds of a fiftieth would be broken.
#[test]
fn deviations() {
    fn most<const N: usize>(x: &[f64], which: usize) -> f64 {
        let (Some(sides), part) = (sides(x), time(x[37])) else { return f64::NAN };
        let (from, long) = (0.5 * time(x[36]), 0.02 + 0.48 * time(x[38]));
        let motion = Motion::<N>::new(&sides[0], &sides[1]);
        let s = slice(&motion, from, long);
        let t = from + part * long;
        let truth = truth::<N>(&sides, t, motion.scale);
        let off = (0..N).map(|k| off(&s, k, (t - from) / long, truth[k])[which]).fold(0.0, f64::max);
        off / ([s.chord, s.parabola][which] + 2.0 * motion.error)
    }
    for which in 0..2 {
        let name = ["of chords", "of parabolas"][which];
        let hunt = Hunt { steps: 2_500, ..Hunt::new(109 + which as u64) };
        let found = hunt.most::<f64>(|r| plain(r, NUMBERS + 2), |x| most::<3>(x, which));
        println!("deviations {name}, vertex/face: {:.3} of the bound", found.ratio);
        assert!(found.ratio <= 1.0 && found.ratio > 0.3, "{name}: {found:?}");
        let found = hunt.most::<f64>(|r| plain(r, NUMBERS + 2), |x| most::<4>(x, which));
        println!("deviations {name}, edge/edge: {:.3} of the bound", found.ratio);
        assert!(found.ratio <= 1.0 && found.ratio > 0.3, "{name}: {found:?}");
    }
}

/// Measured: the error of a triple product of the control vectors as computed.
#[test]
fn turning_volume() {
    fn ratio<const N: usize>(x: &[f64]) -> f64 {
        let Some(sides) = sides(x) else { return f64::NAN };
        let place = Motion::<N>::new(&sides[0], &sides[1]).at(time(x[36]));
        let w = place.w.map(point);
        let [p, q] = if N == 3 {
            [1, 2].map(|k| less(&w[0], &w[k]))
        } else {
            [less(&w[2], &w[0]), less(&w[0], &w[1])]
        };
        let truth = dot(&cross(&p, &q), &w[0]);
        let squares = dot(&p, &p) * dot(&q, &q) * dot(&w[0], &w[0]);
        let off = Exact::of(place.volume) - &truth;
        (&off * &off).over(&squares).sqrt() / TURNING_VOLUME
    }
    for (of, found) in [
        ("vertex/face", Hunt::new(111).most::<f64>(|r| plain(r, NUMBERS), ratio::<3>)),
        ("edge/edge", Hunt::new(112).most::<f64>(|r| plain(r, NUMBERS), ratio::<4>)),
    ] {
        held("TURNING_VOLUME", of, &found);
    }
}

/// Measured: the part of a rotation vector that is across the common axis.
#[test]
fn turning_axis() {
    let zero = [[Vec3([0.0; 3]); 2]; 3];
    let ratio = |x: &[f64]| {
        let (a, b) = (three(x), three(x) * x[3]);
        let rates = Rates::of(a, b, &zero[0], &[zero[0], zero[1]], &zero);
        if !rates.has_axis {
            return f64::NAN;
        }
        let across = |phi: Vec3<f64>| {
            let c = cross(&point(phi), &point(rates.axis));
            dot(&c, &c).over(&dot(&point(phi), &point(phi))).sqrt()
        };
        across(a).max(across(b)) / TURNING_AXIS
    };
    held("TURNING_AXIS", "f64", &Hunt::new(113).most::<f64>(|r| plain(r, 4), ratio));
}

/// Measured: how much of the factor the roundings of a bound use up: of the third derivative of points that move in a
/// turning frame, `3 wb^2 (u + v)`.
#[test]
fn turning_up() {
    let zero = [Vec3([0.0; 3]); 2];
    let ratio = |x: &[f64]| {
        let (phi, way, change) = (three(x), three(&x[3..]), three(&x[6..]));
        let start = Vec3([0.0; 3]);
        let rates = Rates::of(start, phi, &[start, way], &[[start, change]; 2], &[zero; 3]);
        let long = |x: Vec3<f64>| {
            let x = Vector::of(x.0);
            x.dot(x).sqrt()
        };
        let w = long(phi);
        let truth = Ball::of(3.0) * w * w * (long(way) + long(change));
        let left = truth * Ball::of(TURNING_UP) - Ball::of(rates.third.own);
        (left / (truth * Ball::of(TURNING_UP - 1.0))).middle()
    };
    held("TURNING_UP", "f64", &Hunt::new(114).most::<f64>(|r| plain(r, 9), ratio));
}
