//! # Traverse: volumes → candidates, the pairs of triangles for the narrow phase
//!
//! Every walk lists `pairs = {(a, b) : a < b, volumes overlap, filters allow, no common vertex}`.
//! [`KEEP_ADJACENT`](crate::abi::TraverseFlags::KEEP_ADJACENT) keeps pairs with a common vertex.
//! For a volume whose tests nest the set is the same by every walk. Tests that do not nest, and the
//! rims of tiles, leave out pairs that do not meet. So contacts are the same always.
//!
//! | file | broad phase | used | source |
//! | --- | --- | --- | --- |
//! | [`tiles`], [`tile_triangles`] | tiles | **the default** (1) | not in the paper |
//! | [`instances`] | instances | **the default** of discrete queries of rigid scenes | not in the paper |
//! | [`per_leaf`] | trees | default of trees on a CPU; on a GPU of `Aabb` (2) | Karras 2012 |
//! | [`queue`] | trees | default of trees on a GPU, other volumes (2) | section 6.2 |
//! | [`steal`] | trees | on request | departs from section 6.2 |
//! | [`front`] | trees | on request | section 6.2.6 |
//! | [`nearest`] | trees | every distance query, and no other | section 6.2; Larsen 1999 |
//!
//! Sections are those of Lauterbach's thesis, see [`crate::stage`].
//!
//! 1. Tiles answer every query except distance, on every machine, with volumes `Aabb` and `Linear`.
//!    Only tiles take a sample, which gives an earliest query its bound (the entries `…_before`).
//!    Only tiles divide work among devices, leave out fans by their rims, and have a chosen order.
//! 2. Trees are used if the caller chooses trees, a refit or a walk of trees. They are the default
//!    for oriented boxes, whose merges into tiles are loose.
//!
//! On a GPU the walk by leaves has a budget of steps. A longer walk spills the rest of its stack,
//! and [`per_leaf::units`] continues it. On a CPU no walk spills. [`queue`] and [`steal`] test
//! pairs of nodes: fewer tests, which pays for costly volumes.
//!
//! Filters are environments, groups and bodies tested against themselves. In a scene with pairs of
//! bodies that are left out, [`left_out`] then drops their candidates.

pub mod front;
pub mod instances;
pub mod left_out;
pub mod nearest;
pub mod per_leaf;
pub mod queue;
pub mod steal;
pub mod tile_triangles;
pub mod tiles;
