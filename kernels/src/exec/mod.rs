//! The machine, for a kernel: blocks of lanes, memory, barriers.
//!
//! A kernel is a plain function over a [`Block`], a sequence of *phases*. The body of a phase runs
//! once for each lane. The end of a phase is the block's barrier, so no lane can skip one. Code
//! between phases is the same for all lanes. The GPU runs it in every lane, the emulator once. So
//! it has uniform values only. A value of a lane that lives across phases is in a [`Slot`] or in
//! [`Shared`] words. A slot is a register on the GPU and an array on the CPU.
//!
//! A barrier for the whole grid is the same one level up: the end of the launch.
//!
//! Blocks of one launch communicate by [`Lane::store_relaxed`], [`Lane::load_relaxed`] and atomics,
//! ordered by [`Lane::fence`] or [`Block::ticket`].
//!
//! **The law of giving.** A lane stores values, then calls `fence`, then changes a flag by an
//! atomic. Another lane reads the new flag by an atomic, then calls `fence`. Now it may load these
//! values. A barrier extends this within a block at both ends: to values stored by its lanes in
//! earlier phases, and to loads by its lanes in later ones.
//!
//! **The law of waiting.** To wait is to poll a flag by [`Lane::fetch_load`] or
//! [`Lane::compare_exchange`] until it changes. A lane may wait only for another lane's later step
//! in the same phase. Before it waits, it must have read an atomic of that lane, a reservation for
//! example. That step must not wait itself. No lane waits for the end of a phase, nor for a block
//! that may not have started: blocks may run in sequence.

pub mod entries;
mod memory;
mod output;
pub mod ptx;

pub use memory::{Shared, Word, whole_words};
pub use ptx::ALONE;

use crate::abi::Span;
use bytemuck::{Pod, Zeroable};
use core::mem::MaybeUninit;
use core::ops::Range;

/// One lane of a block, inside a phase: its number and its access to memory.
///
/// Memory is read and written by value; no reference to memory of another lane exists. Suppose two
/// lanes access one word by plain accesses, and one of them writes. Then the accesses must be in
/// different phases (one block) or different launches (two blocks). Atomic accesses, relaxed stores
/// and relaxed loads may meet each other. One of them and a plain access may meet if neither
/// writes. The emulator's sanitizer checks these rules and all bounds.
pub trait Lane {
    /// The lane's number in its block, from 0.
    fn lane(&self) -> u32;
    /// The lane's number in the launch, from 0.
    fn global(&self) -> u32;

    /// Element `i` of device memory.
    fn read<T: Pod>(&self, span: Span<T>, i: u32) -> T;
    /// Prefetches element `i` of device memory. It helps if lanes run in sequence; it does nothing
    /// on a GPU.
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

    /// Sets element `i` of device memory for other blocks of this launch to
    /// [read](Lane::load_relaxed). The law of giving applies (see the [module](self)). Orders
    /// nothing by itself. Two stores of an element may meet, and a load may meet a store. Then each
    /// piece of `T`'s alignment, of 8 bytes at most, is whole, but pieces may be of different
    /// values. `T` is made of [whole words](whole_words), and an element is stored and loaded as
    /// the same `T`.
    fn store_relaxed<T: Pod>(&self, span: Span<T>, i: u32, value: T);
    /// Element `i` of device memory as another block of this launch gave it: read afresh each time.
    fn load_relaxed<T: Pod>(&self, span: Span<T>, i: u32) -> T;
    /// Orders all stores, loads and atomics of this lane before it against those after it. The
    /// order holds for all lanes of the launch. Atomics by themselves order nothing. Plain accesses
    /// of other blocks remain races.
    fn fence(&self);

    /// True if `mine` is; it may also be true while another lane's is. On a GPU the lanes of a warp
    /// meet here. Lanes that took different paths continue side by side, and leave together a loop
    /// with this condition. All lanes of a warp must come. Only speed may depend on it: lanes that
    /// run in sequence have only their own value.
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
/// Each lane of a GPU applies it to its row. A CPU collects rows first and maps many at once, in a
/// loop that its compiler can vectorize. So everything that [`RowMap::at_once`] calls is inlined,
/// arrays are filled by index, and no branch matters.
pub trait RowMap {
    /// The number that rows are made of.
    type Number: Pod;
    /// A row, as read from memory: a whole number of [`RowMap::Number`]s.
    type Row: Pod;
    /// The result for a row, or [`OPEN`] if that takes branches. To be `#[inline(always)]`.
    fn at_once(&self, row: Self::Row) -> u32;
    /// Whether rows of f64 whose numbers are all f32 are mapped by [`RowMap::single_at_once`].
    const HAS_SINGLES: bool = false;
    /// Whether a row is such a one.
    #[inline(always)]
    fn is_single(&self, _: &Self::Row) -> bool {
        false
    }
    /// The result for such a row, with the bits of the same row in f32. To be `#[inline(always)]`.
    #[inline(always)]
    fn single_at_once(&self, row: Self::Row) -> u32 {
        self.at_once(row)
    }
    /// The result for a row.
    #[inline(always)]
    fn apply(&self, row: Self::Row) -> u32 {
        if Self::HAS_SINGLES && self.is_single(&row) { self.single_at_once(row) } else { self.at_once(row) }
    }
}

/// A test of two items, without memory. A lane of a GPU tests one pair at a time. A CPU tests many
/// at once, in a loop that its compiler can vectorize: so no branch matters, and everything that
/// the test calls is inlined.
pub trait PairTest {
    /// The type of both: whole words of four bytes, at most 16.
    type Item: Pod;
    /// The test. To be `#[inline(always)]`.
    fn test(a: &Self::Item, b: &Self::Item) -> bool;
}

/// A lane's own item of [`Block::cross_own`].
#[derive(Clone, Copy)]
pub struct Own<T> {
    /// The item.
    pub item: T,
    /// Its name.
    pub name: u32,
    /// Other items are tested with it that have smaller numbers.
    pub end: u32,
}

/// The items of a block: `first` and each `step` further one, up to `end`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Number of the first item.
    pub first: u32,
    /// Distance of its next one.
    pub step: u32,
    /// The item behind the last.
    pub end: u32,
}

impl Share {
    /// Items of a block that strides over all, `each` at a time.
    #[inline(always)]
    pub fn striding<B: Block>(block: &B, count: u32, each: u32) -> Share {
        Share { first: block.block() * each, step: block.blocks() * each, end: count }
    }
    /// Whether there are none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.first >= self.end
    }
}

/// The result for a row is still open.
pub const OPEN: u32 = u32::MAX;

/// A block of lanes: the phases of a kernel and the steps that its lanes take together.
pub trait Block {
    /// The argument of a phase's body.
    type Lane: Lane;
    /// A value of each lane.
    type Slot<T: Copy>: Slot<T, Self::Lane>;

    /// The block's number in the launch.
    fn block(&self) -> u32;
    /// How many blocks the launch has.
    fn blocks(&self) -> u32;
    /// How many lanes a block has: a multiple of 32 on the GPU.
    fn lanes(&self) -> u32;

    /// The share of this block of `count` items, `each` at a time. On a GPU blocks stride, so that
    /// neighbours are tested at the same time. Blocks that run one after another have neighbours.
    #[inline(always)]
    fn share(&self, count: u32, each: u32) -> Share
    where
        Self: Sized,
    {
        Share::striding(self, count, each)
    }

    /// Takes `len` words of the launch's shared memory; uninitialised.
    fn shared<T: Word>(&mut self, len: u32) -> Shared<T>;
    /// Gives each lane a value that lives across phases.
    fn slot<T: Copy>(&self, init: T) -> Self::Slot<T>;
    /// Gives each lane words that live across phases and begin unwritten.
    fn words<const N: usize>(&self) -> Self::Slot<[MaybeUninit<u32>; N]>;
    /// Runs `body` once for each lane; returns when all are done.
    fn phase(&mut self, body: impl FnMut(&Self::Lane));

    /// A phase in steps. Each lane finds its row, or none. It gathers the row, or leaves it
    /// [`OPEN`]. Rows are mapped. Each lane receives the result of its row. If lanes run in
    /// sequence, all take a step before the first takes the next: so many memory accesses overlap.
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

    /// A phase in which each lane tests numbered items, for blocks of one warp. A test that holds
    /// gives a value; `put` receives it with its place, counted from `first` by items, then by
    /// lanes. All lanes test an item before one of them puts, and put before the next item.
    /// Returns the place behind the last.
    fn cross<T: Copy>(
        &mut self,
        items: Range<u32>,
        first: u32,
        test: impl FnMut(&Self::Lane, u32) -> Option<T>,
        put: impl FnMut(&Self::Lane, u32, T),
    ) -> u32;

    /// [`Block::cross`] of items that all lanes can read with each lane's own. A lane's own has a
    /// name, and only items before its end are tested with it. `put` receives the place, the item's
    /// number and that name.
    #[inline(always)]
    fn cross_own<M: PairTest>(
        &mut self,
        items: Range<u32>,
        first: u32,
        item: impl Fn(&Self::Lane, u32) -> M::Item,
        mut own: impl FnMut(&Self::Lane) -> Own<M::Item>,
        put: impl FnMut(&Self::Lane, u32, [u32; 2]),
    ) -> u32 {
        let test = |lane: &Self::Lane, k| {
            let own = own(lane);
            (M::test(&own.item, &item(lane, k)) & (k < own.end)).then_some([k, own.name])
        };
        self.cross(items, first, test, put)
    }

    /// A phase in which lanes below `count` test something, for blocks of one warp: whether it
    /// holds, and a value. Those for which it holds then put their values, with places from 0 in the
    /// order of lanes. All test before one puts. Returns how many put.
    #[inline(always)]
    fn select<T: Copy>(
        &mut self,
        count: u32,
        mut test: impl FnMut(&Self::Lane) -> (bool, T),
        put: impl FnMut(&Self::Lane, u32, T),
    ) -> u32 {
        let test = |lane: &Self::Lane, _| {
            if lane.lane() >= count {
                return None;
            }
            let (holds, value) = test(lane);
            holds.then_some(value)
        };
        self.cross(0..1, 0, test, put)
    }

    /// [`Block::select`] by a test of an item with each lane's own, which lies in device memory by
    /// columns: word `k` of lane `i` is number `first + 32 k + i`. Nothing in this launch may write
    /// it.
    #[inline(always)]
    fn select_columns<M: PairTest>(
        &mut self,
        columns: Span<u32>,
        first: u32,
        other: &M::Item,
        mut put: impl FnMut(&Self::Lane, u32),
    ) -> u32 {
        let test = |lane: &Self::Lane| (M::test(&own::<M, _>(lane, columns, first), other), ());
        self.select(WARP, test, |lane, place, ()| put(lane, place))
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
    /// Adds `count` to a counter once for the whole block; the value before. No atomic, and 0, if
    /// `count` is 0.
    ///
    /// It orders nothing between blocks, even if each lane has called [`Lane::fence`] in the phase
    /// before: a fence speaks for the atomics of its own lane, and here only lane 0 has one.
    /// [`Block::ticket`] does order.
    fn reserve(&mut self, counter: Span<u64>, i: u32, count: u64) -> u64;
    /// [`Block::reserve`] of two counters, each the first of its span, in the time of one.
    fn reserve_both(&mut self, [one, two]: [Span<u64>; 2], [count, other]: [u64; 2]) -> [u64; 2] {
        [self.reserve(one, 0, count), self.reserve(two, 0, other)]
    }
    /// Adds one to a counter once for the whole block. It orders the blocks: lanes of this block
    /// may load what lanes of all blocks stored before they drew smaller tickets. The block with
    /// the last ticket can rely on all others being past theirs. Lanes need no fence for it. Cost:
    /// an atomic and two fences of one lane.
    fn ticket(&mut self, counter: Span<u64>, i: u32) -> u64;
    /// Ranks the block's digits, `K` a lane in the order of [`striped`]. The effect is as if each
    /// digit in turn took `bins[digit]` and added one to it. Each digit is replaced by the value
    /// that it took. Digits of [`BINS`] and more take nothing. `scratch` has `BINS * lanes / 32`
    /// words.
    fn ranks<const K: usize>(
        &mut self,
        digits: &mut Self::Slot<[u32; K]>,
        bins: Shared<u32>,
        scratch: Shared<u32>,
    );

    /// Room in a list for the entries that the lanes append: replaces each lane's wish by the
    /// number of entries before its own, and returns the start of the block's entries. The counter
    /// goes past the end of the list, so that its final value is the exact demand.
    fn append(&mut self, wishes: &mut Self::Slot<u32>, counter: Span<u64>, i: u32) -> u64 {
        let total = self.scan(wishes);
        self.reserve(counter, i, total as u64)
    }
}

/// A lane's item, from columns in device memory.
#[inline(always)]
pub fn own<M: PairTest, L: Lane>(lane: &L, columns: Span<u32>, first: u32) -> M::Item {
    let mut item = M::Item::zeroed();
    let words: &mut [u32] = bytemuck::cast_slice_mut(core::slice::from_mut(&mut item));
    for (k, word) in words.iter_mut().enumerate() {
        *word = lane.read(columns, first + k as u32 * WARP + lane.lane());
    }
    item
}

/// How many bins [`Block::ranks`] has: one for each value of a byte.
pub const BINS: u32 = 256;
/// Lanes of a warp, on every GPU.
pub const WARP: u32 = 32;

/// The place of a lane's item `k` among the block's, `each` a lane: warps one after the other, and
/// in a warp all first items, then all second ones. So a warp's accesses are neighbours, and the
/// items that it ranks by itself are contiguous.
pub const fn striped(lane: u32, lanes: u32, k: u32, each: u32) -> u32 {
    let before = lane / WARP * WARP;
    let width = if lanes - before < WARP { lanes - before } else { WARP };
    before * each + k * width + (lane - before)
}
