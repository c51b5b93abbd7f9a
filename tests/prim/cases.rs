//! Triangle pairs and motions that other libraries got wrong, as reported in public, with exact answers.

use crate::discrete::all_sources;
use crate::motions::MOTIONS;
use crate::{corners, seen};
use nearmiss::oracle::{Triangle, triangles_meet};
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::adjacent::Shared;
use nearmiss_kernels::prim::cubic::{Moving, ee_toi, vf_toi};
use nearmiss_kernels::prim::tri_tri::meets_exactly;

/// Report, first triangle, second, whether they meet: as given, and when rounded to f32.
const TRIANGLES: [(&str, Triangle, Triangle, bool, bool); 7] = [
    (
        "llnl/axom#152",
        [[76.648, 54.6752, 15.0012], [76.648, 54.6752, 14.5542], [76.582, 54.6752, 14.7879]],
        [[76.6252, 54.6752, 14.892], [76.582, 54.6752, 14.7879], [76.5617, 54.6752, 14.7929]],
        true,
        true,
    ),
    (
        "BrunoLevy/geogram#10",
        [[1898.68, 775.0, 1158.48], [2000.0, 775.0, 1166.7], [1898.68, 675.0, 1148.6]],
        [[1966.41, 675.0, 1163.79], [1971.63, 675.0, 1166.95], [1967.56, 684.554, 1166.67]],
        false,
        false,
    ),
    (
        "LokiResearch/fast-triangle-triangle-intersection#3",
        [[-1.0, 0.0, 0.0], [2.0, 0.0, -2.0], [2.0, 0.0, 2.0]],
        [[0.551, 0.0, -0.796], [1.224, 0.0, 0.326], [3.469, 0.0, 1.0]],
        true,
        true,
    ),
    (
        "gradientspace/geometry3Sharp#85 t0/t1",
        [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        true,
        true,
    ),
    (
        "gradientspace/geometry3Sharp#85 t1/t2",
        [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0]],
        false,
        false,
    ),
    (
        "CGAL/cgal#9256",
        [[0.0080606, 0.175, 0.0080606], [0.0146, 0.175, 0.0], [0.0154, 0.175, 0.0154]],
        [[0.0146, 0.175, 0.0], [0.024625, 0.16399, 0.0], [0.0099918, 0.16476, 0.0]],
        true,
        true,
    ),
    (
        "coal-library/coal#48",
        [
            [-12.989391433999979, -1.2885119162351786, 3.7266872889934026],
            [-12.989763285770795, -1.2891305896265277, 3.720706157989417],
            [-12.989391437959867, -1.286704240895501, 3.725831537939471],
        ],
        [
            [-25.655, -1.2858199462890625, 3.72498095703125],
            [-10.926, -1.284259033203125, 3.72814990234375],
            [-10.926, -1.2866180419921875, 3.72335400390625],
        ],
        false,
        false,
    ),
];

/// libigl/libigl#2381: a planar patch, subdivided twice, whose triangles do not meet unless they share a corner.
const PATCH: [[f64; 3]; 15] = [
    [0.280039012432098, 0.827663004398346, 0.463775008916855],
    [0.33890101313591, 0.788042008876801, 0.488126993179321],
    [0.318053007125854, 0.768364012241364, 0.493088006973267],
    [0.309470012784004, 0.8078525066375735, 0.475951001048088],
    [0.299046009778976, 0.798013508319855, 0.478431507945061],
    [0.328477010130882, 0.7782030105590825, 0.490607500076294],
    [0.29475451260805097, 0.8177577555179597, 0.4698630049824715],
    [0.28954251110553697, 0.8128382563591005, 0.471103258430958],
    [0.324185512959957, 0.7979472577571872, 0.4820389971137045],
    [0.333689011633396, 0.7831225097179417, 0.4893672466278075],
    [0.308549508452415, 0.7831887602806095, 0.485759757459164],
    [0.323265008628368, 0.7732835114002232, 0.4918477535247805],
    [0.30425801128149, 0.8029330074787142, 0.4771912544965745],
    [0.318973511457443, 0.793027758598328, 0.483279250562191],
    [0.313761509954929, 0.7881082594394687, 0.4845195040106775],
];
const PATCH_FACES: [[u32; 3]; 16] = [
    [2, 11, 10],
    [1, 8, 9],
    [0, 7, 6],
    [3, 12, 13],
    [5, 14, 11],
    [3, 13, 8],
    [4, 12, 7],
    [4, 14, 12],
    [4, 10, 14],
    [5, 9, 13],
    [3, 6, 12],
    [5, 13, 14],
    [14, 10, 11],
    [13, 9, 8],
    [12, 6, 7],
    [14, 13, 12],
];

#[test]
fn reported_triangles() {
    for (name, p, q, truth, rounded) in TRIANGLES {
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
