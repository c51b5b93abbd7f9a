//! The card: the only file with intrinsics and assembly. Function names follow `cuda_std` where it has them.
//!
//! Shared memory is the launch's dynamic shared memory; the collectives have a few words of their own.

/// The square root, correctly rounded on every machine.
pub use machine::{sqrt32, sqrt64};

#[cfg(not(target_arch = "nvptx64"))]
mod machine {
    /// The square root of an f32.
    pub fn sqrt32(x: f32) -> f32 {
        libm::sqrtf(x)
    }
    /// The square root of an f64.
    pub fn sqrt64(x: f64) -> f64 {
        libm::sqrt(x)
    }
}

#[cfg(target_arch = "nvptx64")]
pub use machine::Card;

#[cfg(target_arch = "nvptx64")]
mod machine {
    use crate::abi::Span;
    use crate::exec::{BINS, Block, Lane, Shared, Slot, WARP, Word};
    use bytemuck::Pod;
    use core::arch::nvptx::{
        _block_dim_x as block_dim_x, _block_idx_x as block_idx_x, _grid_dim_x as grid_dim_x,
        _thread_idx_x as thread_idx_x,
    };
    use core::arch::{asm, global_asm};
    use core::mem::MaybeUninit;
    use core::sync::atomic::{AtomicU64, Ordering::Relaxed};

    // What the lanes of a warp or block do together is an intrinsic, not assembly: the compiler knows that it must not
    // move these into or out of branches (they are convergent), which it does not know of an `asm!`.
    unsafe extern "C" {
        #[link_name = "llvm.nvvm.barrier.cta.sync.aligned.all"]
        fn barrier_sync(barrier: u32);
        #[link_name = "llvm.nvvm.barrier.cta.red.or.aligned.all"]
        fn barrier_or(barrier: u32, value: bool) -> bool;
        #[link_name = "llvm.nvvm.shfl.sync.up.i32"]
        fn shfl_up(mask: u32, value: u32, delta: u32, clamp: u32) -> u32;
        #[link_name = "llvm.nvvm.match.any.sync.i32"]
        fn match_any_sync(mask: u32, value: u32) -> u32;
    }
    /// All lanes of a warp.
    const ALL: u32 = u32::MAX;

    global_asm!(".extern .shared .align 16 .b8 nearmiss_shared[];");
    // 32 warp sums and one broadcast value.
    global_asm!(".shared .align 16 .b8 nearmiss_scratch[144];");
    /// Where the broadcast value lies in the scratch words, in bytes.
    const BROADCAST: u32 = 128;

    /// A panic stops the launch: the host sees an error, never half an answer.
    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo) -> ! {
        // SAFETY: ends the launch.
        unsafe { core::arch::nvptx::trap() }
    }

    /// The square root of an f32.
    pub fn sqrt32(x: f32) -> f32 {
        let r: u32;
        // SAFETY: one instruction on registers.
        unsafe {
            asm!("{{ .reg .f32 t; mov.b32 t, {x}; sqrt.rn.f32 t, t; mov.b32 {r}, t; }}",
                x = in(reg32) x.to_bits(), r = lateout(reg32) r, options(pure, nomem, nostack));
        }
        f32::from_bits(r)
    }
    /// The square root of an f64.
    pub fn sqrt64(x: f64) -> f64 {
        let r: u64;
        // SAFETY: one instruction on registers.
        unsafe {
            asm!("{{ .reg .f64 t; mov.b64 t, {x}; sqrt.rn.f64 t, t; mov.b64 {r}, t; }}",
                x = in(reg64) x.to_bits(), r = lateout(reg64) r, options(pure, nomem, nostack));
        }
        f64::from_bits(r)
    }

    /// The block that this thread belongs to.
    pub struct Card {
        /// Bytes of shared memory given out.
        taken: u32,
        lane: Thread,
    }

    /// This thread, as a lane.
    #[derive(Clone, Copy)]
    pub struct Thread {
        lane: u32,
        global: u32,
    }

    /// A value of this thread: a register.
    pub struct Register<T>(T);

    impl<T> Slot<T, Thread> for Register<T> {
        #[inline(always)]
        fn of(&mut self, _: &Thread) -> &mut T {
            &mut self.0
        }
    }

    /// The barrier of the block.
    #[inline(always)]
    fn sync_threads() {
        // SAFETY: called by all threads of the block: phases and collectives are not inside a lane's control flow.
        unsafe { barrier_sync(0) }
    }

    /// Address of byte `offset` of the launch's shared memory, in the shared window.
    #[inline(always)]
    fn shared_address(offset: u32) -> u32 {
        let base: u32;
        // SAFETY: takes the address of a module variable.
        unsafe { asm!("mov.u32 {}, nearmiss_shared;", out(reg32) base, options(pure, nomem, nostack)) };
        base + offset
    }
    /// Address of byte `offset` of the collectives' scratch words.
    #[inline(always)]
    fn scratch_address(offset: u32) -> u32 {
        let base: u32;
        // SAFETY: takes the address of a module variable.
        unsafe { asm!("mov.u32 {}, nearmiss_scratch;", out(reg32) base, options(pure, nomem, nostack)) };
        base + offset
    }
    #[inline(always)]
    fn load_shared32(at: u32) -> u32 {
        let v: u32;
        // SAFETY: `at` is an aligned address inside the block's shared memory (kernels stay inside their words; the
        // emulator checks it).
        unsafe { asm!("ld.shared.b32 {}, [{}];", out(reg32) v, in(reg32) at) };
        v
    }
    #[inline(always)]
    fn store_shared32(at: u32, v: u32) {
        // SAFETY: as for `load_shared32`.
        unsafe { asm!("st.shared.b32 [{}], {};", in(reg32) at, in(reg32) v) }
    }
    #[inline(always)]
    fn load_shared64(at: u32) -> u64 {
        let v: u64;
        // SAFETY: as for `load_shared32`.
        unsafe { asm!("ld.shared.b64 {}, [{}];", out(reg64) v, in(reg32) at) };
        v
    }
    #[inline(always)]
    fn store_shared64(at: u32, v: u64) {
        // SAFETY: as for `load_shared32`.
        unsafe { asm!("st.shared.b64 [{}], {};", in(reg32) at, in(reg64) v) }
    }
    #[inline(always)]
    fn load_word<T: Word>(at: u32) -> T {
        if size_of::<T>() == 4 {
            bytemuck::cast(load_shared32(at))
        } else {
            bytemuck::cast(load_shared64(at))
        }
    }
    #[inline(always)]
    fn store_word<T: Word>(at: u32, v: T) {
        if size_of::<T>() == 4 {
            store_shared32(at, bytemuck::cast(v));
        } else {
            store_shared64(at, bytemuck::cast(v));
        }
    }
    #[inline(always)]
    fn address<T: Word>(words: Shared<T>, i: u32) -> u32 {
        shared_address(words.offset + i * size_of::<T>() as u32)
    }

    /// The value of the lane `delta` before this one in its warp; its own where there is none.
    #[inline(always)]
    fn shuffle_up(v: u32, delta: u32) -> u32 {
        // SAFETY: called by all threads of the warp.
        unsafe { shfl_up(ALL, v, delta, 0) }
    }
    /// Which lanes of the warp hold the same value.
    #[inline(always)]
    fn match_any(v: u32) -> u32 {
        // SAFETY: called by all threads of the warp.
        unsafe { match_any_sync(ALL, v) }
    }

    #[inline(always)]
    fn element<T>(span: Span<T>, i: u32) -> *mut T {
        (span.addr as *mut T).wrapping_add(i as usize)
    }
    /// A load that knows that its address is device memory, in the widest pieces that `T`'s alignment allows. (A
    /// pointer out of an argument block is generic to the compiler: such a load asks at run time which memory it means.)
    ///
    /// # Safety
    /// `from` is valid for reads, and nobody writes it in this phase.
    #[inline(always)]
    unsafe fn load_global<T: Pod>(from: *const T) -> T {
        let (size, align) = (size_of::<T>(), align_of::<T>());
        let at = from as u64;
        let mut value = MaybeUninit::<T>::uninit();
        let to = value.as_mut_ptr().cast::<u32>();
        let mut word = 0;
        while 4 * word < size {
            let at = at + 4 * word as u64;
            // SAFETY: the pieces lie in `from` and in `value`, and are aligned: sizes are multiples of alignments.
            unsafe {
                if align >= 16 {
                    let (a, b, c, d): (u32, u32, u32, u32);
                    asm!("ld.global.v4.b32 {{ {a}, {b}, {c}, {d} }}, [{at}];", a = lateout(reg32) a,
                        b = lateout(reg32) b, c = lateout(reg32) c, d = lateout(reg32) d, at = in(reg64) at,
                        options(pure, readonly, nostack));
                    to.add(word).cast::<[u32; 4]>().write([a, b, c, d]);
                    word += 4;
                } else if align >= 8 {
                    let a: u64;
                    asm!("ld.global.b64 {a}, [{at}];", a = lateout(reg64) a, at = in(reg64) at,
                        options(pure, readonly, nostack));
                    to.add(word).cast::<u64>().write(a);
                    word += 2;
                } else {
                    let a: u32;
                    asm!("ld.global.b32 {a}, [{at}];", a = lateout(reg32) a, at = in(reg64) at,
                        options(pure, readonly, nostack));
                    to.add(word).write(a);
                    word += 1;
                }
            }
        }
        // SAFETY: every word was written, and any bits are a T.
        unsafe { value.assume_init() }
    }
    #[inline(always)]
    fn atomic(span: Span<u64>, i: u32) -> &'static AtomicU64 {
        // SAFETY: the span is device memory that outlives the launch, aligned for u64, and `i` lies in it: kernels
        // stay inside their spans, which the emulator checks on every access.
        unsafe { AtomicU64::from_ptr(element(span, i)) }
    }

    impl Lane for Thread {
        #[inline(always)]
        fn lane(&self) -> u32 {
            self.lane
        }
        #[inline(always)]
        fn global(&self) -> u32 {
            self.global
        }
        #[inline(always)]
        fn read<T: Pod>(&self, span: Span<T>, i: u32) -> T {
            // SAFETY: as for `atomic`; nobody writes it in this phase, which the emulator's race watch checks.
            unsafe { load_global(element(span, i)) }
        }
        #[inline(always)]
        fn write<T: Pod>(&self, span: Span<T>, i: u32, value: T) {
            // SAFETY: as for `read`; nobody else touches it in this phase.
            unsafe { element(span, i).write(value) }
        }
        #[inline(always)]
        fn fetch_max(&self, span: Span<u64>, i: u32, value: u64) {
            atomic(span, i).fetch_max(value, Relaxed);
        }
        #[inline(always)]
        fn fetch_min(&self, span: Span<u64>, i: u32, value: u64) {
            atomic(span, i).fetch_min(value, Relaxed);
        }
        #[inline(always)]
        fn fetch_add(&self, span: Span<u64>, i: u32, value: u64) -> u64 {
            atomic(span, i).fetch_add(value, Relaxed)
        }
        #[inline(always)]
        fn get<T: Word>(&self, words: Shared<T>, i: u32) -> T {
            load_word(address(words, i))
        }
        #[inline(always)]
        fn put<T: Word>(&self, words: Shared<T>, i: u32, value: T) {
            store_word(address(words, i), value);
        }
        #[inline(always)]
        fn shared_add(&self, words: Shared<u32>, i: u32, value: u32) -> u32 {
            let r: u32;
            // SAFETY: as for `load_shared32`.
            unsafe {
                asm!("atom.shared.add.u32 {r}, [{at}], {v};",
                    r = lateout(reg32) r, at = in(reg32) address(words, i), v = in(reg32) value)
            };
            r
        }
        #[inline(always)]
        fn shared_max(&self, words: Shared<u64>, i: u32, value: u64) {
            // SAFETY: as for `load_shared32`.
            unsafe {
                asm!("red.shared.max.u64 [{at}], {v};", at = in(reg32) address(words, i), v = in(reg64) value)
            };
        }
    }

    impl Card {
        /// This thread's block.
        ///
        /// # Safety
        /// Once a kernel, at its start: shared memory is given out from the beginning.
        #[inline(always)]
        pub unsafe fn new() -> Self {
            // SAFETY: reads special registers.
            let (lane, global) = unsafe {
                (thread_idx_x() as u32, block_idx_x() as u32 * block_dim_x() as u32 + thread_idx_x() as u32)
            };
            Card { taken: 0, lane: Thread { lane, global } }
        }
        /// A lane's value for all: lane 0 computes it.
        #[inline(always)]
        fn broadcast(&self, value: impl FnOnce() -> u64) -> u64 {
            if self.lane.lane == 0 {
                store_shared64(scratch_address(BROADCAST), value());
            }
            sync_threads();
            let value = load_shared64(scratch_address(BROADCAST));
            sync_threads();
            value
        }
    }

    impl Block for Card {
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
            // SAFETY: reads a special register.
            unsafe { block_dim_x() as u32 }
        }
        #[inline(always)]
        fn shared<T: Word>(&mut self, len: u32) -> Shared<T> {
            let offset = self.taken.next_multiple_of(8);
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
            sync_threads();
        }
        #[inline(always)]
        fn load<T: Pod>(&self, span: Span<T>, i: u32) -> T {
            self.lane.read(span, i)
        }
        #[inline(always)]
        fn peek<T: Word>(&mut self, words: Shared<T>, i: u32) -> T {
            let value = self.lane.get(words, i);
            sync_threads();
            value
        }
        #[inline(always)]
        fn any(&mut self, values: &mut Register<bool>) -> bool {
            // SAFETY: called by all threads of the block.
            unsafe { barrier_or(0, values.0) }
        }
        #[inline(always)]
        fn scan(&mut self, values: &mut Register<u32>) -> u32 {
            let (lane, warp) = (self.lane.lane % WARP, self.lane.lane / WARP);
            let mut sum = values.0;
            let mut delta = 1;
            while delta < WARP {
                let before = shuffle_up(sum, delta);
                if lane >= delta {
                    sum += before;
                }
                delta *= 2;
            }
            if lane == WARP - 1 {
                store_shared32(scratch_address(4 * warp), sum);
            }
            sync_threads();
            let (mut before, mut total) = (0, 0);
            for w in 0..self.lanes().div_ceil(WARP) {
                if w == warp {
                    before = total;
                }
                total += load_shared32(scratch_address(4 * w));
            }
            sync_threads();
            values.0 = before + sum - values.0;
            total
        }
        #[inline(always)]
        fn reserve(&mut self, counter: Span<u64>, i: u32, count: u64) -> u64 {
            if count == 0 {
                return 0;
            }
            self.broadcast(|| self.lane.fetch_add(counter, i, count))
        }
        #[inline(always)]
        fn ranks(&mut self, digits: &mut Register<u32>, bins: Shared<u32>, scratch: Shared<u32>) {
            let (lane, warp) = (self.lane.lane % WARP, self.lane.lane / WARP);
            let (lanes, warps) = (self.lanes(), self.lanes() / WARP);
            let at = |w: u32, bin: u32| address(scratch, w * BINS + bin);
            let mut i = self.lane.lane;
            while i < warps * BINS {
                store_shared32(at(0, i), 0);
                i += lanes;
            }
            sync_threads();
            let digit = digits.0;
            let alike = match_any(digit);
            let before = (alike & ((1 << lane) - 1)).count_ones();
            if digit < BINS && before == 0 {
                store_shared32(at(warp, digit), alike.count_ones());
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
            if digit < BINS {
                digits.0 = load_shared32(at(warp, digit)) + before;
            }
            sync_threads();
        }
    }
}
