//! Files of meshes: read, cut, welded, or refused by their reason.
//!
//! The allocator of `fuzz_readers` counts for each thread, so that no other test changes its
//! counts.

mod bad_input;
mod formats;
mod fuzz_readers;
mod gltf;
mod loose;
mod mesh;
mod notes;
mod polygons;
mod problems;
