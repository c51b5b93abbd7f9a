//! Files, read whole: only regular ones, only if memory suffices, unpacked if gzip has packed them.

pub(crate) mod encoding;
mod unpack;

use nearmiss::mesh::Problem;
use nearmiss::{Error, memory};
use std::path::Path;

/// The bytes of a file, unpacked if its name ends in `.gz`. Memory is checked first: `multiple`
/// bytes for each byte of the file, which its reader needs, the file itself included.
///
/// # Errors
/// [`Error::Input`] with [`Problem::Unreadable`], also for a folder, a pipe and a device, which may
/// never end, or [`Problem::Packed`]; [`Error::OutOfMemory`].
pub fn read(path: &Path, multiple: u64) -> Result<Vec<u8>, Error> {
    let file = path.display().to_string();
    let input = |problem| Error::Input { file: file.clone(), problem };
    let size = size(path).map_err(input)?;
    memory::require(&format!("reading {file}"), size.saturating_mul(multiple))?;
    let bytes = std::fs::read(path).map_err(|e| input(unreadable(e)))?;
    if is_packed(path) { unpack::unpack(&file, &bytes, multiple) } else { Ok(bytes) }
}

/// A file's text, without a byte order mark. Lines end in LF or CR LF, even if the file ends them
/// by CR. The bytes are those of [`read`].
///
/// # Errors
/// Errors of [`read`], [`Problem::Encoding`] for UTF-16 and UTF-32, and [`Problem::Unreadable`] for
/// anything else that is not UTF-8.
pub fn text(path: &Path, multiple: u64) -> Result<String, Error> {
    let input = |problem| Error::Input { file: path.display().to_string(), problem };
    encoding::text(read(path, multiple)?).map_err(input)
}

/// Whether a file is packed by gzip: its name ends in `.gz`.
pub fn is_packed(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz"))
}

fn unreadable(error: std::io::Error) -> Problem {
    Problem::Unreadable { reason: error.to_string() }
}

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
