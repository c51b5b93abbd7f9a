//! The plane that turns with the features: what it says against the distance itself, and against contacts.

use super::rung::points;
use nearmiss::Features;
use nearmiss::pairs::built::{Built, built};
use nearmiss_kernels::prim::inclusion::Params;
use nearmiss_kernels::prim::isolate::nearest::nearest;
use nearmiss_kernels::prim::isolate::{Edges, Face, Pair};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// What came of the claims: how many, how many of half the distance that are false of all of it, and a false one.
#[derive(Default)]
struct Told {
    claims: u32,
    weaker: u32,
    fault: Option<String>,
}

fn ask<const N: usize>(pair: &Pair<f64, N>, toi: Option<f64>, r: &mut SmallRng, told: &mut Told) {
    let turning = pair.turning();
    // No point of the hull is nearer than this says, but for roundings.
    let nearer = |t: f64, over: f64| pair.at_most(nearest(&pair.at(t))) < over;
    for _ in 0..40 {
        let from: f64 = r.random_range(0.0..1.0);
        let to = (from + 2f64.powi(-r.random_range(0..20))).min(1.0);
        let over = pair.reach * 2f64.powi(-r.random_range(1..30));
        let seen = |over: f64| (0..=8).any(|i| nearer(from + (to - from) * f64::from(i) / 8.0, over));
        if turning.is_farther((from, to), over) {
            told.claims += 1;
            if seen(over) || toi.is_some_and(|toi| (from..=to).contains(&toi)) {
                told.fault = Some(format!("[{from}, {to}] beyond {over}, with a contact at {toi:?}"));
            }
        } else {
            told.weaker += u32::from(turning.is_farther((from, to), 0.5 * over) && seen(over));
        }
    }
}

fn told(seed: u64) -> Told {
    let (mut told, mut r) = (Told::default(), SmallRng::seed_from_u64(seed));
    for Built { case, toi, .. } in built(seed, 40, 64) {
        let ([a, b, c, d], p) = (points::<f64>(&case), Params::new(0.0));
        match case.features {
            Features::VertexFace => ask(&Face::<f64>::new(a, [b, c, d], &p), toi, &mut r, &mut told),
            Features::EdgeEdge => ask(&Edges::<f64>::new([a, b], [c, d], &p), toi, &mut r, &mut told),
        }
    }
    told
}

#[test]
fn what_it_keeps_farther_is_farther() {
    let told = told(31);
    println!("{} claims; {} would be false of twice the distance", told.claims, told.weaker);
    assert_eq!(told.fault, None);
    assert!(told.claims > 1_000);
    // The comparison sees a claim that is too strong.
    assert!(told.weaker > 100, "{}", told.weaker);
}
