//! The judge of a distance query's answer, by the exact one.

use nearmiss::contacts::NearestTriangles;
use nearmiss::mesh::Body;
use nearmiss_kernels::math::tolerance::{DISTANCE_ERROR, U64};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::nearest::Nearest;
use nearmiss_lab::oracle::Triangle;
use nearmiss_lab::oracle::near::{Squared, least_squared, triangles_squared};

/// A body's triangles.
pub fn triangles(body: &Body) -> Vec<Triangle> {
    let points = body.positions_t0().to_f64();
    body.faces().iter().map(|face| face.map(|v| points[v as usize])).collect()
}

/// The largest difference of two coordinates of the same axis.
fn extent(triangles: &[Triangle]) -> f64 {
    let points = || triangles.iter().flatten();
    let on = |k: usize| {
        let all = points().map(|p| p[k]);
        all.clone().fold(f64::NEG_INFINITY, f64::max) - all.fold(f64::INFINITY, f64::min)
    };
    (0..3).map(on).fold(0.0, f64::max)
}

/// Whether a length is the root of a square up to an error, exactly.
pub fn is_root(length: f64, squared: &Squared, error: f64) -> bool {
    squared.is_within((length + error).next_up())
        && (length <= error || !squared.is_within((length - error).next_down().next_down()))
}

/// The exact answer for bodies.
pub struct Truth {
    bodies: Vec<Vec<Triangle>>,
    pub least: Option<Squared>,
}

impl Truth {
    /// The answer for bodies; those pairs count that `meet`, by their indices.
    pub fn of(bodies: &[Body], meet: impl Fn(usize, usize) -> bool) -> Truth {
        let all: Vec<_> = bodies.iter().map(triangles).collect();
        let mut least: Option<Squared> = None;
        for j in 0..all.len() {
            for i in (0..j).filter(|&i| meet(i, j)) {
                let squared = least_squared(&all[i], &all[j]);
                least = match (least, squared) {
                    (Some(a), Some(b)) => Some(a.min(b)),
                    (a, b) => a.or(b),
                };
            }
        }
        Truth { bodies: all, least }
    }

    /// The fault of an answer, if it has one.
    pub fn fault(&self, found: Option<&NearestTriangles>) -> Result<(), String> {
        let (found, least) = match (found, &self.least) {
            (None, None) => return Ok(()),
            (Some(found), Some(least)) => (found, least),
            (found, least) => return Err(format!("{found:?}, but the least is {least:?}")),
        };
        let fault = |what: String| Err(format!("{what}, truly {:e}: {found:?}", least.to_f64().sqrt()));
        let own = [0, 1].map(|k| self.bodies[found.bodies[k].index()][found.triangles[k] as usize]);
        let error = DISTANCE_ERROR * extent(&self.bodies.concat()) + f64::from_bits(2);
        if (found.distance == 0.0) != least.is_within(0.0) {
            return fault("a wrong zero, or a missing one".into());
        }
        let theirs = triangles_squared(&own[0], &own[1]);
        if found.distance == 0.0 && !theirs.is_within(0.0) {
            return fault("the triangles share no point".into());
        }
        if !is_root(found.distance, least, error) {
            return fault("a distance".into());
        }
        if !is_root(found.distance, &theirs, error) {
            return fault("the distance is not that of the triangles".into());
        }
        if found.bodies[0] >= found.bodies[1] {
            return fault("the order of bodies".into());
        }
        for ((weights, point), corners) in found.weights.iter().zip(&found.points).zip(&own) {
            let summed = (weights.iter().sum::<f64>() - 1.0).abs() <= 4.0 * U64;
            if !weights.iter().all(|w| (0.0..=1.0).contains(w)) || !summed {
                return fault(format!("weights {weights:?}"));
            }
            let at = |c: usize| weights.iter().zip(corners).map(|(w, corner)| w * corner[c]).sum::<f64>();
            if !(0..3).all(|c| (at(c) - point[c]).abs() <= error + 8.0 * U64 * at(c).abs()) {
                return fault("points that differ from their weights".into());
            }
        }
        let [p, q] = found.points;
        // Squares may overflow or underflow.
        let apart = (0..3).map(|c| p[c] - q[c]).fold(0.0, f64::hypot);
        // Rounding of points depends on their coordinates, which may exceed their difference.
        let largest = p.iter().chain(&q).fold(0.0f64, |most, x| most.max(x.abs()));
        if !is_root(apart, &theirs, 4.0 * error + 16.0 * U64 * largest) {
            return fault("points that are not that far apart".into());
        }
        Ok(())
    }
}

/// The answer of the kernels for two triangles.
pub fn asked<R: Real>(p: &Triangle, q: &Triangle) -> Nearest {
    let [p, q] = [p, q].map(|of| of.map(|p| Vec3(p.map(R::of))));
    Nearest::of(&p, &q)
}
