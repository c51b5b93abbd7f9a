//! # Turns: poses of a step → bodies that turn
//! Paper    not in the paper.
//! Launch   a lane a body; a grid of any size strides. Only in scenes with a rigid body that turns,
//!          or whose poses are in the caller's memory.
//! Reads    its poses at both ends.   Writes   its turn.
//! Before   poses are placed: those of the caller's memory were read. One that is no pose has been
//!          noted there, and turns nothing.
//! After    turn = the given rotation vector, or that of the shorter arc: 0, exactly, between equal
//!          rotations. path = where the poses put the pivot.
//! Room     fixed; cannot run out.
//! Cost     128 B of poses in, 160 B out, and log2 of the bodies reads.

use crate::abi::{PoseRecord, TurnRecord, TurnsArgs};
use crate::bvh::turns::holder_of;
use crate::exec::{Block, Lane};
use crate::math::tolerance::POSE_UNIT;
use crate::math::turn::{Turn, between, bulge};
use crate::math::{Real, Vec3, rigid};

/// The turn of every body.
pub fn turns<B: Block>(block: &mut B, args: &TurnsArgs) {
    let stride = block.blocks() * block.lanes();
    let count = args.sources.len() as u32;
    block.phase(|lane| {
        let mut i = lane.global();
        while i < count {
            let source = lane.read(args.sources, i);
            let begin = |k| lane.read(args.sources, k).vertex;
            let span = lane.read(args.sources, count - 1).end - begin(0);
            let poses = if source.is_lent != 0 { args.found } else { args.poses };
            // Those of the host have been divided by their length, once, as these are.
            let mut is_pose = true;
            let mut pose = |end: u32| {
                let pose = lane.read(poses, source.pose + end);
                if source.is_lent == 0 {
                    return pose;
                }
                let length = rigid::length(&pose.rotation);
                is_pose &= Real::abs(length - 1.0) <= POSE_UNIT;
                PoseRecord { rotation: pose.rotation.map(|q| q / length), ..pose }
            };
            let (start, end) = (pose(0), pose(1));
            let turn = match (is_pose, source.is_given) {
                (false, _) => Vec3([0.0; 3]),
                (true, 0) => between(start.rotation, end.rotation),
                (true, _) => Vec3(source.turn),
            };
            let pivot = Vec3(source.pivot);
            let place =
                |pose: &PoseRecord| rigid::moved(&rigid::rows(pose.rotation), &pose.translation, pivot);
            let record = TurnRecord {
                vertex: source.vertex,
                end: source.end,
                rest: source.rest,
                holder: holder_of(i, (span, count), begin),
                rotation: start.rotation,
                turn: turn.0,
                pivot: source.pivot,
                path: [place(&start).0, place(&end).0],
                bulge: bulge(Turn::new(turn).angle()),
                fixed: source.fixed,
            };
            lane.write(args.turns, i, record);
            i = i.saturating_add(stride);
        }
    });
}
