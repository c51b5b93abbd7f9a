//! # Fit: positions → volumes of triangles
//! Paper    the thesis, section 6.2.4, for [`leaves`]. [`tiles`] and [`rims`] are not in the paper.
//!
//! | file | broad phase | writes volumes of | used |
//! | --- | --- | --- | --- |
//! | [`tiles`] | tiles: **the default** | triangles, tiles, nodes above tiles | each frame |
//! | [`bodies`] | instances | bodies, groups, nodes above groups | each frame of rigid scenes |
//! | [`moving_bodies`] | instances | the same, around a step | each frame of rigid scenes in motion |
//! | [`rims`] | tiles | edges opposite to hubs | if adjacent pairs are kept |
//! | [`leaves`] | trees, the paper's | leaves | by the refit by level |
//! | [`leaves`] `groups` | trees | nodes with few leaves | by oriented boxes |
//!
//! The refit by treelets fits its leaves itself: see [`crate::stage::refit`].

pub mod bodies;
pub mod leaves;
pub mod moving_bodies;
pub mod rims;
pub mod tiles;
