//! Trees of awkward scenes: ties, few triangles, many equal ones. Every tree is checked to the last link, and its depth.

use nearmiss::Query;
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::research::{BroadPhase, QueryExt};
use nearmiss::scene::CollisionFilter;
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use support::{ORDERS, engine, sanitizer};

/// A triangle far from everything, that has a tree of its own.
fn far() -> Body {
    let corners = vec![[1e6f32, 1e6, 1e6], [1e6 + 1.0, 1e6, 1e6], [1e6, 1e6 + 1.0, 1e6]];
    Body::fixed(Mesh::new("far", Positions::F32(corners), vec![[0, 1, 2]]).expect("a mesh"))
}

/// Depth of the body's tree, after all volumes are set and everything is checked.
fn depth(device: nearmiss::Device, body: Body) -> usize {
    let body = body.with_filter(CollisionFilter::without_self_collision());
    let mut detector =
        OneQuery::new(device, vec![body, far()], Query::discrete().with_broad_phase(BroadPhase::Tree))
            .expect("a detector");
    assert!(detector.detect().expect("an answer").is_empty(), "nothing is far away");
    detector.check_volumes().expect("a sound tree");
    detector.depths()[0]
}

/// Levels of a tree that splits n leaves in half, and in half again.
fn balanced(n: usize) -> usize {
    n.next_power_of_two().trailing_zeros() as usize + 1
}

#[test]
fn equal_triangles_make_a_balanced_tree() {
    for n in [1, 2, 3, 4, 5, 1023, 1024, 1025] {
        let body = scene::identical(n).expect("a scene");
        assert_eq!(depth(engine(), body.clone()), balanced(n), "{n}");
        if n < 6 {
            for order in ORDERS {
                assert_eq!(depth(sanitizer(order), body.clone()), balanced(n), "{n}, {order:?}");
            }
        }
    }
}

#[test]
fn a_million_equal_triangles_stay_shallow() {
    // 2^20 holds a million: 21 levels.
    assert_eq!(depth(engine(), scene::identical(1_000_000).expect("a scene")), 21);
}

#[test]
fn halving_distances_make_the_deepest_codes_and_stay_within_the_stack() {
    // Centres at 2^-k: each code has a first one-bit of its own, so each split takes off one triangle.
    let corners: Vec<[f32; 3]> = (0..40)
        .flat_map(|k| {
            let x = 0.5f32.powi(k);
            [[x, 0.0, 0.0], [x, 1e-9, 0.0], [x, 0.0, 1e-9]]
        })
        .collect();
    let faces = (0..40).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    let body = Body::deformable(Mesh::new("halving", Positions::F32(corners), faces).expect("a mesh"));
    // 11 bits an axis: the first 11 splits take off one each, the other 29 share a cell, and ties halve them.
    let levels = depth(engine(), body);
    assert_eq!(levels, 11 + balanced(29));
    assert!(levels <= nearmiss_kernels::bvh::MAX_LEVELS as usize);
}
