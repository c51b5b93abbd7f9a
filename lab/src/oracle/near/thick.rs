//! Exact nearest points of two features, all of them, and the radius there.

use super::{Point, Squared, dot, minus, on_grid};
use crate::case::Features;
use crate::oracle::exact;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

/// A point of both features that may be nearest: its parameters, squared distance, and both radii
/// summed.
#[derive(Clone, Debug)]
pub struct Place {
    /// Weights of a face's corners 1 and 2, or the parameters along both edges.
    pub at: [BigRational; 2],
    /// Squared distance.
    pub squared: Squared,
    /// Radius.
    pub radius: BigRational,
}

/// Nearest points of sides, and the one inside. Nearest points of both features, if many, are the
/// hull of those of them that are nearest: their radius is largest at one of these.
#[derive(Clone, Debug)]
pub struct Places {
    r: Point,
    p: Point,
    q: Point,
    grid: u64,
    radii: [BigRational; 3],
    /// All places.
    pub all: Vec<Place>,
}

impl Places {
    /// Returns the places of two features, in [`Features`]' order of points, with these radii.
    ///
    /// # Panics
    /// For numbers that are not finite.
    pub fn of(features: Features, points: [[f64; 3]; 4], radii: [f64; 4]) -> Places {
        Places::on(features, on_grid(points.map(|p| p.map(exact))), radii)
    }

    /// Returns the places at a time of points that move straight from the first positions to the
    /// second ones.
    ///
    /// # Panics
    /// For numbers that are not finite.
    pub fn at(features: Features, ends: [[[f64; 3]; 2]; 4], t: f64, radii: [f64; 4]) -> Places {
        let t = exact(t);
        let mixed = |[start, end]: [[f64; 3]; 2]| -> [BigRational; 3] {
            std::array::from_fn(|k| {
                let (start, end) = (exact(start[k]), exact(end[k]));
                &start + (end - &start) * &t
            })
        };
        Places::on(features, on_grid(ends.map(mixed)), radii)
    }

    fn on(features: Features, ([a, b, c, d], grid): ([Point; 4], u64), radii: [f64; 4]) -> Places {
        let [ra, rb, rc, rd] = radii.map(exact);
        let (r, p, q, radii) = match features {
            Features::VertexFace => {
                (minus(&b, &a), minus(&c, &b), minus(&d, &b), [ra + &rb, rc - &rb, rd - &rb])
            }
            Features::EdgeEdge => {
                (minus(&a, &c), minus(&b, &a), minus(&c, &d), [&ra + &rc, rb - ra, rd - rc])
            }
        };
        let mut places = Places { r, p, q, grid, radii, all: Vec::new() };
        let is_face = features == Features::VertexFace;
        let (zero, one) = (BigRational::zero, BigRational::one);
        let minus_one = || -BigRational::one();
        let mut sides = vec![([zero(), zero()], [one(), zero()]), ([zero(), zero()], [zero(), one()])];
        if is_face {
            sides.push(([one(), zero()], [minus_one(), one()]));
        } else {
            sides.extend([([zero(), one()], [one(), zero()]), ([one(), zero()], [zero(), one()])]);
        }
        for (from, way) in sides {
            places.add_side(&from, &way);
        }
        places.add_inside(is_face);
        places
    }

    fn x(&self, at: &[BigRational; 2], whole: bool) -> [BigRational; 3] {
        std::array::from_fn(|k| {
            let along =
                BigRational::from(self.p[k].clone()) * &at[0] + BigRational::from(self.q[k].clone()) * &at[1];
            if whole { along + BigRational::from(self.r[k].clone()) } else { along }
        })
    }

    /// Returns the place at parameters.
    pub fn place(&self, at: [BigRational; 2]) -> Place {
        let x = self.x(&at, true);
        let squared: BigRational = x.iter().map(|x| x * x).sum();
        let radius = &self.radii[0] + &self.radii[1] * &at[0] + &self.radii[2] * &at[1];
        let unit = BigRational::from(BigInt::one() << (2 * self.grid));
        Place { at, squared: Squared(squared / unit), radius }
    }

    fn add(&mut self, at: [BigRational; 2]) {
        let place = self.place(at);
        self.all.push(place);
    }

    fn add_side(&mut self, from: &[BigRational; 2], way: &[BigRational; 2]) {
        let (x, e) = (self.x(from, true), self.x(way, false));
        let product = |x: &[BigRational; 3], y: &[BigRational; 3]| -> BigRational {
            (0..3).map(|k| &x[k] * &y[k]).sum()
        };
        let length = product(&e, &e);
        let at = |t: BigRational| [0, 1].map(|k| &from[k] + &way[k] * &t);
        if length.is_zero() {
            self.add(at(BigRational::zero()));
            self.add(at(BigRational::one()));
            return;
        }
        let t = -product(&x, &e) / length;
        self.add(at(t.max(BigRational::zero()).min(BigRational::one())));
    }

    /// Returns the parameters of the nearest point of both lines, or of the face's plane; `None` if
    /// there are many.
    pub fn foot(&self) -> Option<[BigRational; 2]> {
        let Places { r, p, q, .. } = self;
        let (pp, qq, pq, rp, rq) = (dot(p, p), dot(q, q), dot(p, q), dot(r, p), dot(r, q));
        let whole = &pp * &qq - &pq * &pq;
        let ratio = |x: BigInt| BigRational::new(x, whole.clone());
        whole.is_positive().then(|| [ratio(&pq * &rq - &qq * &rp), ratio(&pq * &rp - &pp * &rq)])
    }

    /// Returns the ways along which the distance from the foot grows slowest, one for each feature.
    pub fn ways(&self) -> Vec<[BigRational; 2]> {
        let Places { p, q, .. } = self;
        let (pp, qq, pq) = (dot(p, p), dot(q, q), dot(p, q));
        let mut ways = Vec::new();
        if pp.is_positive() {
            ways.push([-BigRational::new(pq.clone(), pp), BigRational::one()]);
        }
        if qq.is_positive() {
            ways.push([BigRational::one(), -BigRational::new(pq, qq)]);
        }
        ways
    }

    fn add_inside(&mut self, is_face: bool) {
        let Some([s, t]) = self.foot() else { return };
        let one = BigRational::one();
        let within = !s.is_negative()
            && !t.is_negative()
            && if is_face { &s + &t <= one } else { s <= one && t <= one };
        if within {
            self.add([s, t]);
        }
    }

    /// Returns the squared distance of both features.
    pub fn least(&self) -> Squared {
        self.all.iter().map(|place| place.squared.clone()).min().unwrap_or(Squared(BigRational::zero()))
    }

    /// Returns the least and the largest radius of their nearest points.
    pub fn radii(&self) -> [BigRational; 2] {
        let least = self.least();
        let of = || self.all.iter().filter(|place| place.squared == least).map(|place| place.radius.clone());
        [of().min(), of().max()].map(Option::unwrap_or_default)
    }

    /// Returns whether some of the nearest points, and whether all, are within a distance and their
    /// radii.
    pub fn within(&self, distance: f64) -> [bool; 2] {
        let least = self.least();
        let [some, all] = self.radii();
        [all, some].map(|radius| least.is_within_exactly(&(exact(distance) + radius)))
    }
}

impl Squared {
    /// Returns whether the distance is at most `length`.
    pub fn is_within_exactly(&self, length: &BigRational) -> bool {
        !length.is_negative() && self.0 <= length * length
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two parallel edges over one another: the radius of all points between them counts.
    #[test]
    fn parallel_edges_have_many_nearest_points() {
        let points = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 0.0, 2.0], [3.0, 0.0, 2.0]];
        let places = Places::of(Features::EdgeEdge, points, [0.0, 1.0, 0.5, 0.5]);
        assert_eq!(places.least().to_f64(), 4.0);
        assert_eq!(places.radii(), [0.75, 1.25].map(exact));
        // 2 <= d + 0.75 for all of them, d + 1.25 for some.
        assert_eq!(
            [0.7, 0.75, 1.0, 1.25].map(|d| places.within(d)),
            [[false, false], [true, false], [true, false], [true, true]]
        );
    }

    #[test]
    fn a_foot_inside_has_the_radius_there() {
        let points = [[1.0, 1.0, 3.0], [0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        let places = Places::of(Features::VertexFace, points, [0.25, 0.0, 1.0, 2.0]);
        assert_eq!(places.least().to_f64(), 9.0);
        assert_eq!(places.radii(), [1.0; 2].map(exact));
        assert_eq!([1.9, 2.0].map(|d| places.within(d)), [[false; 2], [true; 2]]);
    }
}
