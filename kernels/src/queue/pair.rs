//! A unit of work: a pair of nodes that meet, and the pairs below it.

use crate::abi::{Node, Pair, PairArgs, ROOT, SELF};
use crate::bv::Volume;
use crate::exec::Lane;
use crate::queue::bvtt;

/// The pair of roots, where every descent begins: the only unit whose volumes were not tested.
pub const ROOTS: Pair = Pair { a: ROOT, b: ROOT };

/// The pairs below a unit, at most three, and what each of them is (bit k: pair k).
#[derive(Clone, Copy)]
pub struct Below {
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

impl Below {
    /// Nothing.
    pub const NONE: Below = Below {
        nodes: [Pair { a: 0, b: 0 }; 3],
        faces: [Pair { a: 0, b: 0 }; 2],
        units: 0,
        candidates: 0,
        ends: 0,
    };

    /// Says of pair `k` what it is, from whether it overlaps.
    #[inline(always)]
    fn note<V>(&mut self, k: usize, overlap: bool, (p, q): (&Node<V>, &Node<V>), own: bool) {
        let leaves = p.is_leaf() & q.is_leaf();
        let bit = 1 << k;
        self.units |= if overlap & !leaves { bit } else { 0 };
        self.candidates |= if overlap & leaves { bit } else { 0 };
        self.ends |= if !overlap | leaves { bit } else { 0 };
        let (a, b) = (p.triangle(), q.triangle());
        let swap = own & (b < a);
        self.faces[k] = Pair { a: if swap { b } else { a }, b: if swap { a } else { b } };
    }
}

/// The pairs below `unit`. A leaf with itself is no pair.
#[inline(always)]
pub fn below<V: Volume, L: Lane>(l: &L, to: &PairArgs<V>, unit: Pair) -> Below {
    let mut below = Below::NONE;
    let own = to.flags & SELF != 0;
    let (a, b) = (l.read(to.queries, unit.a), l.read(to.nodes, unit.b));
    let leaves = a.is_leaf() & b.is_leaf();
    if unit == ROOTS && (leaves || !own) {
        // Roots may be leaves, and those of two trees may be apart.
        let overlap = a.volume.overlaps(&b.volume);
        if leaves | !overlap {
            if !own {
                below.nodes[0] = unit;
                below.note(0, overlap, (&a, &b), own);
            }
            return below;
        }
    }
    if own & (unit.a == unit.b) {
        let (left, right) = (l.read(to.nodes, a.link), l.read(to.nodes, a.link + 1));
        let (x, y) = (a.link, a.link + 1);
        below.nodes = [Pair { a: x, b: y }, Pair { a: x, b: x }, Pair { a: y, b: y }];
        below.note(0, left.volume.overlaps(&right.volume), (&left, &right), own);
        below.units |= if left.is_leaf() { 0 } else { 2 } | if right.is_leaf() { 0 } else { 4 };
        return below;
    }
    if bvtt::descends_in_a(unit, a.is_leaf(), b.is_leaf()) {
        let (left, right) = (l.read(to.queries, a.link), l.read(to.queries, a.link + 1));
        below.nodes[0] = Pair { a: a.link, b: unit.b };
        below.nodes[1] = Pair { a: a.link + 1, b: unit.b };
        below.note(0, left.volume.overlaps(&b.volume), (&left, &b), own);
        below.note(1, right.volume.overlaps(&b.volume), (&right, &b), own);
    } else {
        let (left, right) = (l.read(to.nodes, b.link), l.read(to.nodes, b.link + 1));
        below.nodes[0] = Pair { a: unit.a, b: b.link };
        below.nodes[1] = Pair { a: unit.a, b: b.link + 1 };
        below.note(0, a.volume.overlaps(&left.volume), (&a, &left), own);
        below.note(1, a.volume.overlaps(&right.volume), (&a, &right), own);
    }
    below
}
