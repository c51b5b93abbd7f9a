//! The judge of a near query's answer, by the exact one.

use nearmiss::contacts::{Closest, NearPair};
use nearmiss::mesh::Body;
use nearmiss_kernels::math::tolerance::{DISTANCE_ERROR, DISTANCE_LISTED, U64};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::near::{Near, corner_weights, edge_edge, vertex_face};
use nearmiss_lab::case::Features;
use nearmiss_lab::oracle::near::{Row, Shape, Squared, all_within, distance_squared, squared_at};
use std::collections::BTreeMap;

pub type Points = [[f64; 3]; 4];

/// The largest component of a pair's differences.
pub fn reach(features: Features, [a, b, c, d]: Points) -> f64 {
    let differences = match features {
        Features::VertexFace => [(a, b), (b, c), (b, d)],
        Features::EdgeEdge => [(a, c), (a, b), (c, d)],
    };
    let components = differences.into_iter().flat_map(|(x, y)| (0..3).map(move |k| (x[k] - y[k]).abs()));
    components.fold(0.0, f64::max)
}

/// The answer of the kernels for one pair.
pub fn asked<R: Real>(features: Features, points: Points, distance: f64) -> Option<Near> {
    let [a, b, c, d] = points.map(|p| Vec3(p.map(R::of)));
    match features {
        Features::VertexFace => vertex_face(a, [b, c, d], distance),
        Features::EdgeEdge => edge_edge([a, b], [c, d], distance),
    }
}

/// The weights of the kernels' parameters.
pub fn weights(features: Features, at: [f64; 2]) -> [f64; 3] {
    match features {
        Features::VertexFace => corner_weights(at),
        Features::EdgeEdge => [at[0], at[1], 0.0],
    }
}

/// The weights of a face, or the places on two edges, from the weights of four vertices; `None` if
/// they disagree.
pub fn places(features: Features, [a, b, c, d]: [f64; 4]) -> Option<[f64; 3]> {
    match features {
        Features::VertexFace => (a == 1.0).then_some([b, c, d]),
        Features::EdgeEdge => ([a, c] == [1.0 - b, 1.0 - d]).then_some([b, d, 0.0]),
    }
}

/// The fault of a listed pair, if it has one.
pub fn wrong(
    (features, points): (Features, Points),
    (squared, weights): (f64, [f64; 3]),
    distance: f64,
    truth: &Squared,
) -> Option<String> {
    let reach = reach(features, points);
    let error = DISTANCE_ERROR * reach;
    if !truth.is_within((distance + DISTANCE_LISTED * reach).next_up()) {
        return Some("farther than the query's distance".into());
    }
    // A square may be subnormal.
    let tiny = truth.to_f64() < f64::MIN_POSITIVE && (squared - truth.to_f64()).abs() <= f64::from_bits(2);
    if !(tiny || truth.is_near(squared, error)) {
        return Some(format!("squared distance {squared:e} of {:e}", truth.to_f64()));
    }
    let sum: f64 = weights.iter().sum();
    let summed = features == Features::EdgeEdge || (sum - 1.0).abs() <= 4.0 * U64;
    if !weights.iter().all(|w| (0.0..=1.0).contains(w)) || !summed {
        return Some(format!("weights {weights:?}"));
    }
    let there = squared_at(features, points, weights);
    // No points of the features are closer than these.
    let least = there >= *truth;
    let found = there.to_f64() == truth.to_f64() || there.is_near(truth.to_f64(), error);
    (!least || !found).then(|| format!("weights {weights:?}, where they are {:e} apart", there.to_f64()))
}

/// The fault of the kernels' answer for one pair, if it has one.
pub fn fault(
    (features, points): (Features, Points),
    answer: Option<Near>,
    distance: f64,
    truth: &Squared,
) -> Option<String> {
    match answer {
        None => truth.is_within(distance).then(|| "missed".into()),
        Some(near) if near.certain && !truth.is_within(distance) => Some("a false certainty".into()),
        Some(near) => wrong((features, points), (near.squared, weights(features, near.at)), distance, truth),
    }
}

/// A body for the oracle.
pub fn shape(body: &Body) -> Shape {
    Shape { points: body.positions_t0().to_f64(), faces: body.faces().to_vec() }
}

/// All pairs within the distance, exactly.
pub struct Truth {
    shapes: Vec<Shape>,
    distance: f64,
    pub within: BTreeMap<Row, Squared>,
}

impl Truth {
    pub fn of(bodies: &[Body], distance: f64) -> Truth {
        let shapes: Vec<Shape> = bodies.iter().map(shape).collect();
        let within = all_within(&shapes, distance);
        Truth { shapes, distance, within }
    }

    /// The number of listed pairs beyond the distance; the error is the fault of the answer.
    pub fn fault(&self, found: &[NearPair]) -> Result<usize, String> {
        let row = |pair: &NearPair| {
            (pair.kind.name(), pair.bodies.map(|body| body.index()), [pair.feature_a, pair.feature_b])
        };
        let key = |pair: &NearPair| {
            let [of_a, of_b] = pair.bodies;
            (pair.kind, (of_a, pair.feature_a), (of_b, pair.feature_b))
        };
        if !found.is_sorted_by(|a, b| key(a) < key(b)) {
            return Err("not in order, or twice".into());
        }
        let mut beyond = 0;
        for pair in found {
            let case = Shape::pair(&self.shapes, row(pair));
            let known = self.within.get(&row(pair)).cloned();
            beyond += usize::from(known.is_none());
            let truth = known.unwrap_or_else(|| distance_squared(case.0, case.1));
            let Some(places) = places(case.0, pair.weights()) else {
                return Err(format!("{pair:?}: weights that do not sum to 1"));
            };
            let reported = (pair.squared_distance, places);
            if let Some(what) = wrong(case, reported, self.distance, &truth) {
                return Err(format!("{pair:?}: {what}"));
            }
            if pair.closest != named(case.0, places) {
                return Err(format!("{pair:?}: another feature is nearest"));
            }
        }
        let mut listed = found.iter().map(row).collect::<Vec<_>>();
        listed.sort_unstable();
        match self.within.keys().find(|row| listed.binary_search(row).is_err()) {
            Some(row) => Err(format!("{row:?} is missed")),
            None => Ok(beyond),
        }
    }
}

/// The closest features of a point, by its weights.
pub fn named(features: Features, [x, y, z]: [f64; 3]) -> Closest {
    match features {
        Features::VertexFace => match [x, y, z].iter().filter(|w| **w != 0.0).count() {
            3 => Closest::VertexFace,
            2 => Closest::VertexEdge,
            _ => Closest::VertexVertex,
        },
        Features::EdgeEdge => match [x, y].iter().filter(|t| **t != 0.0 && **t != 1.0).count() {
            2 => Closest::EdgeEdge,
            1 => Closest::VertexEdge,
            _ => Closest::VertexVertex,
        },
    }
}
