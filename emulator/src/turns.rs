//! Blocks that interleave. Each runs on a thread of its own, and moves only while it has the turn.
//! It passes the turn on at the end of each phase and reservation. It also does so at some atomics,
//! relaxed stores and loads. A number determines the next block. Blocks differ in speed by up to
//! 256 times. At one pace a block would hardly ever be far behind or ahead of the others. Such
//! distances find faults.
//!
//! At most [`SLOTS`] blocks run at once, as on a GPU: the next one starts when one ends. So that
//! number alone determines a launch. Blocks that all wait for one that has not started wait for
//! ever.

use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use std::any::Any;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Number of blocks that run at once.
pub const SLOTS: usize = 64;
/// One in this number of atomics, relaxed stores and loads passes the turn on.
const PASSES: u32 = 4;
/// One in this number of passes changes a block's speed.
const CHANGES: u32 = 64;

/// The panic that ends a block early: the fault has been recorded, and the panic is not reported.
pub struct Stop;

impl Stop {
    /// Leaves the kernel.
    pub fn now() -> ! {
        resume_unwind(Box::new(Stop))
    }
}

/// Runs a block. The error is its panic, also if it was stopped.
pub fn to_its_end(block: impl FnOnce()) -> Result<(), Box<dyn Any + Send>> {
    // A stopped kernel leaves device memory half changed; the launch has failed.
    catch_unwind(AssertUnwindSafe(block))
}

/// Passes on the panic of a kernel, except that of a stop.
pub fn pass_on(panic: Box<dyn Any + Send>) {
    if !panic.is::<Stop>() {
        resume_unwind(panic);
    }
}

/// The schedule of turns.
pub struct TurnScheduler {
    state: Mutex<State>,
    /// A condition variable for each slot, signalled at its turn.
    bells: Vec<Condvar>,
}

struct State {
    random: SmallRng,
    /// The block that has the turn.
    holder: usize,
    /// Speed of the block of each slot; 0 if there is none.
    pace: Vec<u32>,
    /// Blocks that have not started.
    waiting: VecDeque<u32>,
    /// The panic that stops the launch early.
    panic: Option<Box<dyn Any + Send>>,
}

impl State {
    /// A random speed for a block.
    fn draw_pace(&mut self) -> u32 {
        4u32.pow(self.random.random_range(0..=4))
    }
    /// The next block to move; `None` if no block is left.
    fn draw(&mut self) -> Option<usize> {
        let all: u32 = self.pace.iter().sum();
        if all == 0 {
            return None;
        }
        let mut at = self.random.random_range(0..all);
        self.pace.iter().position(|pace| match at.checked_sub(*pace) {
            None => true,
            Some(rest) => {
                at = rest;
                false
            }
        })
    }
}

impl TurnScheduler {
    /// Runs blocks, which start in the order of `blocks`. `run` gets the block, the scheduler and
    /// the block's slot.
    pub fn run(blocks: Vec<u32>, seed: u64, run: impl Fn(u32, &TurnScheduler, usize) + Sync) {
        let slots = blocks.len().min(SLOTS);
        if slots == 0 {
            return;
        }
        let mut state = State {
            random: SmallRng::seed_from_u64(seed),
            holder: 0,
            pace: Vec::new(),
            waiting: blocks.into(),
            panic: None,
        };
        state.pace = (0..slots).map(|_| state.draw_pace()).collect();
        state.holder = state.draw().expect("a block is seated");
        let scheduler =
            TurnScheduler { state: Mutex::new(state), bells: (0..slots).map(|_| Condvar::new()).collect() };
        std::thread::scope(|scope| {
            for slot in 0..slots {
                let (scheduler, run) = (&scheduler, &run);
                scope.spawn(move || scheduler.occupy(slot, run));
            }
        });
        let state = scheduler.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        state.panic.into_iter().for_each(pass_on);
    }

    /// Runs block after block in a slot.
    fn occupy(&self, slot: usize, run: &impl Fn(u32, &TurnScheduler, usize)) {
        drop(self.wait(slot, self.state()));
        loop {
            let Some(block) = self.state().waiting.pop_front() else { break };
            if let Err(panic) = to_its_end(|| run(block, self, slot)) {
                let mut state = self.state();
                state.waiting.clear();
                state.panic.get_or_insert(panic);
            }
        }
        let mut state = self.state();
        state.pace[slot] = 0;
        if let Some(next) = state.draw() {
            state.holder = next;
            self.bells[next].notify_one();
        }
    }

    /// Passes the turn to a block drawn from all that run, and returns when it comes back.
    pub fn pass(&self, slot: usize) {
        let state = self.state();
        self.pass_from(slot, state);
    }
    /// Passes the turn, or keeps it.
    pub fn may_pass(&self, slot: usize) {
        let mut state = self.state();
        if state.random.random_ratio(1, PASSES) {
            self.pass_from(slot, state);
        }
    }
    fn pass_from(&self, slot: usize, mut state: MutexGuard<'_, State>) {
        if state.random.random_ratio(1, CHANGES) {
            state.pace[slot] = state.draw_pace();
        }
        state.holder = state.draw().expect("this block is seated");
        self.bells[state.holder].notify_one();
        let state = self.wait(slot, state);
        if state.panic.is_some() {
            drop(state);
            Stop::now();
        }
    }
    fn wait<'a>(&self, slot: usize, mut state: MutexGuard<'a, State>) -> MutexGuard<'a, State> {
        while state.holder != slot {
            state = self.bells[slot].wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state
    }
    fn state(&self) -> MutexGuard<'_, State> {
        // No code of a kernel runs while the lock is held.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
