//! Threads that run the blocks of launches: the one that launches, and helpers that join it.
//!
//! A launch does not wait for a helper that has not joined. So it begins at once, and a helper that a
//! busy machine wakes late costs nothing. Helpers wait actively for a moment after each launch,
//! since most launches follow another, then they sleep.

use crate::listen::listen;
use crate::place;
use crate::turns::to_its_end;
use std::any::Any;
use std::panic::resume_unwind;
use std::ptr::NonNull;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering::Acquire, Ordering::Relaxed, Ordering::Release};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, Thread};

/// Looks of an active wait: some 20 microseconds.
const LOOKS: u32 = 1000;
/// Pieces of a launch for each thread at least, if it has as many blocks: the last one ends soon after
/// the others.
const PIECES: u64 = 32;

/// The threads of an engine.
pub struct Crew {
    shared: Arc<Shared>,
    threads: usize,
    /// The process that has the helpers, if there are any: one that was forked has none.
    process: Option<u32>,
}

struct Shared {
    state: Mutex<State>,
    bell: Condvar,
    /// Number of changes of the state that a helper waits for; changed with the lock.
    posts: AtomicU64,
    /// The core of the last launcher that woke a helper.
    core: AtomicUsize,
}

#[derive(Default)]
struct State {
    jobs: Vec<Listed>,
    /// Helpers that sleep.
    asleep: usize,
    ends: bool,
}

/// A launch that runs.
struct Job<'a> {
    block: &'a (dyn Fn(u32) + Sync),
    blocks: u64,
    /// Blocks of a piece.
    piece: u64,
    /// First block that no thread has taken.
    next: AtomicU64,
    /// Helpers that work at it.
    helpers: AtomicUsize,
    /// The first panic of a block: it ends the launch.
    panic: Mutex<Option<Box<dyn Any + Send>>>,
    launcher: Thread,
}

/// A job in the list of its crew.
struct Listed(NonNull<Job<'static>>);

// SAFETY: a job is shared by threads: all its parts are `Sync`.
unsafe impl Send for Listed {}

impl Crew {
    /// A crew of so many threads, of which the first is the one that launches.
    ///
    /// # Errors
    /// The system's, if a thread cannot be started.
    pub fn new(threads: usize) -> std::io::Result<Crew> {
        let state = Mutex::new(State::default());
        let (bell, posts, core) = (Condvar::new(), AtomicU64::new(0), AtomicUsize::new(place::UNKNOWN));
        let shared = Arc::new(Shared { state, bell, posts, core });
        // WebAssembly has no processes, and no helpers.
        let process = (threads > 1).then(std::process::id);
        let crew = Crew { shared, threads: threads.max(1), process };
        for _ in 1..threads {
            let shared = crew.shared.clone();
            // If one cannot be started, the others end with the crew.
            thread::Builder::new().name("nearmiss".into()).spawn(move || shared.help())?;
        }
        Ok(crew)
    }

    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Wakes a helper, as a launch is about to begin.
    pub fn wake(&self) {
        if self.threads > 1 {
            self.shared.post(|_| ());
        }
    }

    /// Runs blocks. Returns when all are done, or when one has panicked and the others that had begun
    /// are done.
    ///
    /// # Panics
    /// If a block does.
    pub fn run(&self, blocks: u32, block: &(dyn Fn(u32) + Sync)) {
        let (alone, blocks) = (blocks <= 1 || self.threads == 1, u64::from(blocks));
        let job = Job {
            block,
            blocks,
            piece: (blocks / (PIECES * self.threads as u64)).max(1),
            next: AtomicU64::new(0),
            helpers: AtomicUsize::new(0),
            panic: Mutex::new(None),
            launcher: thread::current(),
        };
        // One block is not worth waking a thread.
        if alone {
            job.work();
            return job.end();
        }
        let at = NonNull::from(&job).cast::<Job<'static>>();
        self.shared.post(|state| state.jobs.push(Listed(at)));
        job.work();
        self.shared.lock().jobs.retain(|listed| listed.0 != at);
        // Helpers join with the lock, so there are no more of them.
        job.wait();
        job.end();
    }
}

impl Drop for Crew {
    fn drop(&mut self) {
        if self.process.is_some_and(|process| process == std::process::id()) {
            self.shared.lock().ends = true;
            self.shared.posts.fetch_add(1, Relaxed);
            self.shared.bell.notify_all();
        }
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        // No block runs while the lock is held.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the state, and wakes a helper if one sleeps.
    fn post(&self, change: impl FnOnce(&mut State)) {
        let mut state = self.lock();
        change(&mut state);
        self.posts.fetch_add(1, Relaxed);
        let sleeps = state.asleep > 0;
        if sleeps {
            self.core.store(place::core(), Relaxed);
        }
        drop(state);
        if sleeps {
            self.bell.notify_one();
        }
    }

    /// Waits actively for a post behind this one. Returns whether there is one.
    fn is_posted(&self, seen: u64) -> bool {
        (0..LOOKS).any(|_| {
            std::hint::spin_loop();
            self.posts.load(Relaxed) != seen
        })
    }

    /// A helper's life.
    fn help(&self) {
        let mut state = self.lock();
        while !state.ends {
            // SAFETY: a job in the list lives: its launch takes it out, with the lock, before it ends.
            // Then the launch waits for helpers, which are counted with the lock, and leave last.
            let jobs = || state.jobs.iter().map(|listed| unsafe { listed.0.as_ref() });
            if let Some(job) = jobs().find(|job| job.has_more()) {
                job.helpers.fetch_add(1, Relaxed);
                let sleeps = state.asleep > 0;
                drop(state);
                // Each wakes the next one: many threads are awake soon, and few for little work.
                if sleeps && job.has_more() {
                    self.bell.notify_one();
                }
                job.work();
                job.leave();
                state = self.lock();
                continue;
            }
            let seen = self.posts.load(Relaxed);
            drop(state);
            let is_posted = self.is_posted(seen);
            state = self.lock();
            if !is_posted && self.posts.load(Relaxed) == seen {
                state.asleep += 1;
                state = self.bell.wait(state).unwrap_or_else(PoisonError::into_inner);
                state.asleep -= 1;
                drop(state);
                place::leave(self.core.load(Relaxed));
                state = self.lock();
            }
        }
    }
}

impl Job<'_> {
    fn has_more(&self) -> bool {
        self.next.load(Relaxed) < self.blocks
    }

    /// Passes on a panic of a block.
    fn end(self) {
        if let Some(panic) = self.panic.into_inner().unwrap_or_else(PoisonError::into_inner) {
            resume_unwind(panic);
        }
    }

    /// Runs blocks until none is left. Behind each piece of them a thread listens, if it is to.
    fn work(&self) {
        let all = || {
            loop {
                let first = self.next.fetch_add(self.piece, Relaxed);
                if first >= self.blocks {
                    return;
                }
                // Numbers of blocks are below 2^32.
                (first..self.blocks.min(first + self.piece)).for_each(|block| (self.block)(block as u32));
                listen();
            }
        };
        if let Err(panic) = to_its_end(all) {
            self.next.fetch_max(self.blocks, Relaxed);
            self.panic.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(panic);
        }
    }

    /// A helper leaves the job, which it must not touch later: the launch may have ended.
    fn leave(&self) {
        let launcher = self.launcher.clone();
        if self.helpers.fetch_sub(1, Release) == 1 {
            launcher.unpark();
        }
    }

    /// Waits until all helpers have left.
    fn wait(&self) {
        let mut looks = 0;
        while self.helpers.load(Acquire) > 0 {
            looks += 1;
            if looks < LOOKS { std::hint::spin_loop() } else { thread::park() }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicBool;
    use std::time::Duration;

    #[test]
    fn each_block_runs_once() {
        for threads in [1, 2, 3, 8] {
            let crew = Crew::new(threads).expect("threads");
            for blocks in [0, 1, 2, 7, 128, 5_000] {
                for _ in 0..20 {
                    let runs: Vec<AtomicU64> = (0..blocks).map(|_| AtomicU64::new(0)).collect();
                    crew.run(blocks, &|block| {
                        runs[block as usize].fetch_add(1, Relaxed);
                    });
                    assert!(runs.iter().all(|runs| runs.load(Relaxed) == 1), "{threads} threads, {blocks}");
                }
            }
        }
    }

    #[test]
    fn helpers_join_awake_and_asleep() {
        let crew = Crew::new(2).expect("threads");
        for pause in [0, 1, 20] {
            thread::sleep(Duration::from_millis(pause));
            crew.wake();
            let (own, others) = (thread::current().id(), AtomicBool::new(false));
            // The first block ends only when another thread has one.
            crew.run(2, &|_| {
                if thread::current().id() == own {
                    while !others.load(Relaxed) {
                        thread::yield_now();
                    }
                } else {
                    others.store(true, Relaxed);
                }
            });
        }
    }

    #[test]
    fn threads_that_launch_at_once_share_helpers() {
        let (crew, sum) = (Crew::new(3).expect("threads"), AtomicU64::new(0));
        thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..200 {
                        crew.run(50, &|block| {
                            sum.fetch_add(block.into(), Relaxed);
                        });
                    }
                });
            }
        });
        assert_eq!(sum.into_inner(), 4 * 200 * (49 * 50 / 2));
    }

    #[test]
    fn a_panic_of_any_thread_ends_the_launch_and_the_crew_goes_on() {
        let crew = Crew::new(4).expect("threads");
        for at in [0, 3, 99] {
            let run = || crew.run(100, &|block| assert_ne!(block, at, "this one"));
            let panic = to_its_end(run).expect_err("it panics");
            assert!(panic.downcast_ref::<String>().is_some_and(|text| text.contains("this one")));
            let done = AtomicU64::new(0);
            crew.run(100, &|_| {
                done.fetch_add(1, Relaxed);
            });
            assert_eq!(done.into_inner(), 100);
        }
    }

    #[test]
    fn helpers_end_with_their_crew() {
        let crew = Crew::new(3).expect("threads");
        let shared = Arc::downgrade(&crew.shared);
        drop(crew);
        let ended = (0..2_000).any(|_| {
            thread::sleep(Duration::from_millis(1));
            shared.strong_count() == 0
        });
        assert!(ended, "{} helpers are left", shared.strong_count());
    }
}
