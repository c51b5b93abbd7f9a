//! The checker of trees: one planted fault a clause, then every fault of one number.

use nearmiss_kernels::abi::{LEAF, Link, Node};
use nearmiss_kernels::bv::Aabb;
use nearmiss_kernels::bvh::{self, Violation, check, check_volumes};

/// A tree of five triangles, the body's first being 10: three levels of inner nodes, a leaf next to
/// an inner node.
///
/// ```text
/// level 0            1
/// level 1        2       3
/// level 2      4   5   6   7        6 is inner, the others are leaves 0, 1, 4
/// level 3             8 9           leaves 2, 3
/// ```
pub struct Tree {
    pub links: Vec<Link>,
    pair_parents: Vec<u32>,
    levels: Vec<u32>,
    leaf_nodes: Vec<u32>,
    nodes: Vec<Node<Aabb>>,
}

const FIRST: u32 = 10;

/// The box of a triangle.
fn box_of(triangle: u32) -> Aabb {
    let at = triangle as f32;
    Aabb { lo: [at, -at, 1.0], hi: [at + 0.5, 0.0, at + 2.0] }
}

/// Boxes of the inner nodes, from those of the leaves.
fn merge(nodes: &mut [Node<Aabb>]) {
    for at in [6, 3, 2, 1] {
        let child = nodes[at].link as usize;
        nodes[at].volume = nodes[child].volume.merge(nodes[child + 1].volume);
    }
}

impl Tree {
    pub fn sound() -> Tree {
        let leaf = |last: u32, triangle: u32| Link { link: LEAF | (FIRST + triangle), last };
        let inner = |link, last| Link { link, last };
        let links = vec![
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
        let mut nodes: Vec<Node<Aabb>> = links
            .iter()
            .map(|link: &Link| {
                let triangle = if link.is_leaf() { link.triangle() } else { 0 };
                link.with(box_of(triangle))
            })
            .collect();
        merge(&mut nodes);
        Tree {
            links,
            pair_parents: vec![0, 1, 2, 3, 6],
            levels: vec![4, 1, 2, 4, 8, 10],
            leaf_nodes: vec![4, 5, 8, 9, 7],
            nodes,
        }
    }

    fn check(&self) -> Result<(), Violation> {
        let tree = bvh::Tree {
            links: &self.links,
            pair_parents: &self.pair_parents,
            levels: &self.levels,
            leaf_nodes: &self.leaf_nodes,
            root: 1,
            place: &|triangle| triangle.checked_sub(FIRST).map(|place| place as usize),
        };
        check(&tree, &mut vec![false; self.leaf_nodes.len()])?;
        check_volumes(&self.links, &self.nodes, 1, box_of, |_, _| None)
    }

    /// The checker's verdict on a tree with a planted fault.
    fn with(fault: impl Fn(&mut Tree)) -> Violation {
        let mut tree = Tree::sound();
        fault(&mut tree);
        tree.check().expect_err("the fault must be noticed")
    }
}

#[test]
fn a_sound_tree_passes() {
    assert_eq!(Tree::sound().check(), Ok(()));
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
        |t| t.links.truncate(9),
    ];
    for (i, fault) in faults.into_iter().enumerate() {
        assert_eq!(Tree::with(fault), Violation::Levels, "fault {i}");
    }
}

#[test]
fn a_wrong_link_is_noticed() {
    for link in [5, 2, 8, 10, 0] {
        assert_eq!(Tree::with(|t| t.links[2].link = link), Violation::Link { node: 2 }, "{link}");
    }
    assert_eq!(Tree::with(|t| t.links[6].link = 10), Violation::Link { node: 6 });
}

#[test]
fn a_wrong_order_is_noticed() {
    assert_eq!(Tree::with(|t| t.links[2].link = 6), Violation::Order { node: 2 });
    assert_eq!(Tree::with(|t| t.links[3].link = 4), Violation::Order { node: 3 });
}

#[test]
fn a_wrong_range_is_noticed() {
    assert_eq!(Tree::with(|t| t.links[1].last = 3), Violation::Range { node: 1 });
    assert_eq!(Tree::with(|t| t.links[2].last = 2), Violation::Range { node: 2 });
    assert_eq!(Tree::with(|t| t.links[4].last = 1), Violation::Range { node: 2 });
    assert_eq!(Tree::with(|t| t.links[9].last = 4), Violation::Range { node: 6 });
}

#[test]
fn a_wrong_leaf_is_noticed() {
    assert_eq!(Tree::with(|t| t.leaf_nodes.swap(0, 1)), Violation::Leaf { leaf: 0 });
    assert_eq!(Tree::with(|t| t.links[8].link = LEAF | FIRST), Violation::Leaf { leaf: 2 });
    assert_eq!(Tree::with(|t| t.links[8].link = LEAF | (FIRST - 1)), Violation::Leaf { leaf: 2 });
    assert_eq!(Tree::with(|t| t.links[8].link = LEAF | (FIRST + 5)), Violation::Leaf { leaf: 2 });
}

#[test]
fn a_wrong_parent_is_noticed() {
    assert_eq!(Tree::with(|t| t.pair_parents[4] = 7), Violation::Parent { node: 6 });
    assert_eq!(Tree::with(|t| t.pair_parents.truncate(4)), Violation::Parent { node: 6 });
}

#[test]
fn a_wrong_box_is_noticed_on_each_axis() {
    for node in [1, 2, 3, 6] {
        for axis in 0..3 {
            let faults: [fn(&mut Aabb, usize); 4] = [
                |b, axis| b.lo[axis] += 0.25,
                |b, axis| b.lo[axis] -= 0.25,
                |b, axis| b.hi[axis] += 0.25,
                |b, axis| b.hi[axis] -= 0.25,
            ];
            for fault in faults {
                // A box is also a part of its parent's, and the parent is looked at first.
                let found = Tree::with(|t| fault(&mut t.nodes[node as usize].volume, axis));
                let Violation::Merge { node: at } = found else { panic!("{found:?}") };
                assert!(at <= node, "{found:?} for node {node}, axis {axis}");
            }
        }
    }
    assert_eq!(Tree::with(|t| t.nodes[5].last = 2), Violation::Fit { node: 5 }, "a leaf's links");
}

/// A leaf that does not fit its triangle, in a tree whose merges are right.
#[test]
fn t7_a_leaf_that_is_anothers() {
    for node in [4, 5, 7, 8, 9] {
        let larger = |t: &mut Tree| {
            t.nodes[node].volume.hi[1] += 0.25;
            merge(&mut t.nodes);
        };
        assert_eq!(Tree::with(larger), Violation::Fit { node: node as u32 });
    }
    let swapped = |t: &mut Tree| {
        (t.nodes[8].volume, t.nodes[9].volume) = (t.nodes[9].volume, t.nodes[8].volume);
        merge(&mut t.nodes);
    };
    assert_eq!(Tree::with(swapped), Violation::Fit { node: 8 });
}

/// Nodes of two leaves, fitted: each is found by its first leaf and its last, and each fault is
/// named.
#[test]
fn t7_a_fit_that_is_none() {
    let tree = Tree::sound();
    let fitted = |fault: Option<u32>| {
        let fit = |first: u32, last: u32| {
            let node = [[0, 1, 2], [2, 3, 6]].into_iter().find(|n| n[..2] == [first, last])?[2];
            let mut volume = tree.nodes[node as usize].volume;
            volume.hi[1] += f32::from(u8::from(fault == Some(node)));
            Some(volume)
        };
        check_volumes(&tree.links, &tree.nodes, 1, box_of, fit)
    };
    assert_eq!(fitted(None), Ok(()));
    for node in [2, 6] {
        assert_eq!(fitted(Some(node)), Err(Violation::Fit { node }));
    }
}

/// No other value of any one number of the tree passes.
#[test]
fn every_single_fault_is_noticed() {
    let sound = Tree::sound();
    let mut faults = 0;
    for at in 1..sound.links.len() {
        for value in (0..16).chain((0..16).map(|i| LEAF | i)).chain([u32::MAX]) {
            for part in 0..2 {
                let mut tree = Tree::sound();
                let word = if part == 0 { &mut tree.links[at].link } else { &mut tree.links[at].last };
                if *word != value {
                    *word = value;
                    faults += 1;
                    assert!(tree.check().is_err(), "node {at}, {}: {value}", ["link", "last"][part]);
                }
            }
        }
    }
    for at in 0..sound.leaf_nodes.len() {
        for value in (0..12).filter(|value| *value != sound.leaf_nodes[at]) {
            let mut tree = Tree::sound();
            tree.leaf_nodes[at] = value;
            faults += 1;
            assert!(tree.check().is_err(), "leaf {at}: {value}");
        }
    }
    assert!(faults > 600, "{faults}");
}
