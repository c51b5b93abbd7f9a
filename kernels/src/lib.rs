#![no_std]
//! The kernels of nearmiss: one source for the GPU and for the CPU.
//!
//! The crate has no host, no files and no allocator. Its tools are [`abi`], [`exec`], [`math`],
//! [`bv`], [`bvh`], [`queue`], [`sort`] and [`prim`]. [`stage`] is the pipeline, one file a stage,
//! in the order in which data flows. [`entry`] is the kernel table.

pub mod abi;
pub mod bv;
pub mod bvh;
pub mod entry;
pub mod exec;
pub mod math;
pub mod prim;
pub mod queue;
#[cfg(test)]
mod random;
pub mod sort;
pub mod stage;
