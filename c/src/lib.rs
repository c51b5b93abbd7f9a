//! The C interface of nearmiss. `include/nearmiss.h` is made from here; what it says at its head holds of all functions.
//!
//! A pointer of the caller is an `Option` of a reference where C types it: then nothing here is unsafe, and NULL is `None`. Where
//! a pointer lies in a struct, the function is unsafe and says what it reads.

mod answer;
mod body;
mod detector;
mod device;
mod error;
mod frame;
mod input;
mod interrupt;
mod on_device;
mod plan;
mod query;
mod records;
mod rows;
mod scene;
mod submit;

pub use answer::*;
pub use body::*;
pub use detector::*;
pub use device::*;
pub use error::{NEARMISS_TEXT, NearmissCode, NearmissError, nearmiss_exit_code};
pub use frame::*;
pub use input::*;
pub use interrupt::*;
pub use on_device::*;
pub use plan::*;
pub use query::*;
pub use records::*;
pub use rows::{NearmissNumber, NearmissRows, nearmiss_doubles, nearmiss_floats};
pub use scene::*;
pub use submit::*;

use std::ffi::c_char;

/// The version of this header, which changes whenever a struct or a function does. Compare it with `nearmiss_abi()` before any other call: one
/// that takes or returns a struct of another version writes where it may not.
pub const NEARMISS_ABI: u32 = 2;

/// The version of the header that this library was built with. This and `nearmiss_version()` are the same in all versions.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_abi() -> u32 {
    NEARMISS_ABI
}

/// The version of nearmiss, such as "0.1.0". It lives as long as the program.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}
