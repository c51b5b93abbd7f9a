//! Everything that is printed and written. Output that cannot be written is an error.

mod pack;
mod place;

use nearmiss::error::Error;
use nearmiss_io::file::is_packed;
use place::Way;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// The file that is standard output.
const STDOUT: &str = "-";

/// Whether standard output is that of a file: then messages go to standard error.
static IS_TAKEN: AtomicBool = AtomicBool::new(false);

/// Whether a file is standard output.
pub fn is_stdout(path: &Path) -> bool {
    path == Path::new(STDOUT)
}

/// Prints to standard output, at once. A full disk is an error, and so is a reader that has gone.
pub fn print(text: &str) -> Result<(), Error> {
    if IS_TAKEN.load(Ordering::Relaxed) {
        let _ = std::io::stderr().write_all(text.as_bytes());
        return Ok(());
    }
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|e| stdout_failed(&e))
}

/// Standard output, which could not be written.
pub fn stdout_failed(text: &impl ToString) -> Error {
    failed(Path::new("standard output"), text)
}

/// Prints a message to standard error. A failure to do so is ignored.
pub fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "nearmiss: {text}");
}

fn failed(path: &Path, text: &impl ToString) -> Error {
    Error::Output { file: path.display().to_string(), text: text.to_string() }
}

/// Why work that writes a file ended before its end.
pub enum Stop {
    /// The file could not be written.
    File(String),
    /// Anything else.
    Other(Error),
}

impl From<Error> for Stop {
    fn from(error: Error) -> Stop {
        Stop::Other(error)
    }
}

/// A file that will be written when the work is done; whether it can be is known before.
pub struct Target {
    path: PathBuf,
    /// Whether it is packed by gzip: its name ends in `.gz`.
    packed: bool,
    way: Way,
}

impl Target {
    /// Checks that the file can be written. Its content stays.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn open(path: &Path) -> Result<Target, Error> {
        if is_stdout(path) {
            if IS_TAKEN.swap(true, Ordering::Relaxed) {
                return Err(Error::InvalidArgument {
                    what: "- is standard output, which holds one file".into(),
                    advice: "name a file for the other".into(),
                });
            }
            return Ok(Target { path: "standard output".into(), packed: false, way: Way::Stdout });
        }
        let way = place::way(path).map_err(|e| failed(path, &e))?;
        Ok(Target { path: path.to_owned(), packed: is_packed(path), way })
    }

    /// Writes the file while work runs that may fail for its own reasons.
    ///
    /// # Errors
    /// Those of the work, and those of [`Target::write`].
    pub fn write_while<T>(self, work: impl FnOnce(&mut dyn Write) -> Result<T, Stop>) -> Result<T, Error> {
        let (mut done, mut failed) = (None, None);
        let written = self.write(|out| match work(out) {
            Ok(value) => {
                done = Some(value);
                Ok(())
            }
            Err(Stop::File(text)) => Err(text),
            Err(Stop::Other(error)) => Err(failed.insert(error).to_string()),
        });
        match (failed, done) {
            (Some(error), _) => Err(error),
            (None, Some(value)) => written.map(|()| value),
            (None, None) => Err(written.err().unwrap_or(Error::Bug { what: "a file without work".into() })),
        }
    }

    /// Writes the file.
    ///
    /// # Errors
    /// [`Error::Output`]; then a file that was there before is as it was, or empty where its folder takes no new ones.
    pub fn write(self, put: impl FnOnce(&mut dyn Write) -> Result<(), String>) -> Result<(), Error> {
        let put = |out: &mut dyn Write| if self.packed { pack::pack(out, put) } else { put(out) };
        let written = match self.way {
            Way::Stdout => place::buffered(std::io::stdout().lock(), put),
            Way::Open(file) => place::into(&file, put),
            Way::Beside(real) => place::beside(&real, put),
        };
        written.map_err(|text| failed(&self.path, &text))
    }
}

/// A file's name without `.gz`.
pub fn unpacked(path: &Path) -> PathBuf {
    if is_packed(path) { path.with_extension("") } else { path.to_owned() }
}

/// A folder that files will be written into when the work is done: made where there is none.
///
/// # Errors
/// [`Error::Output`] when it takes no files.
pub fn folder(path: &Path) -> Result<(), Error> {
    fs::create_dir_all(path).and_then(|()| place::probe(path)).map_err(|e| failed(path, &e))
}

/// Refuses to write over a file that is read, however it is named.
///
/// # Errors
/// [`Error::InvalidArgument`], naming the option and the file.
pub fn keeps<'a>(option: &str, to: &Path, read: impl IntoIterator<Item = &'a Path>) -> Result<(), Error> {
    let Ok(real) = place::real(to) else { return Ok(()) };
    match read.into_iter().find(|from| place::real(from).is_ok_and(|from| from == real)) {
        None => Ok(()),
        Some(from) => Err(Error::InvalidArgument {
            what: format!("{option} would overwrite {}, which is read", from.display()),
            advice: "give another name".into(),
        }),
    }
}
