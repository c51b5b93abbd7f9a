//! Files to meshes: opening, and the choice of the reader.

use super::sequence::difference;
use super::{Mesh, Problem, cut, obj, ply_read};
use crate::Error;
use crate::file::{self, is_packed};
use std::path::Path;

/// The formats that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Stanford PLY: ascii, binary little-endian or big-endian.
    Ply,
    /// Wavefront OBJ: `v` and `f`; other keywords are skipped.
    Obj,
}

impl Format {
    /// The format that the extension names, whatever its case; with feature `gz` of `.ply.gz` that of `.ply`.
    ///
    /// # Errors
    /// [`Problem::UnknownExtension`].
    pub fn of(path: &Path) -> Result<Format, Problem> {
        let inner = is_packed(path).then(|| path.with_extension(""));
        let path = inner.as_deref().unwrap_or(path);
        let found = path.extension().unwrap_or_default().to_string_lossy();
        match found.to_ascii_lowercase().as_str() {
            "ply" => Ok(Format::Ply),
            "obj" => Ok(Format::Obj),
            _ => Err(Problem::UnknownExtension { found: found.into_owned() }),
        }
    }
}

impl Mesh {
    /// Reads a `.ply` or `.obj` file; with feature `gz` also `.ply.gz` and `.obj.gz`. A polygon of n corners becomes n - 2 triangles, in file order;
    /// [`Mesh::file_face`] tells of which face a triangle is.
    ///
    /// A polygon is cut as it is seen along the axis on which its normal is longest, with exact signs: into the fan
    /// around its first corner where that covers it once (every convex polygon), else by ears. A polygon without area,
    /// on a line or there and back, keeps its fan, which has all its edges; so does one that is not flat (a corner off the plane by a
    /// thousandth of its extent) and crosses itself as it is seen. Corners may touch; a hole may be joined by
    /// an edge there and back.
    ///
    /// Cost: O(n log n) for usual polygons, O(n^2) for bad ones. Memory: the file, the mesh, and at most a small multiple of the file on the way, whatever its header promises.
    ///
    /// # Errors
    /// [`Error::Input`], naming the file, the element and the value: a file that cannot be read or is no regular file,
    /// an unknown extension, a malformed file, a mesh that fails [`Mesh::new`], one without triangles, or a flat
    /// polygon that crosses itself ([`Problem::FaceCrosses`], [`Problem::FaceFolds`]), or one of more than 131,072
    /// corners whose fan is wrong ([`Problem::FaceCorners`]). [`Error::OutOfMemory`] for a file that is too large for the memory there
    /// is.
    pub fn read(path: &Path) -> Result<Mesh, Error> {
        let (file, format, bytes) = open(path)?;
        Mesh::parse(file, format, &bytes)
    }

    /// Reads another frame of this mesh: a file with the same faces, cut as here, wherever their corners have moved.
    ///
    /// Frames that are read one by one may be cut differently, if a polygon's first corner no longer sees it whole.
    /// [`Body::moving`](super::Body::moving) takes such frames; a detector that goes from body to body does not.
    ///
    /// # Errors
    /// As [`Mesh::read`], but for polygons that cross themselves; and those of [`Body::moving`](super::Body::moving).
    pub fn read_frame(&self, path: &Path) -> Result<Mesh, Error> {
        let (file, format, bytes) = open(path)?;
        self.parse_frame(file, format, &bytes)
    }

    /// Reads a mesh from the bytes of a file; `name` stands in messages. As [`Mesh::read`] otherwise.
    ///
    /// # Errors
    /// As [`Mesh::read`], but for the file itself.
    pub fn parse(name: impl Into<String>, format: Format, bytes: &[u8]) -> Result<Mesh, Error> {
        let mut mesh = fans(name.into(), format, bytes)?;
        match cut::cut(&mut mesh) {
            Ok(()) => Ok(mesh),
            Err(problem) => Err(Error::Input { file: mesh.name, problem }),
        }
    }

    /// Reads another frame of this mesh from the bytes of a file. As [`Mesh::read_frame`] otherwise.
    ///
    /// # Errors
    /// As [`Mesh::read_frame`], but for the file itself.
    pub fn parse_frame(&self, name: impl Into<String>, format: Format, bytes: &[u8]) -> Result<Mesh, Error> {
        let frame = fans(name.into(), format, bytes)?;
        match difference(self, &frame) {
            None => Ok(Mesh { faces: self.faces.clone(), polygons: self.polygons.clone(), ..frame }),
            Some(problem) => Err(Error::Input { file: frame.name, problem }),
        }
    }
}

/// The mesh of a file, every polygon still a fan.
fn fans(name: String, format: Format, bytes: &[u8]) -> Result<Mesh, Error> {
    let parsed = match format {
        Format::Ply => ply_read::read(bytes),
        Format::Obj => obj::read(bytes),
    };
    let (positions, fans) = match parsed {
        Ok(parsed) => parsed,
        Err(problem) => return Err(Error::Input { file: name, problem }),
    };
    let mut mesh = Mesh::new(name, positions, fans.faces)?;
    mesh.polygons = fans.polygons;
    mesh.require_triangles()?;
    Ok(mesh)
}

/// Name, format and bytes of a file.
fn open(path: &Path) -> Result<(String, Format, Vec<u8>), Error> {
    let file = path.display().to_string();
    let format = Format::of(path).map_err(|problem| Error::Input { file: file.clone(), problem })?;
    Ok((file, format, file::read(path, MULTIPLE)?))
}

/// Most bytes of memory that a byte of a file takes, the file itself with it: texts of short numbers take most.
const MULTIPLE: u64 = 8;
