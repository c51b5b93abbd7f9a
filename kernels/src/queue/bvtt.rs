//! The bounding volume test tree: the pairs of nodes that a traversal of a tree with itself may
//! come to, and who is whose parent there.
//!
//! A pair (a, b) descends into the children of one of its nodes: the one with the smaller index,
//! which is the one nearer the root since nodes lie in level order; the other where that one is a
//! leaf. A node paired with itself descends into three pairs: left with left, left with right,
//! right with right.
//!
//! So every pair has one parent, and it can be told from the pair: on a path the nodes that were
//! descended ascend, for the smaller of two always goes first and is replaced by a larger. The last
//! one is the larger of the two parents.

use crate::abi::Pair;

/// Whether the pair (a, b) of different nodes, not both leaves, descends in `a`.
#[inline]
pub fn descends_in_a(pair: Pair, a_is_leaf: bool, b_is_leaf: bool) -> bool {
    !a_is_leaf & (b_is_leaf | (pair.a <= pair.b))
}

/// The parent of a pair, from the parents of its nodes ([`crate::abi::NONE`] for the root's). Not
/// to be asked of the root with itself.
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
