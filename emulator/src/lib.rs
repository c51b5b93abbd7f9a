//! The GPU, emulated: as an engine (all cores, no checks) or as a sanitizer (any order, every
//! access watched).

mod block;
mod coherent;
mod columns;
mod compiled;
mod crew;
mod engine;
mod interrupt;
mod kept;
mod lane;
mod listen;
mod observer;
mod order;
mod place;
mod prefetch;
mod rows;
mod sanitizer;
mod shadow;
mod threads;
mod turns;

pub use interrupt::{Interrupt, Looks};
pub use listen::{listen, listening};
pub use order::Order;
pub use sanitizer::{Fault, Place, Sanitizer};
pub use threads::start_threads;

use block::Emulated;
use crew::Crew;
use engine::Looking;
use nearmiss_kernels::entry::Entry;
use observer::BlockObserver;
use std::ptr::NonNull;
use std::sync::Arc;
use turns::TurnScheduler;

/// Failures and findings of an emulator.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The threads cannot be started.
    #[error("starting {threads} threads: {text}")]
    Threads {
        /// Number of threads.
        threads: usize,
        /// The system's text.
        text: String,
    },
    /// The process was forked after threads were started.
    #[error("this process was forked and has no threads")]
    Forked,
    /// The machine has no more memory.
    #[error("{bytes} bytes of host memory were needed")]
    Memory {
        /// Number of bytes requested.
        bytes: usize,
    },
    /// An [`Interrupt`] has ended the launch: its memory is half written.
    #[error("interrupted")]
    Interrupted,
    /// A kernel broke a rule.
    #[error("kernel {kernel}: {fault}")]
    Rule {
        /// Name of the kernel.
        kernel: &'static str,
        /// The fault, with its place.
        fault: Fault,
    },
}

/// Mode of the emulator.
#[derive(Clone, Copy, Debug, Default)]
pub enum Mode {
    /// Blocks in parallel on all cores, lanes in order, without checks: the engine for machines
    /// without a GPU.
    #[default]
    Engine,
    /// Blocks in sequence, each to its end, with blocks and lanes in this order (or interleaved,
    /// see [`Emulator::with_interleave`]). Detects races, accesses out of bounds, reads of
    /// unwritten memory and endless waits.
    Sanitizer(Order),
}

/// Lanes of a block of an engine at most, unless a kernel needs more. A cost; no answer depends on it.
const FEW_LANES: u32 = 64;

/// A CPU that runs the kernels.
pub struct Emulator {
    crew: Arc<Crew>,
    sanitizer: Option<Sanitizer>,
    lanes: Option<u32>,
}

impl Emulator {
    /// An engine on `threads` threads, or on all cores; or a sanitizer, always on one thread.
    ///
    /// # Errors
    /// [`Error::Threads`] if the threads cannot be started; [`Error::Forked`] in a process that was
    /// forked after some were.
    pub fn new(mode: Mode, threads: Option<usize>) -> Result<Self, Error> {
        let crew = threads::crew(threads)?;
        let sanitizer = match mode {
            Mode::Engine => None,
            Mode::Sanitizer(order) => Some(Sanitizer::new(order, None)),
        };
        Ok(Emulator { crew, sanitizer, lanes: None })
    }

    /// The same emulator with blocks of another size, except for kernels with an exact one. Answers
    /// must not depend on it.
    pub fn with_lanes(self, lanes: u32) -> Self {
        Emulator { lanes: Some(lanes), ..self }
    }

    /// The same sanitizer, with interleaved blocks. Up to 64 run at once, and one of them moves at
    /// a time. Another continues at the ends of phases and at some accesses that blocks may share
    /// (atomics, relaxed stores and loads). `seed` determines which.
    /// For kernels whose blocks cooperate in a launch. Cost: microseconds a change. An engine stays
    /// as it is.
    pub fn with_interleave(self, seed: u64) -> Self {
        let sanitizer = self.sanitizer.map(|sanitizer| Sanitizer::new(sanitizer.order(), Some(seed)));
        Emulator { sanitizer, ..self }
    }

    /// Number of threads that run blocks.
    pub fn threads(&self) -> usize {
        if self.sanitizer.is_some() { 1 } else { self.crew.threads() }
    }

    /// Lanes of a block of a kernel. Those of an engine have few if they may, so that the values of
    /// all lanes stay in the nearest cache.
    pub fn lanes<E: Entry>(&self) -> u32 {
        match self.lanes {
            _ if E::EXACT => E::LANES,
            Some(lanes) => lanes,
            None if self.sanitizer.is_none() => E::LANES.min(FEW_LANES),
            None => E::LANES,
        }
    }

    /// The sanitizer, if this is one.
    pub fn sanitizer(&self) -> Option<&Sanitizer> {
        self.sanitizer.as_ref()
    }

    /// Takes memory of at least `bytes`: zeroed for the engine, poisoned under the sanitizer.
    ///
    /// # Errors
    /// [`Error::Memory`] if the machine has no more.
    pub fn memory(&self, bytes: usize) -> Result<Memory, Error> {
        let memory = Memory::new(bytes)?;
        if let Some(sanitizer) = &self.sanitizer {
            // SAFETY: the memory is ours, just made, and has that many bytes.
            unsafe { memory.start.cast::<u8>().write_bytes(sanitizer::POISON, memory.bytes()) };
            sanitizer.adopt(memory.addr(), memory.bytes());
        }
        Ok(memory)
    }

    /// Says that launches follow soon, so that a thread is awake for the first one.
    pub fn wake(&self) {
        if self.sanitizer.is_none() {
            self.crew.wake();
        }
    }

    /// Runs every block of a launch, and returns when they are done or `interrupt` is triggered.
    ///
    /// # Errors
    /// [`Error::Interrupted`]; under the sanitizer, [`Error::Rule`] with the first access that
    /// broke a rule.
    ///
    /// # Panics
    /// If the kernel does.
    ///
    /// # Safety
    /// The spans of `args` are of this emulator's [`Memory`]. It lives until the launch returns,
    /// and no other thread accesses it meanwhile. The conditions under "Before" of the kernel's
    /// card hold.
    pub unsafe fn launch<E: Entry>(
        &self,
        blocks: u32,
        args: &E::Args,
        interrupt: Option<&Interrupt>,
    ) -> Result<(), Error> {
        // A constant for each kernel, so that a kernel of the table is not compiled again at each
        // launch.
        if const { E::PLACE.is_some() } {
            let place = E::PLACE.unwrap_or_default();
            // SAFETY: the caller's promise.
            return unsafe { compiled::launch::<E>(self, place, blocks, args, interrupt) };
        }
        self.run::<E>(blocks, args, interrupt)
    }

    /// Runs every block of a launch: [`Emulator::launch`], compiled at its call.
    fn run<E: Entry>(&self, blocks: u32, args: &E::Args, interrupt: Option<&Interrupt>) -> Result<(), Error> {
        let lanes = self.lanes::<E>();
        let looks = Looks::new(interrupt);
        if let Some(sanitizer) = &self.sanitizer {
            sanitizer.begin(E::NAME);
            let run = |block, observer: &BlockObserver| {
                if !looks.ends() {
                    E::run(&mut Emulated::new(block, blocks, lanes, observer), args);
                }
            };
            let sequence = sanitizer.order().sequence(blocks, sanitizer.launches());
            if let Some(seed) = sanitizer.interleave() {
                let seed = seed ^ sanitizer.launches().rotate_left(32);
                TurnScheduler::run(sequence, seed, |block, scheduler, slot| {
                    run(block, &BlockObserver::new(sanitizer, Some((scheduler, slot)), &looks));
                });
            } else {
                let all = || {
                    sequence
                        .into_iter()
                        .for_each(|block| run(block, &BlockObserver::new(sanitizer, None, &looks)))
                };
                turns::to_its_end(all).unwrap_or_else(turns::pass_on);
            }
            sanitizer.verdict()?;
        } else {
            let block = |block| {
                if !looks.ends() {
                    E::run(&mut Emulated::new(block, blocks, lanes, Looking(&looks)), args);
                }
            };
            turns::to_its_end(|| self.crew.run(blocks, &block)).unwrap_or_else(turns::pass_on);
        }
        if looks.ended() { Err(Error::Interrupted) } else { Ok(()) }
    }
}

/// Memory that kernels access by address: 16-byte aligned, zeroed.
pub struct Memory {
    start: NonNull<u128>,
    len: usize,
}

// SAFETY: an allocation like a Box; only its owner accesses it, and kernels under the rules of
// `Lane`.
unsafe impl Send for Memory {}
// SAFETY: as above.
unsafe impl Sync for Memory {}

impl Memory {
    fn new(bytes: usize) -> Result<Self, Error> {
        let len = bytes.div_ceil(16).max(1);
        let layout = std::alloc::Layout::array::<u128>(len).map_err(|_| Error::Memory { bytes })?;
        // SAFETY: the layout is not empty.
        let start = unsafe { std::alloc::alloc_zeroed(layout) }.cast::<u128>();
        let start = NonNull::new(start).ok_or(Error::Memory { bytes })?;
        Ok(Memory { start, len })
    }
    /// The address that kernels use.
    pub fn addr(&self) -> u64 {
        self.start.as_ptr().expose_provenance() as u64
    }
    /// Number of bytes.
    pub fn bytes(&self) -> usize {
        16 * self.len
    }
    /// The first `bytes` bytes.
    pub fn as_slice(&self, bytes: usize) -> &[u8] {
        assert!(bytes <= self.bytes());
        // SAFETY: within the allocation, initialised from the start. No kernel writes while the
        // host reads: launches end before they return, and no other thread accesses a launch's
        // memory (`Device::launch`).
        unsafe { std::slice::from_raw_parts(self.start.as_ptr().cast(), bytes) }
    }
    /// The first `bytes` bytes, to write.
    pub fn as_mut_slice(&mut self, bytes: usize) -> &mut [u8] {
        assert!(bytes <= self.bytes());
        // SAFETY: as above, and the borrow is exclusive.
        unsafe { std::slice::from_raw_parts_mut(self.start.as_ptr().cast(), bytes) }
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        // The layout was valid in `new`, so it is now.
        let layout = std::alloc::Layout::array::<u128>(self.len).expect("a valid layout");
        // SAFETY: allocated in `new` with this layout, freed once.
        unsafe { std::alloc::dealloc(self.start.as_ptr().cast(), layout) }
    }
}
