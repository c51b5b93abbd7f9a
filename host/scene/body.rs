//! A body: one mesh at one frame, or at the two ends of a step, and what it does in a scene.

use super::place::radius;
use super::{BodyKind, CollisionFilter, DeviceMotion, Pose};
use crate::Error;
#[cfg(doc)]
use crate::mesh::Problem;
use crate::mesh::{Mesh, Positions, Vertices, difference, rename};

/// Faces with the positions of one frame (still), or of the two ends of a step (moving). Vertices move in straight
/// lines from `positions_t0` to `positions_t1`, both of the same length and precision.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    pub(super) name: String,
    pub(super) faces: Vec<[u32; 3]>,
    pub(super) positions_t0: Positions,
    pub(super) positions_t1: Option<Positions>,
    pub(super) kind: BodyKind,
    pub(super) filter: CollisionFilter,
    /// Of a rigid body: at both ends of the step.
    pub(super) poses: [Pose; 2],
    /// Of a rigid body: no vertex of a face is farther from where it turns.
    pub(super) radius: f64,
    /// The default tolerance of the mesh that it was made of, once it was computed.
    pub(super) tolerance: Kept,
    /// Where it is, if positions and poses are old.
    pub(super) away: Option<Away>,
}

/// A number that follows from the mesh that a body was made of: bodies are equal whether or not it was computed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Kept(pub(super) Option<f64>);

impl PartialEq for Kept {
    fn eq(&self, _: &Kept) -> bool {
        true
    }
}

/// Where a body is, of which positions and poses are old.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Away {
    /// Where memory of the caller says.
    Lent(DeviceMotion),
    /// On a device, at two ends or at one.
    Placed {
        /// Whether those are two.
        moving: bool,
    },
}

impl Body {
    /// A body at one frame.
    pub fn deformable(mesh: Mesh) -> Body {
        let Mesh { name, positions, faces } = mesh;
        Body {
            name,
            faces,
            positions_t0: positions,
            positions_t1: None,
            kind: BodyKind::Deformable,
            filter: CollisionFilter::default(),
            poses: [Pose::default(); 2],
            radius: 0.0,
            tolerance: Kept::default(),
            away: None,
        }
    }

    /// A body that never moves.
    pub fn fixed(mesh: Mesh) -> Body {
        Body { kind: BodyKind::Fixed, ..Body::deformable(mesh) }
    }

    /// A body that moves as one; without a pose it is where its mesh is.
    pub fn rigid(mesh: Mesh) -> Body {
        let points = mesh.faces.iter().flatten().filter_map(|&v| mesh.positions.get_f64(v as usize));
        let radius = radius(points);
        Body { kind: BodyKind::Rigid, radius, ..Body::deformable(mesh) }
    }

    /// No vertices, no triangles: what a body leaves that was taken out of a scene.
    pub(crate) fn none() -> Body {
        let nothing = Positions::F32(Vec::new());
        Body::deformable(Mesh { name: "nothing".into(), positions: nothing, faces: Vec::new() })
    }

    /// The body, meeting those.
    pub fn with_filter(self, filter: CollisionFilter) -> Body {
        Body { filter, ..self }
    }

    /// What the body does from frame to frame.
    pub fn kind(&self) -> BodyKind {
        self.kind
    }

    /// Which bodies it may meet.
    pub fn filter(&self) -> &CollisionFilter {
        &self.filter
    }

    /// Whether it is tested against itself: see [`CollisionFilter::self_collides`].
    pub fn self_collides(&self) -> bool {
        self.filter.self_collides(self.kind)
    }

    /// Refuses self-collision of a static body, which would do nothing. Detectors check it, and whoever reads bodies may.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`], naming the body.
    pub fn check_filter(&self) -> Result<(), Error> {
        if self.kind == BodyKind::Fixed && self.filter.self_collision == Some(true) {
            return Err(Error::InvalidArgument {
                what: format!("self-collision of {}, which is static and never meets itself", self.name),
                advice: "leave self-collision out, or make the body rigid or deformable".into(),
            });
        }
        Ok(())
    }

    /// The poses of a rigid body at both ends of the step; old ones where it [is away](Body::is_device_resident).
    pub fn poses(&self) -> [Pose; 2] {
        self.poses
    }

    /// A body at two frames of the same faces. If one frame is in single and one in double
    /// precision, both become double, exactly.
    ///
    /// # Errors
    /// [`Problem::FrameVertices`], [`Problem::FrameFaces`] or [`Problem::FrameFace`] (the first face that
    /// differs), against the second frame and naming the first. A vertex must be finite in both frames if a face uses it, which
    /// [`Mesh`] has seen to.
    pub fn moving(t0: Mesh, t1: Mesh) -> Result<Body, Error> {
        if let Some(problem) = difference(&t0, &t1) {
            return Err(Error::Input { file: t1.name, problem });
        }
        let (positions_t0, positions_t1) = match (t0.positions, t1.positions) {
            (a, b) if a.is_f64() == b.is_f64() => (a, b),
            (a, b) => (a.promoted(), b.promoted()),
        };
        let still = Body::deformable(Mesh { name: t0.name, positions: positions_t0, faces: t0.faces });
        Ok(Body { positions_t1: Some(positions_t1), ..still })
    }

    /// The name of the mesh, or of its first frame.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Three vertex indices a triangle.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Whether only the device knows where the body is: it was put there by [`Motion::OnDevice`](crate::scene::Motion::OnDevice), and
    /// positions and poses here are those from before. [`Detector::download_positions`](crate::Detector::download_positions) brings them.
    pub fn is_device_resident(&self) -> bool {
        self.away.is_some()
    }

    /// Positions at the start of the step, or of the only frame; old ones where the body [is away](Body::is_device_resident).
    pub fn positions_t0(&self) -> &Positions {
        &self.positions_t0
    }

    /// Positions at the end of the step; `None` for a still body.
    pub fn positions_t1(&self) -> Option<&Positions> {
        self.positions_t1.as_ref()
    }

    /// Positions at both ends of the step: twice the same of a still body.
    pub fn ends(&self) -> [&Positions; 2] {
        [&self.positions_t0, self.positions_t1.as_ref().unwrap_or(&self.positions_t0)]
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.positions_t0.len()
    }

    /// Number of triangles.
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// The body with vertices merged that coincide in all of its frames, and how many were merged; as [`Mesh::weld`].
    pub fn weld(&self) -> (Body, usize) {
        self.weld_through(&[])
    }

    /// The same of a body that goes on: merged are vertices that coincide in those frames too.
    pub fn weld_through(&self, frames: &[Positions]) -> (Body, usize) {
        let own = std::iter::once(&self.positions_t0).chain(&self.positions_t1);
        let vertices = Vertices::of(&own.chain(frames).collect::<Vec<_>>(), &self.faces);
        let mut welded = self.clone();
        rename(&vertices, &mut welded.faces);
        (welded, vertices.merged)
    }

    /// How many vertices that a face uses share their place, in all frames, with an earlier one; as
    /// [`Mesh::coincident`].
    pub fn coincident(&self) -> usize {
        self.vertices().merged
    }

    fn vertices(&self) -> Vertices {
        let frames: Vec<&Positions> = std::iter::once(&self.positions_t0).chain(&self.positions_t1).collect();
        Vertices::of(&frames, &self.faces)
    }

    /// Whether there are two frames.
    pub fn is_moving(&self) -> bool {
        self.positions_t1.is_some() || matches!(self.away, Some(Away::Placed { moving: true }))
    }

    /// The frames as meshes, to be written or handed on: one, or two. Copies.
    pub fn frames(&self) -> Vec<Mesh> {
        let mesh = |positions: &Positions| Mesh {
            name: self.name.clone(),
            positions: positions.clone(),
            faces: self.faces.clone(),
        };
        std::iter::once(&self.positions_t0).chain(&self.positions_t1).map(mesh).collect()
    }

    /// xxh3 of the faces and of the bits of every position, in little-endian order: the same on every machine.
    pub fn fingerprint(&self) -> u64 {
        let mut hash = xxhash_rust::xxh3::Xxh3::new();
        self.faces.iter().flatten().for_each(|i| hash.update(&i.to_le_bytes()));
        for frame in std::iter::once(&self.positions_t0).chain(&self.positions_t1) {
            match frame {
                Positions::F32(points) => points.iter().flatten().for_each(|x| hash.update(&x.to_le_bytes())),
                Positions::F64(points) => points.iter().flatten().for_each(|x| hash.update(&x.to_le_bytes())),
            }
        }
        hash.digest()
    }
}
