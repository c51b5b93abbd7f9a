//! Step of a rigid body: from one pose to another, and the path between them.

use super::Pose;
use crate::error::Error;
use crate::mesh::{MAX_ABS_F64, Problem};
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::math::turn::{after, between, exp};
use nearmiss_kernels::stage::place::moved;

/// Step of a rigid body. It turns at a constant rate about its pivot, which moves in a straight
/// line: `x(t) = p(t) + exp(t w) R (v - c)`.
///
/// `c` is the pivot and `v` a vertex, both in the frame of the mesh. `R` is the rotation at the
/// start, `w` the rotation vector of the whole step in the axes of the scene. `p` leads from where
/// the first pose puts the pivot to where the second one does.
///
/// ```
/// use nearmiss::scene::{Motion, Pose, PoseStep};
///
/// let end = Pose { rotation: [0.0, 0.0, 1.0, 0.0], translation: [0.0; 3] };
/// // Half a turn about the origin of the mesh, or about its corner.
/// let about_origin = PoseStep::new(Pose::default(), end);
/// let about_corner = PoseStep::new(Pose::default(), end).about([1.0, 1.0, 0.0]);
/// // 350 degrees: two poses cannot give it.
/// let far = PoseStep::turning(Pose::default(), [0.0, 0.0, 350_f64.to_radians()], [0.0; 3]);
/// # let _ = (Motion::PoseStep(about_origin), about_corner, far);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseStep {
    start: Pose,
    end: End,
    path: PosePath,
}

/// How the end of a step was given.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    Pose(Pose),
    /// How far the pivot moves.
    Travel([f64; 3]),
}

/// Path between two poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PosePath {
    /// At a constant rate about a pivot.
    Turn {
        /// The pivot, in the frame of the mesh.
        pivot: [f64; 3],
        /// The rotation vector of the step, in the axes of the scene and in radians; `None` for the
        /// shorter arc. At exactly 180 degrees that is the one whose axis has a positive first
        /// coordinate; if this is 0, a positive second or third one.
        by: Option<[f64; 3]>,
    },
    /// Each vertex in a straight line: between the poses the body is not rigid.
    Straight,
}

impl Default for PosePath {
    /// The shorter arc about the origin of the mesh.
    fn default() -> PosePath {
        PosePath::Turn { pivot: [0.0; 3], by: None }
    }
}

impl PoseStep {
    /// Longest rotation vector, in radians: a whole turn.
    pub const LONGEST_TURN: f64 = std::f64::consts::TAU;

    /// Returns the step that turns by the shorter arc, about the origin of the mesh.
    pub fn new(start: impl Into<Pose>, end: impl Into<Pose>) -> PoseStep {
        PoseStep { start: start.into(), end: End::Pose(end.into()), path: PosePath::default() }
    }

    /// Returns the step that turns by a rotation vector while the pivot moves by `travel`. The
    /// vector is in the axes of the scene and in radians, as an integrator has it: angular velocity
    /// times the length of the step. Up to a whole turn ([`PoseStep::LONGEST_TURN`]).
    pub fn turning(start: impl Into<Pose>, turn: [f64; 3], travel: [f64; 3]) -> PoseStep {
        let path = PosePath::Turn { pivot: [0.0; 3], by: Some(turn) };
        PoseStep { start: start.into(), end: End::Travel(travel), path }
    }

    /// Returns the step about another pivot, in the frame of the mesh: a centre of mass, a hinge.
    /// It has no effect on straight lines.
    pub fn about(self, pivot: [f64; 3]) -> PoseStep {
        match self.path {
            PosePath::Turn { by, .. } => PoseStep { path: PosePath::Turn { pivot, by }, ..self },
            PosePath::Straight => self,
        }
    }

    /// Returns the step along straight lines: every vertex moves from its place in the first pose to
    /// that in the second. Between them the body is not rigid.
    pub fn straight(self) -> PoseStep {
        PoseStep { end: End::Pose(self.end()), path: PosePath::Straight, ..self }
    }

    /// Returns the step of a body with these poses, on a path that leads from one to the other.
    #[doc(hidden)]
    pub fn along([start, end]: [Pose; 2], path: PosePath) -> PoseStep {
        PoseStep { start, end: End::Pose(end), path }
    }

    /// The pose at the start.
    pub fn start(&self) -> Pose {
        self.start
    }

    /// Returns the pose at the end.
    pub fn end(&self) -> Pose {
        let (travel, pivot, turn) = match (self.end, self.path) {
            (End::Pose(end), _) => return end,
            (End::Travel(travel), PosePath::Turn { pivot, by: Some(turn) }) => (travel, pivot, turn),
            (End::Travel(travel), _) => (travel, [0.0; 3], [0.0; 3]),
        };
        let rotation = after(exp(Vec3(turn)), self.start.record().rotation);
        let turned = Pose { rotation, translation: [0.0; 3] };
        let to = moved(&self.start.record(), Vec3(pivot)) + Vec3(travel);
        Pose { rotation, translation: (to - moved(&turned.record(), Vec3(pivot))).0 }
    }

    /// Returns the pose at a time from 0 to 1; `None` on straight lines, where the body is not rigid.
    ///
    /// ```
    /// use nearmiss::scene::{Pose, PoseStep};
    ///
    /// let turn = [0.0, 0.0, std::f64::consts::PI];
    /// let middle = PoseStep::turning(Pose::default(), turn, [0.0; 3]).at(0.5).expect("it turns");
    /// let [x, y, z] = middle.apply([1.0, 0.0, 0.0]);
    /// assert!(x.abs() < 1e-15 && (y - 1.0).abs() < 1e-15 && z == 0.0);
    /// ```
    pub fn at(&self, time: f64) -> Option<Pose> {
        let PosePath::Turn { pivot, .. } = self.path else { return None };
        let ends = [self.start, self.end()];
        let turn = self.path.turn(ends).map_or(Vec3([0.0; 3]), |(_, turn)| turn);
        let rotation = after(exp(turn * time), self.start.record().rotation);
        let [from, to] = ends.map(|pose| moved(&pose.record(), Vec3(pivot)));
        let turned = Pose { rotation, translation: [0.0; 3] };
        let at = from * (1.0 - time) + to * time;
        Some(Pose { rotation, translation: (at - moved(&turned.record(), Vec3(pivot))).0 })
    }

    /// Whether the body turns: not on straight lines, nor between equal rotations.
    pub fn turns(&self) -> bool {
        self.path.turn([self.start, self.end()]).is_some()
    }

    /// Checks the path.
    ///
    /// # Errors
    /// [`Error::Input`], naming `body`, for a pivot or a rotation vector that is not finite, and for
    /// more than a whole turn.
    pub(crate) fn check(&self, body: &str) -> Result<(), Error> {
        let PosePath::Turn { pivot, by } = self.path else { return Ok(()) };
        let turn = by.unwrap_or_default();
        let length = Vec3(turn).dot(Vec3(turn)).sqrt();
        // False for NaN. The bound is above the rounding of a whole turn about any axis.
        let is_short = length <= PoseStep::LONGEST_TURN * (1.0 + 1e-12);
        if is_short && pivot.iter().all(|x| x.abs() <= MAX_ABS_F64) {
            return Ok(());
        }
        Err(Error::Input { file: body.into(), problem: Problem::NoTurn { pivot, turn } })
    }

    /// The path.
    pub fn path(&self) -> PosePath {
        self.path
    }
}

impl From<[Pose; 2]> for PoseStep {
    /// The shorter arc, about the origin of the mesh.
    fn from([start, end]: [Pose; 2]) -> PoseStep {
        PoseStep::new(start, end)
    }
}

impl PosePath {
    /// Returns the pivot and the rotation vector between two poses. `None` if nothing turns, or
    /// vertices go straight.
    pub(crate) fn turn(&self, [start, end]: [Pose; 2]) -> Option<([f64; 3], Vec3<f64>)> {
        let PosePath::Turn { pivot, by } = *self else { return None };
        let turn = by.map_or_else(|| between(start.record().rotation, end.record().rotation), Vec3);
        (turn.0 != [0.0; 3]).then_some((pivot, turn))
    }
}
