//! The level-ordered tree: its invariants, and a checker that names the broken one.

pub mod centres;
pub mod course;
pub mod filter;
pub mod gap;
pub mod group;
pub mod horizon;
pub mod leaf;
pub mod motion;
pub mod on_chip;
pub mod pieces;
pub mod placing;
pub mod relation;
pub mod rims;
pub mod thick;
pub mod tile_box;
pub mod tiles;
pub mod turns;

use crate::abi::{LEAF, Link, Node, NodeFilter};
use crate::bv::Volume;

/// Bits of a triangle's Morton code: four passes of the radix sort.
pub const CODE_BITS: u32 = 32;

/// Most levels of a tree. A path from the root splits on each bit of the code at most once. Between
/// equal codes it splits on each of the 32 bits of the index at most once. Leaves add one level.
pub const MAX_LEVELS: u32 = CODE_BITS + 32 + 1;

/// Leaves of the largest subtree of a treelet, and of the chunk in which a treelet's subtrees
/// begin. So a treelet has fewer than twice as many. It equals the lanes of a block. The volumes of
/// 512 leaves, 56 bytes each, fit on chip.
pub const TREELET: u32 = 256;
const _: () = assert!(TREELET <= 512, "a merge counts slots with ten bits");

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
    /// T4: a leaf's node is not the one in `leaf_nodes`, or its triangle is not the body's, or
    /// appears twice.
    Leaf {
        /// The leaf, in leaf order.
        leaf: u32,
    },
    /// T5: a pair of siblings does not know its parent.
    Parent {
        /// The parent.
        node: u32,
    },
    /// T6: a node's volume is not the merge of its children's, or its links are not the tree's.
    Merge {
        /// The parent.
        node: u32,
    },
    /// T8: a node's filter is not that of the triangles below it.
    Filter {
        /// The node.
        node: u32,
    },
    /// A node does not name the hub of all triangles below it. Or its rim misses one of their
    /// opposite edges.
    Rim {
        /// The node.
        node: u32,
    },
    /// T9: a volume does not hold a triangle at every time, exactly.
    Outside {
        /// The triangle's leaf.
        leaf: u32,
        /// The volume's level: 0 its own, 1 its tile's, and so on upward.
        level: u32,
    },
    /// T7: a node's volume is not the one fitted to the points below it (a leaf's: to its
    /// triangle), or its links are not the tree's.
    Fit {
        /// The node.
        node: u32,
    },
}

/// A tree on the host, to be checked.
#[derive(Clone, Copy)]
pub struct Tree<'a> {
    /// The nodes; the first is not used.
    pub links: &'a [Link],
    /// The parent of each pair of siblings.
    pub pair_parents: &'a [u32],
    /// Number of levels, then the start of each, then the end of the last.
    pub levels: &'a [u32],
    /// Each leaf's node.
    pub leaf_nodes: &'a [u32],
    /// The root's index: nodes before it are not used.
    pub root: u32,
    /// Triangles by their place among those of the tree's bodies; `None` for no triangle of theirs.
    pub place: &'a dyn Fn(u32) -> Option<usize>,
}

/// Checks T1 to T5 (see [`crate::stage::construct::tree`]). `seen` is one false flag for each
/// triangle of the bodies. Cost: linear.
///
/// # Errors
/// The first violation.
pub fn check(tree: &Tree, seen: &mut [bool]) -> Result<(), Violation> {
    let Tree { links, pair_parents, levels, leaf_nodes, root, place } = *tree;
    let leaves = leaf_nodes.len();
    let count = levels.first().map_or(0, |&n| n as usize);
    let starts = levels.get(1..count + 2).ok_or(Violation::Levels)?;
    let ends = (starts.first(), starts.last());
    let end = root + 2 * leaves as u32 - 1;
    if count == 0 || ends != (Some(&root), Some(&end)) || !starts.is_sorted() {
        return Err(Violation::Levels);
    }
    if links.len() < end as usize {
        return Err(Violation::Levels);
    }
    for level in 0..count {
        let mut next = starts[level + 1];
        for at in starts[level]..starts[level + 1] {
            let node = links[at as usize];
            if node.is_leaf() {
                let known = leaf_nodes.get(node.last as usize) == Some(&at);
                let fresh = place(node.triangle()).filter(|&at| seen.get(at) == Some(&false));
                let Some(triangle) = fresh.filter(|_| known) else {
                    return Err(Violation::Leaf { leaf: node.last });
                };
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
            let (left, right) = (links[node.link as usize], links[node.link as usize + 1]);
            if right.last != node.last || left.last >= right.last {
                return Err(Violation::Range { node: at });
            }
            if pair_parents.get(node.link as usize / 2) != Some(&at) {
                return Err(Violation::Parent { node: at });
            }
        }
    }
    match seen.iter().position(|&s| !s) {
        Some(missing) => Err(Violation::Leaf { leaf: missing as u32 }),
        None => Ok(()),
    }
}

/// Checks T8 on a sound tree: `filters` has as many elements as `links`; `leaf` returns the filter
/// of a triangle. Cost: linear.
///
/// # Errors
/// The first violation, from the last node to the root.
pub fn check_filters(
    links: &[Link],
    filters: &[NodeFilter],
    root: u32,
    leaf: impl Fn(u32) -> NodeFilter,
) -> Result<(), Violation> {
    for (at, link) in links.iter().enumerate().skip(root as usize).rev() {
        let wanted = if link.is_leaf() {
            leaf(link.triangle())
        } else {
            filters[link.link as usize].above(filters[link.link as usize + 1])
        };
        if filters[at] != wanted {
            return Err(Violation::Filter { node: at as u32 });
        }
    }
    Ok(())
}

/// Checks T6 and T7 on a sound tree, from its root on. `nodes` has as many elements as `links`.
/// `leaf` returns the volume of a leaf from its triangle. `fitted` returns that of an inner node
/// from its first and last leaf, or `None` for a merge. Cost: a merge or a fit and a walk down a
/// node.
///
/// # Errors
/// The first violation.
pub fn check_volumes<V: Volume>(
    links: &[Link],
    nodes: &[Node<V>],
    root: u32,
    leaf: impl Fn(u32) -> V,
    fitted: impl Fn(u32, u32) -> Option<V>,
) -> Result<(), Violation> {
    for (at, (link, node)) in links.iter().zip(nodes).enumerate().skip(root as usize) {
        let (at, mut first) = (at as u32, *link);
        while !first.is_leaf() {
            first = links[first.link as usize];
        }
        let (volume, violation) = if link.is_leaf() {
            (leaf(link.triangle()), Violation::Fit { node: at })
        } else if let Some(volume) = fitted(first.last, link.last) {
            (volume, Violation::Fit { node: at })
        } else {
            let [left, right] = [0, 1].map(|i| nodes[link.link as usize + i].volume);
            (left.merge(&right), Violation::Merge { node: at })
        };
        if *node != link.with(volume) {
            return Err(violation);
        }
    }
    Ok(())
}
