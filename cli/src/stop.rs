//! SIGINT and SIGTERM end the program at once: with status 130 or 143, one line, and no half file.
//! On Windows Ctrl-C and Ctrl-Break do, and a console that closes, with status 130.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Files that are not whole yet.
struct Unfinished {
    /// New files that have no name of their own yet. Those that are gone do no harm: no other file
    /// gets such a name.
    new: Vec<std::path::PathBuf>,
    /// Files that are written where they are, by their numbers.
    open: Vec<(u64, File)>,
    opened: u64,
}

/// Held to make, write or give up such a file. A signal holds it to the end, so that
/// nothing is written behind it.
static UNFINISHED: Mutex<Unfinished> =
    Mutex::new(Unfinished { new: Vec::new(), open: Vec::new(), opened: 0 });

fn unfinished() -> MutexGuard<'static, Unfinished> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes a new file that goes with the program if that is ended.
///
/// # Errors
/// Those of `make`.
pub fn making<T: AsRef<Path>>(make: impl FnOnce() -> io::Result<T>) -> io::Result<T> {
    let mut unfinished = unfinished();
    let made = make()?;
    unfinished.new.push(made.as_ref().to_owned());
    Ok(made)
}

/// A regular file that is being written. It is emptied if the program is ended before this is
/// dropped.
pub struct Writing<'a> {
    file: &'a File,
    number: u64,
}

impl<'a> Writing<'a> {
    /// Begins to write a file.
    ///
    /// # Errors
    /// Those of the system.
    pub fn new(file: &'a File) -> io::Result<Writing<'a>> {
        let mut unfinished = unfinished();
        unfinished.opened += 1;
        let number = unfinished.opened;
        // WebAssembly has no signals, and no second handles.
        if !cfg!(target_family = "wasm") {
            unfinished.open.push((number, file.try_clone()?));
        }
        Ok(Writing { file, number })
    }
}

impl Write for &Writing<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let (_turn, mut file) = (unfinished(), self.file);
        file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        let mut file = self.file;
        file.flush()
    }
}

impl Drop for Writing<'_> {
    fn drop(&mut self) {
        unfinished().open.retain(|(number, _)| *number != self.number);
    }
}

/// Leaves nothing half written, and takes the turn of all that write.
#[cfg_attr(target_family = "wasm", expect(dead_code, reason = "no signal reaches it"))]
fn give_up() -> MutexGuard<'static, Unfinished> {
    let unfinished = unfinished();
    for (_, file) in &unfinished.open {
        // A file that cannot be emptied stays as it is.
        let _ = file.set_len(0);
    }
    for file in &unfinished.new {
        let _ = fs::remove_file(file);
    }
    unfinished
}

/// From here on, signals end the program as described above. If no thread can be started, they keep
/// their default effect.
#[cfg(unix)]
pub fn listen() {
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    let (ready, listens) = std::sync::mpsc::channel();
    let wait = move || {
        let signals = Signals::new([SIGINT, SIGTERM]);
        // The starter of this thread waits for it.
        let _ = ready.send(());
        let Some(signal) = signals.ok().and_then(|mut signals| signals.forever().next()) else { return };
        let _turn = give_up();
        let name = if signal == SIGINT { "SIGINT" } else { "SIGTERM" };
        crate::output::say(&format!("ended by {name}: nothing is written"));
        signal_hook::low_level::exit(128 + signal);
    };
    if std::thread::Builder::new().name("signals".into()).spawn(wait).is_ok() {
        // It fails if that thread has ended.
        let _ = listens.recv();
    }
}

/// From here on, Ctrl-C ends the program as described above. If no thread can be started, it keeps
/// its default effect.
#[cfg(windows)]
pub fn listen() {
    let _ = ctrlc::set_handler(|| {
        let _turn = give_up();
        crate::output::say("ended by Ctrl-C: nothing is written");
        std::process::exit(130)
    });
}

/// No signals reach a program of WebAssembly: its host ends it.
#[cfg(target_family = "wasm")]
pub fn listen() {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_whole_is_given_up() {
        let folder = tempfile::tempdir().expect("a folder");
        let new = making(|| tempfile::NamedTempFile::new_in(folder.path())).expect("a file");
        let [written, whole] = ["written", "whole"].map(|name| folder.path().join(name));
        let [open, done] = [&written, &whole].map(|path| File::create(path).expect("a file"));
        let (writing, wrote) = (Writing::new(&open).expect("open"), Writing::new(&done).expect("open"));
        (&writing).write_all(b"half").expect("written");
        (&wrote).write_all(b"all").expect("written");
        drop(wrote);
        drop(give_up());
        assert!(!new.path().exists(), "a new file goes");
        let text = |path| fs::read_to_string(path).expect("text");
        assert_eq!((text(&written).as_str(), text(&whole).as_str()), ("", "all"));
    }
}
