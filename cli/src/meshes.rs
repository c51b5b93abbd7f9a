//! Meshes from files, with the notes of their readers.

use nearmiss::error::Error;
use nearmiss::mesh::Mesh;
use std::path::Path;

/// Reads meshes one after another, and keeps what their readers noted.
#[derive(Default)]
pub struct Reader {
    /// Whether a note is an error.
    pub strict: bool,
    /// The notes so far, a sentence each.
    pub notes: Vec<String>,
}

impl Reader {
    /// A reader that refuses what it would note.
    pub fn new(strict: bool) -> Reader {
        Reader { strict, notes: Vec::new() }
    }

    /// A mesh.
    ///
    /// # Errors
    /// Those of [`Mesh::read`]; where this is strict, those of [`Mesh::strict`].
    pub fn mesh(&mut self, path: &Path) -> Result<Mesh, Error> {
        Mesh::read(path).and_then(|mesh| self.noted(mesh))
    }

    /// Another frame of a mesh.
    ///
    /// # Errors
    /// Those of [`Mesh::read_frame`]; where this is strict, those of [`Mesh::strict`].
    pub fn frame(&mut self, of: &Mesh, path: &Path) -> Result<Mesh, Error> {
        of.read_frame(path).and_then(|mesh| self.noted(mesh))
    }

    fn noted(&mut self, mesh: Mesh) -> Result<Mesh, Error> {
        if self.strict {
            return mesh.strict();
        }
        self.notes.extend(mesh.notes().iter().map(ToString::to_string));
        Ok(mesh)
    }
}
