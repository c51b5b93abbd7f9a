//! What the program says and writes. Nothing is lost in silence: output that cannot be written is an error.

use flate2::Compression;
use flate2::write::GzEncoder;
use nearmiss::error::Error;
use std::fs::{self, File, OpenOptions};
use std::io::{BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Prints to standard output, at once. A full disk is an error, and so is a reader that has gone.
pub fn print(text: &str) -> Result<(), Error> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|e| stdout_failed(&e))
}

/// Standard output, which could not be written.
pub fn stdout_failed(text: &impl ToString) -> Error {
    failed(Path::new("standard output"), text)
}

/// Says something beside the answer. Where standard error cannot be written there is nobody to tell.
pub fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "nearmiss: {text}");
}

fn failed(path: &Path, text: &impl ToString) -> Error {
    Error::Output { file: path.display().to_string(), text: text.to_string() }
}

/// A file that will be written when the work is done; whether it can be is known before.
pub struct Target {
    path: PathBuf,
    /// Whether it is packed by gzip: its name ends in `.gz`.
    packed: bool,
    way: Way,
}

enum Way {
    /// A new file beside it takes its place when it is whole: what was there stays until then.
    Beside(PathBuf),
    /// Into what is open: a device, a pipe, or a file in a folder that takes no new ones.
    Open(File),
}

impl Target {
    /// Looks whether the file can be written. What it holds stays.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn open(path: &Path) -> Result<Target, Error> {
        let way = way(path).map_err(|e| failed(path, &e))?;
        Ok(Target { path: path.to_owned(), packed: is_packed(path), way })
    }

    /// Writes the file.
    ///
    /// # Errors
    /// [`Error::Output`]; then a file that was there before is as it was, unless its folder takes no new ones.
    pub fn write(self, put: impl FnOnce(&mut dyn Write) -> Result<(), String>) -> Result<(), Error> {
        let put = |out: &mut BufWriter<File>| if self.packed { pack(out, put) } else { put(out) };
        let written = match self.way {
            Way::Open(file) => into(file, put),
            Way::Beside(real) => beside(&real, put),
        };
        written.map_err(|text| failed(&self.path, &text))
    }
}

/// Whether a file's name says that it is packed by gzip.
fn is_packed(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz"))
}

/// A file's name without `.gz`.
pub fn unpacked(path: &Path) -> PathBuf {
    if is_packed(path) { path.with_extension("") } else { path.to_owned() }
}

fn pack(
    out: &mut BufWriter<File>,
    put: impl FnOnce(&mut dyn Write) -> Result<(), String>,
) -> Result<(), String> {
    let mut packed = BufWriter::new(GzEncoder::new(out, Compression::default()));
    put(&mut packed)?;
    let packed = packed.into_inner().map_err(|e| e.to_string())?;
    packed.finish().map(|_| ()).map_err(|e| e.to_string())
}

fn way(path: &Path) -> std::io::Result<Way> {
    let kind = match fs::metadata(path) {
        Ok(kind) => kind,
        // A link to nothing yet: what it names is made.
        Err(e) if e.kind() == ErrorKind::NotFound && path.is_symlink() => {
            return Ok(Way::Open(File::create(path)?));
        }
        Err(e) if e.kind() == ErrorKind::NotFound => {
            probe(path)?;
            return Ok(Way::Beside(path.to_owned()));
        }
        Err(e) => return Err(e),
    };
    if kind.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    let file = OpenOptions::new().write(true).open(path)?;
    if kind.is_file() {
        // A link stays one: the file that it names is replaced.
        let real = fs::canonicalize(path)?;
        if probe(&real).is_ok() {
            return Ok(Way::Beside(real));
        }
    }
    Ok(Way::Open(file))
}

/// A name beside a file, of this process's own.
fn name_beside(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.part", std::process::id()))
}

/// Whether a file can be made beside this one.
fn probe(path: &Path) -> std::io::Result<()> {
    let name = name_beside(path);
    File::create_new(&name)?;
    fs::remove_file(name)
}

fn into(file: File, put: impl FnOnce(&mut BufWriter<File>) -> Result<(), String>) -> Result<(), String> {
    let text = |e: std::io::Error| e.to_string();
    let regular = file.metadata().map_err(text)?.is_file();
    if regular {
        file.set_len(0).map_err(text)?;
    }
    let mut out = BufWriter::new(file);
    put(&mut out)?;
    let file = out.into_inner().map_err(|e| e.to_string())?;
    // A pipe and a device keep nothing.
    if regular { file.sync_all().map_err(text) } else { Ok(()) }
}

fn beside(real: &Path, put: impl FnOnce(&mut BufWriter<File>) -> Result<(), String>) -> Result<(), String> {
    let name = name_beside(real);
    let write = || {
        let file = File::create_new(&name).map_err(|e| e.to_string())?;
        if let Ok(before) = fs::metadata(real) {
            file.set_permissions(before.permissions()).map_err(|e| e.to_string())?;
        }
        into(file, put)?;
        fs::rename(&name, real).map_err(|e| e.to_string())
    };
    write().inspect_err(|_| {
        // It may not even have been made.
        let _ = fs::remove_file(&name);
    })
}

/// A folder that files will be written into when the work is done: made where there is none.
///
/// # Errors
/// [`Error::Output`] when it takes no files.
pub fn folder(path: &Path) -> Result<(), Error> {
    fs::create_dir_all(path).and_then(|()| probe(&path.join("files"))).map_err(|e| failed(path, &e))
}
