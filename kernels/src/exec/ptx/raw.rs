//! Single instructions, as functions. Intrinsics for collective operations, assembly for loads,
//! shared memory and roots.

use crate::abi::Span;
use crate::exec::{Shared, Word};
use bytemuck::Pod;
use core::arch::{asm, global_asm};
use core::mem::MaybeUninit;
use core::sync::atomic::AtomicU64;

// Collective operations of a warp or block are intrinsics, not assembly. The compiler must not move
// them into or out of branches: they are convergent. For an `asm!` it has no such rule.
unsafe extern "C" {
    #[link_name = "llvm.nvvm.barrier.cta.sync.aligned.all"]
    pub fn barrier_sync(barrier: u32);
    #[link_name = "llvm.nvvm.bar.warp.sync"]
    pub fn bar_warp_sync(mask: u32);
    #[link_name = "llvm.nvvm.barrier.cta.red.or.aligned.all"]
    pub fn barrier_or(barrier: u32, value: bool) -> bool;
    #[link_name = "llvm.nvvm.shfl.sync.up.i32"]
    pub fn shfl_up(mask: u32, value: u32, delta: u32, clamp: u32) -> u32;
    #[link_name = "llvm.nvvm.shfl.sync.idx.i32"]
    pub fn shfl_idx(mask: u32, value: u32, lane: u32, clamp: u32) -> u32;
    #[link_name = "llvm.nvvm.vote.ballot.sync"]
    pub fn vote_ballot(mask: u32, vote: bool) -> u32;
    #[link_name = "llvm.nvvm.vote.any.sync"]
    pub fn vote_any(mask: u32, vote: bool) -> bool;
    #[link_name = "llvm.nvvm.match.any.sync.i32"]
    pub fn match_any_sync(mask: u32, value: u32) -> u32;
}
/// All lanes of a warp.
const ALL: u32 = u32::MAX;

global_asm!(".extern .shared .align 16 .b8 nearmiss_shared[];");
// 32 warp sums and two broadcast values.
global_asm!(".shared .align 16 .b8 nearmiss_scratch[144];");
/// Offset of the broadcast values in the scratch words, in bytes.
pub const BROADCAST: u32 = 128;

/// The smaller of two finite numbers; of two zeros the negative one. One instruction.
#[inline(always)]
pub fn lesser32(a: f32, b: f32) -> f32 {
    f32::min(a, b)
}
/// The larger of two finite numbers; of two zeros the positive one. One instruction.
#[inline(always)]
pub fn greater32(a: f32, b: f32) -> f32 {
    f32::max(a, b)
}

/// `over / under`; of two zeros either, if `over` is zero. The division of a zero is a subroutine,
/// for which all lanes of a warp wait. So such a lane divides another number. In assembly: the compiler
/// would see that this number is not needed.
#[inline(always)]
pub fn ratio32(over: f32, under: f32) -> f32 {
    let r: u32;
    // SAFETY: instructions on registers.
    unsafe {
        asm!("{{ .reg .pred z; .reg .f32 x, y, n; mov.b32 x, {x}; mov.b32 y, {y};",
            "setp.ne.f32 z, y, 0f00000000;",
            "setp.eq.and.f32 z, x, 0f00000000, z; selp.f32 n, y, x, z; div.rn.f32 n, n, y;",
            "selp.f32 n, 0f00000000, n, z; mov.b32 {r}, n; }}",
            x = in(reg32) over.to_bits(), y = in(reg32) under.to_bits(), r = lateout(reg32) r,
            options(pure, nomem, nostack));
    }
    f32::from_bits(r)
}
/// The same in f64.
#[inline(always)]
pub fn ratio64(over: f64, under: f64) -> f64 {
    let r: u64;
    // SAFETY: instructions on registers.
    unsafe {
        asm!("{{ .reg .pred z; .reg .f64 x, y, n; mov.b64 x, {x}; mov.b64 y, {y};",
            "setp.ne.f64 z, y, 0d0000000000000000;",
            "setp.eq.and.f64 z, x, 0d0000000000000000, z; selp.f64 n, y, x, z; div.rn.f64 n, n, y;",
            "selp.f64 n, 0d0000000000000000, n, z; mov.b64 {r}, n; }}",
            x = in(reg64) over.to_bits(), y = in(reg64) under.to_bits(), r = lateout(reg64) r,
            options(pure, nomem, nostack));
    }
    f64::from_bits(r)
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

/// The barrier of the block.
#[inline(always)]
pub fn sync_threads() {
    // SAFETY: called by all threads of the block: phases and collectives are not inside a lane's
    // control flow.
    unsafe { barrier_sync(0) }
}

/// Brings the lanes of a warp together where the assembler finds them parted. Every collective
/// operation begins with it. Stores of lanes to shared memory before it are visible to all of them
/// after it.
///
/// The assembler leaves it out where its analysis finds the warp together. Behind loops that lanes
/// leave at different turns that analysis is wrong: such a phase ends with [`reconverge`].
/// `.ci/lanes.py` proves for each kernel that the lanes are together where they must be.
#[inline(always)]
pub fn sync_warp() {
    // SAFETY: called by all 32 threads of the warp.
    unsafe { bar_warp_sync(ALL) }
}

/// Reconverges the lanes of a warp, for certain: [`Lane::meet`](crate::exec::Lane::meet).
///
/// A shuffle's mask that names 32 lanes does not make it wait. ptxas (12.9, 13.0, the driver's)
/// waits only if its analysis finds the warp diverged. Behind loops that lanes leave at different
/// turns that analysis is wrong. It removes a warp barrier for the same reason, unless the mask is
/// opaque to it. This mask is all lanes, from two registers that are opaque to it. `.ci/ptxas.sh`
/// looks for the instruction. The registers are read each time, or the mask would occupy a register
/// in between. It costs a match, a reduction and a vote.
#[inline(always)]
pub fn reconverge() {
    let mask: u32;
    // SAFETY: reads special registers; called by all 32 threads of the warp.
    unsafe {
        asm!("{{ .reg .b32 t; mov.u32 t, %lanemask_le; mov.u32 {m}, %lanemask_gt; or.b32 {m}, {m}, t; }}",
            m = out(reg32) mask, options(nomem, nostack));
        bar_warp_sync(mask)
    }
}

/// Address of byte `offset` of the launch's shared memory, in the shared window.
#[inline(always)]
pub fn shared_address(offset: u32) -> u32 {
    let base: u32;
    // SAFETY: takes the address of a module variable.
    unsafe { asm!("mov.u32 {}, nearmiss_shared;", out(reg32) base, options(pure, nomem, nostack)) };
    base + offset
}
/// Address of byte `offset` of the collectives' scratch words.
#[inline(always)]
pub fn scratch_address(offset: u32) -> u32 {
    let base: u32;
    // SAFETY: takes the address of a module variable.
    unsafe { asm!("mov.u32 {}, nearmiss_scratch;", out(reg32) base, options(pure, nomem, nostack)) };
    base + offset
}
#[inline(always)]
pub fn load_shared32(at: u32) -> u32 {
    let v: u32;
    // SAFETY: `at` is an aligned address inside the block's shared memory (kernels stay inside
    // their words; the emulator checks it).
    unsafe { asm!("ld.shared.b32 {}, [{}];", out(reg32) v, in(reg32) at) };
    v
}
#[inline(always)]
pub fn store_shared32(at: u32, v: u32) {
    // SAFETY: as for `load_shared32`.
    unsafe { asm!("st.shared.b32 [{}], {};", in(reg32) at, in(reg32) v) }
}
#[inline(always)]
pub fn load_shared64(at: u32) -> u64 {
    let v: u64;
    // SAFETY: as for `load_shared32`.
    unsafe { asm!("ld.shared.b64 {}, [{}];", out(reg64) v, in(reg32) at) };
    v
}
#[inline(always)]
pub fn store_shared64(at: u32, v: u64) {
    // SAFETY: as for `load_shared32`.
    unsafe { asm!("st.shared.b64 [{}], {};", in(reg32) at, in(reg64) v) }
}
/// Sixteen bytes at once.
#[inline(always)]
fn load_shared128(at: u32) -> [u32; 4] {
    let (a, b, c, d): (u32, u32, u32, u32);
    // SAFETY: as for `load_shared32`. It reads memory and does nothing else: what is not used is not
    // read.
    unsafe {
        asm!("ld.shared.v4.b32 {{ {a}, {b}, {c}, {d} }}, [{at}];", a = lateout(reg32) a,
            b = lateout(reg32) b, c = lateout(reg32) c, d = lateout(reg32) d, at = in(reg32) at,
            options(pure, readonly, nostack));
    }
    [a, b, c, d]
}
#[inline(always)]
fn store_shared128(at: u32, [a, b, c, d]: [u32; 4]) {
    // SAFETY: as for `load_shared32`.
    unsafe {
        asm!("st.shared.v4.b32 [{at}], {{ {a}, {b}, {c}, {d} }};", at = in(reg32) at, a = in(reg32) a,
            b = in(reg32) b, c = in(reg32) c, d = in(reg32) d)
    }
}
#[inline(always)]
pub fn load_word<T: Word>(at: u32) -> T {
    match size_of::<T>() {
        4 => bytemuck::cast(load_shared32(at)),
        8 => bytemuck::cast(load_shared64(at)),
        _ => bytemuck::cast(load_shared128(at)),
    }
}
#[inline(always)]
pub fn store_word<T: Word>(at: u32, v: T) {
    match size_of::<T>() {
        4 => store_shared32(at, bytemuck::cast(v)),
        8 => store_shared64(at, bytemuck::cast(v)),
        _ => store_shared128(at, bytemuck::cast(v)),
    }
}
#[inline(always)]
pub fn address<T: Word>(words: Shared<T>, i: u32) -> u32 {
    shared_address(words.offset + i * size_of::<T>() as u32)
}

/// The value of the lane `delta` before this one in its warp; its own if there is none. A
/// [`sync_warp`] goes before.
#[inline(always)]
pub fn shuffle_up(v: u32, delta: u32) -> u32 {
    // SAFETY: called by all threads of the warp.
    unsafe { shfl_up(ALL, v, delta, 0) }
}
/// The value of a lane of the warp. A [`sync_warp`] goes before.
#[inline(always)]
pub fn shuffle(v: u32, lane: u32) -> u32 {
    // SAFETY: called by all threads of the warp.
    unsafe { shfl_idx(ALL, v, lane, 31) }
}
/// Which lanes of the warp vote for it. A [`sync_warp`] goes before.
#[inline(always)]
pub fn ballot(vote: bool) -> u32 {
    // SAFETY: called by all threads of the warp.
    unsafe { vote_ballot(ALL, vote) }
}
/// The sum of the values of a warp. A [`sync_warp`] goes before.
#[inline(always)]
pub fn warp_sum(v: u32) -> u32 {
    let sum: u32;
    // SAFETY: called by all threads of the warp.
    unsafe {
        asm!("redux.sync.add.u32 {s}, {v}, 0xffffffff;", s = lateout(reg32) sum, v = in(reg32) v,
            options(nomem, nostack))
    };
    sum
}
/// Whether any lane of the warp votes for it; all lanes come. It has no [`sync_warp`]: lanes that
/// vote by themselves lose time and no answer (`Lane::any`). The hardware checks whether all lanes
/// are there. A wait for an opaque mask is a match and a reduction. In the loop of the search that
/// would cost 88 bytes of spills in f32.
#[inline(always)]
pub fn warp_any(vote: bool) -> bool {
    // SAFETY: called by all lanes of the warp, as `Lane::any` requires.
    unsafe { vote_any(ALL, vote) }
}

/// Which lanes of the warp hold the same value.
#[inline(always)]
pub fn match_any(v: u32) -> u32 {
    sync_warp();
    // SAFETY: called by all threads of the warp.
    unsafe { match_any_sync(ALL, v) }
}

#[inline(always)]
pub fn element<T>(span: Span<T>, i: u32) -> *mut T {
    (span.addr() as *mut T).wrapping_add(i as usize)
}
/// A load of device memory, in the widest pieces that `T`'s alignment allows. (A pointer out of an
/// argument block is generic to the compiler: such a load finds the kind of memory at run time.)
///
/// # Safety
/// `from` is valid for reads, and no lane writes it in this phase.
#[inline(always)]
pub unsafe fn load_global<T: Pod>(from: *const T) -> T {
    let (size, align) = (size_of::<T>(), align_of::<T>());
    let at = from as u64;
    let mut value = MaybeUninit::<T>::uninit();
    let to = value.as_mut_ptr().cast::<u32>();
    let mut word = 0;
    while 4 * word < size {
        let at = at + 4 * word as u64;
        // SAFETY: the pieces are within `from` and `value`, and aligned: sizes are multiples of
        // alignments.
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
pub fn atomic(span: Span<u64>, i: u32) -> &'static AtomicU64 {
    // SAFETY: the span is device memory that outlives the launch, aligned for u64, and `i` is in
    // it. Kernels stay inside their spans, which the emulator checks on every access.
    unsafe { AtomicU64::from_ptr(element(span, i)) }
}
