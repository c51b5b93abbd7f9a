//! Files to meshes: opening, and the choice of the reader.

use super::difference::difference;
use super::note::Notes;
use super::polygons::Fans;
use super::{Mesh, Positions, Problem, cut, obj, ply_read};
use crate::Error;
use crate::file::{self, encoding, is_packed};
use std::path::Path;

/// The formats that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Stanford PLY: ascii, binary little-endian or big-endian.
    Ply,
    /// Wavefront OBJ: `v` and `f`; other keywords of the format are skipped, and all else is
    /// counted by [`Mesh::notes`].
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
    /// A flat polygon that crosses itself is cut as a fan too, which covers all that it winds
    /// around, and may cover more. A face of fewer than three corners is left out. [`Mesh::notes`]
    /// counts both, and all else that was not read; [`Mesh::strict`] refuses them. A byte order
    /// mark of UTF-8 is skipped; UTF-16 and UTF-32 are refused.
    ///
    /// Cost: O(n log n) for usual polygons, O(n^2) for bad ones. Memory: the file, the mesh, and at most a small multiple of the file on the way, whatever its header promises.
    ///
    /// # Errors
    /// [`Error::Input`], naming the file, the element and the value: a file that cannot be read or is no regular file,
    /// an unknown extension, a malformed file, a mesh that fails [`Mesh::new`], one without
    /// triangles, or a polygon of more than 131,072 corners whose fan is wrong
    /// ([`Problem::FaceCorners`]). [`Error::OutOfMemory`] for a file that is too large for the
    /// memory there is.
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
    /// As [`Mesh::read`], except for polygons, which are cut as here; and those of
    /// [`Body::moving`](super::Body::moving).
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
            None => {
                let mut notes = frame.notes;
                notes.retain(|note| !self.notes.iter().any(|known| known.is_as(note)));
                Ok(Mesh { faces: self.faces.clone(), polygons: self.polygons.clone(), notes, ..frame })
            }
            Some(problem) => Err(Error::Input { file: frame.name, problem }),
        }
    }
}

/// What a reader of a format makes of a file.
pub(super) struct Parsed {
    pub positions: Positions,
    pub fans: Fans,
    pub notes: Notes,
}

/// The mesh of a file, every polygon still a fan.
fn fans(name: String, format: Format, bytes: &[u8]) -> Result<Mesh, Error> {
    let parsed = encoding::utf8(bytes).and_then(|bytes| match format {
        Format::Ply => ply_read::read(bytes),
        Format::Obj => obj::read(bytes),
    });
    let Parsed { positions, fans, notes } = match parsed {
        Ok(parsed) => parsed,
        Err(problem) => return Err(Error::Input { file: name, problem }),
    };
    let mut mesh = Mesh::new(name, positions, fans.faces)?;
    mesh.polygons = fans.polygons;
    mesh.notes = notes.of(&mesh.name);
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
