//! # Refit: volumes of a level → volumes of the level above
//! Paper    the thesis, section 6.2.4, "Parallel hierarchy refitting", for [`levels`]. The others
//!          are not in the paper.
//!
//! | file | broad phase | launches | used |
//! | --- | --- | --- | --- |
//! | [`meshes`] | instances | vertices, triangles, one a level, bodies | bodies that deform, as instances |
//! | [`tiles`] | tiles: **the default** | one a level, from the third on | every machine |
//! | [`treelets`] | trees | one, with barriers within blocks | default of trees on a GPU |
//! | [`levels`] | trees, the paper's | one a level | default of trees on a CPU |
//!
//! Both of trees merge left with right, so they give the same bits.

pub mod levels;
pub mod meshes;
pub mod tiles;
pub mod treelets;
