//! Computations of kernels, without a detector: the narrow tests, their bounds, bounding volumes, a
//! block of the emulator.

mod bounds;
mod bvtt;
mod direction;
mod emulator;
mod exclude;
mod isolate;
mod limits;
mod pairs;
mod prim;
mod queries;
mod sweep;
mod swell;
mod turning;
mod turning_apart;
mod turning_bodies;
mod turning_chords;
mod volume;
