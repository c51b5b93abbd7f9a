//! The least distance of two sets of triangles, by testing each pair.

use super::{Squared, distance_squared};
use crate::case::Features;
use crate::oracle::{Triangle, triangles_meet};
use num_rational::BigRational;
use num_traits::Zero;

/// Returns the square of the distance of two closed triangles: 0 if they share a point, else the
/// least of their fifteen pairs of features.
///
/// # Panics
/// For coordinates that are not finite.
pub fn triangles_squared(p: &Triangle, q: &Triangle) -> Squared {
    if gap(p, q) == 0.0 && triangles_meet(p, q) {
        return Squared(BigRational::zero());
    }
    let mut least: Option<Squared> = None;
    let mut ask = |features, points| {
        let squared = distance_squared(features, points);
        if least.as_ref().is_none_or(|least| squared < *least) {
            least = Some(squared);
        }
    };
    for k in 0..3 {
        let [b, c, d] = *q;
        ask(Features::VertexFace, [p[k], b, c, d]);
        let [b, c, d] = *p;
        ask(Features::VertexFace, [q[k], b, c, d]);
        for m in 0..3 {
            ask(Features::EdgeEdge, [p[k], p[(k + 1) % 3], q[m], q[(m + 1) % 3]]);
        }
    }
    least.unwrap_or_else(|| Squared(BigRational::zero()))
}

/// Returns the gap between the boxes of two triangles on the axis with the largest gap.
fn gap(p: &Triangle, q: &Triangle) -> f64 {
    let range = |of: &Triangle, k: usize| {
        let all = of.iter().map(|p| p[k]);
        (all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max))
    };
    let on = |k: usize| {
        let ((a, b), (c, d)) = (range(p, k), range(q, k));
        (a - d).max(c - b)
    };
    (0..3).map(on).fold(0.0, f64::max)
}

/// Returns the least square over all pairs with a triangle of each set; `None` if one set is empty.
pub fn least_squared(one: &[Triangle], other: &[Triangle]) -> Option<Squared> {
    let mut least: Option<Squared> = None;
    for p in one {
        for q in other {
            // With a margin: the gap of boxes is rounded.
            let hopeless = least
                .as_ref()
                .is_some_and(|least| least.is_within(gap(p, q) * (1.0 - 1e-9)) && gap(p, q) > 0.0);
            if !hopeless {
                let squared = triangles_squared(p, q);
                if least.as_ref().is_none_or(|least| squared < *least) {
                    least = Some(squared);
                }
            }
        }
    }
    least
}
