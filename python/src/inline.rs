//! Short calls on the main thread, which looks for signals meanwhile.

use crate::watch::{Heard, PERIOD, Watch};
use nearmiss::{Error, Interrupt, listening};
use pyo3::prelude::*;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, PoisonError};

thread_local! {
    /// The locks of calls that this thread runs.
    static HELD: RefCell<Vec<usize>> = const { RefCell::new(Vec::new()) };
}

fn place<T>(of: &Mutex<T>) -> usize {
    std::ptr::from_ref(of).addr()
}

/// A call that this thread runs holds this lock.
pub fn holds<T>(of: &Mutex<T>) {
    HELD.with(|held| held.borrow_mut().push(place(of)));
}

/// The places of all such locks. Only a signal's handler calls in the middle of a call.
pub fn held() -> Vec<usize> {
    HELD.with(|held| held.borrow().clone())
}

/// Checks that a lock is none of these. A thread that waits for one of them waits for ever.
///
/// # Errors
/// [`Error::InvalidArgument`].
pub fn check<T>(of: &Mutex<T>, held: &[usize]) -> Result<(), Error> {
    if held.contains(&place(of)) {
        return Err(Error::InvalidArgument {
            what: "a signal's handler called a detector in the middle of a call of the same device".into(),
            advice: "let the handler raise, or set a flag and call later".into(),
        });
    }
    Ok(())
}

/// Runs work on this thread. A signal whose handler raises ends it.
pub fn run<T: Send>(
    py: Python<'_>,
    interrupt: &Interrupt,
    work: impl FnOnce(&Watch) -> T + Send,
) -> Heard<T> {
    let (watch, signal) = (Arc::new(Watch::new(true)), Arc::new(Mutex::new(None)));
    let (own, heard, interrupt) = (watch.clone(), signal.clone(), interrupt.clone());
    let listen = move || {
        if let Err(error) = Python::attach(|py| py.check_signals()) {
            heard.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            own.cancel(&interrupt);
        }
    };
    let before = HELD.with(|held| held.borrow().len());
    let done = py.detach(|| catch_unwind(AssertUnwindSafe(|| listening(PERIOD, listen, || work(&watch)))));
    HELD.with(|held| held.borrow_mut().truncate(before));
    let signal = signal.lock().unwrap_or_else(PoisonError::into_inner).take();
    (signal, Some(done))
}
