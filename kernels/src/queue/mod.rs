//! Work units that wait: the stack of one walk, a block's buffer, a block's queue; the tree that pairs
//! of nodes form; and the tests of pairs of triangles.

pub mod bvtt;
pub mod listing;
pub mod pair;
pub mod waiting;
pub mod worker;

use crate::abi::Pair;
use crate::bvh::MAX_LEVELS;
use crate::exec::{Lane, Shared};
use core::mem::MaybeUninit;

/// Entries that a walk's stack can need: one waiting sibling a level.
pub const ROOM: usize = MAX_LEVELS as usize;

/// The memory of a stack; see [`crate::exec::Block::words`].
pub type Words = [MaybeUninit<u32>; ROOM];

/// A stack of work that cannot overflow: a depth-first walk leaves at most one sibling a level
/// behind. Between phases its words and its length are in slots of their own. So nothing copies the
/// words.
pub struct Stack<'a> {
    words: &'a mut Words,
    len: &'a mut u32,
}

impl<'a> Stack<'a> {
    /// A stack of the first `len` entries of `words`.
    ///
    /// # Safety
    /// As many were pushed to these words, and a walk pushes no more than [`ROOM`]: a tree has at
    /// most [`MAX_LEVELS`] levels.
    #[inline(always)]
    pub unsafe fn new(words: &'a mut Words, len: &'a mut u32) -> Self {
        Stack { words, len }
    }
    /// How many entries wait.
    #[inline(always)]
    pub fn len(&self) -> u32 {
        *self.len
    }
    /// Whether the stack is empty.
    #[inline]
    pub fn is_empty(&self) -> bool {
        *self.len == 0
    }
    /// Adds an entry.
    #[inline]
    pub fn push(&mut self, item: u32) {
        debug_assert!((*self.len as usize) < ROOM);
        // SAFETY: a walk holds at most ROOM entries, as the caller of `new` promised.
        unsafe { self.words.get_unchecked_mut(*self.len as usize).write(item) };
        *self.len += 1;
    }
    /// Drops all entries.
    #[inline]
    pub fn clear(&mut self) {
        *self.len = 0;
    }
    /// Takes the entry that was added last.
    #[inline]
    pub fn pop(&mut self) -> Option<u32> {
        if *self.len == 0 {
            return None;
        }
        *self.len -= 1;
        // SAFETY: entries below `len` were written by `push`, and len was at least 1.
        Some(unsafe { self.words.get_unchecked(*self.len as usize).assume_init() })
    }
}

/// A block's buffer of pairs in shared memory. Lanes append at any time; when it is full they wait
/// for a flush.
#[derive(Clone, Copy)]
pub struct Buffer {
    /// The pairs.
    pub pairs: Shared<[u32; 2]>,
    /// One word: the number of pairs put in, past the end too.
    pub fill: Shared<u32>,
}

impl Buffer {
    /// Takes places for `count` pairs. Returns the first, which may be past the end.
    #[inline]
    pub fn take<L: Lane>(&self, lane: &L, count: u32) -> u32 {
        lane.shared_add(self.fill, 0, count)
    }
    /// Puts a pair in its place; false if that is past the end.
    #[inline]
    pub fn put<L: Lane>(&self, lane: &L, place: u32, pair: Pair) -> bool {
        let room = place < self.pairs.len;
        if room {
            lane.put(self.pairs, place, [pair.a, pair.b]);
        }
        room
    }
    /// A pair that was put in.
    #[inline]
    pub fn get<L: Lane>(&self, lane: &L, i: u32) -> Pair {
        let [a, b] = lane.get(self.pairs, i);
        Pair { a, b }
    }
}
