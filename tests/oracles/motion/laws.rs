//! Laws, and linear programs at fixed times: motions on small grids, where most contacts are degenerate.

use super::case;
use nearmiss_lab::oracle::simplex::{Outcome, maximize};
use nearmiss_lab::oracle::{exact, first_contact, meet_at};
use nearmiss_lab::{Case, Features};
use num_rational::BigRational;
use num_traits::{One, Zero};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// Whether the features share a point at the fraction `t`: weights of both, each summing to one, of equal places.
fn feasible(case: &Case, t: &BigRational) -> bool {
    let first = |i: usize| i < if case.features == Features::VertexFace { 1 } else { 2 };
    let at = |i: usize, k: usize| {
        let (a, b) = (exact(case.positions_t0[i][k]), exact(case.positions_t1[i][k]));
        let x = &a + (&b - &a) * t;
        if first(i) { x } else { -x }
    };
    let (one, zero) = (BigRational::one, BigRational::zero);
    let mut rows: Vec<Vec<BigRational>> = (0..3).map(|k| (0..4).map(|i| at(i, k)).collect()).collect();
    rows.push((0..4).map(|i| if first(i) { one() } else { zero() }).collect());
    rows.push((0..4).map(|i| if first(i) { zero() } else { one() }).collect());
    let right = [zero(), zero(), zero(), one(), one()];
    maximize(&rows, &right, &vec![zero(); 4]) != Outcome::Infeasible
}

/// Motions on the grid 0..n, some of them flat or still.
fn motions(seed: u64, count: usize) -> impl Iterator<Item = Case> {
    let mut r = SmallRng::seed_from_u64(seed);
    (0..count).map(move |i| {
        let (n, dims) = ([2, 3, 4, 9][i % 4], [3, 3, 2, 1, 3][i % 5]);
        let mut grid = || {
            [0; 4].map(|_| [0, 1, 2].map(|k| if k < dims { f64::from(r.random_range(0..n)) } else { 1.0 }))
        };
        let (t0, t1) = (grid(), grid());
        let features = if i % 2 == 0 { Features::VertexFace } else { Features::EdgeEdge };
        case(features, t0, if i % 11 == 0 { t0 } else { t1 })
    })
}

/// At the first time the linear program has a solution, if it applies; before it, never.
#[test]
fn linear_programs_agree() {
    let (mut met, mut fractions, mut zero) = (0, 0, 0);
    for case in motions(1, 4000) {
        let toi = first_contact(&case);
        let until = toi.as_ref().map_or_else(BigRational::one, |toi| toi.within(30).0);
        for k in 0..=4 {
            let t = &until * BigRational::new(k.into(), 4.into());
            let before = toi.as_ref().is_none_or(|toi| toi.within(200).0 > t);
            assert!(!before || !feasible(&case, &t), "{case:?} at {t}");
        }
        for t in [0.0, 0.25, 1.0] {
            assert_eq!(meet_at(&case, t), feasible(&case, &exact(t)), "{case:?} at {t}");
        }
        met += toi.is_some() as usize;
        if let Some(t) = toi.and_then(|toi| toi.ratio()) {
            assert!(feasible(&case, &t), "{case:?} at {t}");
            fractions += 1;
            zero += t.is_zero() as usize;
        }
    }
    println!("{met} meet, {fractions} at fractions, {zero} at 0");
    assert!(met > 1000 && fractions - zero > 200 && met - fractions > 50, "{met} {fractions} {zero}");
}

/// The same answer for the other order of corners, of ends and of edges, for other axes, for powers of two, and, as to
/// whether, for the motion reversed.
#[test]
fn answers_do_not_hang_on_names_or_units() {
    for case in motions(2, 1500) {
        let toi = first_contact(&case);
        let ordered = |order: [usize; 4]| Case {
            positions_t0: order.map(|i| case.positions_t0[i]),
            positions_t1: order.map(|i| case.positions_t1[i]),
            ..case
        };
        let orders = match case.features {
            Features::VertexFace => [[0, 2, 1, 3], [0, 3, 1, 2], [0, 3, 2, 1]],
            Features::EdgeEdge => [[1, 0, 2, 3], [2, 3, 0, 1], [3, 2, 1, 0]],
        };
        for order in orders {
            assert_eq!(first_contact(&ordered(order)), toi, "{case:?} {order:?}");
        }
        let changed = |f: &dyn Fn([f64; 3]) -> [f64; 3]| Case {
            positions_t0: case.positions_t0.map(f),
            positions_t1: case.positions_t1.map(f),
            ..case
        };
        let changes: [&dyn Fn([f64; 3]) -> [f64; 3]; 4] = [
            &|[x, y, z]| [z, x, -y],
            &|p| p.map(|x| x * 2f64.powi(600)),
            &|[x, y, z]| [x * 2f64.powi(-700), y, z * 2f64.powi(300)],
            &|[x, y, z]| [x + 4096.0, y - 0.5, z + x],
        ];
        for change in changes {
            assert_eq!(first_contact(&changed(change)), toi, "{case:?}");
        }
        let reversed = case_reversed(&case);
        assert_eq!(first_contact(&reversed).is_some(), toi.is_some(), "{case:?}");
    }
}

fn case_reversed(of: &Case) -> Case {
    case(of.features, of.positions_t1, of.positions_t0)
}
