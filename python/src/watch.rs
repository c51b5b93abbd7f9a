//! Work that a signal ends. Python handles signals on the main thread. So a call that may take long runs on
//! another thread, and the main thread waits for it. A call that is likely to be short runs on the main
//! thread, which looks for signals between launches: to wake another thread takes as long as the call.

use crate::errors::raised;
use crate::inline;
use crate::worker;
use nearmiss::{Error, Interrupt, listen};
use pyo3::prelude::*;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::{Duration, Instant};

/// How often signals are looked for.
pub const PERIOD: Duration = Duration::from_millis(50);
/// How often a lock is tried that another thread has.
const TURN: Duration = Duration::from_millis(1);
/// A call is likely to be short if the last ones took at most this. A cost: signals are heard in any case.
const SHORT: Duration = Duration::from_millis(10);

/// How a detector's calls are run.
pub struct Calls {
    /// Ends them.
    pub interrupt: Interrupt,
    /// Nanoseconds that one of the last took: the longest, and a quarter less for each behind it.
    recent: AtomicU64,
    is_gpu: bool,
}

impl Calls {
    /// Calls of a detector on a GPU, or on none. A GPU's stay away from the main thread, whose current
    /// context may be another library's.
    pub fn new(is_gpu: bool) -> Calls {
        // The first calls build.
        let recent = AtomicU64::new(2 * nanoseconds(SHORT));
        Calls { interrupt: Interrupt::new(), recent, is_gpu }
    }

    fn are_short(&self) -> bool {
        !self.is_gpu && self.recent.load(Relaxed) <= nanoseconds(SHORT)
    }

    fn took(&self, time: Duration) {
        let before = self.recent.load(Relaxed);
        self.recent.store(nanoseconds(time).max(before - before / 4), Relaxed);
    }
}

fn nanoseconds(time: Duration) -> u64 {
    u64::try_from(time.as_nanos()).unwrap_or(u64::MAX)
}

/// State that work shares with the thread that waits for it.
#[derive(Default)]
pub struct Watch {
    /// A signal has come: threads that wait for a lock give up.
    cancelled: AtomicBool,
    /// The work has all its locks: a trigger ends it, and no other thread's.
    begun: AtomicBool,
    /// The work runs on the main thread.
    is_inline: bool,
    /// The locks of calls that a signal's handler is in the middle of, by their places.
    beneath: Vec<usize>,
    over: Mutex<bool>,
    ends: Condvar,
}

impl Watch {
    /// Waits for a lock, unless a signal comes.
    ///
    /// # Errors
    /// [`Error::Interrupted`]; [`Error::Bug`] if an earlier call with it has ended in a fault;
    /// [`Error::InvalidArgument`] if a call has it that a signal's handler is in the middle of.
    pub fn lock<'a, T>(&self, of: &'a Mutex<T>) -> Result<MutexGuard<'a, T>, Error> {
        loop {
            if self.cancelled.load(Relaxed) {
                return Err(Error::Interrupted);
            }
            match of.try_lock() {
                Ok(guard) => {
                    if self.is_inline {
                        inline::holds(of);
                    }
                    return Ok(guard);
                }
                Err(TryLockError::Poisoned(_)) => {
                    return Err(Error::Bug {
                        what: "an earlier call ended in a fault; make another one".into(),
                    });
                }
                Err(TryLockError::WouldBlock) => {
                    inline::check(of, &self.beneath)?;
                    thread::sleep(TURN);
                    listen();
                }
            }
        }
    }

    /// For work of the main thread, or on it.
    pub fn new(is_inline: bool) -> Watch {
        Watch { is_inline, beneath: inline::held(), ..Watch::default() }
    }

    /// The work has all locks that it needs.
    pub fn begins(&self) {
        self.begun.store(true, Relaxed);
    }

    /// A signal's handler has raised: ends the work.
    pub fn cancel(&self, interrupt: &Interrupt) {
        self.cancelled.store(true, Relaxed);
        if self.begun.load(Relaxed) {
            interrupt.trigger();
        }
    }

    /// Whether the work is over, waiting for that a little.
    pub fn is_over(&self) -> bool {
        let over = self.over.lock().unwrap_or_else(PoisonError::into_inner);
        let waited = self.ends.wait_timeout_while(over, PERIOD, |over| !*over);
        *waited.unwrap_or_else(PoisonError::into_inner).0
    }
}

/// Says that work is over, also after a panic.
pub struct Over(pub Arc<Watch>);

impl Drop for Over {
    fn drop(&mut self) {
        *self.0.over.lock().unwrap_or_else(PoisonError::into_inner) = true;
        self.0.ends.notify_all();
    }
}

/// Whether this is the thread on which Python handles signals.
pub fn is_main(py: Python<'_>) -> PyResult<bool> {
    let threading = py.import("threading")?;
    let main = threading.call_method0("main_thread")?.getattr("ident")?;
    main.eq(threading.call_method0("get_ident")?)
}

/// Runs work while the interpreter runs on. On the main thread a signal whose handler raises, as
/// SIGINT's does, ends it within some 50 ms and what `interrupt` takes.
///
/// # Errors
/// The exception that a signal's handler raised.
pub fn watched<T: Send>(py: Python<'_>, calls: &Calls, work: impl FnOnce(&Watch) -> T + Send) -> PyResult<T> {
    if !is_main(py)? {
        return caught(py, || work(&Watch::default()));
    }
    let interrupt = &calls.interrupt;
    let work = |watch: &Watch| {
        let start = Instant::now();
        let done = work(watch);
        calls.took(start.elapsed());
        done
    };
    let (signal, done) =
        if calls.are_short() { inline::run(py, interrupt, work) } else { elsewhere(py, interrupt, work) };
    match (signal, done.map(|done| ended(py, || done)).transpose()) {
        (Some(error), _) => {
            interrupt.clear();
            Err(error)
        }
        (None, Ok(Some(done))) => Ok(done),
        // A task is called or dropped, and nothing drops it.
        (None, Ok(None)) => Err(raised(Error::Bug { what: "work that was not done".into() })),
        (None, Err(error)) => Err(error),
    }
}

/// The exception that a signal's handler raised, and the result of work or its panic.
pub type Heard<T> = (Option<PyErr>, Option<thread::Result<T>>);

/// Runs work on another thread, while this one waits for signals.
fn elsewhere<T: Send>(
    py: Python<'_>,
    interrupt: &Interrupt,
    work: impl FnOnce(&Watch) -> T + Send,
) -> Heard<T> {
    let watch = Arc::new(Watch::new(false));
    let mut signal = None;
    let wait = || {
        while !py.detach(|| watch.is_over()) {
            if signal.is_none()
                && let Err(error) = py.check_signals()
            {
                signal = Some(error);
            }
            if signal.is_some() {
                watch.cancel(interrupt);
            }
        }
    };
    let done = worker::run(&watch, || work(&watch), wait);
    (signal, done)
}

/// Runs work on this thread.
fn caught<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    ended(py, || catch_unwind(AssertUnwindSafe(work)))
}

/// The result of work that may panic, which is a fault of ours: locks that it held refuse later calls.
fn ended<T: Send>(py: Python<'_>, end: impl FnOnce() -> thread::Result<T> + Send) -> PyResult<T> {
    let bug = |panic: Box<dyn Any + Send>| Error::Bug { what: said(&*panic).into() };
    py.detach(|| end().map_err(bug)).map_err(raised)
}

/// The message of a panic.
fn said(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a panic")
}

/// Looks at what a lock holds. A signal ends the wait for it.
///
/// # Errors
/// The exception that a signal's handler raised.
pub fn look<S: Send, T: Send>(
    py: Python<'_>,
    calls: &Calls,
    at: &Mutex<S>,
    look: impl FnOnce(&S) -> T + Send,
) -> PyResult<T> {
    // The lock is mostly free. Its holder may wait for the interpreter.
    if let Ok(held) = at.try_lock() {
        return Ok(look(&held));
    }
    watched(py, calls, |watch| watch.lock(at).map(|held| look(&held)))?.map_err(raised)
}

/// Runs work that nothing ends. A signal leaves it behind: it goes on by itself, and what it comes
/// to is dropped.
///
/// # Errors
/// The exception that a signal's handler raised.
pub fn left_behind<T: Send + 'static>(
    py: Python<'_>,
    work: impl Fn() -> T + Send + Sync + 'static,
) -> PyResult<T> {
    let (watch, work) = (Arc::new(Watch::default()), Arc::new(work));
    let (over, its) = (Over(watch.clone()), work.clone());
    let run = move || {
        let _over = over;
        its()
    };
    match thread::Builder::new().name("nearmiss".into()).spawn(run) {
        Ok(worker) => {
            let hears = is_main(py)?;
            while hears && !py.detach(|| watch.is_over()) {
                py.check_signals()?;
            }
            ended(py, || worker.join())
        }
        // No thread is to be had: then no signal ends the work.
        Err(_) => caught(py, || work()),
    }
}
