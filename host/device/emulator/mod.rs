//! The card, emulated: as an engine (all cores, no checks) or as a microscope (any order, every access watched).

mod baton;
mod block;
mod coherent;
mod eye;
mod microscope;
mod order;
mod rows;
mod shadow;

pub use microscope::{Fault, Microscope, Place};
pub use order::Order;

use crate::error::Error;
use baton::Baton;
use block::{Blind, Emulated};
use eye::Eye;
use nearmiss_kernels::entry::Entry;
use rayon::prelude::*;
use std::ptr::NonNull;

/// How the emulator runs.
#[derive(Clone, Copy, Debug, Default)]
pub enum Mode {
    /// Blocks in parallel on all cores, lanes in order, nothing watched. What people without a card use.
    #[default]
    Engine,
    /// One block after the other, each to its end, blocks and lanes in the given order (or interleaved, see
    /// [`Emulator::with_interleave`]); races, bounds, unwritten memory and waits without end are watched.
    Microscope(Order),
}

/// A CPU that runs the kernels.
pub struct Emulator {
    pool: Option<rayon::ThreadPool>,
    microscope: Option<Microscope>,
    lanes: Option<u32>,
}

impl Emulator {
    /// An engine on `threads` threads, or on all cores; or a microscope, always on one thread.
    ///
    /// # Errors
    /// [`Error::Device`] when the threads cannot be started.
    pub fn new(mode: Mode, threads: Option<usize>) -> Result<Self, Error> {
        let pool = match threads {
            None => None,
            Some(n) => {
                Some(rayon::ThreadPoolBuilder::new().num_threads(n).build().map_err(|e| Error::Device {
                    what: format!("starting {n} threads"),
                    text: e.to_string(),
                    advice: "ask for fewer with --threads",
                })?)
            }
        };
        let microscope = match mode {
            Mode::Engine => None,
            Mode::Microscope(order) => Some(Microscope::new(order, None)),
        };
        Ok(Emulator { pool, microscope, lanes: None })
    }

    /// The same emulator with blocks of another size: answers must not depend on it.
    pub fn with_lanes(self, lanes: u32) -> Self {
        Emulator { lanes: Some(lanes), ..self }
    }

    /// The same microscope, with blocks that interleave: up to 64 run at once, one of them moves at a time, and at the
    /// ends of phases and at some accesses that blocks may share (atomics, gives, takes) another goes on, drawn by the
    /// seed. For kernels whose blocks work together in a launch. Cost: microseconds a change. The engine is as it was.
    pub fn with_interleave(self, seed: u64) -> Self {
        let microscope = self.microscope.map(|microscope| Microscope::new(microscope.order(), Some(seed)));
        Emulator { microscope, ..self }
    }

    /// How many threads run blocks.
    pub fn threads(&self) -> usize {
        match (&self.microscope, &self.pool) {
            (Some(_), _) => 1,
            (None, Some(pool)) => pool.current_num_threads(),
            (None, None) => rayon::current_num_threads(),
        }
    }

    /// Lanes of a block of a kernel.
    pub fn lanes<E: Entry>(&self) -> u32 {
        self.lanes.unwrap_or(E::LANES)
    }

    /// The microscope, if this is one.
    pub fn microscope(&self) -> Option<&Microscope> {
        self.microscope.as_ref()
    }

    /// Takes memory of at least `bytes`: zeroed for the engine, poisoned under the microscope.
    ///
    /// # Errors
    /// [`Error::Room`] when the machine has no more.
    pub fn memory(&self, bytes: usize) -> Result<Memory, Error> {
        crate::memory::require("host memory", bytes as u64)?;
        let memory = Memory::new(bytes)?;
        if let Some(microscope) = &self.microscope {
            // SAFETY: the memory is ours, just made, and has that many bytes.
            unsafe { memory.start.cast::<u8>().write_bytes(microscope::POISON, memory.bytes()) };
            microscope.adopt(memory.addr(), memory.bytes());
        }
        Ok(memory)
    }

    /// Runs every block of a launch.
    ///
    /// # Errors
    /// Under the microscope, [`Error::Bug`] with the first access that broke a rule.
    ///
    /// # Panics
    /// When the kernel does.
    pub fn launch<E: Entry>(&self, blocks: u32, args: &E::Args) -> Result<(), Error> {
        let lanes = self.lanes::<E>();
        if let Some(microscope) = &self.microscope {
            microscope.begin(E::NAME);
            let run = |block, eye: &Eye| E::run(&mut Emulated::new(block, blocks, lanes, eye), args);
            let sequence = microscope.order().sequence(blocks, microscope.launches());
            if let Some(seed) = microscope.interleave() {
                let seed = seed ^ microscope.launches().rotate_left(32);
                Baton::run(sequence, seed, |block, baton, seat| {
                    run(block, &Eye::new(microscope, Some((baton, seat))));
                });
            } else {
                let all = || sequence.into_iter().for_each(|block| run(block, &Eye::new(microscope, None)));
                baton::to_its_end(all).unwrap_or_else(baton::pass_on);
            }
            return microscope.verdict();
        }
        let run = || {
            let block = |block| E::run(&mut Emulated::new(block, blocks, lanes, Blind), args);
            // One block is not worth a thread's waking up.
            if blocks == 1 { block(0) } else { (0..blocks).into_par_iter().for_each(block) }
        };
        match &self.pool {
            Some(pool) => pool.install(run),
            None => run(),
        }
        Ok(())
    }
}

/// Memory that kernels reach by address: 16-byte aligned, zeroed.
pub struct Memory {
    start: NonNull<u128>,
    len: usize,
}

// SAFETY: an allocation like a Box; all access goes through the owner or through kernels under the rules of `Lane`.
unsafe impl Send for Memory {}
// SAFETY: as above.
unsafe impl Sync for Memory {}

impl Memory {
    fn new(bytes: usize) -> Result<Self, Error> {
        let len = bytes.div_ceil(16).max(1);
        let layout = std::alloc::Layout::array::<u128>(len).map_err(|_| Error::Room {
            what: "host memory".into(),
            asked: bytes as u64,
            given: isize::MAX as u64,
        })?;
        // SAFETY: the layout is not empty.
        let start = unsafe { std::alloc::alloc_zeroed(layout) }.cast::<u128>();
        let start = NonNull::new(start).ok_or(Error::Room {
            what: "host memory".into(),
            asked: bytes as u64,
            given: 0,
        })?;
        Ok(Memory { start, len })
    }
    /// The address that kernels use.
    pub fn addr(&self) -> u64 {
        self.start.as_ptr().expose_provenance() as u64
    }
    /// How many bytes there are.
    pub fn bytes(&self) -> usize {
        16 * self.len
    }
    /// The first `bytes` bytes.
    pub fn as_slice(&self, bytes: usize) -> &[u8] {
        assert!(bytes <= self.bytes());
        // SAFETY: within the allocation, initialised from the start, and no kernel runs while the host reads
        // (launches end before they return).
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
        let layout = std::alloc::Layout::array::<u128>(self.len).expect("a layout that was valid before");
        // SAFETY: allocated in `new` with this layout, freed once.
        unsafe { std::alloc::dealloc(self.start.as_ptr().cast(), layout) }
    }
}
