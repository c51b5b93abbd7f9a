//! Meshes: validated once, then trusted.
//!
//! A [`Mesh`] is one frame, a [`Body`] one mesh at one or two frames, a [`Topology`] the edges of
//! its faces. A mesh that passed [`Mesh::new`] needs no further check: its used positions are
//! finite and in range, its indices valid.
//! Files are read and written by the package `nearmiss-io`.

mod difference;
mod loose;
mod matrix_problem;
mod obj_problem;
mod ply_problem;
mod points;
mod positions;
mod problem;
mod topology;
mod topology_check;
mod validate;
mod weld;

pub use crate::scene::Body;
pub(crate) use difference::difference;
pub(crate) use loose::{Element, Elements, Loose};
pub use matrix_problem::MatrixProblem;
pub use obj_problem::ObjProblem;
pub use ply_problem::PlyProblem;
pub use points::{Coordinate, Points};
pub use positions::Positions;
pub use problem::Problem;
pub(crate) use topology::owners;
pub use topology::{NO_EDGE, Topology};
pub use topology_check::{Violation, check};
pub use validate::{MAX_ABS_F32, MAX_ABS_F64, MAX_FACES, MAX_VERTICES};

use crate::Error;
pub(crate) use validate::is_single;
pub(crate) use weld::{Vertices, rename};

/// One validated frame of a triangle mesh.
///
/// Every vertex that a face uses is finite and at most [`MAX_ABS_F64`] in size, and every index is
/// in range.
/// Single precision is kept up to [`MAX_ABS_F32`]. A mesh beyond that is kept in double precision,
/// exactly.
/// Degenerate and duplicate triangles, repeated indices and -0.0 are legal. A vertex that no face
/// uses may have any value, even NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    pub(crate) name: String,
    pub(crate) positions: Positions,
    pub(crate) faces: Vec<[u32; 3]>,
    pub(crate) loose: Loose,
}

impl Mesh {
    /// Validates a mesh in memory. Messages contain `name`, as they would a file name.
    ///
    /// A mesh without triangles is legal here; see [`Mesh::require_elements`]. Cost: one pass over
    /// the positions and one over the faces.
    ///
    /// # Errors
    /// [`Error::Input`] with [`Problem::NonFinite`], [`Problem::TooLarge`],
    /// [`Problem::IndexOutOfRange`] or [`Problem::TooMany`], for the first bad element.
    pub fn new(name: impl Into<String>, positions: Positions, faces: Vec<[u32; 3]>) -> Result<Mesh, Error> {
        let name = name.into();
        match validate::check(positions, &faces) {
            Ok(positions) => Ok(Mesh { name, positions, faces, loose: Loose::default() }),
            Err(problem) => Err(Error::Input { file: name, problem }),
        }
    }

    /// The file, scene or caller's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// One point per vertex.
    pub fn positions(&self) -> &Positions {
        &self.positions
    }

    /// Three vertex indices per triangle.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Number of vertices, used or not.
    pub fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// Number of triangles.
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Name, positions and faces, without a copy; edges and points are dropped.
    pub fn into_parts(self) -> (String, Positions, Vec<[u32; 3]>) {
        (self.name, self.positions, self.faces)
    }

    /// Refuses a mesh without faces, edges and points. Readers call this; a caller that builds
    /// meshes may.
    ///
    /// # Errors
    /// [`Problem::NoElements`].
    pub fn require_elements(&self) -> Result<(), Error> {
        if self.faces.is_empty() && self.loose.is_empty() {
            return Err(Error::Input { file: self.name.clone(), problem: Problem::NoElements });
        }
        Ok(())
    }
}
