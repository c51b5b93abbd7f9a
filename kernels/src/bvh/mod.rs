//! The level-ordered tree: what holds of it, and a checker that names what does not.

use crate::abi::{LEAF, Node, ROOT};

/// Levels that a tree can have: a path from the root splits on one of the 63 bits of the code or, between equal
/// codes, on one of the 32 bits of the index, each at most once; and the leaves.
pub const MAX_LEVELS: u32 = 63 + 32 + 1;

/// The first thing found wrong with a tree. Node numbers are indices into the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Violation {
    /// The list of levels is not: a count, ascending starts from the root on, the end of the nodes.
    Levels,
    /// T1: a child pair begins at an odd index or outside the next level.
    Link {
        /// The parent.
        node: u32,
    },
    /// T2: the children of a level's inner nodes do not follow one another.
    Order {
        /// The parent.
        node: u32,
    },
    /// T3: a node's `last` is not its right child's, or leaves do not ascend.
    Range {
        /// The node.
        node: u32,
    },
    /// T4: a leaf's node is not where `leaf_nodes` says, or its triangle is not one of the body's, or comes twice.
    Leaf {
        /// The leaf, in leaf order.
        leaf: u32,
    },
    /// T5: a box is not exactly the union of its children's.
    Union {
        /// The parent.
        node: u32,
        /// 0, 1, 2: x, y, z.
        axis: u32,
    },
}

/// Checks T1 to T4 (see [`crate::stage::construct::tree`]) and, with `volumes`, T5. `seen` is one false flag for each
/// triangle of the body, whose first triangle is `first`. Cost: linear.
pub fn check(
    nodes: &[Node],
    levels: &[u32],
    leaf_nodes: &[u32],
    (first, seen): (u32, &mut [bool]),
    volumes: bool,
) -> Result<(), Violation> {
    let leaves = leaf_nodes.len();
    let count = levels.first().map_or(0, |&n| n as usize);
    let starts = levels.get(1..count + 2).ok_or(Violation::Levels)?;
    let ends = (starts.first(), starts.last());
    if count == 0 || ends != (Some(&ROOT), Some(&(2 * leaves as u32))) || !starts.is_sorted() {
        return Err(Violation::Levels);
    }
    if nodes.len() < 2 * leaves {
        return Err(Violation::Levels);
    }
    for level in 0..count {
        let mut next = starts[level + 1];
        for at in starts[level]..starts[level + 1] {
            let node = nodes[at as usize];
            if node.is_leaf() {
                let triangle = node.triangle().wrapping_sub(first) as usize;
                let known = leaf_nodes.get(node.last as usize) == Some(&at);
                if !known || seen.get(triangle) != Some(&false) {
                    return Err(Violation::Leaf { leaf: node.last });
                }
                seen[triangle] = true;
                continue;
            }
            let inside = level + 2 < starts.len() && node.link < starts[level + 2];
            if node.link & LEAF != 0
                || !node.link.is_multiple_of(2)
                || node.link < starts[level + 1]
                || !inside
            {
                return Err(Violation::Link { node: at });
            }
            if node.link != next {
                return Err(Violation::Order { node: at });
            }
            next += 2;
            let (left, right) = (nodes[node.link as usize], nodes[node.link as usize + 1]);
            if right.last != node.last || left.last >= right.last {
                return Err(Violation::Range { node: at });
            }
            let union = left.volume().merge(right.volume());
            for axis in 0..3 {
                if volumes && (union.lo[axis] != node.lo[axis] || union.hi[axis] != node.hi[axis]) {
                    return Err(Violation::Union { node: at, axis: axis as u32 });
                }
            }
        }
    }
    match seen.iter().position(|&s| !s) {
        Some(missing) => Err(Violation::Leaf { leaf: missing as u32 }),
        None => Ok(()),
    }
}
