//! # Fit bodies: poses → places and boxes of bodies, of groups of 32, of the nodes above
//! Paper    not in the paper.
//! Launch   a block 16 groups, a lane a body.
//! Reads    the order; a pose and a mesh a body.
//! Writes   a frame and a box a body; groups; the node above them.
//! Before   poses are finite, quaternions have length 1.
//! After    frame = rows of the rotation, translation and placed centre.
//!          box(body) ⊇ every placed vertex of a triangle of it, as [`super::super::place`] rounds it,
//!          and everything that is nearer to one than the margin, as computed.
//!          Other volumes = merges, as after `fit_tiles`.
//! Room     fixed; cannot run out.
//! Cost     64 B a pose and 96 B a mesh (from cache) in; 160 B a body out. 150 operations in f64.

use super::tiles::{Fitted, fit};
use crate::abi::{BodiesArgs, InstanceFrame, MeshRecord, PoseRecord};
use crate::bv::FrameBox;
use crate::bvh::relation::size;
use crate::exec::{Block, Lane};
use crate::math::tolerance::{DISTANCE_CERTAIN, DISTANCE_UP, PLACED_BOX};
use crate::math::{Real, Vec3, rigid, round};

/// Places and boxes of bodies.
pub fn bodies<B: Block>(block: &mut B, args: &BodiesArgs) {
    let (first, count) = (block.block() * block.lanes(), args.order.len() as u32);
    fit(block, &fitted(args), |lane, body| {
        let mesh = lane.read(args.tables.meshes, lane.read(args.tables.bodies, body).mesh);
        let frame = frame(&lane.read(args.poses, 2 * body), &mesh);
        // The last body is there again behind it, and has one writer.
        if first + lane.lane() < count {
            lane.write(args.tables.frames, body, frame);
        }
        placed_box(&frame, &mesh, args.margin)
    });
}

/// Bodies in order, and their nodes.
#[inline(always)]
pub fn fitted(args: &BodiesArgs) -> Fitted<FrameBox> {
    Fitted { items: args.order, leaves: args.leaves, nodes: args.nodes, tile: args.tile, above: args.above }
}

/// The place of a mesh by a pose.
#[inline(always)]
pub fn frame(pose: &PoseRecord, mesh: &MeshRecord) -> InstanceFrame {
    let rows = rigid::rows(pose.rotation);
    InstanceFrame {
        rows,
        translation: pose.translation,
        origin: rigid::moved(&rows, &pose.translation, Vec3(mesh.centre)).0,
        far: size(&pose.translation) + size(&mesh.centre),
    }
}

/// Around everything within a margin of a mesh's placed vertices, in f32.
#[inline(always)]
pub fn placed_box(frame: &InstanceFrame, mesh: &MeshRecord, margin: f32) -> FrameBox {
    // A mesh that deforms beyond the range of f32 has a box without ends.
    if mesh.radius == f64::INFINITY {
        return FrameBox { lo: [f32::NEG_INFINITY; 3], hi: [f32::INFINITY; 3] };
    }
    let middle = |k: usize| 0.5 * mesh.lo[k] + 0.5 * mesh.hi[k];
    let c = [middle(0), middle(1), middle(2)];
    let half = |k: usize| {
        let (down, up) = (c[k] - mesh.lo[k], mesh.hi[k] - c[k]);
        if down > up { down } else { up }
    };
    let h = [half(0), half(1), half(2)];
    let scale = mesh.radius + frame.far;
    // The computed distance may be below the true one, by a part of each body's coordinates.
    let near = if margin > 0.0 { margin.wide() * DISTANCE_UP + DISTANCE_CERTAIN * scale } else { 0.0 };
    let grown = PLACED_BOX * scale + near;
    let side = |k: usize| {
        let row = &frame.rows[k];
        let at = row[0] * c[0] + row[1] * c[1] + row[2] * c[2] + frame.origin[k];
        let by = row[0].abs() * h[0] + row[1].abs() * h[1] + row[2].abs() * h[2] + grown;
        (round::down(at - by), round::up(at + by))
    };
    let (x, y, z) = (side(0), side(1), side(2));
    FrameBox { lo: [x.0, y.0, z.0], hi: [x.1, y.1, z.1] }
}
