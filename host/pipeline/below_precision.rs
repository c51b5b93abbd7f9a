//! Where the solver's precision may be too below_precision for the tolerance: told from where the bodies are, once for each place.

use super::list::List;
use super::narrow::NarrowContext;
use super::precision::Precision;
use crate::error::Error;
use crate::mesh::Positions;
use crate::pipeline::launch;
use crate::query::{Certified, CertifiedPrecision};
use crate::scene::{Body, Bounds, NOTHING, union};
use nearmiss_kernels::abi::{BelowPrecisionArgs, BodyTolerance, Hit, Span};
use nearmiss_kernels::math::tolerance::Tolerance;
use rayon::prelude::*;

/// What may be too large for the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BelowPrecision {
    /// Pairs of features that are listed: the kernels count them.
    Listed {
        /// The tolerance that was asked for.
        tolerance: f64,
        /// The least part of a pair's extent that the solver can tell.
        finest: f64,
    },
    /// Pairs that are not listed, of an edge that is.
    Unlisted,
}

impl BelowPrecision {
    /// Of bodies where they are; none where no pair can be that large. Cost: a pass over the positions; where an earliest
    /// query's tolerance is near the precision one over the faces.
    pub fn of(bodies: &[Body], certified: &Certified, is_earliest: bool) -> Option<BelowPrecision> {
        let finest = finest(certified);
        // Positive, or not asked for.
        let tolerance = certified.tolerance.filter(|t| *t > 0.0)?;
        let extent = extent(bodies);
        if !is_earliest {
            // How large it is where only the device knows, the kernels tell.
            let away = bodies.iter().any(Body::is_away);
            return (away || tolerance < finest * extent)
                .then_some(BelowPrecision::Listed { tolerance, finest });
        }
        // The two ends of an edge differ from any one point by half of its length, one or the other.
        let is_long = |side: f64| tolerance < finest * side / 2.0;
        let long = |body: &Body| {
            let ends = body.ends();
            let sides = |[p, q, r]: [u32; 3]| [[p, q], [q, r], [r, p]].map(|[p, q]| largest(&ends, p, q));
            body.faces().par_iter().any(|&face| sides(face).into_iter().any(is_long))
        };
        (is_long(extent) && bodies.iter().any(long)).then_some(BelowPrecision::Unlisted)
    }

    /// Whether pairs may be so large, where no two coordinates differ by more than that.
    pub fn may_be(certified: &Certified, extent: f64) -> bool {
        // A tolerance of 0 is never below.
        certified.tolerance.is_some_and(|tolerance| 0.0 < tolerance && tolerance < finest(certified) * extent)
    }
}

/// The least part of a pair's extent that the solver can tell.
fn finest(certified: &Certified) -> f64 {
    match certified.precision {
        CertifiedPrecision::F32 => f32::INCLUSION_FINEST.into(),
        // What f32 cannot tell is asked again in f64.
        CertifiedPrecision::Mixed | CertifiedPrecision::F64 => f64::INCLUSION_FINEST,
    }
}

/// Has the kernels count the hits that are too large for the tolerance, where there may be such.
///
/// # Errors
/// Those of the device.
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
    // Faces were checked when the mesh was made: every vertex is there.
    positions.get_f64(v as usize).unwrap_or_default()
}

/// The largest component of the difference of two vertices, at either end of the step.
fn largest(ends: &[&Positions; 2], p: u32, q: u32) -> f64 {
    let apart = |positions: &Positions| {
        let (p, q) = (point(positions, p), point(positions, q));
        (0..3).map(|k| (p[k] - q[k]).abs()).fold(0.0, f64::max)
    };
    apart(ends[0]).max(apart(ends[1]))
}

/// The largest difference of coordinates of all: no pair is larger. What no face uses counts too; of rigid bodies at least
/// as much.
fn extent(bodies: &[Body]) -> f64 {
    let of = |body: &Body| {
        body.posed_box().unwrap_or_else(|| {
            body.ends().into_iter().fold(NOTHING, |bounds, positions| {
                let own = match positions {
                    Positions::F32(points) => of_points(points),
                    Positions::F64(points) => of_points(points),
                };
                union(bounds, own)
            })
        })
    };
    let bounds = bodies.iter().map(of).fold(NOTHING, union);
    (0..3).map(|k| bounds[1][k] - bounds[0][k]).fold(0.0, f64::max)
}

fn of_points<T: Copy + Into<f64> + Sync>(points: &[[T; 3]]) -> Bounds {
    let of = |piece: &[[T; 3]]| {
        piece.iter().map(|p| p.map(Into::into)).fold(NOTHING, |bounds, p| union(bounds, [p, p]))
    };
    points.par_chunks(1 << 13).map(of).reduce(|| NOTHING, union)
}
