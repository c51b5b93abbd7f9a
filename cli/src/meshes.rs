//! Meshes from files, with the notes of their readers.

use nearmiss::error::Error;
use nearmiss_io::MeshFile;
use std::path::Path;

/// Reads meshes one after another, and keeps what their readers noted.
#[derive(Default)]
pub struct Reader {
    /// Whether a note is an error.
    pub strict: bool,
    /// Whether frames that cannot be read are passed over.
    pub keep_going: bool,
    /// The notes so far, a sentence each.
    pub notes: Vec<String>,
}

impl Reader {
    /// A mesh.
    ///
    /// # Errors
    /// Those of [`MeshFile::read`]; where this is strict, those of [`MeshFile::strict`].
    pub fn mesh(&mut self, path: &Path) -> Result<MeshFile, Error> {
        MeshFile::read(path).and_then(|mesh| self.noted(mesh))
    }

    /// Another frame of a mesh.
    ///
    /// # Errors
    /// Those of [`MeshFile::read_frame`]; where this is strict, those of [`MeshFile::strict`].
    pub fn frame(&mut self, of: &MeshFile, path: &Path) -> Result<MeshFile, Error> {
        of.read_frame(path).and_then(|mesh| self.noted(mesh))
    }

    fn noted(&mut self, mesh: MeshFile) -> Result<MeshFile, Error> {
        if self.strict {
            return mesh.strict();
        }
        self.notes.extend(mesh.notes().iter().map(ToString::to_string));
        Ok(mesh)
    }
}
