//! nearmiss: collision detection for deformable triangle meshes.
//!
//! [`Session`] is the front door: bodies in, [`Contacts`] out, on the CPU or on an NVIDIA card, to the same bit. [`Query`]
//! holds every choice; [`Device`] is where it runs; [`Error`] says who must act.

mod case;
pub mod cli;
pub mod contacts;
pub mod device;
pub mod error;
pub mod extremes;
pub mod mesh;
pub mod oracle;
pub mod pairs;
pub mod pipeline;
pub mod query;
pub mod report;
pub mod scene;
mod tables;
pub mod trade;

pub use case::{Case, Features};
pub use contacts::{Answer, Contact, Contacts};
pub use device::Device;
pub use error::Error;
pub use mesh::{Body, Mesh};
pub use pipeline::Session;
pub use query::Query;

/// The front page's program is a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;
