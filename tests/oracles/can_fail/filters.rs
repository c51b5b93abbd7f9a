//! The checker of filters, and the placing of a grafted tree: every fault of one number is named.

use super::tree::Tree;
use nearmiss_kernels::abi::{
    BodyRecord, EVERY, GRAFTED_ROOT, LEAF, Link, MOVING_ROOT, NodeFilter, ROOT, grafted, grafted_link,
};
use nearmiss_kernels::bvh::{Violation, check_filters};

/// The tree has five triangles. The first two are of body 0 in environment 1, the next two of body
/// 1 in environment 0, tested against itself, the last of body 2 in every one.
fn whose(triangle: u32) -> NodeFilter {
    let [body, environment, self_collision] = match triangle - 10 {
        0 | 1 => [0, 1, 0],
        2 | 3 => [1, 0, 1],
        _ => [2, EVERY, 0],
    };
    // Triangles of body 1 have one hub, that of body 2 another; those of body 0 have none.
    let hub = [0, 7, 9][body as usize];
    NodeFilter::leaf(body, &BodyRecord { environment, self_collision, ..BodyRecord::default() }, hub)
}

/// The filters of a tree's nodes.
fn filters(links: &[Link]) -> Vec<NodeFilter> {
    let mut all = vec![NodeFilter::default(); links.len()];
    for at in (1..links.len()).rev() {
        let link = links[at];
        all[at] = match link.is_leaf() {
            true => whose(link.triangle()),
            false => all[link.link as usize].above(all[link.link as usize + 1]),
        };
    }
    all
}

#[test]
fn every_wrong_filter_is_noticed() {
    let tree = Tree::sound();
    let sound = filters(&tree.links);
    let check = |filters: &[NodeFilter]| check_filters(&tree.links, filters, ROOT, whose);
    assert_eq!(check(&sound), Ok(()));
    for node in 1..sound.len() {
        for bit in 0..32 {
            for field in 0..3 {
                let mut wrong = sound.clone();
                let NodeFilter { who, last, hub, .. } = &mut wrong[node];
                *[who, last, hub][field] ^= 1 << bit;
                // A wrong leaf is named itself; so is a node that its children are not.
                assert_eq!(check(&wrong), Err(Violation::Filter { node: node as u32 }), "bit {bit}");
            }
        }
    }
}

#[test]
fn a_grafted_tree_keeps_its_shape_behind_the_other() {
    let (tree, leaves) = (Tree::sound(), 7);
    let mut places: Vec<u32> = (1..tree.links.len() as u32).map(|node| grafted(node, leaves)).collect();
    for (node, link) in tree.links.iter().enumerate().skip(1) {
        let moved = grafted_link(*link, leaves);
        assert_eq!(moved.last, link.last + leaves);
        match link.is_leaf() {
            true => assert_eq!(moved.link, link.link),
            false => assert_eq!(moved.link, grafted(link.link, leaves), "node {node}"),
        }
        // Siblings stay neighbours that begin at an even index, behind all of the other tree's.
        assert!(
            moved.link & LEAF != 0
                || moved.link.is_multiple_of(2) && moved.link > MOVING_ROOT + 2 * leaves - 2
        );
    }
    assert_eq!(places.remove(0), GRAFTED_ROOT);
    places.dedup();
    assert_eq!(places.len(), tree.links.len() - 2, "no two at one place");
}
