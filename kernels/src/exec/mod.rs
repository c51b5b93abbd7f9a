//! The machine as a kernel sees it: blocks of lanes, memory, barriers.
//!
//! A kernel is a plain function over a [`Block`]. It is a sequence of *phases*: the body of a phase
//! runs once for each lane, and the end of a phase is the block's barrier, so no lane can skip one.
//! Code between phases is the same for all lanes (the GPU runs it in every lane, the emulator
//! once), so it can only know uniform values. What a lane must remember from one phase to the next
//! sits in a [`Slot`] (a register on the GPU, an array on the CPU) or in [`Shared`] words.
//!
//! A barrier for the whole grid is the same idea one level up: the end of the launch.
//!
//! Blocks of one launch talk to each other by [`Lane::store_relaxed`], [`Lane::load_relaxed`] and
//! atomics, ordered by [`Lane::fence`] or [`Block::ticket`]. **The law of giving:** what a lane
//! gives before a `fence` and then an atomic on a flag, a lane that saw the flag's new value by an
//! atomic and then called `fence` may take. A barrier passes this on within a block, at both ends:
//! what its lanes gave in earlier phases, and what its lanes may take in later ones. **The law of
//! waiting:** a lane may wait (look at a flag by [`Lane::fetch_load`] or [`Lane::compare_exchange`]
//! until it changes) only for what a lane of which an atomic was seen, a reservation for example,
//! does further on in the same phase, without waiting itself. Nobody waits for the end of a phase,
//! nor for a block that may not have started: blocks may run one after the other.

mod memory;
mod output;
pub mod ptx;

pub use memory::{Shared, Word, whole_words};
pub use ptx::ALONE;

use crate::abi::Span;
use bytemuck::Pod;
use core::mem::MaybeUninit;

/// One lane of a block, inside a phase: its number and its hands on memory.
///
/// Memory is read and written by value; nobody holds a reference to what another lane can reach.
/// Plain accesses to one word by two lanes, one of them writing, must lie in different phases (one
/// block) or different launches (two blocks); atomic accesses, relaxed stores and loads may meet
/// each other, but not plain ones of which one writes. The emulator's sanitizer checks these rules
/// and all bounds.
pub trait Lane {
    /// The lane's number in its block, from 0.
    fn lane(&self) -> u32;
    /// The lane's number in the launch, from 0.
    fn global(&self) -> u32;

    /// Element `i` of device memory.
    fn read<T: Pod>(&self, span: Span<T>, i: u32) -> T;
    /// Element `i` of device memory will be read soon. Where lanes run one after another their
    /// memory can be on its way before they come to it; nothing to a GPU.
    #[inline(always)]
    fn expect<T: Pod>(&self, _span: Span<T>, _i: u32) {}
    /// Sets element `i` of device memory.
    fn write<T: Pod>(&self, span: Span<T>, i: u32, value: T);
    /// Atomic maximum on device memory.
    fn fetch_max(&self, span: Span<u64>, i: u32, value: u64);
    /// Atomic minimum on device memory.
    fn fetch_min(&self, span: Span<u64>, i: u32, value: u64);
    /// Atomic addition on device memory; the value before.
    fn fetch_add(&self, span: Span<u64>, i: u32, value: u64) -> u64;
    /// Atomic read of device memory.
    fn fetch_load(&self, span: Span<u64>, i: u32) -> u64;
    /// Atomically sets device memory; the value before.
    fn exchange(&self, span: Span<u64>, i: u32, value: u64) -> u64;
    /// Atomically sets device memory to `new` if it holds `current`; the value before. It never
    /// fails without cause.
    fn compare_exchange(&self, span: Span<u64>, i: u32, current: u64, new: u64) -> u64;

    /// Sets element `i` of device memory so that other blocks of this launch may
    /// [read](Lane::load_relaxed) it, under the law of relaxed stores (see the [module](self)).
    /// Orders nothing by itself. Two of an element may meet, and a load may meet a store: then
    /// pieces of `T`'s alignment, of 8 bytes at most, are whole, and not all need be of one value.
    /// `T` is made of [whole words](whole_words), and an element is given and taken as the same
    /// `T`.
    fn store_relaxed<T: Pod>(&self, span: Span<T>, i: u32, value: T);
    /// Element `i` of device memory as another block of this launch gave it: read afresh each time.
    fn load_relaxed<T: Pod>(&self, span: Span<T>, i: u32) -> T;
    /// Orders what this lane gave, took and did by atomics before it against what it does after, as
    /// seen by all lanes of the launch. Atomics by themselves order nothing. Plain accesses of
    /// other blocks stay races all the same.
    fn fence(&self);

    /// True if `mine` is; and it may be true if it is not, while another lane's is. On a GPU the
    /// lanes of a warp meet here: those that took different ways go on side by side, and leave a
    /// loop together of which this is the condition. All lanes of a warp must come. Nothing but
    /// speed may hang on it: lanes that run one after another know only their own.
    fn any(&self, mine: bool) -> bool;

    /// The end of a phase's body: on a GPU the lanes of a warp come together here, and the
    /// assembler cannot leave it out. For bodies whose loops lanes leave at different turns: behind
    /// these it believes that they are together, although they are not (`.ci/lanes.py` finds such
    /// places). All lanes of a warp must come. Lanes that run one after another need not.
    fn meet(&self) {}

    /// Word `i` of shared memory.
    fn get<T: Word>(&self, words: Shared<T>, i: u32) -> T;
    /// Sets word `i` of shared memory.
    fn put<T: Word>(&self, words: Shared<T>, i: u32, value: T);
    /// Atomic addition on shared memory; the value before.
    fn shared_add(&self, words: Shared<u32>, i: u32, value: u32) -> u32;
    /// Atomic maximum on shared memory.
    fn shared_max(&self, words: Shared<u64>, i: u32, value: u64);
    /// Atomic minimum on shared memory.
    fn shared_min(&self, words: Shared<u64>, i: u32, value: u64);
    /// Atomically sets a word of shared memory to `new` if it holds `current`; the value before.
    fn shared_cas(&self, words: Shared<u32>, i: u32, current: u32, new: u32) -> u32;
}

/// A value of each lane that lives across phases.
pub trait Slot<T, L> {
    /// This lane's value.
    fn of(&mut self, lane: &L) -> &mut T;
}

/// A function of a row of numbers, without memory.
///
/// A GPU's lanes each apply it to their row. A CPU collects rows first and asks for many of them at
/// once, in a loop that its compiler can turn into vectors: so everything that [`RowMap::at_once`]
/// calls is inlined, arrays are filled by index, and no branch matters.
pub trait RowMap {
    /// The number that rows are made of.
    type Number: Pod;
    /// What is read of memory: a whole number of [`RowMap::Number`]s.
    type Row: Pod;
    /// What becomes of a row, or [`OPEN`] where that takes branches. To be `#[inline(always)]`.
    fn at_once(&self, row: Self::Row) -> u32;
    /// Whether rows of f64 whose numbers are all f32 are mapped by [`RowMap::single_at_once`].
    const HAS_SINGLES: bool = false;
    /// Whether a row is such a one.
    #[inline(always)]
    fn is_single(&self, _: &Self::Row) -> bool {
        false
    }
    /// What becomes of such a row, with the bits that the same row of f32 has. To be
    /// `#[inline(always)]`.
    #[inline(always)]
    fn single_at_once(&self, row: Self::Row) -> u32 {
        self.at_once(row)
    }
    /// What becomes of a row.
    #[inline(always)]
    fn apply(&self, row: Self::Row) -> u32 {
        if Self::HAS_SINGLES && self.is_single(&row) { self.single_at_once(row) } else { self.at_once(row) }
    }
}

/// What becomes of a row is still open.
pub const OPEN: u32 = u32::MAX;

/// A block of lanes: the phases of a kernel and the steps that its lanes take together.
pub trait Block {
    /// What a phase's body is given.
    type Lane: Lane;
    /// A value of each lane.
    type Slot<T: Copy>: Slot<T, Self::Lane>;

    /// The block's number in the launch.
    fn block(&self) -> u32;
    /// How many blocks the launch has.
    fn blocks(&self) -> u32;
    /// How many lanes a block has: a multiple of 32 on the GPU.
    fn lanes(&self) -> u32;

    /// Takes `len` words of the launch's shared memory; uninitialised.
    fn shared<T: Word>(&mut self, len: u32) -> Shared<T>;
    /// Gives each lane a value that lives across phases.
    fn slot<T: Copy>(&self, init: T) -> Self::Slot<T>;
    /// Gives each lane words that live across phases and begin unwritten.
    fn words<const N: usize>(&self) -> Self::Slot<[MaybeUninit<u32>; N]>;
    /// Runs `body` once for each lane, then waits for all of them.
    fn phase(&mut self, body: impl FnMut(&Self::Lane));

    /// A phase in steps: each lane finds which row it has, or none; gathers it, or leaves it
    /// [`OPEN`]; rows are mapped; each lane is given what became of its row. Where lanes run one
    /// after another, all take a step before the first takes the next: memory answers many at once.
    #[inline(always)]
    fn map_rows<M: RowMap, T: Copy>(
        &mut self,
        map: &M,
        mut find: impl FnMut(&Self::Lane) -> Option<T>,
        mut gather: impl FnMut(&Self::Lane, T) -> Option<M::Row>,
        mut scatter: impl FnMut(&Self::Lane, Option<(T, u32)>),
    ) {
        self.phase(|l| {
            let told = find(l).map(|which| (which, gather(l, which).map_or(OPEN, |row| map.apply(row))));
            scatter(l, told);
        });
    }

    /// A uniform read of device memory, between phases. Nothing in this launch may write it.
    fn load<T: Pod>(&self, span: Span<T>, i: u32) -> T;
    /// A uniform read of shared memory, between phases; a barrier follows, so that the next phase
    /// may write the word.
    fn peek<T: Word>(&mut self, words: Shared<T>, i: u32) -> T;

    /// Whether any lane's value is true.
    fn any(&mut self, values: &mut Self::Slot<bool>) -> bool;
    /// Replaces each lane's value by the sum of those of the lanes before it; returns the sum of
    /// all.
    fn scan(&mut self, values: &mut Self::Slot<u32>) -> u32;
    /// [`Block::scan`] of zeros and ones. Cost: two instructions in a block of one warp.
    fn number(&mut self, wishes: &mut Self::Slot<u32>) -> u32 {
        self.scan(wishes)
    }
    /// Adds `count` to a counter once for the whole block; the value before. No atomic, and 0,
    /// where `count` is 0.
    ///
    /// It orders nothing between blocks, even where each lane has called [`Lane::fence`] in the
    /// phase before: a fence speaks for the atomics of its own lane, and here only lane 0 has one.
    /// [`Block::ticket`] does order.
    fn reserve(&mut self, counter: Span<u64>, i: u32, count: u64) -> u64;
    /// [`Block::reserve`] of two counters, each the first of its span, in the time of one.
    fn reserve_both(&mut self, [one, two]: [Span<u64>; 2], [count, other]: [u64; 2]) -> [u64; 2] {
        [self.reserve(one, 0, count), self.reserve(two, 0, other)]
    }
    /// Adds one to a counter once for the whole block, and orders it: what all lanes of all blocks
    /// that drew smaller tickets gave before they drew, the lanes of this block may take. The block
    /// that draws the last ticket knows that all others are past theirs. Lanes need no fence for
    /// it. Cost: an atomic and two fences of one lane.
    fn ticket(&mut self, counter: Span<u64>, i: u32) -> u64;
    /// As if the block's `K` digits a lane, in the order of [`striped`], each took `bins[digit]`
    /// and added one to it: each digit (under [`BINS`]; others take nothing) is replaced by what it
    /// took. `scratch` has `BINS * lanes / 32` words.
    fn ranks<const K: usize>(
        &mut self,
        digits: &mut Self::Slot<[u32; K]>,
        bins: Shared<u32>,
        scratch: Shared<u32>,
    );

    /// Room in a list for what the lanes want to append: replaces each lane's wish by the number of
    /// entries before its own, and returns where the block's entries begin. The counter goes past
    /// the end of the list, so that its final value is the exact demand.
    fn append(&mut self, wishes: &mut Self::Slot<u32>, counter: Span<u64>, i: u32) -> u64 {
        let total = self.scan(wishes);
        self.reserve(counter, i, total as u64)
    }
}

/// How many bins [`Block::ranks`] has: one for each value of a byte.
pub const BINS: u32 = 256;
/// Lanes of a warp, on every GPU.
pub const WARP: u32 = 32;

/// The place of a lane's item `k` among the block's, `each` a lane: warps one after the other, and
/// in a warp all first items, then all second ones. So a warp's accesses are neighbours, and what
/// it ranks by itself is one stretch.
pub const fn striped(lane: u32, lanes: u32, k: u32, each: u32) -> u32 {
    let before = lane / WARP * WARP;
    let width = if lanes - before < WARP { lanes - before } else { WARP };
    before * each + k * width + (lane - before)
}
