//! nearmiss: collision detection for deformable triangle meshes.
//!
//! [`Detector`] is the front door: a [`Scene`] of bodies in, [`Contacts`] out, on the CPU or on an NVIDIA GPU, to the same bit.
//! [`Query`] holds every choice; [`Device`] is where it runs; [`Error`] says who must act.

pub mod contacts;
mod detector;
pub mod device;
pub mod error;
#[doc(hidden)]
pub mod memory;
pub mod mesh;
#[doc(hidden)]
pub mod pipeline;
pub mod query;
#[cfg(test)]
mod samples;
pub mod scene;
#[doc(hidden)]
pub mod words;

pub use contacts::{Answer, Contact, Contacts};
pub use detector::Detector;
pub use device::Device;
pub use error::Error;
pub use mesh::{Body, Mesh};
pub use pipeline::{Stage, Stages};
pub use query::Query;
pub use scene::Scene;

/// The front page's program is a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;
