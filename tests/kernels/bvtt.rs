//! The tree of node pairs: a descent from a pair knows it as its parent.

use nearmiss_kernels::abi::{NONE, Pair};
use nearmiss_kernels::queue::bvtt::{descends_in_a, parent};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// A level-ordered tree of random shape: for each node its first child (0 for a leaf) and its parent.
struct Tree {
    children: Vec<u32>,
    parents: Vec<u32>,
}

fn tree(rng: &mut SmallRng, nodes: u32) -> Tree {
    let (mut children, mut parents) = (vec![0, 0], vec![NONE, NONE]);
    let mut level = vec![1u32];
    while !level.is_empty() {
        let mut next = Vec::new();
        for &node in &level {
            let at = children.len() as u32;
            if at < nodes && (node == 1 || rng.random_bool(0.7)) {
                children[node as usize] = at;
                children.extend([0, 0]);
                parents.extend([node, node]);
                next.extend([at, at + 1]);
            }
        }
        level = next;
    }
    Tree { children, parents }
}

/// Every pair below `pair`; each must know the pair it came from.
fn walk(pair: Pair, tree: &Tree, seen: &mut Vec<Pair>) {
    seen.push(pair);
    let (into_a, into_b) = (tree.children[pair.a as usize], tree.children[pair.b as usize]);
    let below = if pair.a == pair.b {
        if into_a == 0 {
            return;
        }
        vec![(into_a, into_a), (into_a, into_a + 1), (into_a + 1, into_a + 1)]
    } else if into_a == 0 && into_b == 0 {
        return;
    } else if descends_in_a(pair, into_a == 0, into_b == 0) {
        vec![(into_a, pair.b), (into_a + 1, pair.b)]
    } else {
        vec![(pair.a, into_b), (pair.a, into_b + 1)]
    };
    for (x, y) in below {
        let child = Pair { a: x, b: y };
        let parents = [x, y].map(|node| tree.parents[node as usize]);
        assert_eq!(parent(child, parents[0], parents[1]), pair, "{child:?}");
        walk(child, tree, seen);
    }
}

#[test]
fn every_pair_knows_its_parent() {
    let mut rng = SmallRng::seed_from_u64(5);
    let mut pairs = 0;
    for nodes in [2, 4, 8, 30, 80] {
        for _ in 0..20 {
            let tree = tree(&mut rng, nodes);
            let mut seen = Vec::new();
            walk(Pair { a: 1, b: 1 }, &tree, &mut seen);
            pairs += seen.len();
            seen.sort_unstable();
            let all = seen.len();
            seen.dedup();
            assert_eq!(seen.len(), all, "no pair is reached twice");
        }
    }
    assert!(pairs > 10_000, "{pairs}");
}
