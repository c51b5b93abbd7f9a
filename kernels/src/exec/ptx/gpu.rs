//! A block of the GPU: each thread runs the kernel for its own lane.

use super::coherent::fence;
use super::raw::{
    BROADCAST, address, ballot, barrier_or, load_shared32, load_shared64, match_any, reconverge,
    scratch_address, shuffle, shuffle_up, store_shared32, store_shared64, sync_threads, sync_warp, warp_sum,
};
use super::thread::Thread;
use crate::abi::Span;
use crate::exec::{BINS, Block, Lane, Shared, Slot, WARP, Word};
use bytemuck::Pod;
use core::arch::nvptx::{
    _block_idx_x as block_idx_x, _grid_dim_x as grid_dim_x, _thread_idx_x as thread_idx_x,
};
use core::mem::MaybeUninit;
use core::ops::Range;

/// A panic stops the launch: the host sees an error, never half an answer.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    // SAFETY: ends the launch.
    unsafe { core::arch::nvptx::trap() }
}

/// The block of `LANES` threads that this thread belongs to. A block of one warp has no barriers
/// but the warp's, and its collectives pass values from register to register.
pub struct Gpu<const LANES: u32> {
    /// Bytes of shared memory given out.
    taken: u32,
    lane: Thread,
}

/// A value of this thread: a register.
pub struct Register<T>(T);

impl<T> Slot<T, Thread> for Register<T> {
    #[inline(always)]
    fn of(&mut self, _: &Thread) -> &mut T {
        &mut self.0
    }
}

impl<const LANES: u32> Gpu<LANES> {
    const ONE_WARP: bool = LANES == WARP;

    /// This thread's block.
    ///
    /// # Safety
    /// Once a kernel, at its start: shared memory is given out from the beginning. The kernel was
    /// launched with blocks of `LANES`.
    #[inline(always)]
    pub unsafe fn new() -> Self {
        // SAFETY: reads special registers.
        let (lane, block) = unsafe { (thread_idx_x() as u32, block_idx_x() as u32) };
        Gpu { taken: 0, lane: Thread { lane, global: block * LANES + lane } }
    }
    /// Stores of lanes to shared memory before it are visible to all of them after it.
    #[inline(always)]
    fn barrier(&self) {
        if Self::ONE_WARP { sync_warp() } else { sync_threads() }
    }
    /// A lane's value for all: lane 0 computes it.
    #[inline(always)]
    fn broadcast(&self, value: impl FnOnce() -> u64) -> u64 {
        if !Self::ONE_WARP {
            // A block of several warps comes here seldom: a certain barrier costs nothing.
            reconverge();
        }
        if Self::ONE_WARP {
            sync_warp();
            let value = if self.lane.lane == 0 { value() } else { 0 };
            sync_warp();
            return u64::from(shuffle(value as u32, 0)) | u64::from(shuffle((value >> 32) as u32, 0)) << 32;
        }
        if self.lane.lane == 0 {
            store_shared64(scratch_address(BROADCAST), value());
        }
        sync_threads();
        let value = load_shared64(scratch_address(BROADCAST));
        sync_threads();
        value
    }
}

impl<const LANES: u32> Block for Gpu<LANES> {
    type Lane = Thread;
    type Slot<T: Copy> = Register<T>;

    #[inline(always)]
    fn block(&self) -> u32 {
        // SAFETY: reads a special register.
        unsafe { block_idx_x() as u32 }
    }
    #[inline(always)]
    fn blocks(&self) -> u32 {
        // SAFETY: reads a special register.
        unsafe { grid_dim_x() as u32 }
    }
    #[inline(always)]
    fn lanes(&self) -> u32 {
        LANES
    }
    #[inline(always)]
    fn shared<T: Word>(&mut self, len: u32) -> Shared<T> {
        let offset = self.taken.next_multiple_of(if size_of::<T>() > 8 { 16 } else { 8 });
        self.taken = offset + len * size_of::<T>() as u32;
        Shared::at(offset, len)
    }
    #[inline(always)]
    fn slot<T: Copy>(&self, init: T) -> Register<T> {
        Register(init)
    }
    #[inline(always)]
    fn words<const N: usize>(&self) -> Register<[MaybeUninit<u32>; N]> {
        Register([const { MaybeUninit::uninit() }; N])
    }
    #[inline(always)]
    fn phase(&mut self, mut body: impl FnMut(&Thread)) {
        body(&self.lane);
        self.barrier();
    }
    #[inline(always)]
    fn cross<T: Copy>(
        &mut self,
        items: Range<u32>,
        first: u32,
        mut test: impl FnMut(&Thread, u32) -> Option<T>,
        mut put: impl FnMut(&Thread, u32, T),
    ) -> u32 {
        const { assert!(LANES == WARP) };
        let (lane, mut next) = (self.lane, first);
        for k in items {
            let found = test(&lane, k);
            sync_warp();
            let all = ballot(found.is_some());
            let before = all & ((1 << lane.lane) - 1);
            if let Some(found) = found {
                put(&lane, next + before.count_ones(), found);
            }
            next += all.count_ones();
        }
        sync_warp();
        next
    }
    #[inline(always)]
    fn load<T: Pod>(&self, span: Span<T>, i: u32) -> T {
        self.lane.read(span, i)
    }
    #[inline(always)]
    fn peek<T: Word>(&mut self, words: Shared<T>, i: u32) -> T {
        let value = self.lane.get(words, i);
        self.barrier();
        value
    }
    #[inline(always)]
    fn any(&mut self, values: &mut Register<bool>) -> bool {
        sync_warp();
        // SAFETY: called by all threads of the block.
        unsafe { barrier_or(0, values.0) }
    }
    #[inline(always)]
    fn scan(&mut self, values: &mut Register<u32>) -> u32 {
        let (lane, warp) = (self.lane.lane % WARP, self.lane.lane / WARP);
        let mut sum = values.0;
        let mut delta = 1;
        sync_warp();
        while delta < WARP {
            let before = shuffle_up(sum, delta);
            if lane >= delta {
                sum += before;
            }
            delta *= 2;
        }
        if Self::ONE_WARP {
            values.0 = sum - values.0;
            return shuffle(sum, WARP - 1);
        }
        if lane == WARP - 1 {
            store_shared32(scratch_address(4 * warp), sum);
        }
        sync_threads();
        // A lane for each of the warps, 32 at most.
        let there = lane < self.lanes().div_ceil(WARP);
        let of_warp = if there { load_shared32(scratch_address(4 * lane)) } else { 0 };
        sync_warp();
        let before = warp_sum(if lane < warp { of_warp } else { 0 });
        let total = warp_sum(of_warp);
        sync_threads();
        values.0 = before + sum - values.0;
        total
    }
    #[inline(always)]
    fn number(&mut self, wishes: &mut Register<u32>) -> u32 {
        if !Self::ONE_WARP {
            return self.scan(wishes);
        }
        sync_warp();
        let all = ballot(wishes.0 != 0);
        wishes.0 = (all & ((1 << self.lane.lane) - 1)).count_ones();
        all.count_ones()
    }
    #[inline(always)]
    fn reserve(&mut self, counter: Span<u64>, i: u32, count: u64) -> u64 {
        if count == 0 {
            return 0;
        }
        self.broadcast(|| self.lane.fetch_add(counter, i, count))
    }
    #[inline(always)]
    fn reserve_both(&mut self, counters: [Span<u64>; 2], counts: [u64; 2]) -> [u64; 2] {
        if counts[0] | counts[1] == 0 {
            return [0; 2];
        }
        let lane = self.lane.lane;
        sync_warp();
        // A lane each.
        let mut start = 0;
        if lane < 2 {
            let (counter, count) =
                if lane == 0 { (counters[0], counts[0]) } else { (counters[1], counts[1]) };
            if count > 0 {
                start = self.lane.fetch_add(counter, 0, count);
            }
        }
        if Self::ONE_WARP {
            sync_warp();
            let [low, high] = [start as u32, (start >> 32) as u32];
            return [0, 1].map(|of| u64::from(shuffle(low, of)) | u64::from(shuffle(high, of)) << 32);
        }
        if lane < 2 {
            store_shared64(scratch_address(BROADCAST + 8 * lane), start);
        }
        sync_threads();
        let starts = [0, 8].map(|other| load_shared64(scratch_address(BROADCAST + other)));
        sync_threads();
        starts
    }
    #[inline(always)]
    fn ticket(&mut self, counter: Span<u64>, i: u32) -> u64 {
        // The barrier at the end of the phase before orders the other lanes' stores before lane 0's
        // fence. That fence and its atomic release them all. Atomic and fence acquire, and the
        // broadcast's barrier extends that to all lanes.
        self.broadcast(|| {
            fence();
            let ticket = self.lane.fetch_add(counter, i, 1);
            fence();
            ticket
        })
    }
    #[inline(always)]
    fn ranks<const K: usize>(
        &mut self,
        digits: &mut Register<[u32; K]>,
        bins: Shared<u32>,
        scratch: Shared<u32>,
    ) {
        let (lane, warp) = (self.lane.lane % WARP, self.lane.lane / WARP);
        let (lanes, warps) = (self.lanes(), self.lanes() / WARP);
        let at = |w: u32, bin: u32| address(scratch, w * BINS + bin);
        let mut bin = lane;
        while bin < BINS {
            store_shared32(at(warp, bin), 0);
            bin += WARP;
        }
        sync_warp();
        // Each warp counts by itself, an item a lane in sequence: the ranks of its items within the
        // warp.
        let mut before = [0; K];
        for k in 0..K {
            let digit = digits.0[k];
            let alike = match_any(digit);
            let lower = (alike & ((1 << lane) - 1)).count_ones();
            let counted = digit < BINS;
            let taken = if counted { load_shared32(at(warp, digit)) } else { 0 };
            sync_warp();
            if counted && lower == 0 {
                store_shared32(at(warp, digit), taken + alike.count_ones());
            }
            sync_warp();
            before[k] = taken + lower;
        }
        sync_threads();
        let mut bin = self.lane.lane;
        while bin < BINS {
            let mut next = load_shared32(address(bins, bin));
            for w in 0..warps {
                let count = load_shared32(at(w, bin));
                store_shared32(at(w, bin), next);
                next += count;
            }
            store_shared32(address(bins, bin), next);
            bin += lanes;
        }
        sync_threads();
        for k in 0..K {
            if digits.0[k] < BINS {
                digits.0[k] = load_shared32(at(warp, digits.0[k])) + before[k];
            }
        }
        sync_threads();
    }
}
