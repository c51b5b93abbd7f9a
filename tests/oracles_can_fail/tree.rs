//! The checker of trees: one planted fault a clause, then every fault of one number.

use nearmiss_kernels::abi::{LEAF, Node};
use nearmiss_kernels::bvh::{Violation, check};

/// A tree of five triangles, the body's first being 10: three levels of inner nodes, a leaf beside an inner node.
///
/// ```text
/// level 0            1
/// level 1        2       3
/// level 2      4   5   6   7        6 is inner, the others are leaves 0, 1, 4
/// level 3             8 9           leaves 2, 3
/// ```
struct Tree {
    nodes: Vec<Node>,
    levels: Vec<u32>,
    leaf_nodes: Vec<u32>,
}

const FIRST: u32 = 10;

impl Tree {
    fn sound() -> Tree {
        let leaf = |last: u32, triangle: u32| {
            let at = last as f32;
            Node { link: LEAF | (FIRST + triangle), last, lo: [at, -at, 1.0], hi: [at + 0.5, 0.0, at + 2.0] }
        };
        let inner = |link, last| Node { link, last, ..Node::default() };
        let mut nodes = vec![
            inner(0, 0),
            inner(2, 4),
            inner(4, 1),
            inner(6, 4),
            leaf(0, 3),
            leaf(1, 0),
            inner(8, 3),
            leaf(4, 1),
            leaf(2, 4),
            leaf(3, 2),
        ];
        for at in [6, 3, 2, 1] {
            let link = nodes[at].link as usize;
            nodes[at] = nodes[at].with(nodes[link].volume().merge(nodes[link + 1].volume()));
        }
        Tree { nodes, levels: vec![4, 1, 2, 4, 8, 10], leaf_nodes: vec![4, 5, 8, 9, 7] }
    }

    fn check(&self, volumes: bool) -> Result<(), Violation> {
        let mut seen = vec![false; self.leaf_nodes.len()];
        check(&self.nodes, &self.levels, &self.leaf_nodes, (FIRST, &mut seen), volumes)
    }

    /// What the checker says of a tree with a fault planted in it.
    fn with(fault: impl Fn(&mut Tree)) -> Violation {
        let mut tree = Tree::sound();
        fault(&mut tree);
        tree.check(true).expect_err("the fault must be noticed")
    }
}

#[test]
fn a_sound_tree_passes() {
    assert_eq!(Tree::sound().check(true), Ok(()));
}

#[test]
fn wrong_levels_are_noticed() {
    let faults: [fn(&mut Tree); 8] = [
        |t| t.levels[0] = 0,
        |t| t.levels[0] = 3,
        |t| t.levels[0] = 900,
        |t| t.levels[1] = 0,
        |t| t.levels.swap(2, 3),
        |t| t.levels[5] = 9,
        |t| t.levels.clear(),
        |t| t.nodes.truncate(9),
    ];
    for (i, fault) in faults.into_iter().enumerate() {
        assert_eq!(Tree::with(fault), Violation::Levels, "fault {i}");
    }
}

#[test]
fn a_wrong_link_is_noticed() {
    for link in [5, 2, 8, 10, 0] {
        assert_eq!(Tree::with(|t| t.nodes[2].link = link), Violation::Link { node: 2 }, "{link}");
    }
    assert_eq!(Tree::with(|t| t.nodes[6].link = 10), Violation::Link { node: 6 });
}

#[test]
fn a_wrong_order_is_noticed() {
    assert_eq!(Tree::with(|t| t.nodes[2].link = 6), Violation::Order { node: 2 });
    assert_eq!(Tree::with(|t| t.nodes[3].link = 4), Violation::Order { node: 3 });
}

#[test]
fn a_wrong_range_is_noticed() {
    assert_eq!(Tree::with(|t| t.nodes[1].last = 3), Violation::Range { node: 1 });
    assert_eq!(Tree::with(|t| t.nodes[2].last = 2), Violation::Range { node: 2 });
    assert_eq!(Tree::with(|t| t.nodes[4].last = 1), Violation::Range { node: 2 });
    assert_eq!(Tree::with(|t| t.nodes[9].last = 4), Violation::Range { node: 6 });
}

#[test]
fn a_wrong_leaf_is_noticed() {
    assert_eq!(Tree::with(|t| t.leaf_nodes.swap(0, 1)), Violation::Leaf { leaf: 0 });
    assert_eq!(Tree::with(|t| t.nodes[8].link = LEAF | FIRST), Violation::Leaf { leaf: 2 });
    assert_eq!(Tree::with(|t| t.nodes[8].link = LEAF | (FIRST - 1)), Violation::Leaf { leaf: 2 });
    assert_eq!(Tree::with(|t| t.nodes[8].link = LEAF | (FIRST + 5)), Violation::Leaf { leaf: 2 });
}

#[test]
fn a_wrong_box_is_noticed_on_each_axis() {
    for node in [1, 2, 3, 6] {
        for axis in 0..3 {
            let faults: [fn(&mut Node, usize); 4] = [
                |n, axis| n.lo[axis] += 0.25,
                |n, axis| n.lo[axis] -= 0.25,
                |n, axis| n.hi[axis] += 0.25,
                |n, axis| n.hi[axis] -= 0.25,
            ];
            for fault in faults {
                // A box is also a part of its parent's union, and the parent is looked at first.
                let found = Tree::with(|t| fault(&mut t.nodes[node as usize], axis));
                let Violation::Union { node: at, axis: which } = found else { panic!("{found:?}") };
                assert!(at <= node && which == axis as u32, "{found:?} for node {node}, axis {axis}");
            }
        }
    }
    let mut unfitted = Tree::sound();
    unfitted.nodes[1].lo[0] = -9.0;
    assert_eq!(unfitted.check(false), Ok(()), "volumes are not asked for");
}

/// No other value of any one number of the tree passes.
#[test]
fn every_single_fault_is_noticed() {
    let sound = Tree::sound();
    let mut faults = 0;
    for at in 1..sound.nodes.len() {
        for value in (0..16).chain((0..16).map(|i| LEAF | i)).chain([u32::MAX]) {
            for part in 0..2 {
                let mut tree = Tree::sound();
                let word = if part == 0 { &mut tree.nodes[at].link } else { &mut tree.nodes[at].last };
                if *word != value {
                    *word = value;
                    faults += 1;
                    assert!(tree.check(true).is_err(), "node {at}, {}: {value}", ["link", "last"][part]);
                }
            }
        }
    }
    for at in 0..sound.leaf_nodes.len() {
        for value in (0..12).filter(|value| *value != sound.leaf_nodes[at]) {
            let mut tree = Tree::sound();
            tree.leaf_nodes[at] = value;
            faults += 1;
            assert!(tree.check(true).is_err(), "leaf {at}: {value}");
        }
    }
    assert!(faults > 600, "{faults}");
}
