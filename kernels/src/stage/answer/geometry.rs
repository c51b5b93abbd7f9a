//! # Answer, geometry: rows → vertices, weights, nearest points, distance and normal
//! Paper    not in the paper.
//! Launch   a lane a row that there is room for; a grid of any size strides.
//! Reads    rows, faces or edges, positions of both frames (four vertices).
//! Writes   a record a row; zeros for rows that are not used.
//! Before   lists are complete. No body turns in the step.
//! After    geometry\[i\] = that of row i at its time of contact: see [`crate::prim::geometry`].
//! Room     as many records as rows have room.
//! Cost     32 B row, 16 B indices, 128 B positions (gathered), 128 B out; 500 operations of f64.

use super::{Count, Measured, corners};
use crate::abi::{AnswerGeometryArgs, Positions, RowGeometry};
use crate::exec::{Block, Lane};
use crate::math::{Real, Vec3};
use crate::prim::geometry::{Connection, Corners};
use bytemuck::Zeroable;

/// The geometry of each row.
pub fn geometry<R: Real, T: Measured, B: Block>(block: &mut B, args: &AnswerGeometryArgs<R, T>) {
    let (rows, room) = (&args.rows, args.geometry.len() as u32);
    let count = Count::of(block, rows);
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let mut row = lane.global();
        while row < room {
            let mut record = RowGeometry::zeroed();
            if row < count.all {
                let contact = count.get(lane, rows, row);
                let name = count.name(lane, rows, row, &contact);
                let vertices = corners(lane, rows, &name);
                let ends = [0, 1, 2, 3].map(|k: usize| ends(lane, &args.frames, vertices[k]));
                let of = Connection::of(name.kind, &Corners::straight(&ends, contact.time()));
                record = RowGeometry {
                    distance: of.distance,
                    normal: of.normal.0,
                    signed_weights: of.signed_weights(name.kind),
                    points: [of.points[0].0, of.points[1].0],
                    vertices,
                };
            }
            lane.write(args.geometry, row, record);
            row = row.saturating_add(stride);
        }
    });
}

/// A vertex at both ends of the step, or twice as it is.
#[inline(always)]
fn ends<R: Real, L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) -> [Vec3<f64>; 2] {
    if frames.moving.is_empty() {
        let at = lane.read(frames.still, vertex).at.wide();
        return [at, at];
    }
    let vertex = lane.read(frames.moving, vertex);
    [vertex.t0.at.wide(), vertex.t1.at.wide()]
}
