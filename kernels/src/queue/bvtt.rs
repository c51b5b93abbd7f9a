//! The bounding volume test tree: the pairs of nodes that a traversal of a tree with itself may
//! visit, and the parent of each pair.
//!
//! A pair (a, b) descends into the children of one of its nodes: the one with the smaller index.
//! That is the one nearer the root, since nodes are in level order. If it is a leaf, the other
//! descends. A node paired with itself descends into three pairs: left with left, left with right,
//! right with right.
//!
//! So every pair has one parent, and the pair determines it. On a path the descended nodes ascend:
//! the smaller of two goes first and is replaced by a larger one. The last one is the larger of the
//! two parents.

use crate::abi::Pair;

/// Whether the pair (a, b) of different nodes, not both leaves, descends in `a`.
#[inline]
pub fn descends_in_a(pair: Pair, a_is_leaf: bool, b_is_leaf: bool) -> bool {
    !a_is_leaf & (b_is_leaf | (pair.a <= pair.b))
}

/// The parent of a pair, from the parents of its nodes ([`crate::abi::NONE`] for the root's). The
/// pair of the root with itself has none and is not allowed.
#[inline]
pub fn parent(pair: Pair, parent_a: u32, parent_b: u32) -> Pair {
    use crate::abi::NONE;
    let together = parent_a == parent_b;
    let in_a = parent_b == NONE || (parent_a != NONE && parent_a > parent_b);
    match (together, in_a) {
        (true, _) => Pair { a: parent_a, b: parent_b },
        (false, true) => Pair { a: parent_a, b: pair.b },
        (false, false) => Pair { a: pair.a, b: parent_b },
    }
}
