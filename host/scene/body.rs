//! A body: one mesh at one frame or at both ends of a step, with its kind and filter.

use super::place::radius;
use super::{BodyKind, CollisionFilter, DeviceMotion, Pose, PosePath, PoseStep, Thickness};
use crate::Error;
#[cfg(doc)]
use crate::mesh::Problem;
use crate::mesh::{Element, Elements, Loose, Mesh, Positions, Vertices, difference, rename};
use nearmiss_kernels::math::Vec3;

/// Faces with the positions of one frame, or of both ends of a step. Vertices move in straight
/// lines from `positions_t0` to `positions_t1`, which have the same length and precision.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    pub(super) name: String,
    /// Faces, edges of no face and points, as the detector tests them.
    pub(super) elements: Elements,
    /// Edges and points, as given.
    pub(super) loose: Loose,
    pub(super) positions_t0: Positions,
    pub(super) positions_t1: Option<Positions>,
    pub(super) kind: BodyKind,
    pub(super) filter: CollisionFilter,
    pub(crate) thickness: Thickness,
    /// Poses of a rigid body at both ends of the step.
    pub(super) poses: [Pose; 2],
    /// Its path between them.
    pub(super) path: PosePath,
    /// Radius of a rigid body: no vertex of a face is farther from the centre of rotation.
    pub(super) radius: f64,
    /// Default tolerance of the original mesh, once it was computed.
    pub(super) tolerance: Kept,
    /// Place of the body, if positions and poses are stale.
    pub(super) resident: Option<Resident>,
}

/// A number that follows from the body's original mesh. Bodies are equal whether or not it was
/// computed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Kept(pub(super) Option<f64>);

impl PartialEq for Kept {
    fn eq(&self, _: &Kept) -> bool {
        true
    }
}

/// Place of a body with stale positions and poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Resident {
    /// In memory of the caller.
    InArrays(DeviceMotion),
    /// On a device, at both ends or at one.
    Placed {
        /// Whether there are two ends.
        moving: bool,
    },
}

impl Body {
    /// A deformable body at one frame.
    pub fn deformable(mesh: Mesh) -> Body {
        let Mesh { name, positions, faces, loose } = mesh;
        Body {
            name,
            elements: Elements::new(faces, &loose, positions.len()),
            loose,
            positions_t0: positions,
            positions_t1: None,
            kind: BodyKind::Deformable,
            filter: CollisionFilter::default(),
            thickness: Thickness::default(),
            poses: [Pose::default(); 2],
            path: PosePath::default(),
            radius: 0.0,
            tolerance: Kept::default(),
            resident: None,
        }
    }

    /// A body that never moves.
    pub fn fixed(mesh: Mesh) -> Body {
        Body { kind: BodyKind::Fixed, ..Body::deformable(mesh) }
    }

    /// A body that moves as a whole; without a pose it is in the position of its mesh.
    pub fn rigid(mesh: Mesh) -> Body {
        let body = Body::deformable(mesh);
        let radius = radius(body.used().filter_map(|v| body.positions_t0.get_f64(v as usize)));
        Body { kind: BodyKind::Rigid, radius, ..body }
    }

    /// A body without vertices and triangles: the remainder of one that was removed from a scene.
    pub(crate) fn none() -> Body {
        let nothing = Positions::F32(Vec::new());
        let loose = Loose::default();
        Body::deformable(Mesh { name: "nothing".into(), positions: nothing, faces: Vec::new(), loose })
    }

    /// Sets the collision filter.
    pub fn with_filter(self, filter: CollisionFilter) -> Body {
        Body { filter, ..self }
    }

    /// Sets the thickness: a radius, or one for each vertex.
    ///
    /// ```
    /// use nearmiss::{Body, Mesh, mesh::Positions};
    ///
    /// let positions = Positions::F32(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    /// let mesh = Mesh::new("sheet", positions, vec![[0, 1, 2]])?;
    /// let sheet = Body::deformable(mesh).with_thickness(0.01);
    /// assert_eq!(sheet.thickness().largest(), 0.01);
    /// # Ok::<(), nearmiss::Error>(())
    /// ```
    pub fn with_thickness(self, thickness: impl Into<Thickness>) -> Body {
        Body { thickness: thickness.into(), ..self }
    }

    /// Thickness of the body: see [`Thickness`].
    pub fn thickness(&self) -> &Thickness {
        &self.thickness
    }

    /// Kind of the body: its motion from frame to frame.
    pub fn kind(&self) -> BodyKind {
        self.kind
    }

    /// Collision filter: the bodies that it may meet.
    pub fn filter(&self) -> &CollisionFilter {
        &self.filter
    }

    /// Whether it is tested against itself: see [`CollisionFilter::self_collides`].
    pub fn self_collides(&self) -> bool {
        self.filter.self_collides(self.kind)
    }

    /// Refuses self-collision of a fixed body, which would do nothing, and a thickness that is none.
    /// Detectors check it, and readers of bodies may.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`], naming the body.
    pub fn validate(&self) -> Result<(), Error> {
        if self.kind == BodyKind::Fixed && self.filter.self_collision == Some(true) {
            return Err(Error::InvalidArgument {
                what: format!("self-collision of {}, which is fixed and never meets itself", self.name),
                advice: "leave self-collision out, or make the body rigid or deformable".into(),
            });
        }
        self.thickness.check(&self.name, self.vertex_count())
    }

    /// Poses of a rigid body at both ends of the step; stale if it [is
    /// device-resident](Body::is_device_resident).
    pub fn poses(&self) -> [Pose; 2] {
        self.poses
    }

    /// Step of a rigid body: its poses at both ends, and the path between them; stale as
    /// [`Body::poses`] is.
    pub fn pose_step(&self) -> PoseStep {
        PoseStep::along(self.poses, self.path)
    }

    /// Returns the step of a rigid body. If the body is device-resident, by the poses that the device
    /// has read, two of each body, of which it is number `own`; `None` if it rests or they are not
    /// known. `None` for other bodies.
    pub(crate) fn step_among(&self, own: usize, found: &[Pose]) -> Option<PoseStep> {
        if self.kind != BodyKind::Rigid || self.elements().is_empty() {
            return None;
        }
        if !self.is_device_resident() {
            return Some(self.pose_step());
        }
        match found.get(2 * own..2 * own + 2) {
            Some(&[start, end]) if self.is_moving() => Some(PoseStep::new(start, end)),
            _ => None,
        }
    }

    /// Whether its vertices go straight between its poses, by choice. A body whose poses only the
    /// device has turns.
    pub(crate) fn is_straight(&self) -> bool {
        self.path == PosePath::Straight && !self.is_device_resident()
    }

    /// Returns whether its vertices may leave straight lines in the step.
    pub(crate) fn may_turn(&self) -> bool {
        let is_resident = self.kind == BodyKind::Rigid && self.is_device_resident() && self.is_moving();
        is_resident || self.turn().is_some()
    }

    /// Returns the pivot and the rotation vector of a rigid body with these poses. `None` if it does
    /// not turn, or its vertices go straight.
    pub(crate) fn turn(&self) -> Option<([f64; 3], Vec3<f64>)> {
        let is_rigid = self.kind == BodyKind::Rigid && !self.elements().is_empty();
        if is_rigid { self.path.turn(self.poses) } else { None }
    }

    /// A body at two frames of the same faces. If one frame is in single and one in double
    /// precision, both become double, exactly.
    ///
    /// # Errors
    /// [`Problem::FrameVertices`], [`Problem::FrameFaces`] or [`Problem::FrameFace`] (the first
    /// face that differs), against the second frame and naming the first. [`Mesh`] has checked that
    /// a vertex is finite in both frames if a face uses it.
    pub fn moving(t0: Mesh, t1: Mesh) -> Result<Body, Error> {
        if let Some(problem) = difference(&t0, &t1) {
            return Err(Error::Input { file: t1.name, problem });
        }
        let (positions_t0, positions_t1) = match (t0.positions, t1.positions) {
            (a, b) if a.is_f64() == b.is_f64() => (a, b),
            (a, b) => (a.promoted(), b.promoted()),
        };
        let still = Body::deformable(Mesh { positions: positions_t0, ..t0 });
        Ok(Body { positions_t1: Some(positions_t1), ..still })
    }

    /// Name of the mesh, or of its first frame.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Three vertex indices for each triangle.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.elements.corners[..self.elements.faces]
    }

    /// Edges, as given: see [`Mesh::with_edges`].
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.loose.edges
    }

    /// Points, as given: see [`Mesh::with_points`].
    pub fn points(&self) -> &[u32] {
        &self.loose.points
    }

    /// All that takes part, in the numbering of discrete queries and distances: the triangles; then
    /// edges of no face as `[a, b, b]`, in the order given; then points as `[p, p, p]`. Each once.
    pub fn elements(&self) -> &[[u32; 3]] {
        &self.elements.corners
    }

    /// Number of [elements](Body::elements).
    pub fn element_count(&self) -> usize {
        self.elements.corners.len()
    }

    /// Numbers of edges of no face, and of points of no face and no edge.
    pub(crate) fn loose_counts(&self) -> [usize; 2] {
        let Elements { corners, faces, edges } = &self.elements;
        [*edges, corners.len() - faces - edges]
    }

    /// Kind of an element.
    pub(crate) fn element_kind(&self, element: usize) -> Element {
        self.elements.kind(element)
    }

    /// Whether only the device has the body's place:
    /// [`Motion::OnDevice`](crate::scene::Motion::OnDevice) put it there, and positions and poses
    /// here are stale. [`Detector::download_positions`](crate::Detector::download_positions)
    /// updates them.
    pub fn is_device_resident(&self) -> bool {
        self.resident.is_some()
    }

    /// Positions at the start of the step, or of the only frame; stale if the body [is
    /// device-resident](Body::is_device_resident).
    pub fn positions_t0(&self) -> &Positions {
        &self.positions_t0
    }

    /// Positions at the end of the step; `None` for a body at one frame.
    pub fn positions_t1(&self) -> Option<&Positions> {
        self.positions_t1.as_ref()
    }

    /// Positions at both ends of the step; twice the same for a body at one frame.
    pub fn ends(&self) -> [&Positions; 2] {
        [&self.positions_t0, self.positions_t1.as_ref().unwrap_or(&self.positions_t0)]
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.positions_t0.len()
    }

    /// Number of triangles.
    pub fn face_count(&self) -> usize {
        self.elements.faces
    }

    /// Returns the body with vertices merged that coincide in all of its frames, and their number;
    /// as [`Mesh::weld`]. The largest radius of merged vertices is that of their representative.
    pub fn weld(&self) -> (Body, usize) {
        self.weld_through(&[])
    }

    /// As [`Body::weld`], for vertices that coincide in `frames` too.
    pub fn weld_through(&self, frames: &[Positions]) -> (Body, usize) {
        let own = std::iter::once(&self.positions_t0).chain(&self.positions_t1);
        let vertices = Vertices::of(&own.chain(frames).collect::<Vec<_>>(), self.used());
        let (mut faces, mut loose) = (self.faces().to_vec(), self.loose.clone());
        rename(&vertices, &mut faces, &mut loose);
        let elements = Elements::new(faces, &loose, self.vertex_count());
        let thickness = vertices.radii(&self.thickness);
        (Body { elements, loose, thickness, ..self.clone() }, vertices.merged)
    }

    /// Number of vertices of elements that coincide, in all frames, with an earlier one;
    /// as [`Mesh::coincident`].
    pub fn coincident(&self) -> usize {
        self.vertices().merged
    }

    fn vertices(&self) -> Vertices {
        let frames: Vec<&Positions> = std::iter::once(&self.positions_t0).chain(&self.positions_t1).collect();
        Vertices::of(&frames, self.used())
    }

    /// Vertices of elements, some of them several times.
    pub(super) fn used(&self) -> impl Iterator<Item = u32> + Clone + '_ {
        self.elements().iter().flatten().copied()
    }

    /// Whether there are two frames.
    pub fn is_moving(&self) -> bool {
        self.positions_t1.is_some() || matches!(self.resident, Some(Resident::Placed { moving: true }))
    }

    /// Copies the frames to meshes: one, or two.
    pub fn frames(&self) -> Vec<Mesh> {
        let mesh = |positions: &Positions| Mesh {
            name: self.name.clone(),
            positions: positions.clone(),
            faces: self.faces().to_vec(),
            loose: self.loose.clone(),
        };
        std::iter::once(&self.positions_t0).chain(&self.positions_t1).map(mesh).collect()
    }

    /// xxh3 of the faces, edges and points and of the bits of every position, little-endian: the same
    /// on every machine.
    pub fn fingerprint(&self) -> u64 {
        let mut hash = xxhash_rust::xxh3::Xxh3::new();
        let Loose { edges, points } = &self.loose;
        let indices = self.faces().iter().flatten().chain(edges.iter().flatten()).chain(points);
        indices.for_each(|i| hash.update(&i.to_le_bytes()));
        if !self.loose.is_empty() {
            [edges.len(), points.len()].iter().for_each(|n| hash.update(&(*n as u64).to_le_bytes()));
        }
        for frame in std::iter::once(&self.positions_t0).chain(&self.positions_t1) {
            match frame {
                Positions::F32(points) => points.iter().flatten().for_each(|x| hash.update(&x.to_le_bytes())),
                Positions::F64(points) => points.iter().flatten().for_each(|x| hash.update(&x.to_le_bytes())),
            }
        }
        hash.digest()
    }
}
