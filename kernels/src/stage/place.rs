//! # Place: poses, uploads and memory of the caller → vertices in the scene
//! Paper    nothing; gProximity uploads every vertex every frame. A rigid body needs 64 B a pose.
//! Launch   a lane a vertex of the bodies that were moved; a grid of any size strides.
//! Reads    placements; points at rest and poses, uploaded vertices, or rows in memory of the caller.
//! Writes   vertices, each once; ends of steps that are kept; poses that lay in memory of the caller; what was seen there, by atomics.
//! Before   placements come in the order of their vertices; every pose that the host gave gives coordinates that are small enough (it
//!          has looked). `seen` is zero.
//! After    a vertex of a rigid body is [`moved`] by its pose at either end, in f64 and as computed (a scene with a rigid body has
//!          positions in f64);
//!          one that was uploaded, or lies in memory of the caller, is as it was; one that rests is at both ends where it was at the
//!          later one. Other bodies' vertices are as they were. An answer is with respect to these vertices. Of the caller's numbers,
//!          `seen` tells whether all can be computed with (else there is no answer) and the largest.
//!          With one end, a step in memory of the caller keeps its end in `later`, and a body that rests is copied from there.
//! Room     fixed; cannot run out.
//! Cost     16 B a point in and 16 or 32 B out (f32), 64 B a pose from cache; 50 operations a vertex and end.

use crate::abi::{
    KEEPS_END, LENT, Lent, POSED, PlaceArgs, Point, PoseRecord, RESTING, Span, UPLOADED, VertexMotion, seen,
};
use crate::bvh::filter::holder;
use crate::exec::{Block, Lane};
use crate::math::tolerance::POSE_UNIT;
use crate::math::{Real, Vec3};

/// Where the pose takes a point: `R v + t` by these operations, in doubles and in this order, on every machine.
#[inline(always)]
pub fn moved(pose: &PoseRecord, p: Vec3<f64>) -> Vec3<f64> {
    let [x, y, z, w] = pose.rotation;
    let rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let coordinate =
        |k: usize| rows[k][0] * p[0] + rows[k][1] * p[1] + rows[k][2] * p[2] + pose.translation[k];
    Vec3([coordinate(0), coordinate(1), coordinate(2)])
}

/// The same of a point at rest.
#[inline(always)]
fn placed<R: Real>(pose: &PoseRecord, at_rest: Point<R>) -> Point<R> {
    Point::from(moved(pose, at_rest.at.wide()).map(|x| R::of(x)))
}

/// A row of the caller's numbers.
#[inline(always)]
fn row<L: Lane, const N: usize>(l: &L, lent: &Lent, row: u32) -> [f64; N] {
    let at = row * lent.stride;
    let mut numbers = [0.0; N];
    for (k, number) in numbers.iter_mut().enumerate() {
        let i = at + k as u32;
        // SAFETY: so many numbers of that kind are there, as whoever launches this promises.
        *number = unsafe {
            if lent.is_f64 != 0 {
                l.read(Span::<f64>::new(lent.address, lent.numbers.into()), i)
            } else {
                l.read(Span::<f32>::new(lent.address, lent.numbers.into()), i).into()
            }
        };
    }
    numbers
}

/// The root of the sum of a rotation's squares.
#[inline(always)]
fn length(rotation: &[f64; 4]) -> f64 {
    let [x, y, z, w] = *rotation;
    Real::sqrt(x * x + y * y + z * z + w * w)
}

/// What a lane saw of the caller's numbers: see [`seen`].
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
}

/// Every vertex of the placed bodies.
pub fn place<R: Real, B: Block>(b: &mut B, a: &PlaceArgs<R>) {
    let still = a.vertices.moving.is_empty();
    let ends = if still { 1 } else { 2 };
    let stride = b.blocks() * b.lanes();
    let words = b.shared::<u64>(seen::COUNT);
    let lanes = b.lanes();
    b.phase(|l| (l.lane()..seen::COUNT).step_by(lanes as usize).for_each(|word| l.put(words, word, 0)));
    b.phase(|l| {
        let mut seen = Seen { invalid: 0, largest: 0.0 };
        let mut i = l.global();
        while i < a.count {
            let at = holder(a.placements.len(), i, |k| l.read(a.placements, k).before);
            let placement = l.read(a.placements, at);
            let own = i - placement.before;
            let (vertex, source) = (placement.vertex + own, placement.source + own);
            // At one end; the rest of a body in motion is below.
            let from = placement.from & !KEEPS_END;
            let mut end_of = |end: u32| match from {
                UPLOADED => l.read(a.uploaded.still, source),
                RESTING => l.read(a.later, vertex),
                LENT => {
                    let point = row::<_, 3>(l, &l.read(a.lent, placement.lent + end), own);
                    let point = Point::from(Vec3(point.map(|x| R::of(x))));
                    seen.look(vertex, &point, true, a.most);
                    point
                }
                POSED => {
                    let pose = l.read(a.poses, placement.pose + end);
                    placed(&pose, l.read(a.rest, source))
                }
                _ => {
                    let lent = placement.lent + 2 * end;
                    let translation = row::<_, 3>(l, &l.read(a.lent, lent), 0);
                    let rotation = row::<_, 4>(l, &l.read(a.lent, lent + 1), 0);
                    let length = length(&rotation);
                    let found = PoseRecord { rotation, translation, pad: 0.0 };
                    if own == 0 {
                        l.write(a.found, placement.pose + end, found);
                    }
                    let pose = PoseRecord { rotation: rotation.map(|q| q / length), ..found };
                    let point = placed(&pose, l.read(a.rest, source));
                    seen.look(vertex, &point, Real::abs(length - 1.0) <= POSE_UNIT, a.most);
                    point
                }
            };
            if still {
                let point = end_of(0);
                l.write(a.vertices.still, vertex, point);
                if placement.from & KEEPS_END != 0 {
                    let end = end_of(1);
                    l.write(a.later, vertex, end);
                }
            } else {
                let motion = match from {
                    UPLOADED => l.read(a.uploaded.moving, source),
                    RESTING => {
                        let end = l.read(a.vertices.moving, vertex).t1;
                        VertexMotion { t0: end, t1: end }
                    }
                    _ => {
                        let t0 = end_of(0);
                        VertexMotion { t0, t1: end_of(ends - 1) }
                    }
                };
                l.write(a.vertices.moving, vertex, motion);
            }
            i = i.saturating_add(stride);
        }
        if seen.invalid > 0 {
            l.shared_max(words, seen::INVALID, seen.invalid.into());
        }
        if seen.largest > 0.0 {
            l.shared_max(words, seen::LARGEST, seen.largest.to_bits());
        }
    });
    b.phase(|l| {
        for word in (l.lane()..seen::COUNT).step_by(lanes as usize) {
            let most = l.get(words, word);
            if most > 0 {
                l.fetch_max(a.seen, word, most);
            }
        }
    });
}

/// Bytes of shared memory of a block.
pub const SHARED: u32 = 8 * seen::COUNT;
