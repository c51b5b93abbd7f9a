//! The C interface of nearmiss. `include/nearmiss.h` is made from here; its head holds for all functions.
//!
//! A pointer that C types is an `Option` of a reference: NULL is `None`, and nothing here is unsafe.
//! A function that reads a pointer inside a struct is unsafe and names what it reads.

mod answer;
mod body;
mod detector;
mod device;
mod edits;
mod error;
mod exclusions;
mod extras;
mod frame;
mod geometry;
mod grouped;
mod interrupt;
mod matrix;
mod motion;
mod names;
mod notes;
mod on_device;
mod plan;
mod poses;
mod positions;
mod query;
mod records;
mod research;
mod rows;
mod scene;
mod several;
mod submit;
mod summary;

pub use answer::*;
pub use body::*;
pub use detector::*;
pub use device::*;
pub use edits::*;
pub use error::{NEARMISS_TEXT, NearmissCode, NearmissError, nearmiss_exit_code};
pub use exclusions::*;
pub use extras::*;
pub use frame::*;
pub use geometry::*;
pub use grouped::*;
pub use interrupt::*;
pub use matrix::*;
pub use motion::*;
pub use names::*;
pub use notes::*;
pub use on_device::*;
pub use plan::*;
pub use poses::*;
pub use positions::*;
pub use query::*;
pub use records::*;
pub use research::*;
pub use rows::{NearmissNumber, NearmissRows, nearmiss_doubles, nearmiss_floats};
pub use scene::*;
pub use several::*;
pub use submit::*;
pub use summary::*;

use std::ffi::c_char;

/// The version of this header. It changes whenever a struct or a function changes. Compare it with
/// `nearmiss_abi()` before any other call: a library of another version has other structs.
pub const NEARMISS_ABI: u32 = 8;

/// The version of the header that this library was built with. This function and
/// `nearmiss_version()` are the same in all versions.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_abi() -> u32 {
    NEARMISS_ABI
}

/// The version of nearmiss, such as "0.1.0". The text lives as long as the program.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}
