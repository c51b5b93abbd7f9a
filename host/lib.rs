//! nearmiss: collision detection for deformable triangle meshes.

pub mod error;
pub mod mesh;
pub mod oracle;
pub mod scene;

pub use error::Error;
