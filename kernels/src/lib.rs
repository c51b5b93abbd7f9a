#![no_std]
//! The kernels of nearmiss: what runs on the card, and on the CPU from the same source.

pub mod math;
pub mod prim;
