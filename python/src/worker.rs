//! A thread that is kept from call to call. A call's work runs there: to make a thread for each call
//! takes longer than a short call, and a new thread has none of the memory that kernels keep.

use crate::watch::{Over, Watch};
use std::cell::RefCell;
use std::mem::transmute;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{SendError, Sender, channel};
use std::thread;

type Task<'a> = Box<dyn FnOnce() + Send + 'a>;

struct Worker {
    tasks: Sender<Task<'static>>,
    /// The process that has the thread: one that was forked has none.
    process: u32,
}

thread_local! {
    /// The worker of this thread, while no call uses it.
    static KEPT: RefCell<Option<Worker>> = const { RefCell::new(None) };
}

impl Worker {
    /// The kept worker, or a new one. `None` if no thread is to be had.
    fn new() -> Option<Worker> {
        let process = std::process::id();
        let kept = KEPT.try_with(RefCell::take).ok().flatten();
        if let Some(worker) = kept.filter(|worker| worker.process == process) {
            return Some(worker);
        }
        let (tasks, all) = channel::<Task<'static>>();
        let run = move || all.into_iter().for_each(|task| task());
        let started = thread::Builder::new().name("nearmiss".into()).spawn(run);
        started.is_ok().then_some(Worker { tasks, process })
    }

    fn keep(self) {
        // A thread that ends keeps nothing.
        let _ = KEPT.try_with(|kept| kept.replace(Some(self)));
    }
}

/// Waits until the work is over.
struct Waits<'a>(&'a Watch);

impl Drop for Waits<'_> {
    fn drop(&mut self) {
        while !self.0.is_over() {}
    }
}

/// Runs work on the kept thread, and calls `wait` on this one meanwhile. The watch is over when the work
/// is; it is that of no other work. Returns the result of the work, or its panic. Without a thread
/// this one does the work.
pub fn run<T: Send>(
    watch: &Arc<Watch>,
    work: impl FnOnce() -> T + Send,
    wait: impl FnOnce(),
) -> Option<thread::Result<T>> {
    let mut done = None;
    let (to, over) = (&mut done, Over(watch.clone()));
    let task: Task = Box::new(move || {
        *to = Some(catch_unwind(AssertUnwindSafe(work)));
        // Nothing of the caller is used later.
        drop(over);
    });
    // SAFETY: all that the task uses lives until the watch is over, which `Waits` waits for. A task
    // that is not called is dropped, which ends the watch too.
    let task = unsafe { transmute::<Task<'_>, Task<'static>>(task) };
    let waits = Waits(watch);
    match Worker::new() {
        Some(worker) => {
            // A thread that ended has left the task here.
            worker.tasks.send(task).unwrap_or_else(|SendError(task)| task());
            wait();
            worker.keep();
        }
        None => task(),
    }
    drop(waits);
    done
}
