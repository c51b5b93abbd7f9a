//! Tiles find what trees find: candidate for candidate where boxes nest, and the same contacts always.

mod support;

use nearmiss::mesh::Body;
use nearmiss::query::{Broad, Bv, Distance, Query, QueryKind, Refit, Search, Traversal};
use nearmiss::scene::Scene;
use nearmiss::{Contacts, Detector, Device};
use nearmiss_lab::scene;
use support::{ORDERS, ask_scene, asked, engine, machines, sanitizer};

/// Answers by trees and by tiles.
fn both(device: &Device, scene: &Scene, query: Query) -> [Contacts; 2] {
    [Broad::Tree, Broad::Tiles].map(|broad| ask_scene(device.clone(), scene.clone(), query.with_broad(broad)))
}

/// Both answers are one, and where the volumes nest the candidates are as many.
fn agree(scene: &Scene, query: Query, nests: bool) -> Contacts {
    let [tree, tiles] = both(&engine(), scene, query);
    assert_eq!(tree.answer, tiles.answer, "{query:?}");
    assert_eq!(tree.hash(), tiles.hash());
    if nests {
        assert_eq!(tree.triangle_pairs, tiles.triangle_pairs, "{query:?}");
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
            for bv in Bv::ALL {
                let contacts = agree(&scene, query.with_bv(bv), matches!(bv, Bv::Aabb | Bv::Linear));
                assert!(contacts.triangle_pairs > 0, "{query:?}");
            }
        }
    }
}

/// Known numbers of pairs, tile after tile: around a tile, around 16 of them, and where a third level begins.
#[test]
fn known_pairs_are_found_at_every_size() {
    for cells in [1, 2, 3, 4, 5, 15, 16, 17, 40, 520] {
        let body = scene::grid(cells).expect("a grid");
        let query = Query::discrete().with_broad(Broad::Tiles);
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
    let query = Query::discrete().with_broad(Broad::Tiles);
    let contacts = support::ask(engine(), vec![scene::identical(n).expect("equal triangles")], query);
    assert!(contacts.reruns > 0);
    assert_eq!(contacts.len(), n * (n - 1) / 2);
}

/// Bodies of every kind, frame after frame; the static one is fitted once.
#[test]
fn many_bodies_have_the_same_contacts_step_by_step() {
    let piles = [
        scene::Bodies::pile(30, 20, 12).expect("a pile"),
        scene::Bodies::worlds(6, 5).expect("worlds"),
        scene::Bodies::pile(40, 0, 0).expect("balls alone"),
    ];
    for pile in piles {
        for query in [Query::discrete(), Query::continuous(), Query::near(0.02)] {
            let mut detectors = [Broad::Tree, Broad::Tiles].map(|broad| {
                Detector::new(engine(), pile.scene.clone(), query.with_broad(broad)).expect("a detector")
            });
            for step in 0..3 {
                let moves = pile.step(step);
                let inputs: Vec<_> = moves.iter().map(|(id, to)| (*id, to.input())).collect();
                let [tree, tiles] = detectors.each_mut().map(|detector| {
                    if step == 2 {
                        detector.rebuild().expect("built anew");
                    }
                    let contacts = detector.frame(&inputs).expect("a frame");
                    detector.check_trees().expect("sound volumes");
                    contacts
                });
                assert_eq!(tree.answer, tiles.answer, "{query:?}, step {step}");
                assert_eq!(tree.triangle_pairs, tiles.triangle_pairs, "{query:?}, step {step}");
                assert!(!tiles.is_empty(), "{query:?}");
            }
        }
    }
}

/// Every machine, in any order of lanes and blocks, leaves the same bits at every stage.
#[test]
fn every_machine_leaves_the_same_behind() {
    let pile = scene::Bodies::pile(6, 6, 4).expect("a pile");
    for query in [Query::discrete(), Query::continuous().with_bv(Bv::Obb)] {
        let query = query.with_broad(Broad::Tiles);
        let left = |device: Device| {
            let mut detector = Detector::new(device, pile.scene.clone(), query).expect("a detector");
            let moves = pile.step(1);
            let inputs: Vec<_> = moves.iter().map(|(id, to)| (*id, to.input())).collect();
            let contacts = detector.frame(&inputs).expect("a frame");
            (detector.fingerprints().expect("what is left"), contacts.hash(), contacts.steps)
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
    let query = Query::discrete().with_broad(Broad::Tiles);
    let truth = support::ask(engine(), vec![body.clone()], query);
    for order in ORDERS {
        assert_eq!(support::ask(sanitizer(order), vec![body.clone()], query).answer, truth.answer);
    }
}

#[test]
fn tiles_are_chosen_unless_something_of_trees_is() {
    let by = |search| Query::discrete().with_search(search);
    assert_eq!(Query::discrete().broad_on(true), Broad::Tiles);
    assert_eq!(Query::discrete().broad_on(false), Broad::Tiles);
    assert_eq!(Query::discrete().with_bv(Bv::Obb).broad_on(true), Broad::Tree);
    assert_eq!(Query::distance().broad_on(true), Broad::Tree);
    let levels = Search { refit: Some(Refit::Levels), ..Search::default() };
    let walk = Search { traversal: Some(Traversal::PerLeaf { budget: None }), ..Search::default() };
    for search in [levels, walk] {
        assert_eq!(by(search).broad_on(true), Broad::Tree);
        let error =
            by(Search { broad: Some(Broad::Tiles), ..search }).check().expect_err("tiles have one way");
        assert!(error.to_string().contains("leave out the refit and the traversal"), "{error}");
        by(Search { broad: Some(Broad::Tree), ..search }).check().expect("trees have many");
    }
    let nearest = Distance { search: Search { broad: Some(Broad::Tiles), ..Search::default() } };
    let error = Query::from(nearest).check().expect_err("a distance goes down a tree").to_string();
    assert!(error.contains("the nearest is sought down a tree"), "{error}");
}
