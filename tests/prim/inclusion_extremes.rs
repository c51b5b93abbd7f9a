//! One small motion for each extreme that a certified test must survive, and how near things are when it stops.

use crate::inclusion::{certified, in_passes};
use crate::random;
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::{Params, Verdict};
use rand::Rng;

type Four = [[f64; 3]; 4];

#[derive(Clone, Copy, Debug)]
enum Expect {
    /// Certainly apart.
    Apart,
    /// First contact at that time: not separated, not late, not early by over a thousandth.
    Meets(f64),
    /// The same, and certain.
    Sure(f64),
}
use Expect::{Apart, Meets, Sure};

fn moving(t0: &Four, t1: &Four) -> [Moving<f64>; 4] {
    [0, 1, 2, 3].map(|i| Moving { t0: Vec3(t0[i]), t1: Vec3(t1[i]) })
}

fn check(name: &str, v: &Verdict, expect: Expect) {
    match expect {
        Apart => assert!(v.is_separated(), "{name}: {v:?}"),
        Meets(t) | Sure(t) => {
            assert!(!v.is_separated() && !v.exhausted(), "{name}: {v:?}");
            assert!(v.toi <= t && v.toi >= t - 1e-3, "{name}: {v:?}, not {t}");
            assert!(!matches!(expect, Sure(_)) || v.is_contact(), "{name}: {v:?}");
            assert!(!v.is_contact() || v.toi_hi >= t, "{name}: {v:?}, not {t}");
        }
    }
    assert!(v.boxes <= 100, "{name}: {v:?}");
}

/// Asks in f64, in f32, in passes, and, where the numbers are exact there, from positions in f32.
fn ask(name: &str, face: bool, t0: Four, t1: Four, p: Params, expect: Expect) {
    let x = moving(&t0, &t1);
    let narrow = if let Sure(t) = expect { Meets(t) } else { expect };
    check(name, &certified::<f64, f64>(x, face, &p), expect);
    check(name, &certified::<f64, f32>(x, face, &p), narrow);
    check(name, &in_passes(x, face, &p), expect);
    if t0.iter().chain(&t1).flatten().all(|x| f64::from(*x as f32) == *x) {
        let to = |x: Vec3<f64>| x.map(|x| x as f32);
        let x = x.map(|m| Moving { t0: to(m.t0), t1: to(m.t1) });
        check(name, &certified::<f32, f32>(x, face, &p), narrow);
        check(name, &certified::<f32, f64>(x, face, &p), expect);
    }
}

const FACE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0]];
/// Along x, at rest.
const EDGE: [[f64; 3]; 2] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0]];

fn with(p: [f64; 3], f: [[f64; 3]; 3]) -> Four {
    [p, f[0], f[1], f[2]]
}

fn and(a: [[f64; 3]; 2], b: [[f64; 3]; 2]) -> Four {
    [a[0], a[1], b[0], b[1]]
}

#[test]
fn vertex_and_face() {
    let p = Params::new(1e-5);
    let at = |name, from, to, expect| ask(name, true, with(from, FACE), with(to, FACE), p, expect);
    at("plain", [2.0, 2.0, 3.0], [2.0, 2.0, -1.0], Sure(0.75));
    at("X15 in the plane, entering", [12.0, 4.0, 0.0], [-4.0, 4.0, 0.0], Meets(0.5));
    at("X16 in the plane, passing", [9.0, -4.0, 0.0], [9.0, 8.0, 0.0], Apart);
    at("X22 at rest, apart", [2.0, 2.0, 1.0], [2.0, 2.0, 1.0], Apart);
    at("X22 at rest, touching", [2.0, 2.0, 0.0], [2.0, 2.0, 0.0], Meets(0.0));
    at("X30 leaving", [2.0, 2.0, 0.0], [2.0, 2.0, 5.0], Meets(0.0));
    at("X31 arriving", [2.0, 2.0, 5.0], [2.0, 2.0, 0.0], Meets(1.0));
    at("X32 almost arriving", [2.0, 2.0, 5.0], [2.0, 2.0, 1e-3], Apart);
    at("X33 at once", [2.0, 2.0, 1e-9], [2.0, 2.0, -1.0], Meets(1e-9));
    at("X35 fast", [2.0, 2.0, 3e6], [2.0, 2.0, -1e6], Sure(0.75));
    at("X35 fast, aside", [2.0, 9.0, 3e6], [2.0, 9.0, -1e6], Apart);
    at("X36 at a corner", [0.0, 0.0, 3.0], [0.0, 0.0, -1.0], Meets(0.75));
    at("X36 at a side", [4.0, 4.0, 3.0], [4.0, 4.0, -1.0], Meets(0.75));
    let other = [[8.0, 8.0, 0.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0]];
    let beside =
        |from, to| ask("X36 at the side of two", true, with(from, other), with(to, other), p, Meets(0.75));
    beside([4.0, 4.0, 3.0], [4.0, 4.0, -1.0]);
    for (name, face) in [
        ("X12 a point", [[2.0, 2.0, 0.0]; 3]),
        ("X12 two points", [[2.0, 2.0, 0.0], [2.0, 2.0, 0.0], [7.0, 1.0, 0.0]]),
        ("X12 on a line", [[0.0, 2.0, 0.0], [8.0, 2.0, 0.0], [1.0, 2.0, 0.0]]),
    ] {
        let to = |x, y, z| with([x, y, z], face);
        ask(name, true, to(2.0, 2.0, 3.0), to(2.0, 2.0, -1.0), p, Meets(0.75));
        ask(name, true, to(2.0, 3.0, 3.0), to(2.0, 3.0, -1.0), p, Apart);
        ask(name, true, to(2.0, 2.0, 0.0), to(2.0, 2.0, 0.0), p, Meets(0.0));
    }
    // Of a face that turns over through a segment, at a half.
    let turned = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [4.0, -8.0, 0.0]];
    let upright = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [4.0, 8.0, 0.0]];
    let to = |from, to, expect| ask("X26", true, with(from, upright), with(to, turned), p, expect);
    to([4.0, -1.0, 3.0], [4.0, -1.0, -1.0], Sure(0.75));
    to([20.0, 20.0, 0.0], [20.0, 20.0, 0.0], Apart);
    // Until a part of the step.
    let end = Params { end: 0.5, ..p };
    ask("X31 at the end", true, with([2.0, 2.0, 1.0], FACE), with([2.0, 2.0, -1.0], FACE), end, Meets(0.5));
    ask("after the end", true, with([2.0, 2.0, 1.1], FACE), with([2.0, 2.0, -0.9], FACE), end, Apart);
    let third = Params { end: 0.1, ..p };
    ask(
        "an end off the grid",
        true,
        with([2.0, 2.0, 1.0], FACE),
        with([2.0, 2.0, -9.0], FACE),
        third,
        Meets(0.1),
    );
}

#[test]
fn edge_and_edge() {
    let p = Params::new(1e-5);
    let at = |name, from, to, expect| ask(name, false, and(EDGE, from), and(EDGE, to), p, expect);
    let across = |z: f64| [[1.0, -1.0, z], [1.0, 1.0, z]];
    at("plain", across(3.0), across(-1.0), Sure(0.75));
    at(
        "plain, beyond the end",
        across(3.0).map(|x| [x[0] + 4.0, x[1], x[2]]),
        across(-1.0).map(|x| [x[0] + 4.0, x[1], x[2]]),
        Apart,
    );
    let along = |x: f64, y: f64| [[x, y, 0.0], [x + 3.0, y, 0.0]];
    let against = |x: f64, y: f64| [[x + 3.0, y, 0.0], [x, y, 0.0]];
    at("X17 parallel", along(3.0, 2.0), along(3.0, -2.0), Meets(0.5));
    at("X18 on one line, apart", along(5.0, 0.0), along(6.0, 0.0), Apart);
    at("X18 parallel, passing beyond", along(5.0, 2.0), along(5.0, -2.0), Apart);
    at("X19 sliding to an end", along(6.0, 0.0), along(2.0, 0.0), Meets(0.5));
    at("X20 the other way", against(6.0, 0.0), against(2.0, 0.0), Meets(0.5));
    at("X20 through each other", against(8.0, 0.0), against(-8.0, 0.0), Meets(0.25));
    at("X22 at rest, crossing", across(0.0), across(0.0), Meets(0.0));
    at("X22 at rest, apart", across(1.0), across(1.0), Apart);
    at("X13 a point", [[1.0, 0.0, 3.0]; 2], [[1.0, 0.0, -1.0]; 2], Meets(0.75));
    at("X13 a point, aside", [[1.0, 1.0, 3.0]; 2], [[1.0, 1.0, -1.0]; 2], Apart);
    let points = |z: f64| and([[1.0, 1.0, 0.0]; 2], [[1.0, 1.0, z]; 2]);
    ask("X13 two points", false, points(3.0), points(-1.0), p, Meets(0.75));
    ask("X13 two points, apart", false, points(3.0), points(1.0), p, Apart);
    ask("X13 two points, always there", false, points(0.0), points(0.0), p, Sure(0.0));
    for k in 1..17 {
        let tilted = |z: f64| [[1.0, -(10f64.powi(-k)), z], [3.0, 10f64.powi(-k), z]];
        at("X21 nearly parallel", tilted(2.0), tilted(-2.0), Meets(0.5));
    }
    // X24, X25: who moves, and how both move together, is nothing to them.
    let shift = |x: Four, d: f64| x.map(|p| [p[0], p[1] + d, p[2] + d]);
    let (from, to) = (and(EDGE, across(3.0)), and(EDGE, across(-1.0)));
    ask(
        "X24",
        false,
        and(EDGE, across(3.0)),
        and(EDGE.map(|x| [x[0], x[1], 4.0]), across(3.0)),
        p,
        Sure(0.75),
    );
    ask("X25", false, from, shift(to, 1048576.0), p, Sure(0.75));
    // X29: in and out again; two roots.
    let v = [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [0.1, 0.2, 2.0], [0.1, 0.2, -1.0]];
    let w = [[1.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.1, 0.2, 2.0], [0.1, 0.2, -1.0]];
    ask("X29", false, v, w, p, Sure(0.11270166537925833));
}

#[test]
fn separations() {
    let p = |separation: f64| Params { separation, ..Params::new(1e-6) };
    let still = |z: f64| with([2.0, 2.0, z], FACE);
    ask("X38 nearer", true, still(0.5), still(0.75), p(1.0), Sure(0.0));
    ask("X38 at it", true, still(1.0), still(2.0), p(1.0), Meets(0.0));
    ask("X38 beyond", true, still(1.001), still(1.5), p(1.0), Apart);
    ask("coming near", true, still(3.0), still(-1.0), p(1.0), Sure(0.5));
    ask("far more than they are long", true, still(3.0), still(-1.0), p(1e9), Sure(0.0));
    // Past a corner, at that distance; Euclidean, across all three axes.
    let d = 1.0 / 3f64.sqrt();
    for (factor, expect) in [(1.001, Apart), (0.999, Sure(0.5))] {
        let corner = |s: f64| with([-d * factor + s, -d * factor - s, d * factor], FACE);
        let by = (1.0f64 - 0.999 * 0.999).sqrt() / 2f64.sqrt();
        let t = if factor < 1.0 { 0.5 - by / 8.0 } else { 0.5 };
        let expect = if let Sure(_) = expect { Sure(t) } else { expect };
        ask("X38 flying by", true, corner(-4.0), corner(4.0), p(1.0), expect);
    }
    let edges = |z: f64| and(EDGE, [[1.0, -1.0, z], [1.0, 1.0, z]]);
    ask("edges", false, edges(3.0), edges(-1.0), p(1.0), Sure(0.5));
    ask("X39 far below f32", true, still(3.0), still(-1.0), p(1e-12), Meets(0.75));
}

#[test]
fn tolerances() {
    for tolerance in [0.0, 5e-324, 1e-300, 1e-12, 1.0, 1e300, f64::INFINITY] {
        let p = Params::new(tolerance);
        let x = moving(&with([2.0, 2.0, 3.0], FACE), &with([2.0, 2.0, -1.0], FACE));
        for v in
            [certified::<f64, f64>(x, true, &p), certified::<f64, f32>(x, true, &p), in_passes(x, true, &p)]
        {
            assert!(!v.is_separated() && v.toi <= 0.75 && v.boxes < 200, "X40 {tolerance}: {v:?}");
            assert!(tolerance > 1e-6 || v.toi > 0.7499, "X40 {tolerance}: {v:?}");
        }
        let far = moving(&with([2.0, 2.0, 3.0], FACE), &with([2.0, 2.0, 1.0], FACE));
        assert!(certified::<f64, f32>(far, true, &p).is_separated());
    }
}

/// Whatever is not a number rejects nothing; what is tiny or huge gives well-formed answers.
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
        let p = Params { separation: bad.abs(), ..Params::new(1e-3) };
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
    // X06: subnormal coordinates of f32; the contact is found.
    let tiny = |t: Four| t.map(|p| p.map(|x| f64::from((x * 1e-41) as f32)));
    let to = |x: Vec3<f64>| x.map(|x| x as f32);
    let x = moving(&tiny(with([2.0, 2.0, 3.0], FACE)), &tiny(with([2.0, 2.0, -1.0], FACE)));
    let x = x.map(|m| Moving { t0: to(m.t0), t1: to(m.t1) });
    let v = certified::<f32, f32>(x, true, &Params::new(1e-44));
    assert!(!v.is_separated() && v.toi < 0.751, "{v:?}");
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

/// Where it stops, features are as near as promised; where it does not, never nearer than the separation at any time.
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
        let p = Params { separation, ..Params::new([1e-2, 1e-4, finest][i / 6 % 3]) };
        let at = |t: f64| x.map(|m| m.t0 * (1.0 - t) + m.t1 * t);
        for (v, u) in [
            (certified::<f64, f64>(x, face, &p), 2f64.powi(-53)),
            (certified::<f64, f32>(x, face, &p), 2f64.powi(-24)),
        ] {
            let reach = 4.0;
            let promised =
                p.separation + 3f64.sqrt() * (3.0 * p.tolerance.max(64.0 * u * reach) + 40.0 * u * reach);
            if v.is_separated() {
                for k in 0..33 {
                    assert!(distance(at(k as f64 / 32.0), face) > p.separation, "{v:?}");
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
                    assert!(distance(at(t), face) > p.separation - 1e-12, "a contact at {t} before {v:?}");
                }
            }
        }
    }
    println!("{met} met, {apart} apart, {exhausted} exhausted, {boxes} boxes");
    assert!(met > 4000 && apart > 4000 && exhausted * 100 <= met);
}
