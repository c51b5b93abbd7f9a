//! Distances of features at rest: `prim::near`.

use super::hunt::{Found, Hunt, held};
use nearmiss_kernels::math::tolerance::{DISTANCE_CERTAIN, DISTANCE_ERROR, DISTANCE_UP, U64};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::near::{Radii, edge_edge, shortest, vertex_face};
use nearmiss_lab::case::Features;
use nearmiss_lab::oracle::near::{Places, distance_squared};
use num_traits::ToPrimitive;
use rand::Rng;
use rand::rngs::SmallRng;
use support::cases;

const KINDS: [Features; 2] = [Features::VertexFace, Features::EdgeEdge];

/// By how much a computed distance is above the true one, in parts of the largest difference.
fn above(features: Features, x: &[f64]) -> f64 {
    let at: [[f64; 3]; 4] = std::array::from_fn(|i| std::array::from_fn(|k| x[3 * i + k]));
    let [a, b, c, d] = at.map(Vec3);
    let (near, of) = match features {
        Features::VertexFace => (vertex_face(a, [b, c, d], f64::MAX), [b - a, c - b, d - b]),
        Features::EdgeEdge => (edge_edge([a, b], [c, d], f64::MAX), [a - c, b - a, c - d]),
    };
    let reach = of.iter().flat_map(|v| v.0).fold(0.0, |most: f64, x| most.max(x.abs()));
    let (squared, truth) = (near.expect("within").squared, distance_squared(features, at).to_f64());
    (squared - truth) / (squared.sqrt() + truth.sqrt()) / reach
}

/// Flat features over one another: slivers, and edges that are nearly parallel, with an inside between them.
fn flat(r: &mut SmallRng, features: Features) -> Vec<f64> {
    let mut any = || -> [f64; 3] { std::array::from_fn(|_| r.random_range(-1.0..1.0)) };
    let [a, e, w, n] = [any(), any(), any(), any()];
    let [thin, s, t] = [r.random_range(1..30), r.random_range(0..8), r.random_range(0..8)];
    let (thin, [s, t]) = (2f64.powi(-thin), [s, t].map(|k| f64::from(k) / 8.0));
    let high = 2f64.powi(-r.random_range(0..30));
    let along = |x: [f64; 3], d: [f64; 3], by: f64| -> [f64; 3] { std::array::from_fn(|k| x[k] + by * d[k]) };
    let (b, way) = (along(a, e, 1.0), along(e, w, thin));
    let over = along(along(a, e, s), n, high);
    match features {
        Features::VertexFace => [over, a, b, along(along(a, e, t), w, thin)].concat(),
        Features::EdgeEdge => [a, b, along(over, way, -t), along(over, way, 1.0 - t)].concat(),
    }
}

fn most(features: Features, by: f64, sign: f64) -> Found {
    let hunt = Hunt { starts: 24, ..Hunt::new(71) };
    hunt.most::<f64>(|r| flat(r, features), |x| sign * above(features, x) / by)
}

/// How far a computed distance is above the true one. The proof adds up worst cases that do not come together, and what it rounds up
/// costs nothing: so the search comes to a fiftieth of the bound, and a bound of a sixtieth would be broken.
#[test]
fn the_error_of_a_distance() {
    for features in KINDS {
        let Found { ratio, input } = most(features, DISTANCE_ERROR, 1.0);
        println!("DISTANCE_ERROR, {features:?}: {ratio:.4} of the bound");
        assert!((1.0 / 60.0..=1.0).contains(&ratio), "{features:?}: {ratio} by {input:?}");
    }
}

/// Measured: how far it is below.
#[test]
fn distance_certain() {
    for features in KINDS {
        held("DISTANCE_CERTAIN", &format!("{features:?}"), &most(features, DISTANCE_CERTAIN, -1.0));
    }
}

/// Measured: what the sum of two lengths and the square of it use up of the factor, of its square.
#[test]
fn distance_up() {
    let start = |r: &mut SmallRng| vec![r.random_range(0.5..2.0), r.random_range(0.5..2.0)];
    let used = |x: &[f64]| {
        let said = x[0] + x[1] * DISTANCE_ERROR;
        // The part of a unit by which the sum is below, and the square below that: doubles of doubles.
        let lost = (x[0] - said) + x[1] * DISTANCE_ERROR;
        let square = said * said;
        let of_square = f64::mul_add(said, said, -square);
        (2.0 * lost / said + of_square / square) / (2.0 * (DISTANCE_UP - 1.0))
    };
    held("DISTANCE_UP", "f64", &Hunt::new(72).most::<f64>(start, used));
    assert_eq!(DISTANCE_UP, 1.0 + 8.0 * U64);
}

/// How far a parameter of the nearest points is from the computed one, in parts of the range that is
/// allowed for it. 0 for a range that is not short: there nearest points are many.
fn beside(features: Features, x: &[f64]) -> f64 {
    let at: [[f64; 3]; 4] = std::array::from_fn(|i| std::array::from_fn(|k| x[3 * i + k]));
    let [a, b, c, d] = at.map(Vec3);
    // One corner alone has a radius: that of a point is its weight.
    let (radii, near, of) = match features {
        Features::VertexFace => {
            ([0.0, 0.0, 0.0, 1.0], vertex_face(a, [b, c, d], f64::MAX), [b - a, c - b, d - b])
        }
        Features::EdgeEdge => {
            ([0.0, 1.0, 0.0, 0.0], edge_edge([a, b], [c, d], f64::MAX), [a - c, b - a, c - d])
        }
    };
    let reach = of.iter().flat_map(|v| v.0).fold(0.0, |most: f64, x| most.max(x.abs()));
    let (found, range) = match features {
        Features::VertexFace => {
            let range = Radii::new::<true>(radii).of_nearest::<true>(of, reach, shortest::<true>(of));
            (near.expect("within").at[1], range)
        }
        Features::EdgeEdge => {
            let range = Radii::new::<false>(radii).of_nearest::<false>(of, reach, shortest::<false>(of));
            (near.expect("within").at[0], range)
        }
    };
    if range.most - range.least > 1e-3 {
        return 0.0;
    }
    let [low, high] = Places::of(features, at, radii).radii().map(|x| x.to_f64().unwrap_or(f64::NAN));
    ((high - found) / (range.most - found)).greater((found - low) / (found - range.least))
}

/// How much of the range of nearest points is needed. As of a distance, worst cases do not come
/// together, and what is rounded up costs nothing.
#[test]
fn the_error_of_a_parameter() {
    for features in KINDS {
        let hunt = Hunt { starts: cases(4, 12), steps: cases(500, 1_500), seed: 73 };
        let Found { ratio, input } = hunt.most::<f64>(|r| flat(r, features), |x| beside(features, x));
        println!("DISTANCE_WEIGHT, {features:?}: {ratio:.4} of the range");
        assert!((1.0 / 60.0..=1.0).contains(&ratio), "{features:?}: {ratio} by {input:?}");
    }
}
