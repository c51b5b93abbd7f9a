//! The catalogue's pairs, by the certified tests themselves; and how near things are when they
//! stop.

use super::inclusion::{certified, in_passes};
use super::random;
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::{Params, Verdict};
use nearmiss_lab::Features;
use nearmiss_lab::robustness::{Question, questions};
use rand::Rng;

type Four = [[f64; 3]; 4];

fn moving(t0: &Four, t1: &Four) -> [Moving<f64>; 4] {
    [0, 1, 2, 3].map(|i| Moving { t0: Vec3(t0[i]), t1: Vec3(t1[i]) })
}

/// Verdicts in f64, in f32 and in passes; and, if the numbers are exact there, from positions in
/// f32. True: in f32 alone.
fn said(q: &Question) -> Vec<(&'static str, Verdict, bool)> {
    let x = moving(&q.case.positions_t0, &q.case.positions_t1);
    let (face, p) = (q.case.features == Features::VertexFace, q.params());
    let mut all = vec![
        ("f64", certified::<f64, f64>(x, face, &p), false),
        ("f32", certified::<f64, f32>(x, face, &p), true),
        ("in passes", in_passes(x, face, &p), false),
    ];
    if q.case.fits_f32() {
        let to = |x: Vec3<f64>| x.map(|x| x as f32);
        let x = x.map(|m| Moving { t0: to(m.t0), t1: to(m.t1) });
        all.push(("f32 positions, f32", certified::<f32, f32>(x, face, &p), true));
        all.push(("f32 positions, f64", certified::<f32, f64>(x, face, &p), false));
        all.push(("f32 positions, in passes", in_passes(x, face, &p), false));
    }
    all
}

#[test]
fn the_catalogue() {
    let mut wrong = Vec::new();
    for q in questions() {
        for (how, verdict, narrow) in said(&q) {
            if let Some(fault) = q.judge(&verdict, narrow) {
                wrong.push(format!("{} {}, {how}: {fault:?}: {verdict:?}, not {:?}", q.id, q.what, q.expect));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

const FACE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0]];

fn with(p: [f64; 3], f: [[f64; 3]; 3]) -> Four {
    [p, f[0], f[1], f[2]]
}

/// NaN rejects nothing; tiny and huge numbers give well-formed answers.
#[test]
fn any_bits() {
    let mut r = random(95);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for k in 0..24 {
            let mut t = [with([2.0, 2.0, 3.0], FACE), with([2.0, 2.0, 5.0], FACE)];
            t[k / 12][k / 3 % 4][k % 3] = bad;
            let x = moving(&t[0], &t[1]);
            for face in [true, false] {
                assert!(!certified::<f64, f64>(x, face, &Params::new(1e-3)).is_separated());
                assert!(!certified::<f64, f32>(x, face, &Params::new(1e-3)).is_separated());
            }
        }
        let far = moving(&with([2.0, 2.0, 3.0], FACE), &with([2.0, 2.0, 1.0], FACE));
        assert!(!certified::<f64, f32>(far, true, &Params::new(bad.abs())).is_contact());
        let p = Params { min_separation: bad.abs(), ..Params::new(1e-3) };
        let x = moving(&with([2.0, 2.0, 3.0], FACE), &with([2.0, 2.0, 5.0], FACE));
        assert!(!certified::<f64, f32>(x, true, &p).is_separated());
    }
    for _ in 0..10_000 {
        let mut point = || Vec3(std::array::from_fn(|_| f32::from_bits(r.random())));
        let x: [Moving<f32>; 4] = std::array::from_fn(|_| Moving { t0: point(), t1: point() });
        let p = Params::new(f64::from_bits(r.random()));
        for face in [true, false] {
            certified::<f32, f32>(x, face, &p);
            certified::<f32, f64>(x, face, &p);
        }
    }
}

/// The distance of a vertex and a face, or of two edges.
fn distance(x: [Vec3<f64>; 4], face: bool) -> f64 {
    let to_edge = |p: Vec3<f64>, a: Vec3<f64>, b: Vec3<f64>| {
        let (d, q) = (b - a, p - a);
        let s = if d.dot(d) > 0.0 { (q.dot(d) / d.dot(d)).clamp(0.0, 1.0) } else { 0.0 };
        let r = q - d * s;
        r.dot(r).sqrt()
    };
    let [p, a, b, c] = x;
    let pairs = if face {
        [(p, a, b), (p, b, c), (p, c, a), (p, a, b)]
    } else {
        [(p, b, c), (a, b, c), (b, p, a), (c, p, a)]
    };
    let mut best = pairs.map(|(p, a, b)| to_edge(p, a, b)).into_iter().fold(f64::INFINITY, f64::min);
    let (e, f, g) = if face { (b - a, c - a, p - a) } else { (a - p, c - b, b - p) };
    let n = e.cross(f);
    let (u, v, square) =
        (g.cross(f).dot(n), if face { e.cross(g).dot(n) } else { g.cross(e).dot(n) }, n.dot(n));
    let inside = u >= 0.0 && v >= 0.0 && if face { u + v <= square } else { u <= square && v <= square };
    if square > 0.0 && inside {
        best = best.min(g.dot(n).abs() / square.sqrt());
    }
    best
}

/// If it stops, features are as near as promised; otherwise they are never nearer than the
/// separation.
#[test]
fn stops_near_contact_only() {
    let mut r = random(96);
    let (mut met, mut apart, mut exhausted, mut boxes) = (0, 0, 0, 0);
    for i in 0..20_000 {
        let face = i % 2 == 0;
        let mut point = || Vec3(std::array::from_fn(|_| r.random_range(-1.0f64..1.0)));
        let x: [Moving<f64>; 4] = std::array::from_fn(|_| Moving { t0: point(), t1: point() });
        let separation = [0.0, 0.05, 0.3][i / 2 % 3];
        let finest = if separation > 0.0 { 1e-6 } else { 1e-9 };
        let p = Params { min_separation: separation, ..Params::new([1e-2, 1e-4, finest][i / 6 % 3]) };
        let at = |t: f64| x.map(|m| m.t0 * (1.0 - t) + m.t1 * t);
        for (v, u) in [
            (certified::<f64, f64>(x, face, &p), 2f64.powi(-53)),
            (certified::<f64, f32>(x, face, &p), 2f64.powi(-24)),
        ] {
            let reach = 4.0;
            let promised =
                p.min_separation + 3f64.sqrt() * (3.0 * p.tolerance.max(64.0 * u * reach) + 40.0 * u * reach);
            if v.is_separated() {
                for k in 0..33 {
                    assert!(distance(at(k as f64 / 32.0), face) > p.min_separation, "{v:?}");
                }
                apart += 1;
            } else {
                exhausted += v.exhausted() as u32;
                boxes += v.boxes as u64;
                let d = distance(at(v.toi), face);
                assert!(v.exhausted() || d <= promised, "{d} is not {promised}: {v:?}, {p:?}");
                met += 1;
                let before = (0..if v.toi > 0.0 { 32 } else { 0 }).map(|k| v.toi * k as f64 / 32.0);
                for t in before {
                    assert!(
                        distance(at(t), face) > p.min_separation - 1e-12,
                        "a contact at {t} before {v:?}"
                    );
                }
            }
        }
    }
    println!("{met} met, {apart} apart, {exhausted} exhausted, {boxes} boxes");
    assert!(met > 4000 && apart > 4000 && exhausted * 100 <= met);
}
