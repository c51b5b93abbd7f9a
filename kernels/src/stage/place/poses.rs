//! # Place, poses: uploads and the caller's memory → poses of instances
//! Paper    not in the paper.
//! Launch   a lane a body whose pose changes; a grid of any size strides. Only in scenes of
//!          instances with a pose in the caller's memory.
//! Reads    sources; uploaded poses, or rows in the caller's memory; a mesh a body.
//! Writes   two poses a body; poses as they were in the caller's memory; `seen`, by atomics.
//! Before   each body has at most one source. Poses from the host are within the limit. `seen` = 0.
//! After    Both poses of a body have length 1; a body that stands has one pose twice.
//!          One at rest has the pose of its end twice. Poses of other bodies are unchanged.
//!          Rotations that are none are replaced by none, and coordinates that are no numbers by 0,
//!          so that later launches read finite poses. Both are noted.
//!          `seen` = (first vertex of a body that may be invalid, a bound of coordinates). A pose
//!          that may put a vertex beyond the limit counts as invalid: the host looks again.
//! Room     fixed; cannot run out.
//! Cost     24 B a source, 56 B of the caller a pose and 96 B of a mesh in; 256 B out.

use super::{Seen, all_seen, nothing_seen, read};
use crate::abi::{LENT_POSES, PlacePosesArgs, Point, PoseRecord, RESTING};
use crate::exec::{Block, Lane};
use crate::math::root::sqrt64;
use crate::math::tolerance::turning::TURNING_UP;
use crate::math::{Real, Vec3};

/// The poses of every changed body.
pub fn poses<B: Block>(block: &mut B, args: &PlacePosesArgs) {
    let (count, stride) = (args.sources.len() as u32, block.blocks() * block.lanes());
    let words = nothing_seen(block);
    block.phase(|lane| {
        let mut seen = Seen { invalid: 0, largest: 0.0 };
        let mut i = lane.global();
        while i < count {
            let source = lane.read(args.sources, i);
            let [first, last] = [2 * source.body, 2 * source.body + 1];
            let mesh = lane.read(args.tables.meshes, lane.read(args.tables.bodies, source.body).mesh);
            let mut end_of = |end: u32| match source.from {
                RESTING => (lane.read(args.found, last), lane.read(args.poses, last)),
                LENT_POSES => {
                    let (found, pose, is_pose) = read(lane, args.lent, source.at + 2 * end);
                    (
                        found,
                        checked(
                            &mut seen,
                            source.vertex,
                            (&pose, is_pose),
                            (&mesh.centre, mesh.radius),
                            args.most,
                        ),
                    )
                }
                _ => {
                    let pose = lane.read(args.uploaded, source.at + end);
                    (pose, pose)
                }
            };
            let start = end_of(0);
            let end = if source.ends == 2 { end_of(1) } else { start };
            for (at, (found, pose)) in [(first, start), (last, end)] {
                lane.write(args.found, at, found);
                lane.write(args.poses, at, pose);
            }
            i = i.saturating_add(stride);
        }
        seen.tell(lane, words);
    });
    all_seen(block, words, args.seen);
}

/// A pose of the caller, checked for a mesh of this centre and radius; a finite one in its place.
#[inline(always)]
fn checked(
    seen: &mut Seen,
    vertex: u32,
    (pose, is_pose): (&PoseRecord, bool),
    (centre, radius): (&[f64; 3], f64),
    most: f64,
) -> PoseRecord {
    let centre = Vec3(*centre);
    let reach = (sqrt64(centre.dot(centre)) + radius) * TURNING_UP;
    let far = Vec3(pose.translation.map(|t| (Real::abs(t) + reach) * TURNING_UP));
    seen.look(vertex, &Point::from(far), is_pose, most);
    let rotation = if is_pose { pose.rotation } else { [0.0, 0.0, 0.0, 1.0] };
    let finite = |t: f64| if Real::abs(t) <= most { t } else { 0.0 };
    PoseRecord { rotation, translation: pose.translation.map(finite), pad: 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOST: f64 = 1e100;

    fn seen_of(rotation: [f64; 4], translation: [f64; 3], is_pose: bool) -> (Seen, PoseRecord) {
        let mut seen = Seen { invalid: 0, largest: 0.0 };
        let pose = PoseRecord { rotation, translation, pad: 0.0 };
        let pose = checked(&mut seen, 7, (&pose, is_pose), (&[3.0, 0.0, 4.0], 2.0), MOST);
        (seen, pose)
    }

    #[test]
    fn a_pose_is_noted_if_it_is_none_or_too_far() {
        let unit = [0.0, 1.0, 0.0, 0.0];
        let (seen, pose) = seen_of(unit, [1.0, -20.0, 0.0], true);
        assert!(seen.invalid == 0 && pose.rotation == unit && pose.translation == [1.0, -20.0, 0.0]);
        // A vertex may be 7 from the origin of the mesh.
        assert!((27.0..27.1).contains(&seen.largest), "{}", seen.largest);
        for (rotation, at, is_pose) in [
            (unit, [MOST, 0.0, 0.0], true),
            (unit, [0.0, f64::NAN, 0.0], true),
            (unit, [f64::INFINITY, 0.0, 0.0], true),
            ([f64::NAN; 4], [0.0; 3], false),
        ] {
            let (seen, pose) = seen_of(rotation, at, is_pose);
            assert_eq!(seen.invalid, !7);
            let all = pose.rotation.into_iter().chain(pose.translation);
            assert!(all.clone().all(f64::is_finite) && all.take(4).any(|q| q != 0.0));
        }
    }
}
