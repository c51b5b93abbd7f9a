//! Motions built in integers, at ordinary scales and at the ends of both precisions: every answer against the rational
//! oracle, and every rung has its share.

use super::rung::{Rung, certified, deciding};
use nearmiss_kernels::math::Real;
use nearmiss_kernels::prim::inclusion::{Params, Verdict};
use nearmiss_kernels::prim::isolate::Rungs;
use nearmiss_lab::oracle::first_contact;
use nearmiss_lab::pairs::built::{Built, REACH_F32, built};
use nearmiss_lab::pairs::directed::{DIRECTED, directed};
use std::collections::BTreeMap;
use support::fuzz::continuous::fault;

/// How many each rung decided: separated, in contact, undecided.
pub type Shares = BTreeMap<Rung, [u32; 3]>;

fn note(shares: &mut Shares, rung: Rung, verdict: &Verdict) {
    let at = if verdict.is_separated() { 0 } else { 2 - usize::from(verdict.is_contact()) };
    shares.entry(rung).or_default()[at] += 1;
}

/// Tests in `R`, by all rungs and by some; returns the first fault.
fn ask<R: Real>(all: &[Built], tolerances: &[f64], shares: &mut Shares) -> Option<String> {
    for built in all {
        let truth = first_contact(&built.case);
        for &tolerance in tolerances {
            let p = Params::new(tolerance);
            let (rung, verdict) = deciding::<R>(&built.case, &p);
            note(shares, rung, &verdict);
            for rungs in [Rungs::All, Rungs::Single, Rungs::Double] {
                let said = certified::<R>(&built.case, rungs, &p);
                let what =
                    || format!("{}, {rungs:?}, {p:?}: {said:?} by {rung:?}, {:?}", built.name, built.case);
                if rungs == Rungs::All && said != verdict {
                    return Some(format!("not {verdict:?}: {}", what()));
                }
                if let Some(fault) = fault(&said, truth.as_ref()) {
                    let truth = truth.as_ref().map(|toi| toi.bracket());
                    return Some(format!("{fault}, exactly {truth:?}: {}", what()));
                }
            }
        }
    }
    None
}

fn print(name: &str, shares: &Shares) {
    println!("{name}: separated, in contact, undecided");
    shares.iter().for_each(|(rung, shares)| println!("  {rung:?} {shares:?}"));
}

#[test]
fn built_motions_are_judged_by_the_oracle() {
    let mut shares = Shares::new();
    for (seed, reach, tolerance) in [(1, 4, 1e-3), (2, REACH_F32, 1e-6), (3, 1 << 30, 1e-6), (4, 64, 0.0)] {
        let all = built(seed, 8, reach);
        let tolerance = tolerance * reach as f64;
        assert_eq!(ask::<f64>(&all, &[tolerance], &mut shares), None);
        let single: Vec<Built> = all.into_iter().filter(|built| built.case.fits_f32()).collect();
        assert_eq!(ask::<f32>(&single, &[tolerance], &mut shares), None);
    }
    print("all kinds", &shares);
    // After slices, nothing built in integers is far.
    let idle = |rung: &Rung| *rung != Rung::Near && !shares.contains_key(rung);
    let idle: Vec<Rung> = Rung::ALL.into_iter().filter(idle).collect();
    assert!(idle.is_empty(), "rungs that decide nothing: {idle:?}");
    let of = |rung: Rung, at: usize| shares[&rung][at];
    assert!(of(Rung::Single, 0) > 9 && of(Rung::Double, 0) > 9 && of(Rung::Double, 1) > 9);
    assert!([Rung::Boxes, Rung::Signs, Rung::Window].iter().all(|rung| shares[rung][1..] == [0, 0]));
    for rung in [Rung::Together, Rung::Touch] {
        assert_eq!(shares[&rung][1], shares[&rung].iter().sum::<u32>(), "{rung:?}");
    }
}

#[test]
fn hostile_scales_are_judged_by_the_oracle() {
    for (family, name) in DIRECTED.iter().enumerate() {
        let mut shares = Shares::new();
        for single in [true, false] {
            let all = directed(11, family, single, 60);
            assert_eq!(ask::<f64>(&all, &[0.0, 1e-6], &mut shares), None);
            if single {
                assert_eq!(ask::<f32>(&all, &[0.0, 1e-6], &mut shares), None);
            }
        }
        print(name, &shares);
        let contacts: u32 = shares.values().map(|shares| shares[1]).sum();
        assert!(contacts > 20, "{name}: {contacts}");
    }
}

/// Extents near the largest that a mesh of f32 may hold, where products of four lengths would overflow.
#[test]
fn what_is_far_larger_is_scaled() {
    for built in built(5, 2, 16) {
        for power in [-480, -140, -20, 20, 55] {
            let mut case = built.case;
            let by = 2f64.powi(power);
            for p in case.positions_t0.iter_mut().chain(&mut case.positions_t1).flatten() {
                *p *= by;
            }
            let (there, here) = (Params::new(1e-3 * by), Params::new(1e-3));
            let one = certified::<f64>(&built.case, Rungs::All, &here);
            assert_eq!(certified::<f64>(&case, Rungs::All, &there), one, "{}, 2^{power}", built.name);
            if power.abs() == 20 && case.fits_f32() {
                assert_eq!(
                    certified::<f32>(&case, Rungs::All, &there),
                    one,
                    "{}, 2^{power}, f32",
                    built.name
                );
            }
        }
    }
}
