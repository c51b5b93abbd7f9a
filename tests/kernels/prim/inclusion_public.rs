//! The certified continuous tests on public data with exact answers.

use super::inclusion::{certified, in_passes};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::{Moving, ee_apart, vf_apart};
use nearmiss_kernels::prim::inclusion::{Edges, Face, Params, Verdict};
use nearmiss_lab::robustness::MOTIONS;
use std::collections::HashSet;
use support::candidates::{Key, scene};
use support::truth::queries::folders;

fn moving<R: Real>(x: &[[f64; 3]; 8]) -> [Moving<R>; 4] {
    let point = |i: usize| Vec3(x[i].map(R::of));
    [0, 1, 2, 3].map(|i| Moving { t0: point(i), t1: point(i + 4) })
}

/// None missed, no certificate false, in any precision; false alarms no more than Tight-Inclusion's, in doubles.
#[test]
#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]
fn queries() {
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let p = Params::new(tolerance);
        let (mut alarms, mut cubic) = ([[0; 2]; 2], [0; 2]);
        for f in folders() {
            for m in &f.motions {
                let x = moving(&m.points);
                let all = [
                    certified::<f64, f64>(x, f.face, &p),
                    certified::<f64, f32>(x, f.face, &p),
                    in_passes(x, f.face, &p),
                ];
                for (k, v) in all.iter().enumerate() {
                    assert!(!(m.meets && v.is_separated()), "{}: missed", f.name);
                    assert!(m.meets || !v.is_contact(), "{}: falsely certain", f.name);
                    assert!(!v.exhausted() && v.boxes <= 100, "{}: {v:?}", f.name);
                    if k < 2 {
                        alarms[k][f.face as usize] += (!m.meets && !v.is_separated()) as u32;
                    }
                }
                cubic[f.face as usize] += (!m.meets && m.found::<f64, f64>(f.face)) as u32;
                // Rounded positions are another pair; only contacts that f32 holds must be found.
                let rounded = certified::<f32, f32>(moving(&m.points), f.face, &p);
                assert!(!(m.fits_f32() && m.meets && rounded.is_separated()), "{}: missed", f.name);
                let exact = certified::<f32, f64>(moving(&m.points), f.face, &p);
                assert!(!(exact.is_contact() && rounded.is_separated()), "{}: contradiction", f.name);
            }
        }
        println!(
            "{tolerance:e}: false alarms [f64, f32] of [edge/edge, vertex/face]: {alarms:?}; cubic {cubic:?}"
        );
        assert!(alarms[0][0] <= 137 && alarms[0][1] <= 85, "{alarms:?}");
        assert!(alarms[1][0] <= 219 && alarms[1][1] <= 133, "{alarms:?}");
    }
}

/// Motions that other libraries got wrong, with their exact times.
#[test]
fn reported_motions() {
    for (name, face, t0, t1, end, truth) in MOTIONS {
        let x = [0, 1, 2, 3].map(|i| Moving { t0: Vec3(t0[i]), t1: Vec3(t1[i]) });
        let p = Params { end, ..Params::new(1e-9) };
        for v in
            [certified::<f64, f64>(x, face, &p), certified::<f64, f32>(x, face, &p), in_passes(x, face, &p)]
        {
            println!("{name}: truth {truth:?}, {:?}, {} boxes", v.answer(), v.boxes);
            match truth {
                // Decimals of the truth are rounded.
                Some(t) => {
                    assert!(!v.is_separated() && v.toi <= t + 1e-11, "{name}");
                    assert!(!v.is_contact() || v.toi_upper >= t - 1e-11, "{name}");
                }
                None => assert!(!v.is_contact(), "{name}"),
            }
            assert!(v.boxes <= 100, "{name}");
        }
    }
}

#[test]
#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]
fn cloth() {
    frames("cloth-ball", "cloth_ball92", "cloth_ball93", 4);
}

/// 31 million candidates: by hand.
#[test]
#[ignore = "a minute"]
fn balls() {
    frames("n-body", "n-body_t0", "n-body_t1", 4);
}

/// All true contacts, certificates that are true, false alarms of at most `most` in a million candidates.
fn frames(folder: &str, before: &str, after: &str, most: usize) {
    let (all, truth, mean) = scene(folder, before, after);
    let p = Params::new(1e-4 * mean);
    for (name, solver) in [
        ("f32", certified::<f32, f32> as fn([Moving<f32>; 4], bool, &Params) -> Verdict),
        ("f64", certified::<f32, f64>),
        ("f32, then f64", in_passes),
    ] {
        let (mut missed, mut alarms, mut sure, mut unsure, mut exhausted) = (0, 0, 0, 0, 0);
        let (mut boxes, mut searched, mut largest) = (0, 0, 0);
        for (key, x) in &all {
            let v = solver(*x, key.0, &p);
            let meets = truth.contains(key);
            missed += (meets && v.is_separated()) as usize;
            alarms += (!meets && !v.is_separated()) as usize;
            sure += (!meets && v.is_contact()) as usize;
            unsure += (!v.is_separated() && !v.is_contact()) as usize;
            exhausted += v.exhausted() as usize;
            boxes += v.boxes as usize;
            searched += (v.boxes > 0) as usize;
            largest = largest.max(v.boxes);
        }
        println!(
            "{folder}, {name}: of {} candidates {} meet; missed {missed}, false {alarms}, falsely certain {sure}, \
             undecided {unsure}, exhausted {exhausted}; {searched} searched, {boxes} boxes, at most {largest}",
            all.len(),
            truth.len()
        );
        assert_eq!((missed, sure, exhausted), (0, 0, 0));
        assert!(alarms * 1_000_000 <= most * all.len() && largest <= 200);
    }
    filters(&all, &truth, &p);
}

/// Pairs that each filter removes: no true contact.
fn filters(all: &[(Key, [Moving<f32>; 4])], truth: &HashSet<Key>, p: &Params) {
    let names = ["axes and coplanarity, exact positions", "axes", "planes", "axes or planes", "all"];
    let mut removed = [0; 5];
    for (key, [a, b, c, d]) in all {
        let (signs, axes, planes) = if key.0 {
            let m = Face::<f32>::new(*a, [*b, *c, *d], p);
            (vf_apart::<f32, f32>(*a, [*b, *c, *d]), m.apart_by_axes(), m.apart_by_planes())
        } else {
            let m = Edges::<f32>::new([*a, *b], [*c, *d], p);
            (ee_apart::<f32, f32>([*a, *b], [*c, *d]), m.apart_by_axes(), m.apart_by_planes())
        };
        let apart = [signs, axes, planes, axes || planes, signs || axes || planes];
        assert!(!(truth.contains(key) && apart[4]), "a true contact was removed");
        (0..5).for_each(|k| removed[k] += apart[k] as usize);
    }
    for (name, n) in names.iter().zip(removed) {
        println!("{name}: {:.2} %", n as f64 * 100.0 / all.len() as f64);
    }
}
