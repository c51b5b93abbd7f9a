//! # Place: poses, uploads and the caller's memory → vertices in the scene
//! Paper    not in the paper: gProximity uploads every vertex every frame. A rigid body needs 64 B
//!          a pose.
//! Launch   a lane a vertex of the moved bodies; a grid of any size strides.
//! Reads    placements; points at rest and poses, uploaded vertices, or rows in the caller's
//!          memory.
//! Writes   vertices, each once; ends of steps that are kept; poses read from the caller's memory;
//!          `seen`, by atomics.
//! Before   placements ascend by their vertices. Every pose from the host gives coordinates within
//!          the limit, as checked there. `seen` = 0.
//! After    A vertex of a rigid body = [`moved`] by its pose at either end, in f64. (A scene with a
//!          rigid body has positions in f64.)
//!          An uploaded vertex, or one in the caller's memory, is copied. A resting one has its
//!          later position at both ends. All have their thickness.
//!          Vertices of other bodies are unchanged. The answer refers to these vertices.
//!          `seen` = (first vertex that is invalid, largest coordinate) of the caller's numbers. An
//!          invalid vertex means no answer.
//!          With one end, a step in the caller's memory keeps its end in `later`. A resting body is
//!          copied from there.
//! Room     fixed; cannot run out.
//! Cost     16 B a point in and 16 or 32 B out (f32), 4 B a thickness, 64 B a pose from cache. 50 operations a
//!          vertex and end.

pub mod poses;

use crate::abi::{
    KEEPS_END, LENT, Lent, POSED, PlaceArgs, Point, PoseRecord, RESTING, Span, UPLOADED, VertexMotion, seen,
};
use crate::bvh::filter::holder;
use crate::exec::{Block, Lane, Shared};
use crate::math::tolerance::POSE_UNIT;
use crate::math::{Real, Vec3, rigid};

/// The image of a point under a pose: `R v + t`, by these operations in f64 and in this order on
/// every machine.
#[inline(always)]
pub fn moved(pose: &PoseRecord, p: Vec3<f64>) -> Vec3<f64> {
    rigid::moved(&rigid::rows(pose.rotation), &pose.translation, p)
}

/// The same of a point at rest.
#[inline(always)]
fn placed<R: Real>(pose: &PoseRecord, at_rest: Point<R>) -> Point<R> {
    Point::from(moved(pose, at_rest.at.wide()).map(|x| R::of(x)))
}

/// A row of the caller's numbers.
#[inline(always)]
fn row<L: Lane, const N: usize>(lane: &L, lent: &Lent, row: u32) -> [f64; N] {
    let at = row * lent.stride;
    let mut numbers = [0.0; N];
    for (k, number) in numbers.iter_mut().enumerate() {
        let i = at + k as u32;
        // SAFETY: `lent` describes this many numbers of that kind; the caller of the launch
        // promises it.
        *number = unsafe {
            if lent.is_f64 != 0 {
                lane.read(Span::<f64>::new(lent.address, lent.numbers.into()), i)
            } else {
                lane.read(Span::<f32>::new(lent.address, lent.numbers.into()), i).into()
            }
        };
    }
    numbers
}

/// Checks that a lane made on the caller's numbers: see [`seen`].
#[derive(Clone, Copy)]
struct Seen {
    invalid: u32,
    largest: f64,
}

impl Seen {
    /// A vertex, and whether its pose is one.
    #[inline(always)]
    fn look<R: Real>(&mut self, vertex: u32, point: &Point<R>, is_pose: bool, most: f64) {
        let [x, y, z] = point.at.wide().0.map(Real::abs);
        // NaN is in no range.
        if !(is_pose & (x <= most) & (y <= most) & (z <= most)) {
            self.invalid = self.invalid.max(!vertex);
        } else {
            self.largest = self.largest.greater(x).greater(y).greater(z);
        }
    }

    /// Adds a lane's checks to those of its block.
    #[inline(always)]
    fn tell<L: Lane>(&self, lane: &L, words: Shared<u64>) {
        if self.invalid > 0 {
            lane.shared_max(words, seen::INVALID, self.invalid.into());
        }
        if self.largest > 0.0 {
            lane.shared_max(words, seen::LARGEST, self.largest.to_bits());
        }
    }
}

/// Words of a block for the checks of its lanes, all 0.
#[inline(always)]
fn nothing_seen<B: Block>(block: &mut B) -> Shared<u64> {
    let (words, lanes) = (block.shared::<u64>(seen::COUNT), block.lanes());
    block.phase(|lane| {
        (lane.lane()..seen::COUNT).step_by(lanes as usize).for_each(|word| lane.put(words, word, 0))
    });
    words
}

/// Adds a block's checks to those of all.
#[inline(always)]
fn all_seen<B: Block>(block: &mut B, words: Shared<u64>, all: Span<u64>) {
    let lanes = block.lanes();
    block.phase(|lane| {
        for word in (lane.lane()..seen::COUNT).step_by(lanes as usize) {
            let most = lane.get(words, word);
            if most > 0 {
                lane.fetch_max(all, word, most);
            }
        }
    });
}

/// A pose in the caller's memory, as it is there, and by its length: a translation, then a rotation.
/// Also whether it is one.
#[inline(always)]
fn read<L: Lane>(lane: &L, lent: Span<Lent>, at: u32) -> (PoseRecord, PoseRecord, bool) {
    let translation = row::<_, 3>(lane, &lane.read(lent, at), 0);
    let rotation = row::<_, 4>(lane, &lane.read(lent, at + 1), 0);
    let length = rigid::length(&rotation);
    let found = PoseRecord { rotation, translation, pad: 0.0 };
    let pose = PoseRecord { rotation: rotation.map(|q| q / length), ..found };
    (found, pose, Real::abs(length - 1.0) <= POSE_UNIT)
}

/// Every vertex of the placed bodies.
pub fn place<R: Real, B: Block>(block: &mut B, args: &PlaceArgs<R>) {
    let still = args.vertices.moving.is_empty();
    let ends = if still { 1 } else { 2 };
    let stride = block.blocks() * block.lanes();
    let words = nothing_seen(block);
    block.phase(|lane| {
        let mut seen = Seen { invalid: 0, largest: 0.0 };
        let mut i = lane.global();
        while i < args.count {
            let at = holder(args.placements.len(), i, |k| lane.read(args.placements, k).before);
            let placement = lane.read(args.placements, at);
            let own = i - placement.before;
            let (vertex, source) = (placement.vertex + own, placement.source + own);
            // At one end; the rest of a body in motion is below.
            let from = placement.from & !KEEPS_END;
            let mut end_of = |end: u32| match from {
                UPLOADED => lane.read(args.uploaded.still, source),
                RESTING => lane.read(args.later, vertex),
                LENT => {
                    let point = row::<_, 3>(lane, &lane.read(args.lent, placement.lent + end), own);
                    let point = Point::from(Vec3(point.map(|x| R::of(x))));
                    // The number of the vertex in the scene.
                    seen.look(source, &point, true, args.most);
                    point
                }
                POSED => {
                    let pose = lane.read(args.poses, placement.pose + end);
                    placed(&pose, lane.read(args.rest, source))
                }
                _ => {
                    let (found, pose, is_pose) = read(lane, args.lent, placement.lent + 2 * end);
                    if own == 0 {
                        lane.write(args.found, placement.pose + end, found);
                    }
                    let point = placed(&pose, lane.read(args.rest, source));
                    seen.look(vertex, &point, is_pose, args.most);
                    point
                }
            };
            let radius = if args.radii.is_empty() { R::ZERO } else { lane.read(args.radii, vertex) };
            let thick = |point: Point<R>| Point { radius, ..point };
            if still {
                let point = end_of(0);
                lane.write(args.vertices.still, vertex, thick(point));
                if placement.from & KEEPS_END != 0 {
                    let end = end_of(1);
                    lane.write(args.later, vertex, end);
                }
            } else {
                let motion = match from {
                    UPLOADED => lane.read(args.uploaded.moving, source),
                    RESTING => {
                        let end = lane.read(args.vertices.moving, vertex).t1;
                        VertexMotion { t0: end, t1: end }
                    }
                    _ => {
                        let t0 = end_of(0);
                        VertexMotion { t0, t1: end_of(ends - 1) }
                    }
                };
                let motion = VertexMotion { t0: thick(motion.t0), t1: thick(motion.t1) };
                lane.write(args.vertices.moving, vertex, motion);
            }
            i = i.saturating_add(stride);
        }
        seen.tell(lane, words);
    });
    all_seen(block, words, args.seen);
}

/// Bytes of shared memory of a block.
pub const SHARED: u32 = 8 * seen::COUNT;
