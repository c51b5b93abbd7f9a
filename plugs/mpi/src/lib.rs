//! One scene over the ranks of MPI for [`nearmiss`]: collision detection for a scene that outgrows
//! one machine.
//!
//! Each rank owns whole bodies, or a part of a body's triangles ([`Piece`]), and alone knows their
//! positions. Boxes are exchanged, then the triangles that may meet those of another rank.
//! [`RankDetector`] answers discrete, continuous, earliest and near queries. Rows and hash are those
//! of one machine, to the bit.
//!
//! ```no_run
//! use nearmiss::device::{Backend, Device};
//! use nearmiss::{Body, Continuous, Mesh, mesh::Positions, scene::{Motion, Scene}};
//! use nearmiss_mpi::{Division, RankDetector, pieces, program};
//!
//! fn main() -> std::process::ExitCode {
//!     program(|ranks| {
//!         let at = |z: f32| Positions::F32(vec![[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]]);
//!         let (pieces, device) = ranks.run(|| {
//!             let body = |z| Ok::<_, nearmiss::Error>(Body::deformable(Mesh::new("sheet", at(z), vec![[0, 1, 2]])?));
//!             let scene = Scene::from(vec![body(0.0)?, body(1.0)?]);
//!             let own = pieces(&scene, Division::Bodies, ranks.rank(), ranks.count())?;
//!             Ok((own, Device::open(Backend::Auto, None)?))
//!         })?;
//!         let mut detector = RankDetector::new(ranks, device, pieces, &[])?;
//!         detector.update_whole(&[(1, Motion::step(&at(1.0), &at(-1.0)))])?;
//!         let found = detector.query(Continuous::default())?;
//!         if let Some(all) = detector.gather(&found)? {
//!             println!("{} contacts, hash {:016x}", all.count, all.hash());
//!         }
//!         Ok(())
//!     })
//!     .into()
//! }
//! ```

mod answer;
mod boxes;
mod bytes;
mod chunks;
mod detector;
mod error;
mod ghosts;
mod local;
mod numbers;
mod piece;
mod place;
#[doc(hidden)]
pub mod plant;
mod question;
mod ranks;
mod rows;
mod setup;
mod share;

pub use answer::RankAnswer;
pub use detector::RankDetector;
pub use error::RankError;
pub use piece::Piece;
pub use ranks::{Bytes, Ranks, program};
pub use share::{Division, left_out, pieces};
