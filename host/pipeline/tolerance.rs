//! Default tolerances: those of a body, of a pair, of a scene.

use super::layout::Offsets;
use crate::scene::{Body, BodyKind};
use nearmiss_kernels::abi::BodyTolerance;

/// Returns the tolerance of the pairs of two bodies, or of a body and itself: the smaller of both
/// defaults. Each default is that of the mesh that the body was made from. A body without a side of
/// positive length has none, and takes that of the other; 0 if neither has one.
pub fn of_pair(a: &Body, b: &Body) -> f64 {
    smaller(own(a), own(b))
}

/// Returns the smaller of two values; 0 if neither is finite.
fn smaller(a: f64, b: f64) -> f64 {
    let smaller = a.min(b);
    if smaller.is_finite() { smaller } else { 0.0 }
}

/// Returns the default of a body; infinite if it has none.
fn own(body: &Body) -> f64 {
    let tolerance = body.default_tolerance();
    if tolerance > 0.0 { tolerance } else { f64::INFINITY }
}

/// Tolerances of a scene's pairs.
#[derive(Clone, Debug, PartialEq)]
pub struct Tolerances {
    /// The smallest tolerance of all pairs that may meet.
    pub least: f64,
    /// The largest tolerance.
    pub largest: f64,
    /// The smallest tolerance above 0; 0 if there is none.
    pub finest: f64,
    /// Tolerance of each body, infinite if it has none; empty if all pairs have the same.
    bodies: Vec<f64>,
}

impl Tolerances {
    /// Returns one tolerance for all pairs.
    pub fn named(tolerance: f64) -> Tolerances {
        Tolerances { least: tolerance, largest: tolerance, finest: tolerance, bodies: Vec::new() }
    }

    /// Returns the default of each pair. Environments and groups are ignored. Cost: a square root
    /// per side of bodies whose default is not yet computed, and a sort of the bodies.
    pub fn of(bodies: &[Body]) -> Tolerances {
        let all: Vec<f64> = bodies.iter().map(own).collect();
        let mut order: Vec<usize> = (0..bodies.len()).filter(|&i| bodies[i].element_count() > 0).collect();
        order.sort_by(|&i, &j| all[i].total_cmp(&all[j]));
        // The tolerance of each pair is that of its first body, which has the smaller one.
        let moves = |i: usize| bodies[i].kind() != BodyKind::Fixed;
        let mut mover_follows = false;
        let mut follows = false;
        let mut pairs = Vec::with_capacity(order.len());
        for &i in order.iter().rev() {
            if bodies[i].self_collides() || mover_follows || (follows && moves(i)) {
                pairs.push(smaller(all[i], all[i]));
            }
            follows = true;
            mover_follows |= moves(i);
        }
        let least = pairs.iter().copied().reduce(f64::min).unwrap_or(0.0);
        let largest = pairs.iter().copied().fold(0.0, f64::max);
        let finest = pairs.iter().copied().filter(|&t| t > 0.0).reduce(f64::min).unwrap_or(0.0);
        let bodies = if least == largest { Vec::new() } else { all };
        Tolerances { least, largest, finest, bodies }
    }

    /// Returns the tolerances and radii as kernels read them, by the first vertex of each body; empty
    /// if all pairs have the same tolerance and `radii`, one a body, are empty.
    pub fn records(&self, starts: &[Offsets], radii: &[f64]) -> Vec<BodyTolerance> {
        let radius = |i: usize| radii.get(i).copied().unwrap_or(0.0);
        let tolerance = |i: usize| self.bodies.get(i).copied().unwrap_or(self.largest);
        let of = |i: usize| BodyTolerance {
            vertex: starts[i].vertex,
            pad: 0,
            tolerance: tolerance(i),
            radius: radius(i),
        };
        (0..self.bodies.len().max(radii.len())).map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::right_triangle;
    use crate::scene::{CollisionFilter, Motion};

    fn triangle(size: f64) -> Body {
        Body::deformable(right_triangle(size))
    }

    #[test]
    fn a_pair_has_the_smaller_one_of_its_bodies_and_a_point_none() {
        let [small, large, point] = [1.0, 1024.0, 0.0].map(triangle);
        assert_eq!(of_pair(&small, &large), 2f64.powi(-12));
        assert_eq!(of_pair(&large, &large), 2f64.powi(-2));
        assert_eq!(of_pair(&large, &point), 2f64.powi(-2));
        assert_eq!(of_pair(&point, &point), 0.0);
    }

    #[test]
    fn those_of_a_scene_are_those_of_its_pairs() {
        let alone = |body: Body| body.with_filter(CollisionFilter::without_self_collision());
        let (small, large) = (2f64.powi(-12), 2f64.powi(-2));
        let fixed = |size| Body::fixed(right_triangle(size));
        let point = || alone(triangle(0.0));
        for (bodies, [least, largest, finest], by_body) in [
            (vec![triangle(1.0)], [small; 3], false),
            (vec![], [0.0; 3], false),
            (vec![point(), point()], [0.0; 3], false),
            // A far ground of large triangles meets only the others.
            (vec![triangle(1.0), fixed(1024.0)], [small; 3], false),
            (vec![triangle(1.0), fixed(1024.0), fixed(1024.0)], [small; 3], false),
            (vec![triangle(1024.0), fixed(1.0)], [small, large, small], true),
            (vec![alone(triangle(1024.0)), fixed(1.0)], [small; 3], false),
            (vec![triangle(1.0), triangle(1024.0)], [small, large, small], true),
            (vec![alone(triangle(1.0)), alone(triangle(1024.0))], [small; 3], false),
            (vec![point(), triangle(1.0)], [small; 3], false),
            (vec![point(), point(), triangle(1.0)], [0.0, small, small], true),
        ] {
            let found = Tolerances::of(&bodies);
            assert_eq!([found.least, found.largest, found.finest], [least, largest, finest], "{bodies:?}");
            assert_eq!(!found.bodies.is_empty(), by_body, "{bodies:?}");
            // Each pair by itself.
            let meets = |i: usize, j: usize| {
                let fixed = |i: usize| bodies[i].kind() == BodyKind::Fixed;
                if i == j { bodies[i].self_collides() } else { !(fixed(i) && fixed(j)) }
            };
            let mut pairs: Vec<f64> = (0..bodies.len())
                .flat_map(|i| (0..=i).map(move |j| (i, j)))
                .filter(|&(i, j)| meets(i, j))
                .map(|(i, j)| of_pair(&bodies[i], &bodies[j]))
                .collect();
            pairs.sort_by(f64::total_cmp);
            let ends = [pairs.first(), pairs.last()].map(|end| end.copied().unwrap_or(0.0));
            assert_eq!([found.least, found.largest], ends, "{bodies:?}");
        }
    }

    #[test]
    fn moving_does_not_change_it_and_another_mesh_does() {
        let mut body = triangle(1.0);
        let far = triangle(1024.0);
        for input in
            [Motion::positions(far.positions_t0()), Motion::step(far.positions_t0(), far.positions_t0())]
        {
            body = body.at(input).expect("a place");
            assert_eq!(body.default_tolerance(), 2f64.powi(-12));
        }
        assert!(body.rest());
        assert_eq!(body.default_tolerance(), 2f64.powi(-12));
        let remade = Body::deformable(body.frames().remove(0));
        assert_eq!(remade.default_tolerance(), 2f64.powi(-2));
    }
}
