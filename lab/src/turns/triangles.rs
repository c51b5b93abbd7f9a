//! The filter of features that turn, on the hunt's pairs: each feature as a part of a triangle.

use super::families::Case;
use super::hunt::side;
use nearmiss_kernels::abi::TurnRecord;
use nearmiss_kernels::bvh::turns::swell_of;
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::math::turn::{Turn, bulge};
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::direction::parted;
use nearmiss_kernels::prim::sweep::{Corners, more};
use nearmiss_kernels::prim::turning::apart::{Needed, open_by};
use nearmiss_kernels::prim::turning::{Side, chords};

/// All tests of two triangles.
const TESTS: u32 = (1 << 15) - 1;

/// Two triangles that have the features of a case, and the number of their test.
pub struct Triangles {
    /// The triangles.
    pub sides: [Side; 2],
    /// The test: see [`nearmiss_kernels::prim::turning::apart::open`].
    pub test: u32,
}

/// Adds corners to a feature of `count` points. They go the way of the first one.
fn completed(mut side: Side, count: usize, others: &Side) -> Side {
    let [x, y, z] = (others.points[1][0] - others.points[0][0]).0;
    let more = [Vec3([y, z, x]) * 0.7, Vec3([z, -x, y]) * 0.6];
    for k in count..3 {
        let by = more[k - 1];
        side.points[k] = side.points[0].map(|point| point + by);
    }
    side
}

/// The corners of a side in the world at both ends of the step, and its swell.
fn in_world(side: &Side) -> (Corners<f64>, f32) {
    let turn = Turn::new(side.phi);
    let corners = side
        .points
        .map(|[from, to]| Moving { t0: side.pivot[0] + from, t1: side.pivot[1] + turn.rotated(1.0, to) });
    let of_body = TurnRecord {
        turn: side.phi.0,
        path: side.pivot.map(|at| at.0),
        bulge: bulge(turn.angle()),
        ..TurnRecord::default()
    };
    let record = if of_body.turns() { of_body } else { TurnRecord::default() };
    let swell = swell_of(&record, corners.map(|corner| [corner.t0, corner.t1]));
    (corners, swell)
}

impl Triangles {
    /// Ways to have the features among the corners, with both orders of the triangles.
    pub const WAYS: usize = 18;

    /// The triangles of a case, in one of the [`Triangles::WAYS`].
    pub fn new(case: &Case, way: usize) -> Self {
        let [mut a, mut b] = case.pair.sides.map(|s| side(&s));
        let (of_a, of_b) = if case.pair.is_face { (1, 3) } else { (2, 2) };
        a = completed(a, of_a, &b);
        b = completed(b, of_b, &a);
        let (i, j) = (way % 3, way / 3 % 3);
        a.points.rotate_right(i);
        b.points.rotate_right(j);
        let (sides, test) = match (case.pair.is_face, way < 9) {
            (true, true) => ([a, b], i),
            (true, false) => ([b, a], 3 + i),
            (false, true) => ([a, b], 6 + 3 * i + j),
            (false, false) => ([b, a], 6 + 3 * j + i),
        };
        Triangles { sides, test: u32::try_from(test).expect("a test is below 15") }
    }

    /// Whether the filter leaves the features out, within a gap.
    pub fn are_apart(&self, gap: f64, needed: &Needed) -> bool {
        let [a, b] = &self.sides;
        open_by(a, b, gap, TESTS, needed) >> self.test & 1 == 0
    }

    /// Whether the filter by chords leaves the features out, within a gap, of any swells.
    pub fn are_apart_by_chords(&self, gap: f64, needed: &chords::Needed) -> bool {
        let [(a, of_a), (b, of_b)] = self.sides.each_ref().map(in_world);
        let swell = f64::from(of_a) + f64::from(of_b);
        let open = chords::open_by(&a, &b, (swell, gap), TESTS, (f64::INFINITY, needed));
        open.is_some_and(|open| open >> self.test & 1 == 0)
    }

    /// Whether a direction parts the triangles, within a gap and a part of the swells.
    pub fn are_parted(&self, gap: f64, part: f32) -> bool {
        let [(a, of_a), (b, of_b)] = self.sides.each_ref().map(in_world);
        parted(&a, &b, more::<f32>(gap) + part * (of_a + of_b), false)
    }
}
