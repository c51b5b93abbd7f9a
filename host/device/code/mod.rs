//! The kernels' code: its form on each machine.

#[cfg(any(feature = "cuda", test))]
#[allow(dead_code, reason = "build.rs uses the rest")]
pub mod cubins;
#[cfg(any(feature = "cuda", test))]
pub mod ptx;

use super::{Device, Machine};

impl Device {
    /// The form of the kernels' code on this machine: machine code, or PTX that the driver compiles
    /// at a kernel's first use, and why machine code is not used.
    pub fn code(&self) -> String {
        match &*self.machine {
            Machine::Emulator(_) => "Rust, compiled for the CPU".into(),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.code(),
        }
    }
}
