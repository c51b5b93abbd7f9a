//! Triangle pairs and motions that other libraries got wrong, as reported in public, with exact answers.

use super::discrete::all_sources;
use super::{corners, seen};
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::adjacent::Shared;
use nearmiss_kernels::prim::cubic::{Moving, ee_toi, vf_toi};
use nearmiss_kernels::prim::tri_tri::meets_exactly;
use nearmiss_lab::oracle::{Triangle, triangles_meet};
use nearmiss_lab::robustness::{MOTIONS, PATCH, PATCH_FACES, TRIANGLES};

#[test]
fn reported_triangles() {
    for (_, name, p, q, truth, rounded) in TRIANGLES {
        println!("{name}");
        assert_eq!(triangles_meet(&p, &q), truth, "the oracle on {name}");
        all_sources::<f64>(&p, &q, truth);
        let round = |t: &Triangle| seen(&corners::<f32>(t));
        assert_eq!(triangles_meet(&round(&p), &round(&q)), rounded, "the oracle on {name}, rounded");
        all_sources::<f32>(&p, &q, rounded);
    }
}

#[test]
fn reported_patch_has_no_pairs() {
    for (i, f) in PATCH_FACES.iter().enumerate() {
        for g in PATCH_FACES.iter().take(i).filter(|g| Shared::by_index(*f, **g) == Shared::Nothing) {
            let t = |f: &[u32; 3]| corners::<f64>(&f.map(|k| PATCH[k as usize]));
            assert!(!meets_exactly(&t(f), &t(g)), "{f:?} {g:?}");
        }
    }
}

/// The double cubic gets every reported motion right but those named; the single one is printed.
#[test]
fn reported_motions() {
    for (name, face, t0, t1, longest, truth) in MOTIONS {
        let m = |i: usize| Moving { t0: Vec3(t0[i]), t1: Vec3(t1[i]) };
        let (double, single) = if face {
            (vf_toi::<f64, f64>(m(0), [m(1), m(2), m(3)]), vf_toi::<f64, f32>(m(0), [m(1), m(2), m(3)]))
        } else {
            let (a, b) = ([m(0), m(1)], [m(2), m(3)]);
            (ee_toi::<f64, f64>(a, b), ee_toi::<f64, f32>(a, b))
        };
        println!("{name}: truth {truth:?}, f64 {double:?}, f32 {single:?}");
        let double = double.filter(|t| *t <= longest);
        match (double, truth) {
            (Some(t), Some(toi)) => assert!((t - toi).abs() < 1e-7, "{name}: {t} is not {toi}"),
            (a, b) => assert_eq!(a.is_some(), b.is_some(), "{name}"),
        }
    }
}
