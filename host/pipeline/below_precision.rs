//! Checks whether the solver's precision is too low for the tolerance. It depends on the positions
//! and runs once for each set of positions.

use super::layout::Layout;
use super::list::List;
use super::narrow::NarrowContext;
use super::precision::Precision;
use super::tolerance::of_pair;
use crate::error::Error;
use crate::mesh::Positions;
use crate::pipeline::launch;
use crate::query::{Certified, CertifiedPrecision};
use crate::scene::{Body, Bounds, NOTHING, union};
use nearmiss_kernels::abi::{BelowPrecisionArgs, BodyTolerance, Hit, Span};
use nearmiss_kernels::math::tolerance::Tolerance;
use rayon::prelude::*;

/// Pairs that may be too large for the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BelowPrecision {
    /// Listed pairs of features: the kernels count them.
    Listed {
        /// The tolerance of the query.
        tolerance: f64,
        /// The smallest fraction of a pair's extent that the solver resolves.
        finest: f64,
    },
    /// Pairs that are not listed, because of a long edge.
    Unlisted,
}

impl BelowPrecision {
    /// Returns the caveat for the current positions; `finest` is the smallest tolerance, if pairs
    /// have several. Returns none for an earliest query with a device-resident body: the detector
    /// checks it after the frame.
    pub fn of(
        (bodies, layout): (&[Body], &Layout),
        certified: &Certified,
        finest: Option<f64>,
        is_earliest: bool,
    ) -> Option<BelowPrecision> {
        if !is_earliest {
            let tolerance = finest.or(certified.tolerance);
            return BelowPrecision::of_listed(bodies, &Certified { tolerance, ..*certified });
        }
        let is_known = !bodies.iter().any(Body::is_device_resident);
        is_known.then(|| BelowPrecision::of_earliest((bodies, layout), certified, finest.is_some())).flatten()
    }

    /// Returns the caveat of a query that lists pairs; none if no pair can be that large. Cost: a
    /// pass over the positions.
    fn of_listed(bodies: &[Body], certified: &Certified) -> Option<BelowPrecision> {
        let finest = finest(certified);
        // Positive, or not set.
        let tolerance = certified.tolerance.filter(|t| *t > 0.0)?;
        // The kernels measure the extent of a device-resident body.
        let any_resident = bodies.iter().any(Body::is_device_resident);
        let extent = || extent(&bodies.iter().map(bounds).fold(NOTHING, union));
        (any_resident || tolerance < finest * extent())
            .then_some(BelowPrecision::Listed { tolerance, finest })
    }

    /// Returns the caveat of an earliest query, which lists no pairs. The host must know all
    /// positions. The caveat holds if bodies that may meet, or one that tests itself, have an
    /// edge too long for the tolerance of their pairs. Bodies farther apart than the tested
    /// distance do not count. `own` is whether each pair has its own tolerance. It costs a pass
    /// over the positions, and one over the faces of bodies whose extent is too large. Each body
    /// with a long edge costs a pass over all bodies.
    pub fn of_earliest(
        (bodies, layout): (&[Body], &Layout),
        certified: &Certified,
        own: bool,
    ) -> Option<BelowPrecision> {
        let tolerance =
            |a: &Body, b: &Body| if own { of_pair(a, b) } else { certified.tolerance.unwrap_or(0.0) };
        // The smallest tolerance of all pairs is that of a body with itself.
        let positive = bodies.iter().map(|body| tolerance(body, body)).filter(|t| *t > 0.0);
        let least = positive.reduce(f64::min)?;
        // For any point, one end of an edge differs from it by at least half of the edge's length.
        let is_long =
            |side: f64, tolerance: f64| 0.0 < tolerance && tolerance < finest(certified) * side / 2.0;
        let boxes: Vec<Bounds> = bodies.iter().map(bounds).collect();
        let large = (0..bodies.len()).filter(|&i| is_long(extent(&boxes[i]), least));
        let long: Vec<(usize, f64)> = large.map(|i| (i, longest_side(&bodies[i]))).collect();
        let apart = certified.min_separation + certified.tolerance.unwrap_or(0.0);
        let within = |i: usize, j: usize| {
            apart + [i, j].map(|body| bodies[body].thickness().largest()).iter().sum::<f64>()
        };
        let meets = |i: usize, j: usize| layout.tests(i, j) && are_near([&boxes[i], &boxes[j]], within(i, j));
        let has_partner = |(i, side): (usize, f64)| {
            let mut others = (0..bodies.len()).filter(|&j| is_long(side, tolerance(&bodies[i], &bodies[j])));
            others.any(|j| meets(i, j))
        };
        long.into_iter().any(has_partner).then_some(BelowPrecision::Unlisted)
    }

    /// Returns the largest coordinate of the bodies whose positions the host knows.
    pub fn largest(bodies: &[Body]) -> f64 {
        let known = bodies.iter().filter(|body| !body.is_device_resident() && body.element_count() > 0);
        known.map(|body| largest_of(&bounds(body))).fold(0.0, f64::max)
    }

    /// Returns whether pairs may be too large if no two coordinates differ by more than `extent`.
    pub fn may_be(certified: &Certified, extent: f64) -> bool {
        // A tolerance of 0 is never below the precision.
        certified.tolerance.is_some_and(|tolerance| 0.0 < tolerance && tolerance < finest(certified) * extent)
    }
}

/// Returns the smallest fraction of a pair's extent that the solver resolves.
fn finest(certified: &Certified) -> f64 {
    match certified.precision {
        CertifiedPrecision::F32 => f32::INCLUSION_FINEST.into(),
        // Pairs that f32 cannot resolve are tested again in f64.
        CertifiedPrecision::Mixed | CertifiedPrecision::F64 => f64::INCLUSION_FINEST,
    }
}

/// Launches a kernel that counts the hits that are too large for the tolerance, if there may be
/// any.
///
/// # Errors
/// Device errors.
pub fn count<R: Precision>(
    below_precision: Option<BelowPrecision>,
    tolerances: Span<BodyTolerance>,
    (edges, vf, ee): (Span<[u32; 2]>, &List<Hit>, &List<Hit>),
    given: &NarrowContext<R>,
) -> Result<(), Error> {
    let Some(BelowPrecision::Listed { tolerance, finest }) = below_precision else { return Ok(()) };
    let args = BelowPrecisionArgs {
        frames: given.frames,
        faces: given.faces,
        edges,
        vf: vf.output(given.counters),
        ee: ee.output(given.counters),
        counters: given.counters,
        tolerance,
        tolerances,
        finest,
    };
    launch::striding::<R::BelowPrecision>(given.device, vf.capacity() + ee.capacity(), &args)
}

fn point(positions: &Positions, v: u32) -> [f64; 3] {
    // Faces were checked when the mesh was made: every vertex exists.
    positions.get_f64(v as usize).unwrap_or_default()
}

/// Returns the largest component of the difference of two vertices, at either end of the step.
fn largest(ends: &[&Positions; 2], p: u32, q: u32) -> f64 {
    let apart = |positions: &Positions| {
        let (p, q) = (point(positions, p), point(positions, q));
        (0..3).map(|k| (p[k] - q[k]).abs()).fold(0.0, f64::max)
    };
    apart(ends[0]).max(apart(ends[1]))
}

/// Returns the longest side of a body's triangles, by the largest component, at either end of the
/// step.
fn longest_side(body: &Body) -> f64 {
    let ends = body.ends();
    let of_face = |&[p, q, r]: &[u32; 3]| {
        [[p, q], [q, r], [r, p]].into_iter().map(|[p, q]| largest(&ends, p, q)).fold(0.0, f64::max)
    };
    body.elements().par_iter().map(of_face).reduce(|| 0.0, f64::max)
}

/// Growth of boxes, as a fraction of the largest coordinate: more than rounding adds to a volume.
const ROUNDED: f64 = 1.0 / (1 << 18) as f64;

/// Returns whether pairs of bodies in two boxes may be tested, if pairs within a distance are.
fn are_near(boxes: [&Bounds; 2], within: f64) -> bool {
    let [a, b] = boxes;
    let grown = 2.0 * within + ROUNDED * boxes.into_iter().map(largest_of).fold(0.0, f64::max);
    (0..3).all(|k| a[0][k] <= b[1][k] + grown && b[0][k] <= a[1][k] + grown)
}

/// Returns the largest coordinate in a box.
fn largest_of(bounds: &Bounds) -> f64 {
    bounds.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// Returns a box around a body in the step. Vertices that no face uses count too. A rigid body's
/// box is at least as large as the body.
fn bounds(body: &Body) -> Bounds {
    body.posed_box().unwrap_or_else(|| {
        body.ends().into_iter().fold(NOTHING, |bounds, positions| {
            let own = match positions {
                Positions::F32(points) => of_points(points),
                Positions::F64(points) => of_points(points),
            };
            union(bounds, own)
        })
    })
}

/// Returns the largest difference of coordinates in a box: no pair in it is larger.
fn extent(bounds: &Bounds) -> f64 {
    (0..3).map(|k| bounds[1][k] - bounds[0][k]).fold(0.0, f64::max)
}

fn of_points<T: Copy + Into<f64> + Sync>(points: &[[T; 3]]) -> Bounds {
    let of = |piece: &[[T; 3]]| {
        piece.iter().map(|p| p.map(Into::into)).fold(NOTHING, |bounds, p| union(bounds, [p, p]))
    };
    points.par_chunks(1 << 13).map(of).reduce(|| NOTHING, union)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use crate::query::Query;
    use crate::scene::CollisionFilter;

    /// The caveat of two long triangles that are 100 apart, with these radii.
    fn of_apart(radii: [f64; 2]) -> Option<BelowPrecision> {
        let body = |z: f64, radius: f64| {
            let corners = vec![[0.0, 0.0, z], [1e6, 0.0, z], [0.0, 1e6, z]];
            let mesh = Mesh::new("long", Positions::F64(corners), vec![[0, 1, 2]]).expect("a mesh");
            let filter = CollisionFilter::without_self_collision();
            Body::deformable(mesh).with_filter(filter).with_thickness(radius)
        };
        // The boxes of bodies grow by a part of their largest coordinate.
        let bodies = [body(0.0, radii[0]), body(100.0, radii[1])];
        let layout = Layout::new(&bodies, Query::earliest().kind());
        let certified = Certified { tolerance: Some(1e-9), ..Certified::default() };
        BelowPrecision::of_earliest((&bodies, &layout), &certified, false)
    }

    #[test]
    fn a_thickness_is_part_of_the_tested_distance() {
        assert_eq!(of_apart([0.0; 2]), None);
        assert_eq!(of_apart([10.0, 10.0]), None);
        assert_eq!(of_apart([100.0, 0.0]), Some(BelowPrecision::Unlisted));
        assert_eq!(of_apart([0.0, 100.0]), Some(BelowPrecision::Unlisted));
    }
}
