//! The GPU: the only room with intrinsics and assembly. Function names follow `cuda_std` if it has
//! them.
//!
//! Shared memory is the launch's dynamic shared memory; the collectives have a few words of their
//! own.

#[cfg(target_arch = "nvptx64")]
mod coherent;
#[cfg(target_arch = "nvptx64")]
mod gpu;
#[cfg(target_arch = "nvptx64")]
mod raw;
#[cfg(target_arch = "nvptx64")]
mod thread;

#[cfg(target_arch = "nvptx64")]
pub use gpu::Gpu;
/// Whether lanes run one after another: then one may skip work that its answer does not need. A
/// GPU's lanes go side by side: work for one of them costs all of them, and a branch around it
/// more.
pub const ALONE: bool = cfg!(not(target_arch = "nvptx64"));
/// The smaller and the larger of two finite numbers, of two zeros either. A quotient that divides
/// no zero. The square root. The last two are correctly rounded on every machine.
#[cfg(target_arch = "nvptx64")]
pub use raw::{greater32, lesser32, ratio32, ratio64, sqrt32, sqrt64};

#[cfg(not(target_arch = "nvptx64"))]
mod host;
#[cfg(not(target_arch = "nvptx64"))]
pub use host::{greater32, lesser32, ratio32, ratio64};
#[cfg(not(target_arch = "nvptx64"))]
pub use libm::{sqrt as sqrt64, sqrtf as sqrt32};
