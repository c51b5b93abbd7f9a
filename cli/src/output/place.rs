//! The way to a file: a new one next to it until that is whole, or one that is open.

use crate::stop::{self, Writing};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Seek, Write};
use std::path::{Component, Path, PathBuf, is_separator};
use tempfile::{Builder, NamedTempFile, PersistError};

/// How a file is written.
pub enum Way {
    /// A new file next to it takes its place when it is whole. Until then the old one stays.
    Beside(PathBuf),
    /// Into what is open: a device, a pipe, or a file in a folder that takes no new ones.
    Open(File),
    /// Standard output.
    Stdout,
}

/// How a file can be written; nothing is made.
///
/// # Errors
/// Those of the system.
pub fn way(path: &Path) -> io::Result<Way> {
    let kind = match fs::metadata(path) {
        Ok(kind) => kind,
        Err(e) if e.kind() == ErrorKind::NotFound => {
            let real = named(path)?;
            probe(folder_of(&real))?;
            return Ok(Way::Beside(real));
        }
        Err(e) => return Err(e),
    };
    if kind.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    let file = OpenOptions::new().write(true).open(path)?;
    if kind.is_file() {
        // A link stays one: the file that it names is replaced.
        let real = real(path)?;
        match probe(folder_of(&real)) {
            Ok(()) => return Ok(Way::Beside(real)),
            Err(e) if takes_no_files(&e) => {}
            Err(e) => return Err(e),
        }
    }
    Ok(Way::Open(file))
}

/// The name of the file that a path leads to: the same for all paths to it.
///
/// # Errors
/// Those of the system.
pub fn real(path: &Path) -> io::Result<PathBuf> {
    if !cfg!(target_family = "wasm") {
        return fs::canonicalize(path);
    }
    // Systems of WebAssembly cannot do that.
    fs::metadata(path)?;
    Ok(named(path)?.components().filter(|part| *part != Component::CurDir).collect())
}

/// The file that a path will name, where there is none yet: a link to nothing stays a link.
fn named(path: &Path) -> io::Result<PathBuf> {
    let mut real = path.to_owned();
    // The system refuses longer chains and rings of links.
    for _ in 0..40 {
        let Ok(next) = fs::read_link(&real) else { break };
        real = folder_of(&real).join(next);
    }
    let is_folder = real.to_string_lossy().ends_with(is_separator);
    if is_folder { Err(ErrorKind::IsADirectory.into()) } else { Ok(real) }
}

/// Whether a folder keeps its files to itself, and may yet have one that can be written.
fn takes_no_files(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem)
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."))
}

/// Whether a folder takes a new file.
///
/// # Errors
/// Those of the system.
pub fn probe(folder: &Path) -> io::Result<()> {
    temporary(folder)?.close()
}

/// A new file in a folder, with a unique name. It is deleted when it is dropped. Its permissions are
/// those of any new file.
fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    stop::making(|| Builder::new().prefix(".nearmiss-").make_in(folder, |path| File::create_new(path)))
}

/// Writes into an open file. A regular file that failed is deleted: half an answer would look like
/// one.
///
/// # Errors
/// Those of `put` and of the file.
pub fn into(file: &File, put: impl FnOnce(&mut dyn Write) -> Result<(), String>) -> Result<(), String> {
    // A pipe and a device keep nothing.
    let is_regular = file.metadata().map_err(text)?.is_file();
    let keep = |length: &dyn Fn(&File) -> io::Result<()>| if is_regular { length(file) } else { Ok(()) };
    let clear = || keep(&|file| file.set_len(0));
    clear().map_err(text)?;
    let written = if is_regular {
        let writing = Writing::new(file).map_err(text)?;
        buffered(&writing, put)
    } else {
        buffered(file, put)
    };
    written.and_then(|()| keep(&File::sync_all).map_err(text)).inspect_err(|_| {
        // The first error is reported.
        let _ = clear();
    })
}

/// Writes by way of a buffer.
///
/// # Errors
/// Those of `put` and of the file.
pub fn buffered(
    to: impl Write,
    put: impl FnOnce(&mut dyn Write) -> Result<(), String>,
) -> Result<(), String> {
    let mut out = BufWriter::new(to);
    let written = put(&mut out);
    // A buffer that is dropped would write what it holds.
    let (mut to, held) = out.into_parts();
    written.and_then(|()| to.write_all(&held.unwrap_or_default()).and_then(|()| to.flush()).map_err(text))
}

fn text(error: io::Error) -> String {
    error.to_string()
}

/// Writes a new file, which takes the place of what is there when it is whole.
///
/// # Errors
/// Those of `put` and of the file; then what is there is as it was.
pub fn beside(real: &Path, put: impl FnOnce(&mut dyn Write) -> Result<(), String>) -> Result<(), String> {
    let new = temporary(folder_of(real)).map_err(text)?;
    // Files of WebAssembly have no permissions.
    if let (Ok(before), false) = (fs::metadata(real), cfg!(target_family = "wasm")) {
        new.as_file().set_permissions(before.permissions()).map_err(text)?;
    }
    into(new.as_file(), put)?;
    replace(new, real, |new| new.persist(real))
}

/// Gives a whole file its name. Some names cannot change hands: a file is mounted there, or belongs to
/// another user in a sticky folder. Then the file stays and takes the bytes.
fn replace(
    new: NamedTempFile,
    real: &Path,
    rename: impl FnOnce(NamedTempFile) -> Result<File, PersistError>,
) -> Result<(), String> {
    let Err(PersistError { error, file: new }) = rename(new) else { return Ok(()) };
    let is_kept = matches!(
        error.kind(),
        ErrorKind::ResourceBusy | ErrorKind::PermissionDenied | ErrorKind::CrossesDevices
    );
    if !is_kept || !real.is_file() {
        return Err(text(error));
    }
    let old = OpenOptions::new().write(true).open(real).map_err(text)?;
    let mut new = new.as_file();
    new.rewind().map_err(text)?;
    into(&old, |mut out| io::copy(&mut new, &mut out).map(|_| ()).map_err(text))
}

#[cfg(test)]
mod tests {
    use super::{ErrorKind, PersistError, fs, io, replace, temporary};
    use std::io::Write;

    /// A whole file whose name is taken: the message, the content after that, and the number of files.
    fn kept(kind: ErrorKind) -> (Result<(), String>, String, usize) {
        let folder = tempfile::tempdir().expect("a folder");
        let real = folder.path().join("a.csv");
        fs::write(&real, "what was there, and longer").expect("written");
        let new = temporary(folder.path()).expect("a file");
        new.as_file().write_all(b"new").expect("written");
        let fails = |file| Err(PersistError { error: io::Error::from(kind), file });
        let said = replace(new, &real, fails);
        let count = fs::read_dir(folder.path()).expect("a folder").count();
        (said, fs::read_to_string(&real).expect("text"), count)
    }

    #[test]
    fn a_file_that_keeps_its_name_takes_the_bytes() {
        for kind in [ErrorKind::ResourceBusy, ErrorKind::PermissionDenied, ErrorKind::CrossesDevices] {
            assert_eq!(kept(kind), (Ok(()), "new".to_owned(), 1), "{kind}");
        }
        let (said, text, count) = kept(ErrorKind::StorageFull);
        assert!(said.is_err(), "a full disk is no such reason");
        assert_eq!((text.as_str(), count), ("what was there, and longer", 1));
    }
}
