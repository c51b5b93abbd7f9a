//! # Fit moving bodies: poses of a step → places and boxes of bodies, of groups of 32, of the nodes above
//! Paper    not in the paper.
//! Launch   a block 16 groups, a lane a body.
//! Reads    the order; two poses, a mesh and a turn a body. At rest one pose, which is both.
//! Writes   frames at both ends, a motion and a box a body; groups; the node above them; the number
//!          of the frame.
//! Before   poses are finite, quaternions have length 1. Turns are placed.
//! After    frames as after [`super::bodies`], by each pose.
//!          motion = that of the body's turn; of a body that goes straight, about its centre.
//!          box(body) ⊇ every place of a vertex in the step, and everything nearer than the margin.
//!          Other volumes = merges, as after `fit_tiles`.
//! Room     fixed; cannot run out.
//! Cost     128 B of poses, 160 B of a turn and 96 B of a mesh (from cache) in; 400 B a body out. 500
//!          operations in f64.
//!
//! A body that turns by `w` leaves the chords of its vertices by `bulge(w)` times the reach. One that
//! goes straight is on its chords, but leaves its motion by as much: see [`crate::bvh::motion`].
//! The rotation at the end is that of the pose, which is not quite that of the turn. Its difference
//! is the skew: computed, and `64U` for its own roundings and those of both.

use super::bodies::{fitted, frame, placed_box};
use super::tiles::fit;
use crate::abi::{InstanceFrame, InstanceMotion, MeshRecord, MovingBodiesArgs, PoseRecord, TurnRecord};
use crate::bvh::turns::body_of;
use crate::exec::{Block, Lane};
use crate::math::root::sqrt64;
use crate::math::tolerance::U64;
use crate::math::tolerance::swell::SWELL;
use crate::math::tolerance::turning::TURNING_UP;
use crate::math::turn::{Turn, after, between, bulge, exp};
use crate::math::{Real, Vec3, rigid, round};

/// Places, motions and boxes of bodies.
pub fn bodies<B: Block>(block: &mut B, args: &MovingBodiesArgs) {
    let of = &args.of;
    let (first, count) = (block.block() * block.lanes(), of.order.len() as u32);
    fit(block, &fitted(of), |lane, body| {
        let own = lane.read(of.tables.bodies, body);
        let mesh = lane.read(of.tables.meshes, own.mesh);
        let poses = [0, args.poses - 1].map(|end| lane.read(of.poses, 2 * body + end));
        let frames = poses.map(|pose| frame(&pose, &mesh));
        let vertex = lane.read(args.faces, own.triangle)[0];
        let turn = body_of(lane, args.turns, vertex);
        let motion = motion(&mesh, &poses, &frames, turn.as_ref());
        // The last body is there again behind it, and has one writer.
        if first + lane.lane() < count {
            lane.write(of.tables.frames, body, frames[0]);
            lane.write(args.ends, body, frames[1]);
            lane.write(args.motions, body, motion);
        }
        if first + lane.lane() == 0 {
            lane.fetch_add(args.frame, 0, 1);
        }
        let margin = around(&mesh, &frames, &motion, turn.is_some());
        let margin = round::up(of.margin.wide() + margin);
        placed_box(&frames[0], &mesh, margin).merge(placed_box(&frames[1], &mesh, margin))
    });
}

/// The motion of a body between two poses, which are its frames.
#[inline(always)]
pub fn motion(
    mesh: &MeshRecord,
    poses: &[PoseRecord; 2],
    frames: &[InstanceFrame; 2],
    turning: Option<&TurnRecord>,
) -> InstanceMotion {
    let of_centre = [frames[0].origin, frames[1].origin];
    let straight = between(poses[0].rotation, poses[1].rotation);
    let turn = turning.map_or(straight, |turn| Vec3(turn.turn));
    let pivot = turning.map_or(mesh.centre, |turn| turn.pivot);
    let path = turning.map_or(of_centre, |turn| turn.path);
    let offset = Vec3(mesh.centre) - Vec3(pivot);
    let reach = (mesh.radius + sqrt64(offset.dot(offset))) * TURNING_UP;
    let turned = rigid::rows(after(exp(turn), poses[0].rotation));
    let mut squares = 0.0;
    for (of_turn, of_pose) in turned.iter().zip(&frames[1].rows) {
        let row = Vec3(*of_turn) - Vec3(*of_pose);
        squares += row.dot(row);
    }
    let skew = (sqrt64(squares) + 64.0 * U64) * TURNING_UP;
    let angle = Turn::new(turn).angle() * TURNING_UP;
    let strays = skew + if turning.is_some() { 0.0 } else { bulge(angle) };
    InstanceMotion { turn: turn.0, path, angle, reach, strays: strays * reach * TURNING_UP, skew, pad: 0.0 }
}

/// By how much a body's box grows in the step, beyond boxes at both ends.
#[inline(always)]
fn around(mesh: &MeshRecord, frames: &[InstanceFrame; 2], motion: &InstanceMotion, turns: bool) -> f64 {
    let most = |p: &[f64; 3]| Real::abs(p[0]).greater(Real::abs(p[1])).greater(Real::abs(p[2]));
    let [start, end] = frames.each_ref().map(|frame| most(&frame.origin));
    let size = start.greater(end).greater(most(&motion.path[0])).greater(most(&motion.path[1]));
    let leaves = if turns { bulge(motion.angle) * motion.reach } else { 0.0 };
    (leaves + motion.skew * motion.reach + SWELL * (size + mesh.radius)) * TURNING_UP
}
