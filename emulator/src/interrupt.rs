//! Interruption of work: a flag that any thread sets, and that work polls between blocks and
//! phases.

use crate::listen::listen;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering::Relaxed};

/// Work goes on.
const CALM: u32 = 0;
/// Work ends at its next poll.
const TRIGGERED: u32 = 1;
/// Polls are counted, and the last one triggers.
const COUNTING: u32 = 2;

/// The shared state of clones.
struct State {
    stage: AtomicU32,
    /// Polls until it triggers; valid only while they are counted.
    left: AtomicU64,
}

static NEVER: State = State::new();

impl State {
    const fn new() -> State {
        State { stage: AtomicU32::new(CALM), left: AtomicU64::new(0) }
    }

    /// Whether work is to end.
    #[inline(always)]
    fn ends(&self) -> bool {
        self.stage.load(Relaxed) != CALM && self.ends_now()
    }

    #[cold]
    fn ends_now(&self) -> bool {
        if self.stage.load(Relaxed) == COUNTING {
            let less = |left: u64| left.checked_sub(1);
            match self.left.fetch_update(Relaxed, Relaxed, less) {
                Ok(left) if left > 1 => return false,
                _ => self.stage.store(TRIGGERED, Relaxed),
            }
        }
        self.stage.load(Relaxed) == TRIGGERED
    }
}

/// A handle that ends work of another thread. Clones are one handle.
///
/// Work reads it between launches, slices and blocks, on a CPU also between the phases of a block.
/// It ends within milliseconds. [`Interrupt::trigger`] concerns the running call or, if there is
/// none, the next one. The call that ends early clears the handle.
#[derive(Clone)]
pub struct Interrupt(Arc<State>);

impl Default for Interrupt {
    fn default() -> Self {
        Interrupt::new()
    }
}

impl std::fmt::Debug for Interrupt {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Interrupt").field("is_triggered", &self.is_triggered()).finish()
    }
}

impl Interrupt {
    /// A handle that ends nothing yet.
    pub fn new() -> Interrupt {
        Interrupt(Arc::new(State::new()))
    }

    /// Ends the running call, or else the next one. One atomic store: safe in a signal handler.
    pub fn trigger(&self) {
        self.0.stage.store(TRIGGERED, Relaxed);
    }

    /// Clears a trigger that has ended no call yet.
    pub fn clear(&self) {
        self.0.stage.store(CALM, Relaxed);
    }

    /// Whether the handle was triggered and has ended no call yet.
    pub fn is_triggered(&self) -> bool {
        self.0.stage.load(Relaxed) == TRIGGERED
    }

    /// Triggers at the poll of that number, counted from 1. Tests end work at the same place each
    /// time with it.
    #[doc(hidden)]
    pub fn trigger_at(&self, look: u64) {
        self.0.left.store(look, Relaxed);
        self.0.stage.store(COUNTING, Relaxed);
    }

    /// Polls left until [`Interrupt::trigger_at`] triggers.
    #[doc(hidden)]
    pub fn looks_left(&self) -> u64 {
        self.0.left.load(Relaxed)
    }

    /// Whether both are clones of one handle.
    pub fn is(&self, other: &Interrupt) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// The polls of one piece of work. Once a poll has ended the work, it stays ended, even if the
/// handle is cleared meanwhile.
pub struct Looks<'a> {
    state: &'a State,
    ended: AtomicBool,
}

impl<'a> Looks<'a> {
    /// Polls for work that `interrupt` may end; `None` for no handle. This thread listens first.
    pub fn new(interrupt: Option<&'a Interrupt>) -> Looks<'a> {
        listen();
        Looks { state: interrupt.map_or(&NEVER, |interrupt| &interrupt.0), ended: AtomicBool::new(false) }
    }

    /// Whether the work is to end here. One relaxed load until the handle is triggered.
    #[inline(always)]
    pub fn ends(&self) -> bool {
        self.state.ends() && self.end()
    }

    #[cold]
    fn end(&self) -> bool {
        self.ended.store(true, Relaxed);
        true
    }

    /// Whether a poll has ended the work.
    pub fn ended(&self) -> bool {
        self.ended.load(Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_look_ends_work_once_it_is_triggered() {
        let interrupt = Interrupt::new();
        let looks = Looks::new(Some(&interrupt));
        assert!(!looks.ends() && !interrupt.is_triggered());
        interrupt.clone().trigger();
        assert!(interrupt.is_triggered() && !looks.ended() && looks.ends());
        interrupt.clear();
        assert!(looks.ended() && !Looks::new(Some(&interrupt)).ends(), "ended work stays ended");
        assert!(!Looks::new(None).ends());
    }

    #[test]
    fn the_look_of_a_number_triggers() {
        let interrupt = Interrupt::new();
        let looks = Looks::new(Some(&interrupt));
        for at in [1, 2, 5] {
            interrupt.trigger_at(at);
            assert_eq!((1..10).position(|_| looks.ends()), Some(at as usize - 1));
            assert!(interrupt.is_triggered() && looks.ends(), "until it is cleared");
            interrupt.clear();
        }
    }
}
