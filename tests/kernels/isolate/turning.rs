//! The planes that turn with the features: what they say against the distance itself, and against contacts.

use super::rung::points;
use nearmiss_kernels::prim::inclusion::{Grid, Params};
use nearmiss_kernels::prim::isolate::nearest::nearest;
use nearmiss_kernels::prim::isolate::{Edges, Face, Pair};
use nearmiss_lab::Features;
use nearmiss_lab::pairs::built::{Built, built};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// Outcome of the claims: how many, how many of half the distance that are false of all of it, and
/// a false one.
#[derive(Default)]
struct Outcome {
    claims: u32,
    weaker: u32,
    fault: Option<String>,
}

/// The claim: whether the features stay farther apart from one time to another.
type Plane<S, const N: usize> = fn(&Pair<S, N>, (S, S), S) -> bool;

fn turned<S: Grid, const N: usize>(pair: &Pair<S, N>, (from, to): (S, S), over: S) -> bool {
    let hull = pair.hull();
    hull.stays_farther(&hull.facing(from), &hull.facing(to), over)
}

fn along<S: Grid, const N: usize>(pair: &Pair<S, N>, part: (S, S), over: S) -> bool {
    pair.normal().is_farther(part, over)
}

/// `exact` is the same pair in f64, which knows the distance, in units `scale` times as large.
fn ask<S: Grid, const N: usize>(
    (pair, plane): (&Pair<S, N>, Plane<S, N>),
    (exact, toi): (&Pair<f64, N>, Option<f64>),
    r: &mut SmallRng,
    told: &mut Outcome,
) {
    let scale = exact.scale / pair.scale;
    // No point of the hull is nearer than this says, but for roundings.
    let nearer = |t: f64, over: f64| exact.at_most(nearest(&exact.at(t))) < over * scale;
    for _ in 0..40 {
        let from = S::of(r.random_range(0.0..1.0));
        let to = S::of((from.wide() + 2f64.powi(-r.random_range(0..20))).min(1.0));
        let over = pair.reach.wide() * 2f64.powi(-r.random_range(1..30));
        let (f, t) = (from.wide(), to.wide());
        let seen = |over: f64| (0..=8).any(|i| nearer(f + (t - f) * f64::from(i) / 8.0, over));
        if plane(pair, (from, to), S::of(over)) {
            told.claims += 1;
            if seen(over) || toi.is_some_and(|toi| (f..=t).contains(&toi)) {
                told.fault = Some(format!("[{f}, {t}] beyond {over}, with a contact at {toi:?}"));
            }
        } else {
            told.weaker += u32::from(plane(pair, (from, to), S::of(0.5 * over)) && seen(over));
        }
    }
}

fn told<S: Grid>(seed: u64, vf: Plane<S, 3>, ee: Plane<S, 4>) -> Outcome {
    let (mut told, mut r) = (Outcome::default(), SmallRng::seed_from_u64(seed));
    for Built { case, toi, .. } in built(seed, 40, 64) {
        let ([a, b, c, d], p) = (points::<f64>(&case), Params::new(0.0));
        match case.features {
            Features::VertexFace => {
                let (pair, exact) = (Face::<S>::new(a, [b, c, d], &p), Face::<f64>::new(a, [b, c, d], &p));
                ask((&pair, vf), (&exact, toi), &mut r, &mut told);
            }
            Features::EdgeEdge => {
                let (x, y) = ([a, b], [c, d]);
                let (pair, exact) = (Edges::<S>::new(x, y, &p), Edges::<f64>::new(x, y, &p));
                ask((&pair, ee), (&exact, toi), &mut r, &mut told);
            }
        }
    }
    told
}

fn judged(name: &str, told: Outcome) {
    println!("{name}: {} claims; {} would be false of twice the distance", told.claims, told.weaker);
    assert_eq!(told.fault, None, "{name}");
    assert!(told.claims > 1_000, "{name}: {}", told.claims);
    // The comparison sees a claim that is too strong.
    assert!(told.weaker > 100, "{name}: {}", told.weaker);
}

#[test]
fn what_a_plane_keeps_farther_is_farther() {
    judged("turned, f32", told::<f32>(31, turned, turned));
    judged("turned, f64", told::<f64>(31, turned, turned));
    judged("along both, f32", told::<f32>(31, along, along));
    judged("along both, f64", told::<f64>(31, along, along));
}
