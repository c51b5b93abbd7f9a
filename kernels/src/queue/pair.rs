//! A unit of work: a pair of nodes that meet, and the pairs below it.

use crate::abi::{Node, Pair, PairArgs, ROOT, TraverseFlags};
use crate::bv::Volume;
use crate::exec::Lane;
use crate::queue::bvtt;

/// The root with itself: the start of every descent.
pub const ROOTS: Pair = Pair { a: ROOT, b: ROOT };

/// The pairs below a unit, at most three, and the kind of each of them (bit k: pair k).
#[derive(Clone, Copy)]
pub struct ChildPairs {
    /// The pairs.
    pub nodes: [Pair; 3],
    /// Their triangles, if both nodes are leaves; never the third.
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

    /// Classifies pair `k`, of nodes `p` and `q`, by whether it overlaps. Its triangles are named
    /// in ascending order.
    #[inline(always)]
    fn note<V>(&mut self, k: usize, overlap: bool, p: &Node<V>, q: &Node<V>) {
        let leaves = p.is_leaf() & q.is_leaf();
        let bit = 1 << k;
        self.units |= if overlap & !leaves { bit } else { 0 };
        self.candidates |= if overlap & leaves { bit } else { 0 };
        self.ends |= if !overlap | leaves { bit } else { 0 };
        let (a, b) = (p.triangle(), q.triangle());
        self.faces[k] = Pair { a: a.min(b), b: a.max(b) };
    }
}

/// The pairs below `unit` that the filters allow. A leaf with itself is no pair.
#[inline(always)]
pub fn below<V: Volume, L: Lane>(lane: &L, to: &PairArgs<V>, unit: Pair) -> ChildPairs {
    let mut below = ChildPairs::NONE;
    let (a, b) = (lane.read(to.nodes, unit.a), lane.read(to.nodes, unit.b));
    if a.is_leaf() & b.is_leaf() {
        return below;
    }
    let together = unit.a == unit.b;
    let in_a = together | bvtt::descends_in_a(unit, a.is_leaf(), b.is_leaf());
    // One path for both nodes, by values: a volume's test is long, and references into a choice
    // would be memory.
    let link = if in_a { a.link } else { b.link };
    let (left, right) = (lane.read(to.nodes, link), lane.read(to.nodes, link + 1));
    let other = if together {
        right
    } else if in_a {
        b
    } else {
        a
    };
    let mut into_left = left.volume.overlaps(&other.volume);
    // For the pairs (left, other) and (right, other); with `together` also (left, left) and (right,
    // right).
    let mut allowed = [true; 4];
    if !to.filters.nodes.is_empty() {
        let node = if together {
            link + 1
        } else if in_a {
            unit.b
        } else {
            unit.a
        };
        let [left, right, other] = [link, link + 1, node].map(|node| to.filters.of(lane, node));
        allowed = [(left, other), (right, other), (left, left), (right, right)]
            .map(|(p, q)| to.filters.allows(lane, p, q));
    }
    into_left &= allowed[0];
    if together {
        let (x, y) = (link, link + 1);
        below.nodes = [Pair { a: x, b: y }, Pair { a: x, b: x }, Pair { a: y, b: y }];
        below.note(0, into_left, &left, &other);
        let still = to.flags.has(TraverseFlags::GRAFTED) & (unit.a == ROOT);
        below.units |= if left.is_leaf() | still | !allowed[2] { 0 } else { 2 };
        below.units |= if right.is_leaf() | !allowed[3] { 0 } else { 4 };
    } else {
        let into_right = right.volume.overlaps(&other.volume) & allowed[1];
        let child = |node| if in_a { Pair { a: node, b: unit.b } } else { Pair { a: unit.a, b: node } };
        below.nodes[0] = child(link);
        below.nodes[1] = child(link + 1);
        below.note(0, into_left, &left, &other);
        below.note(1, into_right, &right, &other);
    }
    below
}
