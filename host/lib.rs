//! nearmiss: collision detection for deformable triangle meshes.

pub mod error;
pub mod mesh;
pub mod oracle;

pub use error::Error;
