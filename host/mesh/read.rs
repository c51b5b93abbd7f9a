//! Files to meshes: opening, and the choice of the reader.

use super::{Mesh, Positions, Problem, obj, ply_read};
use crate::Error;
use crate::memory;
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
    /// The format that the extension names, whatever its case.
    ///
    /// # Errors
    /// [`Problem::UnknownExtension`].
    pub fn of(path: &Path) -> Result<Format, Problem> {
        let found = path.extension().unwrap_or_default().to_string_lossy();
        match found.to_ascii_lowercase().as_str() {
            "ply" => Ok(Format::Ply),
            "obj" => Ok(Format::Obj),
            _ => Err(Problem::UnknownExtension { found: found.into_owned() }),
        }
    }
}

impl Mesh {
    /// Reads a `.ply` or `.obj` file. Polygons become fans of triangles around their first corner, in file order, so
    /// in a mesh with polygons the faces are not those of the file.
    ///
    /// Memory: the file, the mesh, and at most a small multiple of the file on the way, whatever its header promises.
    ///
    /// # Errors
    /// [`Error::Input`], naming the file, the element and the value: a file that cannot be read or is no regular file,
    /// an unknown extension, a malformed file, a mesh that fails [`Mesh::new`], or one without triangles. [`Error::Room`] for
    /// a file that is too large for the memory there is.
    pub fn read(path: &Path) -> Result<Mesh, Error> {
        let file = path.display().to_string();
        let input = |problem| Error::Input { file: file.clone(), problem };
        let format = Format::of(path).map_err(input)?;
        let size = size(path).map_err(input)?;
        memory::require(&format!("reading {file}"), size.saturating_mul(MULTIPLE))?;
        let bytes = std::fs::read(path).map_err(|e| input(unreadable(e)))?;
        Mesh::parse(file, format, &bytes)
    }

    /// Reads a mesh from the bytes of a file; `name` stands in messages. As [`Mesh::read`] otherwise.
    ///
    /// # Errors
    /// As [`Mesh::read`], but for the file itself.
    pub fn parse(name: impl Into<String>, format: Format, bytes: &[u8]) -> Result<Mesh, Error> {
        let name = name.into();
        let parsed = match format {
            Format::Ply => ply_read::read(bytes),
            Format::Obj => obj::read(bytes),
        };
        let (positions, faces): (Positions, Vec<[u32; 3]>) = match parsed {
            Ok(parsed) => parsed,
            Err(problem) => return Err(Error::Input { file: name, problem }),
        };
        let mesh = Mesh::new(name, positions, faces)?;
        mesh.require_triangles()?;
        Ok(mesh)
    }
}

/// Most bytes of memory that a byte of a file takes, the file itself with it: texts of short numbers take most.
const MULTIPLE: u64 = 8;

fn unreadable(error: std::io::Error) -> Problem {
    Problem::Unreadable { reason: error.to_string() }
}

/// The size of a file. Only of regular files: a pipe or a device may never end.
fn size(path: &Path) -> Result<u64, Problem> {
    let kind = std::fs::metadata(path).map_err(unreadable)?;
    if kind.is_dir() {
        return Err(Problem::Unreadable { reason: "it is a directory".into() });
    }
    if !kind.is_file() {
        return Err(Problem::Unreadable { reason: "it is not a regular file".into() });
    }
    Ok(kind.len())
}
