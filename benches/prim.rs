//! Time per call of the narrow tests on one core, in nanoseconds, and the boxes of their searches:
//! `cargo bench --bench prim`.
//! `-- calls`, `-- cloth` or `-- boxes` runs one of them. The last two read the public frames, and
//! are skipped without them.

use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::{Moving, ee_apart, ee_toi, vf_apart, vf_toi};
use nearmiss_kernels::prim::exact::orient3d_exact;
use nearmiss_kernels::prim::inclusion::{
    Edges, Face, Grid, Params, Verdict, ee_certified, ee_first, vf_certified, vf_first,
};
use nearmiss_kernels::prim::moller::moller;
use nearmiss_kernels::prim::tri_tri::{Certain, Exact, Filter, Wide, meets};
use nearmiss_lab::oracle::Triangle;
use std::hint::black_box;
use std::time::Instant;
use support::candidates::scene;
use support::triangles::{anywhere, corners, on_grid, random};

fn main() {
    let names: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let is_chosen = |name: &str| names.is_empty() || names.iter().any(|word| name.contains(word.as_str()));
    if is_chosen("calls") {
        calls();
    }
    let meters: [(&str, fn()); 2] = [("cloth", cloth), ("boxes", boxes)];
    for (name, meter) in meters.into_iter().filter(|(name, _)| is_chosen(name)) {
        if cfg!(public_data) { meter() } else { eprintln!("{name}: no public frames (set NEARMISS_DATA)") }
    }
}

fn time<T, U>(name: &str, items: &[T], f: impl Fn(&T) -> Option<U>) {
    let mut best = f64::INFINITY;
    let mut some = 0;
    for _ in 0..5 {
        let start = Instant::now();
        some = items.iter().filter(|x| black_box(f(black_box(x))).is_some()).count();
        best = best.min(start.elapsed().as_secs_f64() * 1e9 / items.len() as f64);
    }
    println!("{name:45} {best:8.1} ns   ({some} of {} true or decided)", items.len());
}

type Pair<R> = [[Vec3<R>; 3]; 2];

fn pairs<R: Real>(mut t: impl FnMut() -> Triangle, n: usize) -> Vec<Pair<R>> {
    (0..n).map(|_| [corners(&t()), corners(&t())]).collect()
}

/// Single tests of random triangles, in the unit cube and on a small grid.
fn calls() {
    let mut r = random(31);
    let near = pairs::<f32>(|| anywhere(&mut r), 20_000);
    let doubles = pairs::<f64>(|| anywhere(&mut r), 20_000);
    let grid = pairs::<f32>(|| on_grid(&mut r, 4), 20_000);
    for (name, set) in [("random", &near), ("grid", &grid)] {
        time(&format!("moller f32, {name}"), set, |[p, q]| moller(p, q).then_some(()));
        time(&format!("meets f32 Filter, {name}"), set, |[p, q]| meets::<f32, Filter>(p, q));
        time(&format!("meets f32 Wide, {name}"), set, |[p, q]| meets::<f32, Wide>(p, q));
        time(&format!("meets f32 Certain, {name}"), set, |[p, q]| meets::<f32, Certain>(p, q));
        time(&format!("meets f32 Exact, {name}"), set, |[p, q]| meets::<f32, Exact>(p, q));
        time(&format!("orient3d_exact f32, {name}"), set, |[p, q]| {
            Some(orient3d_exact(p[0], p[1], p[2], q[0]))
        });
    }
    time("meets f64 Filter, random", &doubles, |[p, q]| meets::<f64, Filter>(p, q));
    time("meets f64 Exact, random", &doubles, |[p, q]| meets::<f64, Exact>(p, q));
    time("orient3d_exact f64, random", &doubles, |[p, q]| Some(orient3d_exact(p[0], p[1], p[2], q[0])));
    let wild: Vec<Pair<f64>> = doubles
        .iter()
        .map(|p| p.map(|t| t.map(|x| Vec3([x[0] * 2f64.powi(400), x[1] * 2f64.powi(-900), x[2]]))))
        .zip(&doubles)
        .map(|(a, b)| [a[0], b[1]])
        .collect();
    time("orient3d_exact f64, exponents 1300 apart", &wild, |[p, q]| {
        Some(orient3d_exact(p[0], p[1], p[2], q[0]))
    });
    let moving: Vec<[Moving<f32>; 4]> = near
        .chunks_exact(2)
        .map(|c| {
            let x = |k: usize| Moving { t0: c[0][k / 3][k % 3], t1: c[1][k / 3][k % 3] };
            std::array::from_fn(x)
        })
        .collect();
    time("vf_toi f32 in f32, random", &moving, |[p, a, b, c]| vf_toi::<f32, f32>(*p, [*a, *b, *c]));
    time("vf_toi f32 in f64, random", &moving, |[p, a, b, c]| vf_toi::<f32, f64>(*p, [*a, *b, *c]));
    time("ee_toi f32 in f32, random", &moving, |[p, a, b, c]| ee_toi::<f32, f32>([*p, *a], [*b, *c]));
    time("ee_toi f32 in f64, random", &moving, |[p, a, b, c]| ee_toi::<f32, f64>([*p, *a], [*b, *c]));
}

/// The certified answer for four points: a vertex and a face, or two edges.
fn certified<R: Real, S: Grid>([p, q, r, s]: [Moving<R>; 4], face: bool, params: &Params) -> Verdict {
    if face {
        vf_certified::<R, S>(p, [q, r, s], params)
    } else {
        ee_certified::<R, S>([p, q], [r, s], params)
    }
}

/// Both passes, f32 and then f64.
fn in_passes<R: Real>(points: [Moving<R>; 4], face: bool, params: &Params) -> Verdict {
    let [p, q, r, s] = points;
    let first = if face { vf_first(p, [q, r, s], params) } else { ee_first([p, q], [r, s], params) };
    first.unwrap_or_else(|| certified::<R, f64>(points, face, params))
}

/// Time per candidate of real cloth on one core, in nanoseconds.
fn cloth() {
    let (all, _, mean) = scene("cloth-ball", "cloth_ball92", "cloth_ball93");
    let p = Params::new(1e-4 * mean);
    let clocked = |name: &str, f: &dyn Fn(bool, [Moving<f32>; 4]) -> bool| {
        let start = Instant::now();
        let n = all.iter().filter(|(key, x)| black_box(f(key.0, black_box(*x)))).count();
        let ns = start.elapsed().as_secs_f64() * 1e9 / all.len() as f64;
        println!("{name:30} {ns:7.1} ns   ({n} of {})", all.len());
    };
    for _ in 0..2 {
        clocked("cubic f64", &|face, [a, b, c, d]| {
            if face {
                vf_toi::<f32, f64>(a, [b, c, d]).is_some()
            } else {
                ee_toi::<f32, f64>([a, b], [c, d]).is_some()
            }
        });
        clocked("rejection by signs", &|face, [a, b, c, d]| {
            if face { vf_apart::<f32, f32>(a, [b, c, d]) } else { ee_apart::<f32, f32>([a, b], [c, d]) }
        });
        clocked("filters f32", &|face, [a, b, c, d]| {
            if face {
                let m = Face::<f32>::new(a, [b, c, d], &p);
                m.apart_by_axes() || m.apart_by_planes()
            } else {
                let m = Edges::<f32>::new([a, b], [c, d], &p);
                m.apart_by_axes() || m.apart_by_planes()
            }
        });
        clocked("certified f32", &|face, x| !certified::<f32, f32>(x, face, &p).is_separated());
        clocked("certified f64", &|face, x| !certified::<f32, f64>(x, face, &p).is_separated());
        clocked("certified f32, then f64", &|face, x| !in_passes(x, face, &p).is_separated());
    }
}

/// Numbers of boxes in the searches of real cloth.
fn boxes() {
    let (all, _, mean) = scene("cloth-ball", "cloth_ball92", "cloth_ball93");
    let p = Params::new(1e-4 * mean);
    for (name, solver) in [
        ("f32", certified::<f32, f32> as fn([Moving<f32>; 4], bool, &Params) -> Verdict),
        ("f64", certified::<f32, f64>),
    ] {
        let start = Instant::now();
        let mut boxes: Vec<_> = all.iter().map(|(key, x)| solver(*x, key.0, &p).boxes).collect();
        let ms = start.elapsed().as_secs_f64() * 1e3;
        boxes.retain(|boxes| *boxes > 0);
        boxes.sort_unstable();
        let at = |part: f64| boxes[((boxes.len() - 1) as f64 * part) as usize];
        println!(
            "{name}: {} searched, {} boxes; median {}, 99 % {}, 99.9 % {}, most {}; {ms:.0} ms",
            boxes.len(),
            boxes.iter().sum::<u32>(),
            at(0.5),
            at(0.99),
            at(0.999),
            at(1.0)
        );
    }
}
