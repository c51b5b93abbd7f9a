//! nearmiss: collision detection for deformable triangle meshes.

pub mod cli;
pub mod contacts;
pub mod device;
pub mod error;
pub mod mesh;
pub mod oracle;
pub mod pipeline;
pub mod query;
pub mod report;
pub mod scene;

pub use contacts::{Answer, Contact, Contacts};
pub use device::Device;
pub use error::Error;
pub use mesh::{Body, Mesh};
pub use pipeline::Session;
pub use query::Query;
