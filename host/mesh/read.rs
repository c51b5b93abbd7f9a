//! Files to meshes: opening, and the choice of the reader.

use super::{Mesh, Positions, Problem, obj, ply_read};
use crate::Error;
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
    /// an unknown extension, a malformed file, a mesh that fails [`Mesh::new`], or one without triangles.
    pub fn read(path: &Path) -> Result<Mesh, Error> {
        let file = path.display().to_string();
        let opened = Format::of(path).and_then(|format| Ok((format, bytes(path)?)));
        match opened {
            Ok((format, bytes)) => Mesh::parse(file, format, &bytes),
            Err(problem) => Err(Error::Input { file, problem }),
        }
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

/// The whole file. Only regular files: a pipe or a device may never end.
fn bytes(path: &Path) -> Result<Vec<u8>, Problem> {
    let unreadable = |error: std::io::Error| Problem::Unreadable { reason: error.to_string() };
    let kind = std::fs::metadata(path).map_err(unreadable)?;
    if kind.is_dir() {
        return Err(Problem::Unreadable { reason: "it is a directory".into() });
    }
    if !kind.is_file() {
        return Err(Problem::Unreadable { reason: "it is not a regular file".into() });
    }
    std::fs::read(path).map_err(unreadable)
}
