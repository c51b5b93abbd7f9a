//! The certified continuous tests on motions built to meet exactly, in integers.

use crate::built::{FAMILIES, Motion, REACH_F32, REACH_F64, motion};
use crate::random;
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::{Grid, Params, Verdict, ee_certified, vf_certified};

/// The points of a motion in integers, times `scale`.
pub fn points<R: Real>(m: &Motion, scale: f64) -> [Moving<R>; 4] {
    let x = |t: usize, i: usize| Vec3(m[t][i].map(|x| R::of(x as f64 * scale)));
    [0, 1, 2, 3].map(|i| Moving { t0: x(0, i), t1: x(1, i) })
}

/// The certified answer for four points.
pub fn certified<R: Real, S: Grid>([p, q, r, s]: [Moving<R>; 4], face: bool, params: &Params) -> Verdict {
    let v = if face {
        vf_certified::<R, S>(p, [q, r, s], params)
    } else {
        ee_certified::<R, S>([p, q], [r, s], params)
    };
    assert!((0.0..=1.0).contains(&v.toi) && v.toi.is_sign_positive(), "{v:?}");
    assert!(v.toi <= v.toi_hi && v.toi_hi <= params.end, "{v:?}");
    v
}

/// How a family did, in one precision.
#[derive(Debug, Default)]
struct Count {
    missed: u32,
    late: u32,
    contacts: u32,
    exhausted: u32,
    boxes: u64,
    most: u32,
}

impl Count {
    fn note(&mut self, v: Verdict, truth: f64) {
        self.missed += v.is_separated() as u32;
        self.late += (v.toi > truth) as u32;
        self.contacts += v.is_contact() as u32;
        self.exhausted += v.exhausted() as u32;
        self.boxes += v.boxes as u64;
        self.most = self.most.max(v.boxes);
    }
}

fn built(n: usize, show: bool) {
    let mut r = random(51);
    for reach in [8, REACH_F32, REACH_F64] {
        for family in 0..FAMILIES.len() {
            for face in [true, false] {
                for tol in 0..4 {
                let mut counts: [Count; 2] = Default::default();
                for i in 0..n {
                    let time = [0, 16, 1, 8, 11][i % 5];
                    let m = motion(&mut r, family, face, time, reach);
                    let truth = time as f64 / 16.0;
                    let p = Params::new([1e-6, 1e-3, 1e-9, 0.0][tol] * reach as f64);
                    counts[0].note(certified::<f64, f64>(points(&m, 1.0), face, &p), truth);
                    counts[1].note(certified::<f64, f32>(points(&m, 1.0), face, &p), truth);
                }
                if show {
                    println!("{reach:13} {tol} {:10} {face:5} {counts:?}", FAMILIES[family]);
                }
                }
                for c in Vec::<Count>::new() {
                    assert_eq!((c.missed, c.late), (0, 0), "{}, face {face}, {reach}: {c:?}", FAMILIES[family]);
                }
            }
        }
    }
}

#[test]
fn built_contacts_are_never_missed_or_late() {
    built(1000, true);
}
