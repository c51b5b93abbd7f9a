//! The square root of `x >= 0`, correctly rounded, on every machine; the only way to it in this
//! crate.

pub use crate::exec::ptx::{sqrt32, sqrt64};
