//! A block on the CPU: its phases are loops over its lanes.

use crate::columns::wide;
use crate::kept::{NONSENSE, OnChip, Piece};
use crate::lane::{EmulatedLane, device};
use crate::rows::{Rows, WIDTH};
use crate::sanitizer::{Access, Place};
use bytemuck::{Pod, Zeroable};
use nearmiss_kernels::abi::Span;
use nearmiss_kernels::exec::{
    BINS, Block, Lane, OPEN, Own, PairTest, RowMap, Share, Shared, Slot, WARP, Word, own,
};
use std::marker::PhantomData;
use std::mem::MaybeUninit;
use std::ops::Range;
use std::ptr::with_exposed_provenance;
use std::sync::atomic::{Ordering::SeqCst, fence};

/// The observer: [`Looking`](crate::engine::Looking) or a
/// [`BlockObserver`](crate::observer::BlockObserver).
pub trait Watch: Copy {
    /// Whether blocks stride over items, as on a GPU. Otherwise each has neighbours.
    const STRIDES: bool;
    /// The lanes of a phase, in their order.
    fn lanes(&self, count: u32, phase: u32, body: impl FnMut(u32));
    /// An access to device memory; false forbids it.
    fn device(&self, access: Access, addr: u64, bytes: usize, inside: bool, place: Place) -> bool;
    /// An access to shared memory; false forbids it.
    fn shared(&self, access: Access, offset: u32, bytes: usize, inside: bool, place: Place) -> bool;
    /// An access that might only have read, [`Access::Swap`], has changed memory.
    fn changed(&self);
    /// A lane takes part in an atomic; long phases mostly do so repeatedly.
    fn draws(&self);
    /// A barrier of the block: another block may continue.
    fn barrier(&self);
}

/// The lane of a read that all lanes make together.
const EVERY_LANE: u32 = u32::MAX;

/// A block that runs on one thread.
pub struct Emulated<W> {
    block: u32,
    blocks: u32,
    lanes: u32,
    /// Phases and collectives so far: accesses in different ones are ordered.
    phase: u32,
    /// Shared memory and other memory, and the allocated bytes of the first.
    memory: OnChip,
    words: *mut u64,
    taken: u32,
    watch: W,
}

/// One value per lane.
pub struct PerLane<T> {
    memory: Piece,
    len: usize,
    values: PhantomData<T>,
}

impl<T: Copy> PerLane<T> {
    /// Memory for values that are all put before they are read.
    fn unwritten(len: usize) -> Self {
        const { assert!(align_of::<T>() <= Piece::ALIGN) };
        PerLane { memory: Piece::new(len * size_of::<T>()), len, values: PhantomData }
    }
    fn new(init: T, len: usize) -> Self {
        let mut values = Self::unwritten(len);
        (0..len as u32).for_each(|i| values.put(i, init));
        values
    }
    #[inline(always)]
    fn put(&mut self, i: u32, value: T) {
        assert!((i as usize) < self.len);
        // SAFETY: the piece is aligned for `T` and has room for `len` of them.
        unsafe { self.memory.start().cast::<T>().add(i as usize).write(value) };
    }
    #[inline(always)]
    fn values(&mut self) -> &mut [T] {
        // SAFETY: all values are put before this is called, and nothing else has the memory.
        unsafe { std::slice::from_raw_parts_mut(self.memory.start().cast::<T>(), self.len) }
    }
}

impl<T: Copy, W> Slot<T, EmulatedLane<W>> for PerLane<T> {
    #[inline(always)]
    fn of(&mut self, lane: &EmulatedLane<W>) -> &mut T {
        &mut self.values()[lane.place.lane as usize]
    }
}

/// Rows of [`Block::cross_own`] that are tested before the first of them is put.
const ROWS: usize = 8;
/// No row.
const NO_ROW: u32 = u32::MAX;

impl<W: Watch> Emulated<W> {
    /// Block `block` of a launch.
    pub fn new(block: u32, blocks: u32, lanes: u32, watch: W) -> Self {
        let (memory, words) = (OnChip::new(), std::ptr::null_mut());
        Emulated { block, blocks, lanes, phase: 0, memory, words, taken: 0, watch }
    }
    /// The lanes of these bits put, with places from 0. Returns how many.
    #[inline(always)]
    fn put_all(&mut self, mut passes: u32, mut put: impl FnMut(&EmulatedLane<W>, u32)) -> u32 {
        let count = passes.count_ones();
        for place in 0..count {
            put(&self.lane(passes.trailing_zeros()), place);
            passes &= passes - 1;
        }
        self.phase += 1;
        self.watch.barrier();
        count
    }
    fn lane(&mut self, lane: u32) -> EmulatedLane<W> {
        EmulatedLane {
            place: Place { block: self.block, phase: self.phase, lane },
            global: self.block * self.lanes + lane,
            words: self.words,
            bytes: self.taken,
            watch: self.watch,
        }
    }
}

impl<W: Watch> Block for Emulated<W> {
    type Lane = EmulatedLane<W>;
    type Slot<T: Copy> = PerLane<T>;

    fn block(&self) -> u32 {
        self.block
    }
    fn blocks(&self) -> u32 {
        self.blocks
    }
    fn lanes(&self) -> u32 {
        self.lanes
    }
    fn shared<T: Word>(&mut self, len: u32) -> Shared<T> {
        let offset = self.taken.next_multiple_of(if size_of::<T>() > 8 { 16 } else { 8 });
        self.taken = offset + len * size_of::<T>() as u32;
        let (words, count) = (&mut self.memory.words, self.taken.div_ceil(8) as usize);
        if words.len() < count {
            words.resize(count, NONSENSE);
        }
        self.words = words.as_mut_ptr();
        Shared::at(offset, len)
    }
    fn slot<T: Copy>(&self, init: T) -> PerLane<T> {
        PerLane::new(init, self.lanes as usize)
    }
    fn words<const N: usize>(&self) -> PerLane<[MaybeUninit<u32>; N]> {
        // Words that may be unwritten are valid unwritten.
        PerLane::unwritten(self.lanes as usize)
    }
    #[inline(always)]
    fn share(&self, count: u32, each: u32) -> Share {
        if W::STRIDES {
            return Share::striding(self, count, each);
        }
        let turns = count.div_ceil(each).div_ceil(self.blocks) as u64;
        let at = |block: u32| (block as u64 * turns * each as u64).min(count as u64) as u32;
        Share { first: at(self.block), step: each, end: at(self.block + 1) }
    }
    #[inline(always)]
    fn phase(&mut self, mut body: impl FnMut(&EmulatedLane<W>)) {
        let watch = self.watch;
        watch.lanes(self.lanes, self.phase, |lane| body(&self.lane(lane)));
        self.phase += 1;
        watch.barrier();
    }
    fn map_rows<M: RowMap, T: Copy>(
        &mut self,
        map: &M,
        mut find: impl FnMut(&EmulatedLane<W>) -> Option<T>,
        mut gather: impl FnMut(&EmulatedLane<W>, T) -> Option<M::Row>,
        mut scatter: impl FnMut(&EmulatedLane<W>, Option<(T, u32)>),
    ) {
        let (watch, lanes) = (self.watch, self.lanes);
        let mut found = PerLane::unwritten(lanes as usize);
        watch.lanes(lanes, self.phase, |lane| found.put(lane, find(&self.lane(lane))));
        let mut memory = std::mem::take(&mut self.memory.rows);
        let mut rows = Rows::<M>::new(lanes as usize, &mut memory);
        // Rows of lanes that have one, without gaps.
        let (mut row_of, mut count) = (self.slot(NO_ROW), 0);
        watch.lanes(lanes, self.phase, |lane| {
            if let Some(which) = found.values()[lane as usize]
                && let Some(row) = gather(&self.lane(lane), which)
            {
                rows.set(count as usize, &row);
                row_of.values()[lane as usize] = count;
                count += 1;
            }
        });
        rows.zero_behind(count as usize);
        let mut results = PerLane::new([0; WIDTH], (count as usize).div_ceil(WIDTH));
        rows.at_once(map, results.values());
        let results = results.values().as_flattened();
        watch.lanes(lanes, self.phase, |lane| {
            let told = found.values()[lane as usize].map(|which| {
                let row = row_of.values()[lane as usize];
                let result = if row == NO_ROW { OPEN } else { results[row as usize] };
                let is_left = (result == OPEN) & (row != NO_ROW);
                (which, if is_left { map.apply(rows.get(row as usize)) } else { result })
            });
            scatter(&self.lane(lane), told);
        });
        self.memory.rows = memory;
        self.phase += 1;
        watch.barrier();
    }
    #[inline(always)]
    fn select<T: Copy>(
        &mut self,
        count: u32,
        mut test: impl FnMut(&EmulatedLane<W>) -> (bool, T),
        mut put: impl FnMut(&EmulatedLane<W>, u32, T),
    ) -> u32 {
        assert_eq!(self.lanes, WARP, "a block of one warp");
        let mut values = [const { MaybeUninit::<T>::uninit() }; WARP as usize];
        let (watch, mut passes) = (self.watch, 0u32);
        watch.lanes(count.min(WARP), self.phase, |lane| {
            let (holds, value) = test(&self.lane(lane));
            // No branch: it would go either way.
            values[lane as usize % WARP as usize].write(value);
            passes |= u32::from(holds) << lane;
        });
        self.phase += 1;
        self.put_all(passes, |lane, place| {
            // SAFETY: a lane that passes has written its value.
            put(lane, place, unsafe { values[lane.lane() as usize % WARP as usize].assume_init() });
        })
    }
    #[inline(always)]
    fn select_columns<M: PairTest>(
        &mut self,
        columns: Span<u32>,
        first: u32,
        other: &M::Item,
        put: impl FnMut(&EmulatedLane<W>, u32),
    ) -> u32 {
        assert_eq!(self.lanes, WARP, "a block of one warp");
        let (watch, mut passes) = (self.watch, 0u32);
        if W::STRIDES {
            watch.lanes(WARP, self.phase, |lane| {
                let item = own::<M, _>(&self.lane(lane), columns, first);
                passes |= u32::from(M::test(&item, other)) << lane;
            });
        } else {
            let count = size_of::<M::Item>() / size_of::<u32>();
            assert!(first as u64 + count as u64 * WARP as u64 <= columns.len(), "columns end");
            let start = columns.addr() + size_of::<u32>() as u64 * first as u64;
            let start = with_exposed_provenance::<[u32; WARP as usize]>(start as usize);
            // SAFETY: as for `EmulatedLane::read`; the span has so many words from the first on.
            passes = wide::<M>(unsafe { std::slice::from_raw_parts(start, count) }, other);
        }
        self.phase += 1;
        self.put_all(passes, put)
    }
    #[inline(always)]
    fn cross<T: Copy>(
        &mut self,
        items: Range<u32>,
        first: u32,
        mut test: impl FnMut(&EmulatedLane<W>, u32) -> Option<T>,
        mut put: impl FnMut(&EmulatedLane<W>, u32, T),
    ) -> u32 {
        assert_eq!(self.lanes, WARP, "a block of one warp");
        let (watch, mut next) = (self.watch, first);
        for k in items {
            let (mut found, mut passes) = ([None; WARP as usize], 0u32);
            watch.lanes(WARP, self.phase, |lane| {
                let of_lane = test(&self.lane(lane), k);
                passes |= u32::from(of_lane.is_some()) << lane;
                found[lane as usize] = of_lane;
            });
            self.phase += 1;
            while passes != 0 {
                let lane = passes.trailing_zeros();
                passes &= passes - 1;
                if let Some(found) = found[lane as usize] {
                    put(&self.lane(lane), next, found);
                    next += 1;
                }
            }
            self.phase += 1;
        }
        watch.barrier();
        next
    }
    fn cross_own<M: PairTest>(
        &mut self,
        items: Range<u32>,
        first: u32,
        item: impl Fn(&EmulatedLane<W>, u32) -> M::Item,
        mut own: impl FnMut(&EmulatedLane<W>) -> Own<M::Item>,
        mut put: impl FnMut(&EmulatedLane<W>, u32, [u32; 2]),
    ) -> u32 {
        assert_eq!(self.lanes, WARP, "a block of one warp");
        let mut next = first;
        self.memory.columns.clear();
        // The lane, the name and the end of each column.
        let (mut whose, mut count) = ([[0; 3]; WARP as usize], 0);
        for lane in 0..WARP {
            let own = own(&self.lane(lane));
            if own.end > items.start {
                self.memory.columns.push::<M>(&own.item);
                whose[count] = [lane, own.name, own.end];
                count += 1;
            }
        }
        let (mut others, mut passes) = ([M::Item::zeroed(); ROWS], [0; ROWS]);
        for from in items.clone().step_by(ROWS) {
            // All tests before the first branch: none waits for another.
            let some = (items.end - from).min(ROWS as u32) as usize;
            for (k, other) in (from..).zip(&mut others[..some]) {
                *other = item(&self.lane(0), k);
            }
            self.memory.columns.test::<M>(&others[..some], &mut passes[..some]);
            for (k, passes) in (from..).zip(&mut passes[..some]) {
                while *passes != 0 {
                    let [lane, name, end] = whose[passes.trailing_zeros() as usize];
                    *passes &= *passes - 1;
                    if k < end {
                        put(&self.lane(lane), next, [k, name]);
                        next += 1;
                    }
                }
            }
        }
        self.phase += 1;
        self.watch.barrier();
        next
    }
    fn load<T: Pod>(&self, span: Span<T>, i: u32) -> T {
        // Every lane reads it, so no lane may write it in this phase.
        let place = Place { block: self.block, phase: self.phase, lane: EVERY_LANE };
        match device(&self.watch, Access::Read, span, i, place) {
            // SAFETY: as for `EmulatedLane::read`.
            Some(p) => unsafe { p.read() },
            None => T::zeroed(),
        }
    }
    fn peek<T: Word>(&mut self, words: Shared<T>, i: u32) -> T {
        let offset = words.offset + i * size_of::<T>() as u32;
        let place = Place { block: self.block, phase: self.phase, lane: EVERY_LANE };
        let inside = i < words.len;
        self.phase += 1;
        if !self.watch.shared(Access::Read, offset, size_of::<T>(), inside, place) {
            return T::zeroed();
        }
        let bytes: &[u8] = bytemuck::cast_slice(&self.memory.words);
        bytemuck::pod_read_unaligned(&bytes[offset as usize..][..size_of::<T>()])
    }
    fn any(&mut self, values: &mut PerLane<bool>) -> bool {
        values.values().contains(&true)
    }
    fn scan(&mut self, values: &mut PerLane<u32>) -> u32 {
        values.values().iter_mut().fold(0, |sum, value| sum + std::mem::replace(value, sum))
    }
    fn reserve(&mut self, counter: Span<u64>, i: u32, count: u64) -> u64 {
        if count == 0 {
            return 0;
        }
        let before = self.lane(0).fetch_add(counter, i, count);
        self.watch.barrier();
        before
    }
    fn ticket(&mut self, counter: Span<u64>, i: u32) -> u64 {
        fence(SeqCst);
        let ticket = self.reserve(counter, i, 1);
        fence(SeqCst);
        ticket
    }
    fn ranks<const K: usize>(
        &mut self,
        digits: &mut PerLane<[u32; K]>,
        bins: Shared<u32>,
        _scratch: Shared<u32>,
    ) {
        let lane = self.lane(0);
        for warp in digits.values().chunks_mut(WARP as usize) {
            for k in 0..K {
                for digit in warp.iter_mut().map(|digits| &mut digits[k]).filter(|digit| **digit < BINS) {
                    *digit = lane.shared_add(bins, *digit, 1);
                }
            }
        }
        self.phase += 1;
    }
}
