//! # Place: poses and uploads → vertices in the scene
//! Paper    nothing; gProximity uploads every vertex every frame. A rigid body needs 64 B a pose.
//! Launch   a lane a vertex of the bodies that were moved; a grid of any size strides.
//! Reads    placements; points at rest and poses, or uploaded vertices.      Writes   vertices, each once.
//! Before   placements come in the order of their vertices; every pose gives coordinates that are small enough (the host
//!          has looked).
//! After    a vertex of a rigid body is its point at rest, turned and moved by its pose at either end, in f64 and rounded once;
//!          one that was uploaded is as it was; one that rests is at both ends where it was at the later one. Other bodies'
//!          vertices are as they were. An answer is with respect to these vertices.
//! Room     fixed; cannot run out.
//! Cost     16 B a point in and 16 or 32 B out (f32), 64 B a pose from cache; 50 operations a vertex and end.

use crate::abi::{PlaceArgs, Point, PoseRecord, RESTING, UPLOADED, VertexMotion};
use crate::bvh::filter::holder;
use crate::exec::{Block, Lane};
use crate::math::{Real, Vec3};

/// Where the pose takes a point.
#[inline(always)]
fn moved<R: Real>(pose: &PoseRecord, point: Vec3<R>) -> Point<R> {
    let p = point.wide();
    let [x, y, z, w] = pose.rotation;
    let rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let coordinate =
        |k: usize| R::of(rows[k][0] * p[0] + rows[k][1] * p[1] + rows[k][2] * p[2] + pose.translation[k]);
    Point::from(Vec3([coordinate(0), coordinate(1), coordinate(2)]))
}

/// Every vertex of the placed bodies.
pub fn place<R: Real, B: Block>(b: &mut B, a: &PlaceArgs<R>) {
    let still = a.vertices.moving.is_empty();
    let stride = b.blocks() * b.lanes();
    b.phase(|l| {
        let mut i = l.global();
        while i < a.count {
            let at = holder(a.placements.len(), i, |k| l.read(a.placements, k).before);
            let placement = l.read(a.placements, at);
            let own = i - placement.before;
            let (vertex, source) = (placement.vertex + own, placement.source + own);
            if still {
                let point = match placement.poses {
                    UPLOADED => l.read(a.uploaded.still, source),
                    RESTING => l.read(a.vertices.still, vertex),
                    pose => moved(&l.read(a.poses, pose), l.read(a.rest, source).at),
                };
                l.write(a.vertices.still, vertex, point);
            } else {
                let motion = match placement.poses {
                    UPLOADED => l.read(a.uploaded.moving, source),
                    RESTING => {
                        let end = l.read(a.vertices.moving, vertex).t1;
                        VertexMotion { t0: end, t1: end }
                    }
                    pose => {
                        let point = l.read(a.rest, source).at;
                        let ends = [0, 1].map(|end| moved(&l.read(a.poses, 2 * pose + end), point));
                        VertexMotion { t0: ends[0], t1: ends[1] }
                    }
                };
                l.write(a.vertices.moving, vertex, motion);
            }
            i = i.saturating_add(stride);
        }
    });
}
