//! Instances: bodies that are meshes with poses, without a vertex in the scene.
//!
//! | file | from | to |
//! | --- | --- | --- |
//! | [`super::tiles`], [`super::tile_triangles`] | boxes of bodies | pairs of bodies |
//! | [`relations`] | pairs of bodies | frames of one in the other, for those whose meshes may meet |
//! | [`nodes`] | pairs of nodes | pairs of nodes below, and pairs of tiles |
//! | [`triangles`] | pairs of tiles | candidates |
//! | [`touching`] | pairs of tiles | pairs of bodies that share a point, undecided candidates |
//! | [`vertices`] | candidates in motion | their vertices, placed; triangles of the scene |
//! | [`within`] | pairs of nodes and tiles | bounds of distances, candidates within them |
//!
//! The volumes of a mesh never change: a pose moves them. Everything below two bodies is tested in
//! their own frames, see [`crate::bvh::relation`].

pub mod nodes;
pub mod relations;
pub mod touching;
pub mod triangles;
pub mod vertices;
pub mod within;
