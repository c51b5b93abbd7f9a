//! A block on the CPU: its phases are loops over its lanes.

use crate::columns::Columns;
use crate::lane::{EmulatedLane, device};
use crate::rows::Rows;
use crate::sanitizer::{Access, Place};
use bytemuck::Pod;
use nearmiss_kernels::abi::Span;
use nearmiss_kernels::exec::{BINS, Block, Lane, OPEN, Own, PairTest, RowMap, Shared, Slot, WARP, Word};
use std::mem::MaybeUninit;
use std::ops::Range;
use std::sync::atomic::{Ordering::SeqCst, fence};

/// The observer: [`Looking`](crate::engine::Looking) or a
/// [`BlockObserver`](crate::observer::BlockObserver).
pub trait Watch: Copy {
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
    /// Shared memory, and its allocated bytes.
    words: Vec<u64>,
    taken: u32,
    /// Memory for rows, and for columns.
    rows: Vec<u64>,
    columns: Option<Box<Columns>>,
    watch: W,
}

/// One value per lane.
pub struct PerLane<T>(Vec<T>);

impl<T, W> Slot<T, EmulatedLane<W>> for PerLane<T> {
    #[inline(always)]
    fn of(&mut self, lane: &EmulatedLane<W>) -> &mut T {
        &mut self.0[lane.place.lane as usize]
    }
}

impl<W: Watch> Emulated<W> {
    /// Block `block` of a launch.
    pub fn new(block: u32, blocks: u32, lanes: u32, watch: W) -> Self {
        let (words, rows) = (Vec::new(), Vec::new());
        Emulated { block, blocks, lanes, phase: 0, words, taken: 0, rows, columns: None, watch }
    }
    fn lane(&mut self, lane: u32) -> EmulatedLane<W> {
        EmulatedLane {
            place: Place { block: self.block, phase: self.phase, lane },
            global: self.block * self.lanes + lane,
            words: self.words.as_mut_ptr(),
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
        self.words.resize(self.taken.div_ceil(8) as usize, 0);
        Shared::at(offset, len)
    }
    fn slot<T: Copy>(&self, init: T) -> PerLane<T> {
        PerLane(vec![init; self.lanes as usize])
    }
    fn words<const N: usize>(&self) -> PerLane<[MaybeUninit<u32>; N]> {
        let mut words = Vec::with_capacity(self.lanes as usize);
        // SAFETY: the capacity is there, and words that may be unwritten are valid unwritten.
        unsafe { words.set_len(self.lanes as usize) };
        PerLane(words)
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
        let mut found = vec![None; lanes as usize];
        watch.lanes(lanes, self.phase, |lane| found[lane as usize] = find(&self.lane(lane)));
        let mut memory = std::mem::take(&mut self.rows);
        let mut rows = Rows::<M>::new(lanes as usize, &mut memory);
        let mut gathered = vec![false; lanes as usize];
        watch.lanes(lanes, self.phase, |lane| {
            if let Some(which) = found[lane as usize]
                && let Some(row) = gather(&self.lane(lane), which)
            {
                rows.set(lane as usize, &row);
                gathered[lane as usize] = true;
            }
        });
        let results = rows.at_once(map);
        watch.lanes(lanes, self.phase, |lane| {
            let i = lane as usize;
            let result = match (gathered[i], results[i]) {
                (false, _) => OPEN,
                (true, OPEN) => map.apply(rows.get(i)),
                (true, result) => result,
            };
            scatter(&self.lane(lane), found[i].map(|which| (which, result)));
        });
        self.rows = memory;
        self.phase += 1;
        watch.barrier();
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
        let (mut columns, mut next) = (self.columns.take().unwrap_or_default(), first);
        columns.clear();
        // The lane, the name and the end of each column.
        let (mut whose, mut count) = ([[0; 3]; WARP as usize], 0);
        for lane in 0..WARP {
            let own = own(&self.lane(lane));
            if own.end > items.start {
                columns.push::<M>(&own.item);
                whose[count] = [lane, own.name, own.end];
                count += 1;
            }
        }
        for k in items {
            let mut passes = columns.test::<M>(&item(&self.lane(0), k));
            while passes != 0 {
                let [lane, name, end] = whose[passes.trailing_zeros() as usize];
                passes &= passes - 1;
                if k < end {
                    put(&self.lane(lane), next, [k, name]);
                    next += 1;
                }
            }
        }
        self.columns = Some(columns);
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
        let bytes: &[u8] = bytemuck::cast_slice(&self.words);
        bytemuck::pod_read_unaligned(&bytes[offset as usize..][..size_of::<T>()])
    }
    fn any(&mut self, values: &mut PerLane<bool>) -> bool {
        values.0.contains(&true)
    }
    fn scan(&mut self, values: &mut PerLane<u32>) -> u32 {
        values.0.iter_mut().fold(0, |sum, value| sum + std::mem::replace(value, sum))
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
        for warp in digits.0.chunks_mut(WARP as usize) {
            for k in 0..K {
                for digit in warp.iter_mut().map(|digits| &mut digits[k]).filter(|digit| **digit < BINS) {
                    *digit = lane.shared_add(bins, *digit, 1);
                }
            }
        }
        self.phase += 1;
    }
}
