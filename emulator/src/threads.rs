//! The threads of engines: one crew that the program shares, or one of an engine's own; and one pool for
//! the host's own work. On WebAssembly there are none: the calling thread does all the work.

use crate::Error;
use crate::crew::Crew;
use rayon::ThreadPoolBuilder;
use std::error::Error as _;
use std::sync::{Arc, OnceLock};

/// Checks that this is the process that first started threads. A process that was forked since has
/// none of them, and would wait for ever.
#[cfg(not(target_family = "wasm"))]
fn has_threads() -> Result<(), Error> {
    static STARTED_BY: OnceLock<u32> = OnceLock::new();
    let own = std::process::id();
    if *STARTED_BY.get_or_init(|| own) == own { Ok(()) } else { Err(Error::Forked) }
}

/// WebAssembly has no processes that fork.
#[cfg(target_family = "wasm")]
fn has_threads() -> Result<(), Error> {
    Ok(())
}

/// The program's pool: all cores; on WebAssembly the calling thread.
fn shared() -> ThreadPoolBuilder {
    let all = ThreadPoolBuilder::new();
    if cfg!(target_family = "wasm") { all.num_threads(1).use_current_thread() } else { all }
}

/// Starts the program's shared threads, if they do not run yet. If they failed to start later, at
/// their first use, that would panic.
///
/// # Errors
/// [`Error::Threads`], the same each time: they are started once. [`Error::Forked`] in a process
/// that was forked since.
pub fn start_threads() -> Result<(), Error> {
    has_threads()?;
    static STARTED: OnceLock<Result<(), String>> = OnceLock::new();
    let started = STARTED.get_or_init(|| match shared().build_global() {
        // An error without a source means that they run already.
        Err(error) if error.source().is_some() => Err(error.to_string()),
        _ => Ok(()),
    });
    started.clone().map_err(|text| {
        // Only for the text: the system reads files for it.
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        Error::Threads { threads, text }
    })
}

/// A crew of so many threads; without a number the one that the program shares.
///
/// # Errors
/// [`Error::Threads`] if they cannot be started; [`Error::Forked`] in a process that was forked since
/// some were.
pub fn crew(threads: Option<usize>) -> Result<Arc<Crew>, Error> {
    static SHARED: OnceLock<Result<Arc<Crew>, Error>> = OnceLock::new();
    let start = |threads| {
        let crew = Crew::new(threads).map(Arc::new);
        crew.map_err(|e| Error::Threads { threads, text: e.to_string() })
    };
    let Some(threads) = threads.filter(|_| !cfg!(target_family = "wasm")) else {
        start_threads()?;
        return SHARED.get_or_init(|| start(rayon::current_num_threads())).clone();
    };
    has_threads()?;
    start(threads)
}
