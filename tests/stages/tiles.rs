//! Tiles find what trees find: candidate for candidate where boxes nest, and the same contacts always.

use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::{Distance, Query, QueryKind};
use nearmiss::research::{BoundingVolume, BroadPhase, QueryExt, Refit, Search, Traversal};
use nearmiss::scene::Scene;
use nearmiss::{Contacts, Device};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use support::{ORDERS, ask_scene, asked, engine, machines, sanitizer};

/// Answers by trees and by tiles.
fn both(device: &Device, scene: &Scene, query: Query) -> [Contacts; 2] {
    [BroadPhase::Tree, BroadPhase::Tiles]
        .map(|broad| ask_scene(device.clone(), scene.clone(), query.with_broad_phase(broad)))
}

/// Both answers are one, and where the volumes nest the candidates are as many.
fn agree(scene: &Scene, query: Query, nests: bool) -> Contacts {
    let [tree, tiles] = both(&engine(), scene, query);
    assert_eq!(tree.rows, tiles.rows, "{query:?}");
    assert_eq!(tree.hash(), tiles.hash());
    if nests {
        assert_eq!(tree.stats.triangle_pairs, tiles.stats.triangle_pairs, "{query:?}");
    }
    tiles
}

/// Queries of each kind that tiles answer.
fn queries(distance: f64) -> Vec<Query> {
    let kinds = [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Earliest];
    kinds.map(asked::of).into_iter().chain([Query::near(distance)]).collect()
}

#[test]
fn one_mesh_has_the_same_candidates_and_contacts() {
    let bodies: [(Body, f64); 3] = [
        (scene::soup(1_500, 3, true).expect("a soup"), 0.01),
        (scene::scene("cloth-ball", 3_000, 1).expect("cloth"), 0.01),
        (scene::draped(5_000).expect("cloth"), 0.01),
    ];
    for (body, distance) in bodies {
        let scene = Scene::from(body);
        for query in queries(distance) {
            for volume in BoundingVolume::ALL {
                let contacts = agree(
                    &scene,
                    query.with_volume(volume),
                    matches!(volume, BoundingVolume::Aabb | BoundingVolume::Linear),
                );
                assert!(contacts.stats.triangle_pairs > 0, "{query:?}");
            }
        }
    }
}

/// Known numbers of pairs, tile after tile: around a tile, around 16 of them, and where a third level begins.
#[test]
fn known_pairs_are_found_at_every_size() {
    for cells in [1, 2, 3, 4, 5, 15, 16, 17, 40, 520] {
        let body = scene::grid(cells).expect("a grid");
        let query = Query::discrete().with_broad_phase(BroadPhase::Tiles);
        let contacts = support::ask(engine(), vec![body], query);
        assert_eq!(contacts.len() as u64, scene::grid_pairs(cells), "{cells}");
    }
    for n in [1, 31, 32, 33, 511, 512, 513] {
        let contacts =
            support::ask(engine(), vec![scene::identical(n).expect("equal triangles")], Query::discrete());
        assert_eq!(contacts.len(), n * (n - 1) / 2, "{n}");
    }
}

/// More pairs of tiles than there is room for at first.
#[test]
fn a_list_of_pairs_of_tiles_that_is_too_short_grows() {
    let n = 2_500;
    let query = Query::discrete().with_broad_phase(BroadPhase::Tiles);
    let contacts = support::ask(engine(), vec![scene::identical(n).expect("equal triangles")], query);
    assert!(contacts.stats.reruns > 0);
    assert_eq!(contacts.len(), n * (n - 1) / 2);
}

/// Bodies of every kind, frame after frame; the fixed one is fitted once.
#[test]
fn many_bodies_have_the_same_contacts_step_by_step() {
    let piles = [
        scene::Bodies::pile(30, 20, 12).expect("a pile"),
        scene::Bodies::worlds(6, 5).expect("worlds"),
        scene::Bodies::pile(40, 0, 0).expect("balls alone"),
    ];
    for pile in piles {
        for query in [Query::discrete(), Query::continuous(), Query::near(0.02)] {
            let mut detectors = [BroadPhase::Tree, BroadPhase::Tiles].map(|broad| {
                OneQuery::new(engine(), pile.scene.clone(), query.with_broad_phase(broad))
                    .expect("a detector")
            });
            for step in 0..3 {
                let moves = pile.step(step);
                let inputs: Vec<_> = moves.iter().map(|(id, to)| (*id, to.input())).collect();
                let [tree, tiles] = detectors.each_mut().map(|detector| {
                    if step == 2 {
                        detector.rebuild().expect("built anew");
                    }
                    let contacts = detector.frame(&inputs).expect("a frame");
                    detector.check_volumes().expect("sound volumes");
                    contacts
                });
                assert_eq!(tree.rows, tiles.rows, "{query:?}, step {step}");
                assert_eq!(tree.stats.triangle_pairs, tiles.stats.triangle_pairs, "{query:?}, step {step}");
                assert!(!tiles.is_empty(), "{query:?}");
            }
        }
    }
}

/// Every machine, in any order of lanes and blocks, leaves the same bits at every stage.
#[test]
fn every_machine_leaves_the_same_behind() {
    let pile = scene::Bodies::pile(6, 6, 4).expect("a pile");
    for query in [Query::discrete(), Query::continuous().with_volume(BoundingVolume::Obb)] {
        let query = query.with_broad_phase(BroadPhase::Tiles);
        let left = |device: Device| {
            let mut detector = OneQuery::new(device, pile.scene.clone(), query).expect("a detector");
            let moves = pile.step(1);
            let inputs: Vec<_> = moves.iter().map(|(id, to)| (*id, to.input())).collect();
            let contacts = detector.frame(&inputs).expect("a frame");
            (detector.fingerprints().expect("what is left"), contacts.hash(), contacts.stats.steps)
        };
        let truth = left(engine());
        for device in machines() {
            assert_eq!(left(device), truth, "{query:?}");
        }
    }
}

/// Blocks that interleave reserve places side by side.
#[test]
fn blocks_side_by_side_find_the_same() {
    let body = scene::soup(300, 9, false).expect("a soup");
    let query = Query::discrete().with_broad_phase(BroadPhase::Tiles);
    let truth = support::ask(engine(), vec![body.clone()], query);
    for order in ORDERS {
        assert_eq!(support::ask(sanitizer(order), vec![body.clone()], query).rows, truth.rows);
    }
}

#[test]
fn tiles_are_chosen_unless_something_of_trees_is() {
    let by = |search| Query::discrete().with_search(search);
    assert_eq!(Query::discrete().broad_phase_on(true), BroadPhase::Tiles);
    assert_eq!(Query::discrete().broad_phase_on(false), BroadPhase::Tiles);
    assert_eq!(Query::discrete().with_volume(BoundingVolume::Obb).broad_phase_on(true), BroadPhase::Tree);
    assert_eq!(Query::distance().broad_phase_on(true), BroadPhase::Tree);
    let levels = Search { refit: Some(Refit::Levels), ..Search::default() };
    let walk = Search { traversal: Some(Traversal::PerLeaf { budget: None }), ..Search::default() };
    for search in [levels, walk] {
        assert_eq!(by(search).broad_phase_on(true), BroadPhase::Tree);
        let error = by(Search { broad_phase: Some(BroadPhase::Tiles), ..search })
            .check()
            .expect_err("tiles have one way");
        assert!(error.to_string().contains("leave out the refit and the traversal"), "{error}");
        by(Search { broad_phase: Some(BroadPhase::Tree), ..search }).check().expect("trees have many");
    }
    let nearest = Distance::default().with_broad_phase(BroadPhase::Tiles);
    let error = Query::from(nearest).check().expect_err("a distance goes down a tree").to_string();
    assert!(error.contains("the nearest pair is searched down a tree"), "{error}");
}

/// Two sheets of 129 by 129 cells, each in a plane at the start, of which a quarter is over the
/// other one; the upper one falls from 1 to `down`, and tilts by `tilt`.
fn sheets(down: f32, tilt: f32) -> Body {
    const CELLS: u32 = 129;
    const ROW: u32 = CELLS + 1;
    let cell = |i: u32| i / CELLS * ROW + i % CELLS;
    let lower =
        (0..CELLS * CELLS).map(cell).flat_map(|i| [[i, i + 1, i + ROW], [i + 1, i + ROW + 1, i + ROW]]);
    let faces: Vec<_> = lower.clone().chain(lower.map(|face| face.map(|v| v + ROW * ROW))).collect();
    let [t0, t1] = [(1.0, 0.0), (down, tilt)].map(|(height, tilt)| {
        let point = |i: u32, aside: f32, height: f32| {
            let [x, y] = [i % ROW, i / ROW].map(|i| i as f32 / CELLS as f32);
            [x + aside, y, height + if height == 0.0 { 0.0 } else { tilt * x }]
        };
        let lower = (0..ROW * ROW).map(|i| point(i, 0.0, 0.0));
        let upper = (0..ROW * ROW).map(|i| point(i, 0.752, height));
        Mesh::new("sheets", Positions::F32(lower.chain(upper).collect()), faces.clone()).expect("a mesh")
    });
    Body::moving(t0, t1).expect("a step")
}

/// If there are many tiles, some are tested first, and their contacts leave out all that meets
/// later. The answer is the first of all contacts, to the bit, and that of trees, which have no
/// sample.
#[test]
fn a_sample_leaves_out_what_is_later_and_nothing_else() {
    let soup = scene::soup(66_000, 5, true).expect("a soup");
    let bodies = [
        ("cloth", scene::draped(70_000).expect("cloth")),
        ("a soup", soup),
        ("flat", sheets(-0.7, 0.0)),
        ("tilted", sheets(-0.7, 0.2)),
    ];
    for (name, body) in bodies {
        let all = support::ask(engine(), vec![body.clone()], Query::continuous());
        let scene = Scene::from(body);
        let [tree, tiles] = both(&engine(), &scene, Query::earliest());
        println!(
            "{name}: {:?}, {} pairs of {}",
            tiles.earliest_toi(),
            tiles.stats.triangle_pairs,
            tree.stats.triangle_pairs
        );
        assert!(all.earliest_toi().is_some(), "{name}");
        assert_eq!(tiles.earliest_toi(), all.earliest_toi(), "{name}");
        assert_eq!(tree.rows, tiles.rows, "{name}");
        // All that is flat meets at once.
        let fewer = tiles.stats.triangle_pairs < tree.stats.triangle_pairs;
        assert!(fewer || name == "flat" && tiles.stats.triangle_pairs == tree.stats.triangle_pairs, "{name}");
    }
}

/// Bodies that never meet have no first time, and nothing is left out.
#[test]
fn a_sample_without_contacts_bounds_nothing() {
    let scene = Scene::from(sheets(0.3, 0.2));
    let [tree, tiles] = both(&engine(), &scene, Query::earliest());
    assert_eq!((tree.earliest_toi(), tiles.earliest_toi()), (None, None));
    assert_eq!(tree.stats.triangle_pairs, tiles.stats.triangle_pairs);
}

#[test]
#[ignore = "half a minute"]
fn a_sample_leaves_no_lane_behind() {
    let body = sheets(0.3, 0.2);
    let truth = support::ask(engine(), vec![body.clone()], Query::earliest());
    assert_eq!(support::ask(sanitizer(ORDERS[0]), vec![body], Query::earliest()).rows, truth.rows);
}
