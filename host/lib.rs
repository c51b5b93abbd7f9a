//! nearmiss: collision detection for deformable triangle meshes.

#[cfg(all(feature = "cuda", target_os = "linux"))]
#[path = "device/driver.rs"]
pub mod driver;
pub mod error;
pub mod mesh;
pub mod oracle;

pub use error::Error;
