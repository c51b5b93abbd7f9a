//! # Tiles: positions → candidates, without pointers
//! Idea     32 triangles that are neighbours along a curve are a tile, a warp's worth. 16 tiles have a node above them, 16 of these
//!          another, until few are left: [`Levels`](crate::bvh::tiles::Levels) says where. No links are built, so that a frame is
//!          passes over neighbours in memory.
//! Paper    nothing of the seed's. Groups of primitives as leaves: Lauterbach, Mo, Manocha 2010 merge nodes only; tests of all
//!          against all on chip: as sweeps of a cell in spatial hashing do.
//! Stages   [`filters`] construct, [`fit`] fit and refit, [`pairs`] and [`triangles`] traverse.

pub mod filters;
pub mod fit;
pub mod pairs;
pub mod triangles;
