//! Tests of two primitives: the narrow phase.
//!
//! | test | kind | certainty |
//! | --- | --- | --- |
//! | [`moller`] | discrete, in plain floats; the paper's | can miss |
//! | [`tri_tri`] on signs of [`orient`] | discrete, floats with a bound | right or uncertain |
//! | [`at_once`], all of those signs | discrete, floats with a bound | right or uncertain |
//! | [`crossing`] on signs of either | discrete, whether they cross | as the signs |
//! | [`planes`], in f32 with an error | discrete | apart or uncertain |
//! | [`tri_tri`] on signs of [`exact`] | discrete, in integers | always right |
//! | [`cubic`] | continuous, the coplanarity cubic; the paper's | can miss |
//! | [`isolate`] | continuous, in closed form | no miss, never late |
//! | [`inclusion`] | continuous, by boxes, behind [`isolate`] | no miss, never late |
//! | [`approach`] | whether two features come nearer than at the start | exact, or undecided |
//! | [`near`] | distance of two features at rest | proven bounds |
//! | [`nearest`] | distance of two triangles at rest | proven bounds |
//! | [`geometry`] | weights, nearest points and normal of two features | as [`near`] |
//!
//! [`stencil`] names the fifteen vertex/face and edge/edge tests of two triangles. [`sweep`]
//! selects those whose boxes meet. [`direction`] first leaves out triangles that need none of them.

pub mod adjacent;
pub mod approach;
pub mod at_once;
pub mod balls;
pub mod crossing;
pub mod cubic;
pub mod direction;
pub mod exact;
mod flat;
pub mod geometry;
pub mod inclusion;
pub mod isolate;
pub mod moller;
pub mod near;
pub mod nearest;
pub mod orient;
pub mod planes;
mod poly;
pub mod signs;
pub mod stencil;
pub mod sweep;
pub mod tri_tri;
pub mod turning;
