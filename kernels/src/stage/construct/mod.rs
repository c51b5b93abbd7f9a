//! # Construct: positions → level-ordered tree
//! Paper    thesis chapter 5 and section 6.2.4, "the nodes will already be stored in that order".
//! Steps    [`morton`] orders the triangles along a curve, [`crate::sort`] sorts them, [`tree`] finds the hierarchy of the
//!          sorted codes and puts it into level order. All of it on the device.
//!          [`cuts`] cuts what the curve has put in order in halves of halves, where tiles are made of it.
//!          [`graft`] puts a tree that does not change beside one that does.
//!          [`treelet`] cuts the tree into pieces of a block's size, where the refit asks for them.
//! Departs  the thesis splits nodes top-down with work queues, a level at a time. Here every inner node finds its range
//!          on its own (after Karras, "Maximizing parallelism in the construction of BVHs, octrees and k-d trees", 2012),
//!          and ranking the nodes by their depths gives the same breadth-first order.
//! Silent   the thesis does not say what equal codes do. Ties are split by the index in sorted order, as Karras
//!          does, so a million equal triangles make a tree of 21 levels.

pub mod cuts;
pub mod graft;
pub mod morton;
pub mod tile_filters;
pub mod tree;
pub mod treelet;
