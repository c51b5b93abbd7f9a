#![no_std]
//! The kernels of nearmiss: what runs on the GPU, and on the CPU from the same source.
//!
//! Nothing here knows a host, a file or an allocator. Shelves hold what is used ([`abi`], [`exec`],
//! [`math`], [`bv`], [`bvh`], [`queue`], [`sort`], [`prim`]); the pipeline [`stage`] holds what
//! happens, one file a stage, in the order in which data flows. [`entry`] is the kernel table.

pub mod abi;
pub mod bv;
pub mod bvh;
pub mod entry;
pub mod exec;
pub mod math;
pub mod prim;
pub mod queue;
pub mod sort;
pub mod stage;
