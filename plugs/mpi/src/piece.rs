//! The part of a body that a rank owns.

use crate::error::refused;
use crate::numbers;
use crate::place::chosen;
use nearmiss::mesh::{Positions, Problem};
use nearmiss::scene::{BodyKind, Motion};
use nearmiss::{Body, Error, Mesh};

/// The part of a body that a rank owns: some of its triangles, all, or none. Only this rank knows
/// their positions.
///
/// Every rank makes a piece of every body, in the same order. Names, kinds, filters, thickness and
/// numbers of the whole are the same on all ranks.
#[derive(Clone, Debug)]
pub struct Piece {
    pub(crate) body: Body,
    /// Number of each vertex in the whole body, ascending.
    pub(crate) vertices: Vec<u32>,
    /// Number of each triangle in the whole body, ascending.
    pub(crate) faces: Vec<u32>,
    /// Vertices and triangles of the whole body.
    pub(crate) whole: [u32; 2],
    pub(crate) tolerance: Option<f64>,
}

impl Piece {
    /// A piece from a body that has its triangles alone, in numbers of its own. `vertices` and
    /// `faces` are their numbers in the whole body, ascending; `whole` is the number of its vertices
    /// and of its triangles.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if the numbers do not fit the body or are not ascending, for edges
    /// and points of the body's own, and for radii that differ between vertices.
    pub fn new(body: Body, vertices: Vec<u32>, faces: Vec<u32>, whole: [u32; 2]) -> Result<Piece, Error> {
        body.validate()?;
        let name = body.name();
        for (what, numbers, count, end) in [
            ("vertices", &vertices, body.vertex_count(), whole[0]),
            ("triangles", &faces, body.face_count(), whole[1]),
        ] {
            if numbers.len() != count {
                let what = format!("{name} has {count} {what} and {} numbers of {what}", numbers.len());
                return Err(refused(what, "give one number for each"));
            }
            if let Some(at) =
                (0..count).find(|&at| numbers[at] >= end || at > 0 && numbers[at] <= numbers[at - 1])
            {
                let what = format!(
                    "numbers of {what} of {name} must ascend below {end}, got {} at {at}",
                    numbers[at]
                );
                return Err(refused(what, "sort the piece by its numbers in the whole body"));
            }
        }
        of_triangles(&body)?;
        if body.thickness().same().is_none() {
            let what = format!("the thickness of {name} differs between vertices");
            return Err(refused(what, "use one machine, or one radius for the body"));
        }
        if body.is_device_resident() {
            return Err(refused(format!("{name} is in memory of a device"), "give positions in host memory"));
        }
        Ok(Piece { body, vertices, faces, whole, tolerance: None })
    }

    /// These triangles of a body that the rank knows as a whole. The order of `faces` does not
    /// matter.
    ///
    /// # Errors
    /// As of [`Piece::new`], and for a triangle that the body does not have.
    pub fn of(body: &Body, faces: &[u32]) -> Result<Piece, Error> {
        let faces = numbers::ascending(faces.iter().copied());
        if let Some(face) = faces.last().filter(|&&face| face as usize >= body.face_count()) {
            let what = format!("{} has no triangle {face}: it has {}", body.name(), body.face_count());
            return Err(refused(what, "give numbers of its triangles"));
        }
        of_triangles(body)?;
        let corners = faces.iter().map(|&face| body.faces()[face as usize]);
        let vertices = numbers::ascending(corners.clone().flatten());
        let triangles = corners.map(|corners| corners.map(|v| numbers::place(&vertices, v))).collect();
        let part = |positions: &Positions| chosen(positions.into(), &vertices);
        let mesh = Mesh::new(body.name(), part(body.positions_t0()), triangles)?;
        let piece = match body.kind() {
            BodyKind::Fixed => Body::fixed(mesh),
            BodyKind::Rigid => Body::rigid(mesh).at(body.pose_step())?,
            _ => match body.positions_t1() {
                Some(end) => {
                    Body::deformable(mesh).at(Motion::step(&part(body.positions_t0()), &part(end)))?
                }
                None => Body::deformable(mesh),
            },
        };
        let piece = piece.with_filter(*body.filter()).with_thickness(body.thickness().clone());
        let whole = [body.vertex_count() as u32, body.face_count() as u32];
        Ok(Piece::new(piece, vertices, faces, whole)?.with_default_tolerance(body.default_tolerance()))
    }

    /// Sets the default tolerance of the whole body. Without it that follows from the mean side of
    /// all triangles.
    pub fn with_default_tolerance(self, tolerance: f64) -> Piece {
        Piece { tolerance: Some(tolerance), ..self }
    }

    /// The triangles, in numbers of their own.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// Number of each vertex in the whole body, ascending.
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// Number of each triangle in the whole body, ascending.
    pub fn faces(&self) -> &[u32] {
        &self.faces
    }

    /// Returns an error of the piece with the numbers of the whole body.
    pub(crate) fn in_whole(&self, error: Error) -> Error {
        let number = |vertex: usize| self.vertices.get(vertex).map_or(vertex, |&v| v as usize);
        let Error::Input { file, problem } = error else { return error };
        let problem = match problem {
            Problem::NonFinite { vertex, axis, value } => {
                Problem::NonFinite { vertex: number(vertex), axis, value }
            }
            Problem::TooLarge { vertex, axis, value, limit } => {
                Problem::TooLarge { vertex: number(vertex), axis, value, limit }
            }
            other => other,
        };
        Error::Input { file, problem }
    }
}

/// Refuses edges and points of a body's own.
fn of_triangles(body: &Body) -> Result<(), Error> {
    if body.edges().is_empty() && body.points().is_empty() {
        return Ok(());
    }
    let what = format!("{} has edges or points of its own, which ranks do not share", body.name());
    Err(refused(what, "use one machine, or triangles alone"))
}
