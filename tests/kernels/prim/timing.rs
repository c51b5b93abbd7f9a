//! Nanoseconds a call on one core: `cargo test --release --test kernels timing -- --ignored --nocapture`.

use super::{anywhere, corners, on_grid, random};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::{Moving, ee_toi, vf_toi};
use nearmiss_kernels::prim::exact::orient3d_exact;
use nearmiss_kernels::prim::moller::moller;
use nearmiss_kernels::prim::tri_tri::{Certain, Exact, Filter, Wide, meets};
use nearmiss_lab::oracle::Triangle;
use std::hint::black_box;
use std::time::Instant;

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

#[test]
#[ignore = "times, not truths"]
fn timing() {
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
