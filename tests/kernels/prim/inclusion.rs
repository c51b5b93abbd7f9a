//! The certified continuous tests on motions built to meet exactly, in integers: never missed, never late; and the
//! judges of that, shown to condemn.

use super::random;
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::{
    Cell, Edges, Face, Grid, Params, Search, Verdict, ee_certified, ee_first, vf_certified, vf_first,
};
use nearmiss_lab::pairs::built::{FAMILIES, KINDS, Motion, REACH_F32, REACH_F64, motion, of_kind};
use std::mem::MaybeUninit;
use support::cases;

/// The points of a motion in integers, times `scale`.
pub fn points<R: Real>(m: &Motion, scale: f64) -> [Moving<R>; 4] {
    let x = |t: usize, i: usize| Vec3(m[t][i].map(|x| R::of(x as f64 * scale)));
    [0, 1, 2, 3].map(|i| Moving { t0: x(0, i), t1: x(1, i) })
}

/// The certified answer for four points: vertex and face, or two edges.
pub fn certified<R: Real, S: Grid>([p, q, r, s]: [Moving<R>; 4], face: bool, params: &Params) -> Verdict {
    let v = if face {
        vf_certified::<R, S>(p, [q, r, s], params)
    } else {
        ee_certified::<R, S>([p, q], [r, s], params)
    };
    well_formed(&v, params);
    v
}

/// The two passes, f32 and then f64.
pub fn in_passes<R: Real>(x: [Moving<R>; 4], face: bool, params: &Params) -> Verdict {
    let [p, q, r, s] = x;
    let first = if face { vf_first(p, [q, r, s], params) } else { ee_first([p, q], [r, s], params) };
    first.unwrap_or_else(|| certified::<R, f64>(x, face, params))
}

fn well_formed(v: &Verdict, params: &Params) {
    assert!((0.0..=1.0).contains(&v.toi) && v.toi.is_sign_positive(), "{v:?}");
    assert!(v.toi <= v.toi_upper && v.toi_upper <= params.end, "{v:?}");
    assert!(v.boxes <= params.max_iterations, "{v:?}");
}

/// Faults of answers to motions that meet at a known time, or before.
#[derive(Debug, Default)]
struct Judge {
    missed: u32,
    late: u32,
    contacts: u32,
    exhausted: u32,
    boxes: u64,
}

impl Judge {
    fn note(&mut self, v: Verdict, truth: f64) {
        self.missed += v.is_separated() as u32;
        self.late += (v.toi > truth || v.toi > v.toi_upper) as u32;
        self.contacts += v.is_contact() as u32;
        self.exhausted += v.exhausted() as u32;
        self.boxes += v.boxes as u64;
    }
    fn right(&self) -> bool {
        self.missed + self.late == 0
    }
}

/// Tests `n` motions of each family, kind and reach; tolerances from a thousandth of it to none.
fn built(
    seed: u64,
    n: usize,
    asked: impl Fn([Moving<f64>; 4], bool, &Params) -> Verdict,
) -> Vec<(String, Judge)> {
    let mut r = random(seed);
    let mut all = Vec::new();
    for reach in [8, REACH_F32, REACH_F64 / 32] {
        for (kind, face) in (0..KINDS).flat_map(|kind| [(kind, true), (kind, false)]) {
            let (mut judge, mut names) = (Judge::default(), String::new());
            for i in 0..n {
                let (m, truth, name) = of_kind(&mut r, kind, face, i, reach);
                let tolerance = [1e-6, 1e-3, 1e-9, 0.0][i / 5 % 4] * reach as f64;
                judge.note(asked(points(&m, 1.0), face, &Params::new(tolerance)), truth);
                names = name;
            }
            let kind = names.split(',').next().unwrap().to_owned();
            all.push((format!("{kind}, face {face}, reach {reach}"), judge));
        }
    }
    all
}

fn all_right(judges: Vec<(String, Judge)>) {
    for (name, judge) in judges {
        assert!(judge.right(), "{name}: {judge:?}");
    }
}

/// About 65,000 in all.
#[test]
fn built_contacts_are_never_missed_or_late() {
    all_right(built(51, 300, certified::<f64, f64>));
    all_right(built(52, 300, certified::<f64, f32>));
    all_right(built(53, 300, in_passes));
}

/// A million of each of twelve families, in each precision.
#[test]
#[ignore = "ten minutes"]
fn millions_of_built_contacts() {
    all_right(built(54, 1_000_000 / 6, certified::<f64, f64>));
    all_right(built(55, 1_000_000 / 6, certified::<f64, f32>));
}

fn to_its_end<S: Grid, const N: usize>(search: Result<Search<S, N>, (Verdict, bool)>, p: &Params) -> Verdict {
    match search {
        Ok(mut search) => loop {
            if let Some((verdict, _)) = search.step(p) {
                return verdict;
            }
        },
        Err((verdict, _)) => verdict,
    }
}

/// The answer of the search alone, with `planted` done to the motion and so many places on the stack.
fn searched<S: Grid>(
    [p, q, r, s]: [Moving<f64>; 4],
    face: bool,
    params: &Params,
    places: usize,
    planted: fn(Vec3<S>) -> Vec3<S>,
) -> Verdict {
    let mut stack = vec![MaybeUninit::<Cell<S>>::uninit(); places];
    let v: Verdict = if face {
        let mut m = Face::<S>::new(p, [q, r, s], params);
        m.reach = planted(m.reach);
        to_its_end(Search::unfiltered(m, params, &mut stack), params)
    } else {
        let mut m = Edges::<S>::new([p, q], [r, s], params);
        m.reach = planted(m.reach);
        to_its_end(Search::unfiltered(m, params, &mut stack), params)
    };
    assert!(v.boxes <= params.max_iterations);
    v
}

#[test]
fn small_budgets_and_stacks_are_early_never_wrong() {
    for (k, budget) in [0, 1, 2, 3, 5, 8, 20].into_iter().enumerate() {
        let judges = built(60 + k as u64, 40, |x, face, p| {
            certified::<f64, f32>(x, face, &Params { max_iterations: budget, ..*p })
        });
        assert!(judges.iter().map(|(_, j)| j.exhausted).sum::<u32>() > 100);
        all_right(judges);
    }
    for places in [0, 1, 2, 6] {
        let judges =
            built(70 + places as u64, 40, |x, face, p| searched::<f64>(x, face, p, places, |reach| reach));
        assert!(judges.iter().map(|(_, j)| j.exhausted).sum::<u32>() > 100);
        all_right(judges);
    }
}

/// A bound that forgets rounding, half of it even; and a budget that ends as separated: all are condemned.
#[test]
fn planted_faults_are_noticed() {
    let wrong = |judges: Vec<(String, Judge)>| judges.iter().map(|(_, j)| j.missed + j.late).sum::<u32>();
    let with = |planted: fn(Vec3<f32>) -> Vec3<f32>| {
        wrong(built(80, 200, |x, face, p| searched::<f32>(x, face, p, 48, planted)))
    };
    assert_eq!(with(|reach| reach), 0);
    let (none, little) = (with(|reach| reach * 1e-9), with(|reach| reach * 0.05));
    println!("wrong without the bound {none}, with a twentieth {little}");
    assert!(none > 100 && little > 0);
    let forgetful = built(81, 40, |x, face, p| {
        let v = certified::<f64, f64>(x, face, &Params { max_iterations: 2, ..*p });
        if v.exhausted() && !v.is_contact() { Verdict::separated(p.end, v.boxes) } else { v }
    });
    assert!(wrong(forgetful) > 100);
    let late = built(82, 40, |x, face, p| {
        let v = certified::<f64, f64>(x, face, p);
        Verdict { toi: (v.toi + 1e-6).min(v.toi_upper), ..v }
    });
    assert!(wrong(late) > 100);
}

/// Powers of two, the sign of coordinates, common motion by exact numbers, and where positions are kept: the same bits.
#[test]
fn laws() {
    let mut r = random(56);
    for i in 0..cases(504, 3_000) {
        let (kind, face) = (i % FAMILIES.len(), i % 2 == 0);
        let m = motion(&mut r, kind, face, [5, 0, 16][i % 3], 8);
        let p = Params { min_separation: [0.0, 3.0][i / 7 % 2], ..Params::new([1e-3, 1e-7, 0.0][i / 3 % 3]) };
        let (double, single) = (
            certified::<f64, f64>(points(&m, 1.0), face, &p),
            certified::<f64, f32>(points(&m, 1.0), face, &p),
        );
        for k in [-900, -300, 3, 400] {
            let scale = 2f64.powi(k);
            let scaled =
                Params { tolerance: p.tolerance * scale, min_separation: p.min_separation * scale, ..p };
            assert_eq!(double, certified::<f64, f64>(points(&m, scale), face, &scaled), "{k}");
            assert_eq!(single, certified::<f64, f32>(points(&m, scale), face, &scaled), "{k}");
        }
        for k in [-100, -60, 3, 40] {
            let scale = 2f64.powi(k);
            let scaled =
                Params { tolerance: p.tolerance * scale, min_separation: p.min_separation * scale, ..p };
            assert_eq!(single, certified::<f32, f32>(points(&m, scale), face, &scaled), "{k}");
            assert_eq!(double, certified::<f32, f64>(points(&m, scale), face, &scaled), "{k}");
        }
        let moved = m.map(|t| t.map(|p| p.map(|x| x + (1 << 20))));
        assert_eq!(double, certified::<f64, f64>(points(&moved, 1.0), face, &p));
        assert_eq!(single, certified::<f64, f32>(points(&moved, 1.0), face, &p));
        let along = [m[0], m[1].map(|p| p.map(|x| x + (1 << 30)))].map(|t| t.map(|p| p.map(|x| -x)));
        let along = [along[0], along[1].map(|p| p.map(|x| x + (1 << 30)))];
        assert_eq!(double, certified::<f64, f64>(points(&along, 1.0), face, &p), "mirrored through a point");
        assert_eq!(
            double,
            certified::<f64, f64>(points(&along, -1.0).map(zeros), face, &p),
            "signs of zeros"
        );
        exchanges(&m, face, &p, &single);
        exchanges(&[m[1], m[0]], face, &p, &certified::<f64, f32>(points(&[m[1], m[0]], 1.0), face, &p));
    }
}

/// The same points with negative zeros.
fn zeros(p: Moving<f64>) -> Moving<f64> {
    let negative = |x: Vec3<f64>| x.map(|x| if x == 0.0 { -0.0 } else { x });
    Moving { t0: negative(p.t0), t1: negative(p.t1) }
}

/// Orders of the same points round differently: no two answers contradict each other.
fn exchanges(m: &Motion, face: bool, p: &Params, one: &Verdict) {
    let orders: &[[usize; 4]] = if face {
        &[[0, 2, 3, 1], [0, 3, 1, 2], [0, 1, 3, 2], [0, 3, 2, 1], [0, 2, 1, 3]]
    } else {
        &[[1, 0, 2, 3], [0, 1, 3, 2], [1, 0, 3, 2], [2, 3, 0, 1], [3, 2, 0, 1], [2, 3, 1, 0], [3, 2, 1, 0]]
    };
    let x = points::<f64>(m, 1.0);
    for order in orders {
        let v = certified::<f64, f32>(order.map(|i| x[i]), face, p);
        for (a, b) in [(one, &v), (&v, one)] {
            assert!(!a.is_contact() || (!b.is_separated() && b.toi <= a.toi_upper), "{one:?}, {v:?}");
        }
    }
}
