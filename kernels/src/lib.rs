#![no_std]
//! The kernels of nearmiss: what runs on the card, and on the CPU from the same source.
#![cfg_attr(target_arch = "nvptx64", feature(stdarch_nvptx))]

pub mod math;
pub mod prim;

/// The stamp of the sources that this was compiled from (kernels/ptx.sh), exported for the host to compare.
#[cfg(target_arch = "nvptx64")]
#[unsafe(no_mangle)]
pub static NEARMISS_STAMP: u64 = match option_env!("NEARMISS_STAMP") {
    Some(hex) => match u64::from_str_radix(hex, 16) {
        Ok(stamp) => stamp,
        Err(_) => panic!("NEARMISS_STAMP is not 16 hex digits"),
    },
    None => 0,
};

#[cfg(target_arch = "nvptx64")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    // SAFETY: a trap ends the kernel; the host sees a launch failure.
    unsafe { core::arch::nvptx::trap() }
}
