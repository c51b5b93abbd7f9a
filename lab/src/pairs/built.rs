//! Motions built in integers, so that the answer is known without a solver. There are contacts at a
//! known time, of generic kinds and of kinds on which a cubic errs. There are near misses, one unit
//! apart.

use crate::case::{Case, Features};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// A point in integers.
pub type Point = [i64; 3];
/// Four points at time 0 and 1; in twelfths, so that quarters and thirds are whole. A vertex, then
/// a face; or two edges.
pub type Motion = [[Point; 4]; 2];

/// Names of the families. On the last three cubics are known to err. A sliver is a face with one
/// short side, or two edges almost parallel. A parallel motion keeps edges parallel, or the face
/// its shape. A tangent one touches and turns back, or slides on: a double root.
pub const FAMILIES: [&str; 9] = [
    "generic",
    "in a plane",
    "on a line",
    "collapsed",
    "static",
    "together",
    "sliver",
    "parallel",
    "tangent",
];

/// Number of kinds: the families, and any of them far from the origin, at thirty-two times the
/// speed, and backwards in time.
pub const KINDS: usize = FAMILIES.len() + 3;

/// Largest reach at which all coordinates are exact in f32.
pub const REACH_F32: i64 = 1 << 12;
/// Largest reach at which all coordinates are exact in f64.
pub const REACH_F64: i64 = 1 << 40;

/// A motion with a known answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Built {
    /// One of [`FAMILIES`], perhaps with `far`, `fast` or `backwards` before it; or `near miss`.
    pub name: String,
    /// The motion, exact.
    pub case: Case,
    /// A time by which they have met; `None` if they never do.
    pub toi: Option<f64>,
}

/// Returns `n` contacts of every kind, vertex/face and edge/edge, and as many near misses as one
/// kind has. Integers are up to about 64 times `reach`, or 2,000 times for fast ones. `reach` is at
/// most `REACH_F64 / 32`.
pub fn built(seed: u64, n: usize, reach: i64) -> Vec<Built> {
    let mut r = SmallRng::seed_from_u64(seed);
    let mut all = Vec::with_capacity(2 * n * (KINDS + 1));
    for (kind, features) in (0..KINDS).flat_map(|k| [(k, Features::VertexFace), (k, Features::EdgeEdge)]) {
        for i in 0..n {
            let (motion, toi, name) = of_kind(&mut r, kind, features == Features::VertexFace, i, reach);
            all.push(Built { name, case: case(&motion, features), toi: Some(toi) });
        }
    }
    for i in 0..2 * n {
        let features = [Features::VertexFace, Features::EdgeEdge][i % 2];
        let motion = near_miss(&mut r, features == Features::VertexFace, reach);
        all.push(Built { name: "near miss".into(), case: case(&motion, features), toi: None });
    }
    all
}

/// Returns the case of a motion.
pub fn case(motion: &Motion, features: Features) -> Case {
    let [positions_t0, positions_t1] = motion.map(|points| points.map(|p| p.map(|x| x as f64)));
    Case { features, positions_t0, positions_t1 }
}

/// Returns the `i`th motion of a kind (below [`KINDS`]), a time by which it has met, and its name.
pub fn of_kind(r: &mut SmallRng, kind: usize, face: bool, i: usize, reach: i64) -> (Motion, f64, String) {
    let time = [0, 16, 1, 8, 11][i % 5];
    let family = if kind < FAMILIES.len() { kind } else { i % FAMILIES.len() };
    let m = motion(r, family, face, time, reach);
    let name = FAMILIES[family];
    let over = |f: &dyn Fn(usize, usize, usize) -> i64| -> Motion {
        [0, 1].map(|t| std::array::from_fn(|p| std::array::from_fn(|k| f(t, p, k))))
    };
    match (kind + 1).saturating_sub(FAMILIES.len()) {
        1 => (over(&|t, p, k| m[t][p][k] + (1 << 18)), time as f64 / 16.0, format!("far, {name}")),
        2 => {
            let speed = |p: usize, k: usize| (m[1][p][k] - m[0][p][k]) / 16;
            let at = [-31 * time, 31 * (16 - time)];
            (over(&|t, p, k| m[t][p][k] + at[t] * speed(p, k)), time as f64 / 16.0, format!("fast, {name}"))
        }
        3 => ([m[1], m[0]], 1.0 - time as f64 / 16.0, format!("backwards, {name}")),
        _ => (m, time as f64 / 16.0, name.into()),
    }
}

/// Returns features on two sides of a plane for the whole step, then sheared by integers. One of
/// them stays one unit or more from the plane.
pub(super) fn near_miss(r: &mut SmallRng, face: bool, reach: i64) -> Motion {
    let on_one_side = if face { 1 } else { 2 };
    let height = |r: &mut SmallRng| [1, 2, 12, 12 * reach][r.random_range(0..4)];
    let mut plain: Motion = [0, 1].map(|_| {
        std::array::from_fn(|i| {
            let [x, y, _] = point(r, 2, reach);
            [x, y, if i < on_one_side { height(r) } else { 0 }]
        })
    });
    let shear: [i64; 4] = std::array::from_fn(|_| r.random_range(-2..3));
    plain.iter_mut().flatten().for_each(|p| {
        let [x, y, z] = *p;
        let (x, y) = (x + shear[0] * z, y + shear[1] * z);
        *p = [x, y, z + shear[2] * x + shear[3] * y];
    });
    plain
}

/// Returns coordinates of `dims` dimensions, whole multiples of 12 up to 12 `reach`.
fn point(r: &mut SmallRng, dims: usize, reach: i64) -> Point {
    std::array::from_fn(|k| if k < dims { 12 * r.random_range(-reach..reach + 1) } else { 0 })
}

fn mix(a: Point, b: Point, twelfths: i64) -> Point {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) / 12 * twelfths)
}

fn add(a: Point, b: Point) -> Point {
    std::array::from_fn(|k| a[k] + b[k])
}

fn less(a: Point, b: Point) -> Point {
    std::array::from_fn(|k| a[k] - b[k])
}

/// Returns points that meet at `sixteenths / 16`: vertex, then face; or two edges.
pub fn motion(r: &mut SmallRng, family: usize, face: bool, sixteenths: i64, reach: i64) -> Motion {
    let dims = [3, 2, 1, 3, 3, 3, 3, 3, 3][family];
    let mut then: [Point; 4] = std::array::from_fn(|_| point(r, dims, reach));
    let (u, v) = ([0, 3, 4, 6, 12][r.random_range(0..5)], [0, 6, 12][r.random_range(0..3)]);
    match family {
        3 => then[2] = then[1],
        6 if face => then[3] = add(then[2], point(r, 3, 1)),
        _ => {}
    }
    if face {
        then[0] = mix(then[1], mix(then[2], then[3], v), u);
        // Finer than twelfths: scale all.
        then = then.map(|p| p.map(|x| x * 12));
        let [_, a, b, c] = then;
        then[0] = mix(a, mix(b, c, v), u);
    } else {
        let at = mix(then[0], then[1], u);
        match v {
            0 => then[2] = at,
            12 => then[3] = at,
            _ => then[3] = less(add(at, at), then[2]),
        }
        if family == 6 || family == 7 {
            // Parallel to the first edge, or almost.
            let off = if family == 6 { point(r, 3, 1) } else { [0; 3] };
            let along = add(less(then[1], then[0]), off).map(|x| x / 12);
            then[2] = less(at, along.map(|x| x * v));
            then[3] = add(at, along.map(|x| x * (12 - v)));
        }
    }
    let common = point(r, dims, reach);
    let mut speed: [Point; 4] = std::array::from_fn(|_| match family {
        4 => [0; 3],
        5 => common,
        _ => point(r, dims, reach),
    });
    match family {
        7 if face => speed = [speed[0], speed[1], speed[1], speed[1]],
        7 => speed = [speed[0], speed[0], speed[2], speed[2]],
        8 => tangent(&mut speed, &then, face, (u, v), r.random_range(-1..2)),
        _ => {}
    }
    let at = |t: i64| {
        std::array::from_fn(|i| std::array::from_fn(|k| then[i][k] + (t - sixteenths) * speed[i][k]))
    };
    [at(0), at(16)]
}

/// Moves the relative speed at the point of contact into the common plane: `along` times an edge,
/// by a twelfth.
fn tangent(speed: &mut [Point; 4], then: &[Point; 4], face: bool, (u, v): (i64, i64), along: i64) {
    if face {
        let fine = speed.map(|p| p.map(|x| x * 12));
        let slide = less(then[2], then[1]).map(|x| x / 12 * along);
        *speed = fine;
        speed[0] = add(mix(fine[1], mix(fine[2], fine[3], v), u), slide);
    } else {
        let slide = less(then[1], then[0]).map(|x| x / 12 * along);
        let at = add(mix(speed[0], speed[1], u), slide);
        match v {
            0 => speed[2] = at,
            12 => speed[3] = at,
            _ => speed[3] = less(add(at, at), speed[2]),
        }
    }
}
