//! Meshes from files and from standard input, with the notes of their readers.

use crate::output::say;
use flate2::read::MultiGzDecoder;
use nearmiss::error::Error;
use nearmiss::memory;
use nearmiss::mesh::Problem;
use nearmiss_io::{Format, MeshFile};
use std::io::Read;
use std::path::Path;

/// How messages name standard input.
const STDIN: &str = "standard input";

/// Most bytes of memory for a byte of standard input, as for files.
const MULTIPLE: u64 = 24;

/// The first two bytes of a file that gzip has packed.
const PACKED: [u8; 2] = [0x1f, 0x8b];

/// Reads meshes one after another, and keeps what their readers noted.
pub struct Reader {
    /// Whether a note is an error.
    pub strict: bool,
    /// Whether frames that cannot be read are passed over.
    pub keep_going: bool,
    /// How many problems of a file are printed.
    pub problems: usize,
    /// The notes so far, a sentence each.
    pub notes: Vec<String>,
    /// Whether standard input has been read.
    pub is_stdin_read: bool,
}

impl Default for Reader {
    fn default() -> Reader {
        Reader { strict: false, keep_going: false, problems: 1, notes: Vec::new(), is_stdin_read: false }
    }
}

impl Reader {
    /// A mesh. The file `-` is standard input; its first bytes show its format.
    ///
    /// # Errors
    /// Those of [`MeshFile::read`]; where this is strict, those of [`MeshFile::strict`].
    pub fn mesh(&mut self, path: &Path) -> Result<MeshFile, Error> {
        self.read(path, MeshFile::read, |format, bytes| MeshFile::parse(STDIN, format, bytes))
    }

    /// Another frame of a mesh.
    ///
    /// # Errors
    /// Those of [`MeshFile::read_frame`]; where this is strict, those of [`MeshFile::strict`].
    pub fn frame(&mut self, of: &MeshFile, path: &Path) -> Result<MeshFile, Error> {
        self.read(path, |path| of.read_frame(path), |format, bytes| of.parse_frame(STDIN, format, bytes))
    }

    /// A mesh from a file, or from standard input.
    fn read(
        &mut self,
        path: &Path,
        file: impl FnOnce(&Path) -> Result<MeshFile, Error>,
        stdin: impl FnOnce(Format, &[u8]) -> Result<MeshFile, Error>,
    ) -> Result<MeshFile, Error> {
        let read = if path == Path::new("-") {
            let bytes = self.stdin()?;
            let format = Format::of_bytes(&bytes);
            let list = |most| MeshFile::parse_problems(STDIN, format, &bytes, most);
            stdin(format, &bytes).map_err(|e| self.all(e, list))
        } else {
            file(path).map_err(|e| self.all(e, |most| MeshFile::problems(path, most)))
        };
        read.and_then(|mesh| self.noted(mesh))
    }

    fn noted(&mut self, mesh: MeshFile) -> Result<MeshFile, Error> {
        if self.strict {
            return mesh.strict();
        }
        self.notes.extend(mesh.notes().iter().map(ToString::to_string));
        Ok(mesh)
    }

    /// Prints all problems of a file that was refused; the last is returned.
    fn all(&self, first: Error, list: impl FnOnce(usize) -> Result<Vec<Problem>, Error>) -> Error {
        let Error::Input { file, .. } = &first else { return first };
        if self.problems < 2 || self.keep_going {
            return first;
        }
        let mut found = list(self.problems).unwrap_or_default();
        let Some(last) = found.pop() else { return first };
        let error = |problem| Error::Input { file: file.clone(), problem };
        found.into_iter().for_each(|problem| say(&error(problem).to_string()));
        error(last)
    }

    /// All bytes of standard input, unpacked if gzip has packed them.
    fn stdin(&mut self) -> Result<Vec<u8>, Error> {
        if std::mem::replace(&mut self.is_stdin_read, true) {
            return Err(Error::InvalidArgument {
                what: "- is standard input, which can be read once".into(),
                advice: "give a file for all other meshes".into(),
            });
        }
        let bytes = within(std::io::stdin().lock())?;
        if bytes.starts_with(&PACKED) { within(MultiGzDecoder::new(&bytes[..])) } else { Ok(bytes) }
    }
}

/// All bytes of a source. Memory is checked before each piece, which is as long as all before it.
fn within(mut source: impl Read) -> Result<Vec<u8>, Error> {
    const PIECE: u64 = 1 << 20;
    let mut bytes = Vec::new();
    loop {
        let piece = PIECE.max(bytes.len() as u64);
        memory::require("reading standard input", (bytes.len() as u64 + piece).saturating_mul(MULTIPLE))?;
        let read = source.by_ref().take(piece).read_to_end(&mut bytes).map_err(|e| Error::Input {
            file: STDIN.into(),
            problem: Problem::Unreadable { reason: e.to_string() },
        })?;
        if (read as u64) < piece {
            return Ok(bytes);
        }
    }
}
