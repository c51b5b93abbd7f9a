//! Two primitives: the narrow tests.
//!
//! Discrete, from fast to certain: [`moller`] (plain floats, can miss), [`tri_tri`] on the signs of
//! [`orient`] (floats with a proven error bound: right or silent) and of [`exact`] (integers:
//! always right). Continuous: [`cubic`] (the coplanarity cubic; can miss, and says how), and
//! certified, never missing, never late: [`isolate`] (in closed form) and behind it [`inclusion`]
//! (by boxes). [`stencil`] names the fifteen vertex/face and edge/edge tests of two triangles;
//! [`sweep`] tells which of them have boxes that meet. At rest: [`near`], how far they are from
//! each other; [`nearest`], how far two triangles are.

pub mod adjacent;
pub mod cubic;
pub mod exact;
mod flat;
pub mod inclusion;
pub mod isolate;
pub mod moller;
pub mod near;
pub mod nearest;
pub mod orient;
mod poly;
pub mod signs;
pub mod stencil;
pub mod sweep;
pub mod tri_tri;
