//! nearmiss: collision detection for deformable triangle meshes.
//!
//! A [`Detector`] puts a [`Scene`] of bodies on a [`Device`], moves them and answers queries.
//! Answers on a CPU and on an NVIDIA GPU are bit-identical. [`Error`] names the fault and the
//! remedy.
//!
//! A cloth that sinks onto a table. One detector answers several queries of each step:
//!
//! ```
//! use nearmiss::scene::{Motion, Scene};
//! use nearmiss::{Body, Continuous, Detector, Device, Discrete, Mesh, Near, device::Backend, mesh::Positions};
//!
//! let triangle = |z: f32| Positions::F32(vec![[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]]);
//! let mesh = |name, z| Mesh::new(name, triangle(z), vec![[0, 1, 2]]);
//! let mut scene = Scene::new();
//! let cloth = scene.add(Body::deformable(mesh("cloth", 0.5)?));
//! let table = scene.add(Body::fixed(mesh("table", 0.0)?));
//! let mut detector = Detector::new(Device::open(Backend::Auto, None)?, scene)?;
//! for step in 0..4 {
//!     let [t0, t1] = [step, step + 1].map(|k| triangle(0.5 - 0.2 * k as f32));
//!     detector.update(&[(cloth, Motion::step(&t0, &t1))])?;
//!     for contact in detector.query(&Continuous::default())?.iter() {
//!         assert!(contact.bodies.contains(&cloth) && contact.bodies.contains(&table));
//!         println!(
//!             "step {step}: {:?} {} and {} at {:.3}",
//!             contact.kind, contact.feature_a, contact.feature_b, contact.toi
//!         );
//!     }
//!     let near = detector.query(&Near::within(0.2))?;
//!     println!("step {step}: {} pairs within 0.2", near.len());
//!     assert!(detector.query(&Discrete::default())?.is_empty());
//! }
//! # Ok::<(), nearmiss::Error>(())
//! ```
//!
//! | query | rows of its answer |
//! | --- | --- |
//! | [`Discrete`] | triangles that share a point now |
//! | [`Continuous`] | features that meet in a step, and their first times |
//! | [`Earliest`] | the first contact of a step: the limit of the step |
//! | [`Near`] | features within a distance, their distance and nearest points |
//! | [`Distance`] | the two nearest bodies, their distance and nearest points |
//!
//! [`Query`] holds any of these, for programs that choose at run time. None of them misses a
//! contact. [`research`] is the laboratory: other solvers, volumes and walks, and the paper's system.
//!
//! [`MultiDetector`] divides a scene among several devices. [`Detector::geometry`] computes
//! vertices, weights, points and normals of contacts, and the segments in which triangles cross.
//!
//! A simulator with data on the GPU passes its stream ([`Device::from_stream`]) and its arrays
//! ([`Motion::OnDevice`](scene::Motion::OnDevice)). It submits frames that neither allocate nor
//! wait ([`Detector::submit`]).
//!
//! The folder `examples` of the repository has programs of some twenty lines. They show a cloth
//! alone and with an obstacle, a rigid pile, and 1,000 environments. Others show near pairs,
//! distances, a step limited by `earliest`, and device-resident bodies.

// A new variant shows every place that must handle it.
#![warn(clippy::wildcard_enum_match_arm)]

pub mod contacts;
mod detector;
pub mod device;
pub mod error;
pub mod memory;
pub mod mesh;
mod pipeline;
pub mod query;
pub mod research;
#[cfg(test)]
mod samples;
pub mod scene;
mod several;
mod stages;
#[doc(hidden)]
pub mod words;

#[cfg(feature = "nalgebra")]
pub use nalgebra;

pub use contacts::{Answer, Contact, Contacts, Rows};
pub use detector::{Detector, plan};
pub use device::{Device, Interrupt, listen, listening};
pub use error::Error;
pub use mesh::Mesh;
pub use query::{BodyDistances, BodyPairs, Continuous, Discrete, Distance, Earliest, Near, Query};
pub use scene::{Body, Scene, Thickness};
pub use several::{DeviceShare, MultiDetector};
pub use stages::{Stage, Stages};

/// The program of the README is a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;

/// The programs of the book are tests.
#[cfg(doctest)]
pub mod book {
    #[doc = include_str!("../docs/for/cloth-and-ipc.md")]
    pub struct ClothAndIpc;
    #[doc = include_str!("../docs/for/rigid.md")]
    pub struct Rigid;
}
