//! # Construct: positions → the order of tiles, or a level-ordered tree
//! Paper    the thesis, chapter 5 and section 6.2.4: "the nodes will already be stored in that
//!          order".
//! Steps    [`morton`] gives each triangle a code along a curve; [`crate::sort`] sorts the codes.
//!          All on the device.
//!          Tiles (the default): [`cuts`] cuts the order in halves of halves; [`tile_filters`]
//!          writes the bodies below each node.
//!          Trees: [`tree`] finds the hierarchy of the sorted codes and puts it into level order.
//!          [`treelet`] cuts a tree into pieces of a block's size, for the refit by treelets.
//!          [`graft`] puts a static tree behind a moving one.
//! Departs  the thesis splits nodes top-down with work queues, a level at a time. Here every inner
//!          node finds its range on its own.
//!          The rule is that of Karras, "Maximizing parallelism in the construction of BVHs,
//!          octrees and k-d trees", 2012.
//!          Ranking the nodes by their depths gives the same breadth-first order.
//! Silent   the thesis has no rule for equal codes. Ties are split by the index in sorted order, as
//!          in Karras.
//!          So a million equal triangles make a tree of 21 levels.

pub mod cuts;
pub mod graft;
pub mod morton;
pub mod tile_filters;
pub mod tree;
pub mod treelet;
