//! The certified continuous tests on public data with exact answers.

use crate::inclusion::certified;
use crate::public::scene;
use crate::queries::folders;
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::{Moving, ee_apart, ee_toi, vf_apart, vf_toi};
use nearmiss_kernels::prim::inclusion::{Edges, Face, Grid, Params, Verdict};
use std::hint::black_box;
use std::time::Instant;

fn ask<R: Real, S: Grid>(x: &[[f64; 3]; 8], face: bool, p: &Params) -> Verdict {
    let point = |i: usize| Vec3(x[i].map(R::of));
    certified::<R, S>([0, 1, 2, 3].map(|i| Moving { t0: point(i), t1: point(i + 4) }), face, p)
}

#[test]
fn queries() {
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let p = Params::new(tolerance);
        let mut wrong = [[0; 2]; 2];
        for f in folders() {
            let (mut boxes, mut most, mut exhausted, mut sure, mut hits) = ([0; 2], [0; 2], [0; 2], [0; 2], 0);
            for m in &f.motions {
                let all = [ask::<f64, f64>(&m.points, f.face, &p), ask::<f64, f32>(&m.points, f.face, &p)];
                hits += m.meets as u32;
                for (k, v) in all.iter().enumerate() {
                    assert!(!(m.meets && v.is_separated()), "missed");
                    assert!(m.meets || !v.is_contact(), "a false certificate");
                    wrong[k][f.face as usize] += (!m.meets && !v.is_separated()) as u32;
                    boxes[k] += v.boxes;
                    most[k] = most[k].max(v.boxes);
                    exhausted[k] += v.exhausted() as u32;
                    sure[k] += v.is_contact() as u32;
                }
            }
            println!(
                "{tolerance:e} {} face {}: {} ({hits} meet, certain {sure:?}), boxes {boxes:?}, most {most:?}, exhausted {exhausted:?}",
                f.name, f.face, f.motions.len()
            );
        }
        println!("false alarms [f64, f32] of [edge/edge, vertex/face]: {wrong:?}");
    }
}

#[test]
fn cloth() {
    frames("cloth-ball", "cloth_ball92", "cloth_ball93");
}

fn frames(folder: &str, before: &str, after: &str) {
    let Some((all, truth, mean)) = scene(folder, before, after) else { return };
    let p = Params::new(1e-4 * mean);
    let per = |start: Instant| start.elapsed().as_secs_f64() * 1e9 / all.len() as f64;
    let start = Instant::now();
    for ((face, ..), [a, b, c, d]) in &all {
        black_box(if *face { vf_toi::<f32, f64>(*a, [*b, *c, *d]) } else { ee_toi::<f32, f64>([*a, *b], [*c, *d]) });
    }
    println!("cubic f64 {:.1} ns", per(start));
    for k in 0..4 {
        let start = Instant::now();
        let mut n = 0;
        for ((face, ..), [a, b, c, d]) in &all {
            n += black_box(match (k, *face) {
                (0, true) => vf_apart::<f32, f32>(*a, [*b, *c, *d]),
                (0, _) => ee_apart::<f32, f32>([*a, *b], [*c, *d]),
                (1, true) => Face::<f32>::new(*a, [*b, *c, *d], &p).apart_by_axes(),
                (1, _) => Edges::<f32>::new([*a, *b], [*c, *d], &p).apart_by_axes(),
                (2, true) => Face::<f32>::new(*a, [*b, *c, *d], &p).apart_by_planes(),
                (2, _) => Edges::<f32>::new([*a, *b], [*c, *d], &p).apart_by_planes(),
                (_, true) => { let m = Face::<f32>::new(*a, [*b, *c, *d], &p); m.apart_by_axes() || m.apart_by_planes() },
                (_, _) => { let m = Edges::<f32>::new([*a, *b], [*c, *d], &p); m.apart_by_axes() || m.apart_by_planes() },
            }) as u32;
        }
        println!("filter {k}: {:.3} %, {:.1} ns", n as f64 * 100.0 / all.len() as f64, per(start));
    }
    run::<f32>("f32", &all, &truth, &p);
    run::<f64>("f64", &all, &truth, &p);
}

fn run<S: Grid>(name: &str, all: &[(crate::public::Key, [Moving<f32>; 4])], truth: &std::collections::HashSet<crate::public::Key>, p: &Params) {
    let start = Instant::now();
    let answers: Vec<Verdict> = all.iter().map(|((face, ..), x)| certified::<f32, S>(*x, *face, p)).collect();
    let ns = start.elapsed().as_secs_f64() * 1e9 / all.len() as f64;
    let (mut missed, mut false_alarm, mut false_sure, mut unresolved, mut exhausted, mut boxes, mut most, mut wide) = (0, 0, 0, 0, 0, 0u64, 0, 0);
    let mut searched = 0;
    for ((key, _), v) in all.iter().zip(&answers) {
        let meets = truth.contains(key);
        missed += (meets && v.is_separated()) as u32;
        false_alarm += (!meets && !v.is_separated()) as u32;
        false_sure += (!meets && v.is_contact()) as u32;
        unresolved += (!v.is_separated() && !v.is_contact()) as u32;
        exhausted += v.exhausted() as u32;
        boxes += v.boxes as u64;
        searched += (v.boxes > 0) as u32;
        most = most.max(v.boxes);
        wide += (v.is_contact() && v.toi_hi - v.toi > 1e-3) as u32;
    }
    println!("{name}: {} candidates, {} meet; missed {missed}, false {false_alarm}, falsely certain {false_sure}, unresolved {unresolved}, exhausted {exhausted}, wide {wide}; searched {searched}, boxes {boxes}, most {most}; {ns:.1} ns", all.len(), truth.len());
    assert_eq!((missed, false_sure), (0, 0));
}
