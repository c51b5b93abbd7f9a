//! Motions built to meet exactly, in integers: generic ones, and the kinds on which a cubic is known to err.

use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::{Moving, ee_toi, vf_toi};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

pub type Point = [i64; 3];
/// Four points at time 0 and 1; in twelfths, so that quarters and thirds are whole.
pub type Motion = [[Point; 4]; 2];

/// The last three are classes on which cubics are known to err. A sliver is a face with one side short, or two edges
/// almost parallel; a parallel motion keeps edges parallel, or the face its shape; a tangent one touches and turns
/// back, or slides on: a double root.
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

/// Coordinates of `dims` dimensions, whole multiples of 12 up to 12 `reach`.
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

/// Points that meet at `sixteenths / 16`: vertex, then face; or two edges.
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

/// Makes the relative speed at the point of contact lie in the common plane: `along` times an edge, by a twelfth.
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

/// What the cubic in `S` says of positions in `R`; all numbers times `scale`.
pub fn toi<R: Real, S: Real>(m: &Motion, face: bool, scale: f64) -> Option<S> {
    let x = |t: usize, i: usize| Vec3(m[t][i].map(|x| R::of(x as f64 * scale)));
    let p = |i: usize| Moving { t0: x(0, i), t1: x(1, i) };
    if face { vf_toi(p(0), [p(1), p(2), p(3)]) } else { ee_toi([p(0), p(1)], [p(2), p(3)]) }
}

/// How the cubic did on one family.
#[derive(Clone, Copy, Default)]
pub struct Count {
    pub family: usize,
    pub face: bool,
    pub asked: u32,
    /// In f64, in f32.
    pub missed: [u32; 2],
    /// By more than 1e-6 in f64, 1e-3 in f32. Every motion meets at a known time, or before.
    pub late: [u32; 2],
}

/// Up to this reach all coordinates are exact in f32.
pub const REACH_F32: i64 = 1 << 12;
/// Up to this reach all coordinates are exact in f64.
pub const REACH_F64: i64 = 1 << 40;

/// Asks `n` motions of every family and kind. f32 is asked only where it holds the numbers.
pub fn count(seed: u64, n: u32, reach: i64) -> Vec<Count> {
    let mut r = SmallRng::seed_from_u64(seed);
    let kinds = (0..FAMILIES.len()).flat_map(|family| [(family, true), (family, false)]);
    let one = |(family, face)| {
        let mut c = Count { family, face, asked: n, ..Count::default() };
        for i in 0..n as usize {
            let time = [0, 16, 1, 8, 11][i % 5];
            let m = motion(&mut r, family, face, time, reach);
            let truth = time as f64 / 16.0;
            let mut answers = vec![toi::<f64, f64>(&m, face, 1.0)];
            if reach <= REACH_F32 {
                answers.push(toi::<f32, f32>(&m, face, 1.0).map(f64::from));
            }
            for (k, answer) in answers.into_iter().enumerate() {
                match answer {
                    None => c.missed[k] += 1,
                    Some(t) => {
                        assert!((0.0..=1.0).contains(&t) && t.is_sign_positive());
                        c.late[k] += (t > truth + [1e-6, 1e-3][k]) as u32;
                    }
                }
            }
        }
        c
    };
    kinds.map(one).collect()
}
