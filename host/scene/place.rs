//! Placing of a body from frame to frame.

use super::body::{Kept, Resident};
use super::{Body, BodyKind, DeviceMotion, Motion, Pose, PosePath, PoseStep, of_edges};
use crate::Error;
use crate::mesh::{self, MAX_ABS_F64, Points, Positions, Problem};
use nearmiss_kernels::math::Vec3;

/// Lower and upper corner of a box.
pub type Bounds = [[f64; 3]; 2];

impl Body {
    /// Returns the body after a motion: for scenes that begin there. A [`Pose`], a [`PoseStep`] or
    /// any [`Motion`].
    ///
    /// ```
    /// use nearmiss::scene::Pose;
    /// use nearmiss::{Body, Mesh, mesh::Positions};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let mesh = Mesh::new("a triangle", Positions::F32(corners), vec![[0, 1, 2]])?;
    /// let body = Body::rigid(mesh).at(Pose::at([0.0, 0.0, 2.0]))?;
    /// assert_eq!(body.poses()[0].translation, [0.0, 0.0, 2.0]);
    /// # Ok::<(), nearmiss::Error>(())
    /// ```
    ///
    /// # Errors
    /// As of [`Body::check`].
    pub fn at<'a>(mut self, motion: impl Into<Motion<'a>>) -> Result<Body, Error> {
        let motion = motion.into();
        self.check(&motion)?;
        self.put(&motion);
        Ok(self)
    }

    /// Checks that the body can take a motion. Cost: a pass over the positions of a deformable
    /// body.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a motion of another kind. [`Error::Input`] for positions that
    /// no mesh may have, and for an invalid pose.
    pub fn check(&self, input: &Motion) -> Result<(), Error> {
        match (self.kind, input) {
            (BodyKind::Deformable, Motion::Positions(t0)) => self.check_vertices(&[*t0]),
            (BodyKind::Deformable, Motion::Step(ends)) => self.check_vertices(ends),
            (BodyKind::Rigid, Motion::Pose(pose)) => self.check_pose(pose),
            (BodyKind::Rigid, Motion::PoseStep(step)) => self.check_step(step),
            (BodyKind::Deformable, Motion::OnDevice(DeviceMotion::Positions(t0))) => {
                self.check_rows(&[t0.len()])
            }
            (BodyKind::Deformable, Motion::OnDevice(DeviceMotion::Step(ends))) => {
                self.check_rows(&ends.map(|rows| rows.len()))
            }
            // One row of each is read for a pose: the rows' maker has promised that it is there.
            (BodyKind::Rigid, Motion::OnDevice(DeviceMotion::Pose(_) | DeviceMotion::PoseStep(_))) => Ok(()),
            (kind, input) => {
                let (given, advice) = match (kind, input) {
                    (BodyKind::Fixed, _) => ("a frame", "make it rigid or deformable, or replace it"),
                    (
                        _,
                        Motion::Positions(_)
                        | Motion::Step(_)
                        | Motion::OnDevice(DeviceMotion::Positions(_) | DeviceMotion::Step(_)),
                    ) => ("positions", "give a rigid body poses"),
                    _ => ("a pose", "give a deformable body positions"),
                };
                let what = format!("{given} for {}, which is {}", self.name, kind.name());
                Err(Error::InvalidArgument { what, advice: advice.into() })
            }
        }
    }

    fn check_vertices(&self, ends: &[Points]) -> Result<(), Error> {
        for points in ends {
            self.check_rows(&[points.len()])?;
            self.is_single(*points)?;
        }
        Ok(())
    }

    /// Checks that each end has as many rows as there are vertices.
    fn check_rows(&self, ends: &[usize]) -> Result<(), Error> {
        let ours = self.vertex_count();
        match ends.iter().find(|&&theirs| theirs != ours) {
            None => Ok(()),
            Some(&t1) => {
                let problem = Problem::FrameVertices { first: self.name.clone(), t0: ours, t1 };
                Err(Error::Input { file: self.name.clone(), problem })
            }
        }
    }

    /// Returns whether f32 can compute with positions; an error if f64 cannot either.
    pub(crate) fn is_single(&self, points: Points) -> Result<bool, Error> {
        let wrong = |problem| Error::Input { file: self.name.clone(), problem };
        mesh::is_single(points, self.used()).map_err(wrong)
    }

    pub(crate) fn check_pose(&self, pose: &Pose) -> Result<(), Error> {
        pose.check(&self.name)?;
        if size(&self.around(pose)) <= MAX_ABS_F64 {
            return Ok(());
        }
        // The ball in which it turns is up to twice as large as the body: then its vertices decide.
        let used = self.used().filter_map(|v| self.positions_t0.get_f64(v as usize));
        let size = used.flat_map(|point| pose.apply(point)).fold(0.0_f64, |most, x| most.max(x.abs()));
        if size > MAX_ABS_F64 {
            return Err(Error::Input { file: self.name.clone(), problem: Problem::PoseTooFar { size } });
        }
        Ok(())
    }

    /// Checks both poses and the path: numbers that are finite, at most a whole turn, and a turn that
    /// leads from the first rotation to the second.
    fn check_step(&self, step: &PoseStep) -> Result<(), Error> {
        self.check_pose(&step.start())?;
        step.check(&self.name)?;
        self.check_pose(&step.end())
    }

    /// Default tolerance of a certified solver for the body's original mesh, in scene units. It
    /// stays when the body moves. 0 if no side of a triangle has a length. Cost: a square root for
    /// each side, once.
    pub fn default_tolerance(&self) -> f64 {
        self.tolerance.0.unwrap_or_else(|| of_edges(std::slice::from_ref(self)))
    }

    /// Sets the default tolerance, for a body that is part of a larger one.
    #[doc(hidden)]
    pub fn with_default_tolerance(self, tolerance: f64) -> Body {
        Body { tolerance: Kept(Some(tolerance)), ..self }
    }

    /// Computes the default tolerance, before the positions that it follows from are overwritten.
    pub(crate) fn keep_tolerance(&mut self) {
        self.tolerance = Kept(Some(self.default_tolerance()));
    }

    /// Applies a motion that [`Body::check`] accepts. Cost: a copy of the positions.
    pub(crate) fn put(&mut self, input: &Motion) {
        self.resident = None;
        match input {
            Motion::OnDevice(input) => {
                (self.resident, self.positions_t1) = (Some(Resident::InArrays(*input)), None)
            }
            Motion::Positions(t0) => self.put_vertices(*t0, None),
            Motion::Step([t0, t1]) => self.put_vertices(*t0, Some(*t1)),
            Motion::Pose(pose) => self.stand(*pose),
            Motion::PoseStep(step) => (self.poses, self.path) = ([step.start(), step.end()], step.path()),
        }
    }

    /// Stands in a pose.
    fn stand(&mut self, pose: Pose) {
        (self.poses, self.path) = ([pose; 2], PosePath::default());
    }

    fn put_vertices(&mut self, t0: Points, t1: Option<Points>) {
        let single = |points| matches!(mesh::is_single(points, self.used()), Ok(true));
        let as_f64 = !std::iter::once(t0).chain(t1).all(single);
        self.keep_tolerance();
        t0.copy_to(&mut self.positions_t0, as_f64);
        match t1 {
            Some(t1) => {
                let end = self.positions_t1.get_or_insert_with(|| Positions::F32(Vec::new()));
                t1.copy_to(end, as_f64);
            }
            None => self.positions_t1 = None,
        }
    }

    /// Motion in memory of the caller, if the body's place is there.
    pub(crate) fn device_motion(&self) -> Option<&DeviceMotion> {
        if let Some(Resident::InArrays(input)) = &self.resident { Some(input) } else { None }
    }

    /// Records that memory of the caller was read.
    pub(crate) fn placed(&mut self) {
        if let Some(Resident::InArrays(input)) = self.resident {
            self.resident = Some(Resident::Placed { moving: input.is_moving() });
        }
    }

    /// Records that memory of the caller was read again, or may have been: known positions are
    /// stale.
    pub(crate) fn placed_again(&mut self, moving: bool) {
        self.resident = Some(Resident::Placed { moving });
    }

    /// Checks the place in which the device has put the body, at both ends or at the only one.
    /// Returns whether f32 can compute with it.
    ///
    /// # Errors
    /// [`Error::Input`], as of [`Body::check`].
    pub(crate) fn check_found(&self, ends: &[Positions], poses: &[Pose]) -> Result<bool, Error> {
        if self.kind == BodyKind::Rigid {
            poses.iter().try_for_each(|pose| self.check_pose(pose))?;
        }
        let mut are_single = true;
        for positions in ends {
            are_single &= self.is_single(positions.into())?;
        }
        Ok(are_single)
    }

    /// Copies the body's place from the device, at both ends or at the only one. A body at rest is
    /// at the later end, even if the device does not know yet that it rests.
    pub(crate) fn bring(&mut self, ends: &[Positions], poses: &[Pose]) {
        let moving = self.is_moving();
        self.resident = None;
        match (self.kind, ends, poses) {
            (BodyKind::Rigid, _, [start, end]) if moving => {
                (self.poses, self.path) = ([*start, *end], PosePath::default());
            }
            (BodyKind::Rigid, _, [.., end]) => self.stand(*end),
            (_, [t0, t1], _) if moving => self.put_vertices(t0.into(), Some(t1.into())),
            (_, [.., end], _) => self.put_vertices(end.into(), None),
            (_, [], _) => {}
        }
    }

    /// Rests a body that moved in the last step at the end of that step. Returns whether it had
    /// moved.
    pub(crate) fn rest(&mut self) -> bool {
        if self.is_device_resident() {
            let moved = self.is_moving();
            self.resident = Some(Resident::Placed { moving: false });
            return moved;
        }
        match self.kind {
            BodyKind::Fixed => false,
            BodyKind::Rigid => {
                let [start, end] = self.poses;
                let moved = start != end || self.turn().is_some();
                self.stand(end);
                moved
            }
            BodyKind::Deformable => match self.positions_t1.take() {
                Some(end) => {
                    self.keep_tolerance();
                    self.positions_t0 = end;
                    true
                }
                None => false,
            },
        }
    }

    /// Whether the body's coordinates need f64: those in f64, and the placed vertices of every
    /// rigid body. f32 holds these exactly in a few poses only. A pose in memory of the caller is
    /// known too late to decide by.
    pub(crate) fn needs_f64(&self) -> bool {
        self.positions_t0.is_f64()
            || self.device_motion().is_some_and(DeviceMotion::has_f64)
            || (self.kind == BodyKind::Rigid && !self.elements().is_empty())
    }

    /// Returns the angle of the turn between two poses, in degrees, and the bulge. That is the
    /// largest distance of a vertex in straight motion from its arc. `None` for a turn up to
    /// `least` degrees. Cost: a pass over the elements of a body that turns farther.
    pub(crate) fn turn_beyond(&self, least: f64, [start, end]: [Pose; 2]) -> Option<[f64; 2]> {
        let (angle, axis) = start.turn_to(&end);
        let degrees = angle.to_degrees();
        // A NaN comes from a pose that another check refuses.
        if degrees.is_nan() || degrees <= least {
            return None;
        }
        let length = axis.dot(axis).sqrt();
        let axis = axis.map(|x| x / length);
        let from_axis = |&v: &u32| {
            // Faces were checked when the mesh was made: every vertex exists.
            let point = Vec3(self.positions_t0.get_f64(v as usize).unwrap_or_default());
            let across = point.cross(axis);
            across.dot(across).sqrt()
        };
        let farthest = self.elements().iter().flatten().map(from_axis).fold(0.0, f64::max);
        // 1 - cos(angle / 2), without its cancellation.
        Some([degrees, farthest * 2.0 * (angle / 4.0).sin().powi(2)])
    }

    /// The corners of an element at the start of the step, if the host has them; `None` for an element
    /// that does not exist.
    pub(crate) fn corners(&self, element: usize) -> Option<[Vec3<f64>; 3]> {
        let element = self.elements().get(element)?;
        let mut corners = [Vec3([0.0; 3]); 3];
        for (corner, &vertex) in corners.iter_mut().zip(element) {
            let at = self.positions_t0.get_f64(vertex as usize)?;
            *corner = Vec3(if self.kind == BodyKind::Rigid { self.poses()[0].apply(at) } else { at });
        }
        Some(corners)
    }

    /// Box around a rigid body at both ends of the step, if the host has its poses; `None` for
    /// others.
    pub(crate) fn posed_box(&self) -> Option<Bounds> {
        let rigid = self.kind == BodyKind::Rigid && !self.elements().is_empty() && !self.is_device_resident();
        rigid.then(|| union(self.around(&self.poses[0]), self.around(&self.poses[1])))
    }

    /// Box around a rigid body in a pose: around the ball in which it turns.
    fn around(&self, pose: &Pose) -> Bounds {
        [-self.radius, self.radius].map(|radius| pose.translation.map(|t| t + radius))
    }
}

impl BodyKind {
    /// Name of the kind.
    pub(crate) fn name(self) -> &'static str {
        match self {
            BodyKind::Fixed => "fixed",
            BodyKind::Rigid => "rigid",
            BodyKind::Deformable => "deformable",
        }
    }
}

/// Box around both. Comparisons drop NaN.
pub fn union(a: Bounds, b: Bounds) -> Bounds {
    [[0, 1, 2].map(|k| a[0][k].min(b[0][k])), [0, 1, 2].map(|k| a[1][k].max(b[1][k]))]
}

/// Empty box.
pub const NOTHING: Bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];

/// Bound on the distance of points from the centre of rotation. It covers the rounding of a pose
/// and of the placed points.
pub fn radius(points: impl Iterator<Item = [f64; 3]>) -> f64 {
    // The largest coordinate times the root of 3: squares of large coordinates may overflow.
    2.0 * points.flatten().fold(0.0_f64, |most, x| most.max(x.abs()))
}

/// Largest absolute coordinate.
fn size(bounds: &Bounds) -> f64 {
    bounds.iter().flatten().fold(0.0, |most, x| most.max(x.abs()))
}
