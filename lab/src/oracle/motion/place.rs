//! Four points as polynomials of time, and whether their features meet at one time.

use super::dyadic::integers;
use super::polynomial::Polynomial;
use super::root::Root;
use crate::case::{Case, Features};
use std::cmp::Ordering;

/// Pairs of points.
const PAIRS: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// The signed minors of the matrix with one row per coordinate, a row of ones, and one column per
/// point.
pub struct Minors {
    /// For each point, whether it belongs to the first feature.
    first: [bool; 4],
    /// By axis and [`PAIRS`]: the difference of two points.
    along: [[Polynomial; 6]; 3],
    /// By the axis and the point that are left out: the area of the other three. The sign is that
    /// in a sum that vanishes. With these weights the four points, projected along that axis, add
    /// up to zero.
    weights: [[Polynomial; 4]; 3],
    /// Six times the volume of the four points.
    volume: Polynomial,
}

impl Minors {
    pub fn new(case: &Case) -> Minors {
        let first = match case.features {
            Features::VertexFace => [true, false, false, false],
            Features::EdgeEdge => [true, true, false, false],
        };
        // Each axis may have its own scale: whether features meet does not depend on it.
        let x: [[Polynomial; 4]; 3] = [0, 1, 2].map(|k| {
            let numbers: [f64; 8] = std::array::from_fn(
                |i| if i < 4 { &case.positions_t0 } else { &case.positions_t1 }[i % 4][k],
            );
            let n = integers(numbers);
            [0, 1, 2, 3].map(|i| Polynomial::new(vec![n[i].clone(), &n[i + 4] - &n[i]]))
        });
        let area = |[k, l]: [usize; 2], [a, b, c]: [usize; 3]| {
            let d = |k: usize, p: usize| x[k][p].minus(&x[k][a]);
            d(k, b).times(&d(l, c)).minus(&d(l, b).times(&d(k, c)))
        };
        let weights = [[1, 2], [2, 0], [0, 1]].map(|axes| {
            [
                area(axes, [1, 2, 3]),
                area(axes, [0, 2, 3]).negated(),
                area(axes, [0, 1, 3]),
                area(axes, [0, 1, 2]).negated(),
            ]
        });
        // Laplace's expansion along the first axis.
        let volume = (0..4).fold(Polynomial::default(), |sum, i| sum.plus(&x[0][i].times(&weights[0][i])));
        let along = [0, 1, 2].map(|k| PAIRS.map(|[i, j]| x[k][i].minus(&x[k][j])));
        Minors { first, along, weights, volume }
    }

    /// Returns the polynomials of the events. Whenever the features begin to meet after t = 0, one
    /// that is not zero has a root.
    pub fn events(&self) -> Vec<Polynomial> {
        if !self.volume.is_zero() {
            return vec![self.volume.clone()];
        }
        let all = self.weights.iter().flatten().chain(self.along.iter().flatten());
        let mut events: Vec<Polynomial> = Vec::new();
        for p in all.filter(|p| p.degree() > 0) {
            if !events.iter().any(|q| q.is_like(p)) {
                events.push(p.clone());
            }
        }
        events
    }

    /// Returns whether the closed features share a point at that time.
    pub fn meet(&self, at: &mut Root) -> bool {
        // The points span a volume: two disjoint subsets of them have no common point.
        if at.sign_of(&self.volume).is_ne() {
            return false;
        }
        // The points span a plane: one sum of them vanishes, with weights that add up to zero. The
        // features meet unless one feature has weights of both signs, or both features have weights
        // of one sign.
        for weights in &self.weights {
            let signs = weights.each_ref().map(|w| at.sign_of(w));
            if signs.iter().any(|s| s.is_ne()) {
                let turned = |i: usize| if self.first[i] { signs[i] } else { signs[i].reverse() };
                return !((0..4).any(|i| turned(i).is_gt()) && (0..4).any(|i| turned(i).is_lt()));
            }
        }
        // The points span a line. The features are apart on it if one is entirely before the other.
        for along in &self.along {
            let signs = along.each_ref().map(|d| at.sign_of(d));
            if signs.iter().any(|s| s.is_ne()) {
                let between = PAIRS.iter().zip(signs).filter(|([i, j], _)| self.first[*i] && !self.first[*j]);
                let signs: Vec<Ordering> = between.map(|(_, sign)| sign).collect();
                return signs.iter().any(|s| s.is_ge()) && signs.iter().any(|s| s.is_le());
            }
        }
        true
    }
}
