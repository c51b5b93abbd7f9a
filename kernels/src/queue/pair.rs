//! A unit of work: a pair of nodes that meet, and the pairs below it.

use crate::abi::{Node, Pair, PairArgs, ROOT, SELF};
use crate::bv::Volume;
use crate::exec::Lane;
use crate::queue::bvtt;

/// The pair of roots, where every descent begins: the only unit whose volumes were not tested, and the only one of two
/// leaves.
pub const ROOTS: Pair = Pair { a: ROOT, b: ROOT };

/// The pairs below a unit, at most three, and what each of them is (bit k: pair k).
#[derive(Clone, Copy)]
pub struct ChildPairs {
    /// The pairs.
    pub nodes: [Pair; 3],
    /// Their triangles, where both nodes are leaves; never the third.
    pub faces: [Pair; 2],
    /// They overlap and go deeper: units.
    pub units: u32,
    /// They are leaves and overlap: candidates.
    pub candidates: u32,
    /// The descent ends here: apart, or leaves.
    pub ends: u32,
}

impl ChildPairs {
    /// Nothing.
    pub const NONE: ChildPairs = ChildPairs {
        nodes: [Pair { a: 0, b: 0 }; 3],
        faces: [Pair { a: 0, b: 0 }; 2],
        units: 0,
        candidates: 0,
        ends: 0,
    };

    /// Says of pair `k`, of nodes `p` and `q`, what it is, from whether it overlaps. Its triangles are named in this order,
    /// or in the other; in one mesh by their numbers.
    #[inline(always)]
    fn note<V>(&mut self, k: usize, overlap: bool, (p, q): (&Node<V>, &Node<V>), (own, other): (bool, bool)) {
        let leaves = p.is_leaf() & q.is_leaf();
        let bit = 1 << k;
        self.units |= if overlap & !leaves { bit } else { 0 };
        self.candidates |= if overlap & leaves { bit } else { 0 };
        self.ends |= if !overlap | leaves { bit } else { 0 };
        let (a, b) = (p.triangle(), q.triangle());
        let swap = if own { b < a } else { other };
        self.faces[k] = Pair { a: if swap { b } else { a }, b: if swap { a } else { b } };
    }
}

/// The pairs below `unit`. A leaf with itself is no pair; two roots that are leaves are the pair below themselves.
#[inline(always)]
pub fn below<V: Volume, L: Lane>(l: &L, to: &PairArgs<V>, unit: Pair) -> ChildPairs {
    let mut below = ChildPairs::NONE;
    let own = to.flags & SELF != 0;
    let (a, b) = (l.read(to.queries, unit.a), l.read(to.nodes, unit.b));
    if a.is_leaf() & b.is_leaf() {
        if !own {
            below.nodes[0] = unit;
            below.note(0, a.volume.overlaps(&b.volume), (&a, &b), (own, false));
        }
        return below;
    }
    let together = own & (unit.a == unit.b);
    let in_a = together | bvtt::descends_in_a(unit, a.is_leaf(), b.is_leaf());
    // One path for both trees, by values: a volume's test is long, and references into a choice would be memory.
    let (link, nodes) = if in_a { (a.link, to.queries) } else { (b.link, to.nodes) };
    let (left, right) = (l.read(nodes, link), l.read(nodes, link + 1));
    let other = if together {
        right
    } else if in_a {
        b
    } else {
        a
    };
    let into_left = left.volume.overlaps(&other.volume);
    if together {
        let (x, y) = (link, link + 1);
        below.nodes = [Pair { a: x, b: y }, Pair { a: x, b: x }, Pair { a: y, b: y }];
        below.note(0, into_left, (&left, &other), (own, false));
        below.units |= if left.is_leaf() { 0 } else { 2 } | if right.is_leaf() { 0 } else { 4 };
    } else {
        let into_right = right.volume.overlaps(&other.volume);
        let child = |node| if in_a { Pair { a: node, b: unit.b } } else { Pair { a: unit.a, b: node } };
        below.nodes[0] = child(link);
        below.nodes[1] = child(link + 1);
        below.note(0, into_left, (&left, &other), (own, !in_a));
        below.note(1, into_right, (&right, &other), (own, !in_a));
    }
    below
}
