//! Faces round hubs, vertices of many faces: the work grows as they do, and no answer changes.

mod shapes;

use nearmiss::contacts::TrianglePair;
use nearmiss::mesh::{Body, Positions};
use nearmiss::query::{Discrete, Query};
use nearmiss::research::{BoundingVolume, BroadPhase, QueryExt, Search, TriangleTest, WithSolver};
use nearmiss::scene::{CollisionFilter, Motion, Scene};
use nearmiss::{Contacts, Rows};
use nearmiss_lab::OneQuery;
use shapes::Shape;
use support::{ORDERS, cases, engine, sanitizer, walks};

/// Most tests of volumes of four times as many faces, as a multiple; it is 16 if they grow by the square.
const LINEAR: f64 = 6.0;

/// A discrete query of adjacent triangles too.
fn adjacent() -> Query {
    Discrete::by(TriangleTest::Exact { adjacent: true }).into()
}

/// Queries that keep adjacent pairs.
fn keeping() -> [Query; 4] {
    [Query::continuous(), Query::earliest(), Query::near(1e-3), adjacent()]
}

/// Tests of two volumes that a query of a body alone takes, and candidates.
fn work(body: Body, query: Query) -> [u64; 2] {
    let contacts = support::ask(engine(), vec![body], query);
    [contacts.stats.overlap_tests(), contacts.stats.triangle_pairs]
}

/// Tests and candidates of `n` faces and of 4 `n` grow by at most [`LINEAR`].
fn grows_linearly(name: &str, shape: impl Fn(u32) -> Shape, query: Query) {
    let [few, many] = [1_500, 6_000].map(|n| work(shape(n).body(), query));
    for (few, many) in few.into_iter().zip(many) {
        let grown = many as f64 / few.max(1) as f64;
        assert!(many < 1_000 || grown <= LINEAR, "{name}, {query:?}: {few} to {many}, {grown} times");
    }
}

/// A shape of about so many faces.
type Make = fn(u32) -> Shape;

/// Shapes whose hubs lie apart.
const SHAPES: [(&str, Make); 5] = [
    ("a flat fan", |n| Shape::fan(n, 0.0)),
    ("a cone", |n| Shape::fan(n, 1.0)),
    ("two cones", |n| Shape::fan(n / 2, 1.0).beside(Shape::fan(n / 2, -1.0), [0.0, 0.0, -0.5])),
    ("two fans", |n| Shape::fan(n / 2, 0.0).beside(Shape::fan(n / 2, 0.5), [3.0, 0.0, 0.0])),
    ("a fan in a plate", |n| Shape::fan(n / 3, 0.0).with_plate()),
];

#[test]
fn tiles_test_as_many_pairs_as_there_are_faces() {
    for (turn, (name, shape)) in SHAPES.into_iter().enumerate() {
        // Two volumes a shape: the shapes take turns.
        let volumes = BoundingVolume::ALL.into_iter().cycle().skip(2 * turn);
        for volume in volumes.take(cases(2, BoundingVolume::ALL.len())) {
            grows_linearly(
                name,
                shape,
                Query::discrete().with_broad_phase(BroadPhase::Tiles).with_volume(volume),
            );
        }
        for query in keeping() {
            grows_linearly(name, shape, query.with_broad_phase(BroadPhase::Tiles));
        }
    }
}

#[test]
fn so_do_all_walks_of_trees_without_adjacent_pairs() {
    for (name, shape) in SHAPES {
        for traversal in walks() {
            let search = Search {
                broad_phase: Some(BroadPhase::Tree),
                traversal: Some(traversal),
                ..Search::default()
            };
            grows_linearly(name, shape, Query::discrete().with_search(search));
        }
    }
}

/// Faces round one hub of a bicone share no vertex with most of those round the other, and boxes of
/// both overlap at the rim. These pairs are candidates by any search. No hub separates them.
#[test]
fn a_bicone_has_a_square_of_candidates() {
    for height in [1e-3, 1.0] {
        let of = |n: u32| Shape::fan(n / 2, height).and_fan_below(-height);
        let [few, many] = [400, 1_600].map(|n| work(of(n).body(), Query::discrete())[1]);
        assert!(many > 10 * few, "{few} to {many}");
        let [tree, tiles] = [BroadPhase::Tree, BroadPhase::Tiles].map(|broad| {
            support::ask(engine(), vec![of(1_600).body()], Query::discrete().with_broad_phase(broad))
        });
        assert_eq!((tree.rows, tree.stats.triangle_pairs), (tiles.rows, tiles.stats.triangle_pairs));
    }
}

/// Pairs of an answer to a query that keeps adjacent ones, without those of one body that share a vertex.
fn without_adjacent(contacts: &Contacts, scene: &Scene) -> Vec<TrianglePair> {
    let Rows::Pairs(pairs) = &contacts.rows else { panic!("a discrete query") };
    let shares = |pair: &TrianglePair| {
        let [p, q] = [0, 1].map(|k| {
            let body = scene.get(pair.bodies[k]).expect("a body");
            body.faces()[pair.triangles[k] as usize]
        });
        pair.bodies[0] == pair.bodies[1] && p.iter().any(|v| q.contains(v))
    };
    pairs.iter().filter(|pair| !shares(pair)).cloned().collect()
}

/// Detectors of every way to find candidates, of which the first knows no hubs: a tree, of a query that keeps adjacent pairs.
fn detectors(scene: &Scene, query: Query) -> Vec<OneQuery> {
    let tree = |query: Query, traversal| {
        query.with_search(Search { broad_phase: Some(BroadPhase::Tree), traversal, ..query.search() })
    };
    let oracle = if query == Query::discrete() { adjacent() } else { query };
    let tiles = BoundingVolume::ALL
        .into_iter()
        .map(|volume| query.with_broad_phase(BroadPhase::Tiles).with_volume(volume));
    let mut all: Vec<Query> = std::iter::once(tree(oracle, None)).chain(tiles).collect();
    all.extend(walks().into_iter().map(|walk| tree(query, Some(walk))));
    let detector = |query| OneQuery::new(engine(), scene.clone(), query).expect("a detector");
    all.into_iter().map(detector).collect()
}

/// All detectors answer as the first; how many contacts that are.
fn agree(
    detectors: &mut [OneQuery],
    query: Query,
    mut answer: impl FnMut(&mut OneQuery) -> Contacts,
) -> usize {
    let mut all = detectors.iter_mut().map(|detector| {
        let contacts = answer(detector);
        detector.check_volumes().expect("sound volumes and hubs");
        (*detector.query(), contacts, detector.scene().clone())
    });
    let (_, oracle, scene) = all.next().expect("the oracle");
    let wanted = match query == Query::discrete() {
        true => Rows::Pairs(without_adjacent(&oracle, &scene).into()),
        false => oracle.rows.clone(),
    };
    let mut count = 0;
    for (own, contacts, _) in all {
        assert_eq!(contacts.rows, wanted, "{own:?}");
        assert_eq!(contacts.starts_crossing, oracle.starts_crossing, "{own:?}");
        count = contacts.len();
    }
    count
}

/// The queries that are compared.
fn queries() -> impl Iterator<Item = Query> {
    std::iter::once(Query::discrete()).chain(keeping())
}

#[test]
fn a_folded_fan_meets_itself_and_others_as_without_hubs() {
    let folded = Shape::folded(300, 3).beside(Shape::folded(200, 4), [0.4, 0.1, 0.05]);
    for query in queries() {
        let scene = Scene::from(folded.moving(7, 0.05));
        let count = agree(&mut detectors(&scene, query), query, |d| d.detect().expect("an answer"));
        assert!(count > 0, "{query:?}");
    }
}

#[test]
fn fans_of_several_bodies_meet_as_without_hubs() {
    let fan = |seed| Shape::folded(70, seed);
    let environment = |at: u32| CollisionFilter::in_environment(at);
    // At one place, with equal local vertex numbers; a fixed one; one that is not tested against itself; environments.
    let scenes: [Vec<Body>; 3] = [
        vec![fan(1).moving(1, 0.1), fan(1).moving(2, 0.1)],
        vec![
            fan(1).moving(1, 0.1),
            fan(2).fixed(),
            fan(3).body().with_filter(CollisionFilter::without_self_collision()),
        ],
        vec![
            fan(1).moving(1, 0.1).with_filter(environment(3)),
            fan(2).body().with_filter(environment(1)),
            fan(1).moving(3, 0.1).with_filter(environment(3)),
            fan(4).fixed(),
        ],
    ];
    for bodies in scenes {
        let scene: Scene = bodies.into();
        for query in queries() {
            let count = agree(&mut detectors(&scene, query), query, |d| d.detect().expect("an answer"));
            assert!(count > 0, "{query:?}");
        }
    }
}

/// Frame after frame, built again, after a body came and one went.
#[test]
fn fans_meet_so_in_every_frame_and_after_edits() {
    let scene: Scene = vec![Shape::folded(72, 1).body(), Shape::folded(48, 2).body()].into();
    let ids: Vec<_> = scene.ids().collect();
    for query in queries() {
        let mut all = detectors(&scene, query);
        for step in 0..3 {
            let ends = [step, step + 1].map(|k| Positions::F32(Shape::folded(72, 1).moved(k, 0.2)));
            let input = match query == Query::continuous() || query == Query::earliest() {
                true => Motion::step(&ends[0], &ends[1]),
                false => Motion::positions(&ends[1]),
            };
            let count = agree(&mut all, query, |detector| {
                if step == 2 {
                    detector.rebuild().expect("built again");
                }
                detector.frame(&[(ids[0], input)]).expect("a frame")
            });
            assert!(count > 0, "{query:?}");
        }
        agree(&mut all, query, |detector| {
            detector.add(Shape::folded(64, 9).body()).expect("another");
            detector.detect().expect("an answer")
        });
        agree(&mut all, query, |detector| {
            detector.remove(ids[0]).expect("it is there");
            detector.detect().expect("an answer")
        });
    }
}

/// Corners that are one vertex, vertices that are named twice, faces that are there twice, and two hubs of one edge.
#[test]
fn faces_that_are_odd_meet_so_too() {
    let mut odd = Shape::folded(100, 5).beside(Shape::folded(80, 6), [0.3, 0.1, 0.0]);
    let again = odd.faces[..40].to_vec();
    odd.faces.extend(again);
    odd.faces.extend((1..60).map(|k| [0, k, k]).chain((1..60).map(|k| [k, 0, 0])).chain([[0, 0, 0]]));
    odd.faces.extend((3..50).map(|k| [0, 1, k]));
    for query in queries() {
        let scene = Scene::from(odd.moving(4, 0.1));
        let count = agree(&mut detectors(&scene, query), query, |d| d.detect().expect("an answer"));
        assert!(count > 0, "{query:?}");
    }
}

/// Lanes and blocks in any order leave the same bits.
#[test]
fn every_order_of_lanes_gives_the_same() {
    let folded = Shape::folded(150, 3).beside(Shape::folded(100, 4), [0.4, 0.1, 0.05]);
    for query in queries() {
        for broad in [BroadPhase::Tree, BroadPhase::Tiles] {
            let left = |device| {
                let scene = Scene::from(folded.moving(7, 0.05));
                let mut detector =
                    OneQuery::new(device, scene, query.with_broad_phase(broad)).expect("a detector");
                let contacts = detector.detect().expect("an answer");
                detector.check_volumes().expect("sound volumes and hubs");
                (contacts.hash(), contacts.stats.triangle_pairs, detector.fingerprints().expect("hashes"))
            };
            let wanted = left(engine());
            for order in ORDERS {
                assert_eq!(left(sanitizer(order)), wanted, "{query:?}, {broad:?}, {order:?}");
            }
        }
    }
}
