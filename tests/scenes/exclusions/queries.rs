//! Every query, on every way, against the law.

use super::law::differ;
use super::*;
use support::{cases, some_ways};

/// How an answer differs from the law: its rows, the least time of an earliest query, and the count
/// of pairs at the start.
pub fn fault(device: Device, scene: &Scene, query: Query) -> Option<String> {
    let (law, without) = (Law::of(scene), whole(scene));
    let found = ask(device, scene, query);
    let (truth, first) = match query {
        Query::Earliest(earliest) => {
            let all: Query = Query::Continuous(support_of(earliest));
            let contacts = less(&ask(engine(), &without, all), &law).1;
            ((Vec::new(), Vec::new(), Vec::new()), contacts.iter().map(|c| c.toi).reduce(f64::min))
        }
        _ => (less(&ask(engine(), &without, query), &law), found.earliest_toi()),
    };
    if found.earliest_toi() != first {
        return Some(format!("first at {:?}, by the law {first:?}", found.earliest_toi()));
    }
    let start = less(&ask(engine(), &without, Query::discrete()), &law).0.len() as u64;
    if found.starts_crossing.is_some_and(|count| count != start) {
        return Some(format!("{:?} cross at the start, by the law {start}", found.starts_crossing));
    }
    if query.kind() == QueryKind::Earliest { None } else { differ(&found, &truth) }
}

/// The continuous query of the contacts of which an earliest query returns the first.
fn support_of(earliest: nearmiss::Earliest) -> nearmiss::Continuous {
    let certified = Query::Earliest(earliest).certified().expect("a certified solver");
    let all = nearmiss::Continuous::default().with_min_separation(certified.min_separation);
    match support::asked::with_tolerance(Query::Continuous(all), certified.tolerance.expect("given")) {
        Query::Continuous(query) => query,
        other => panic!("{other:?}"),
    }
}

/// Each kind of exclusion alone, and all together.
const KINDS: [u32; 5] = [1, 2, 4, 8, 15];

#[test]
fn an_answer_is_the_one_without_exclusions_less_their_rows() {
    // The first one has removed a body, and the second one has doubles.
    let seeds = &[3, 1, 0, 2, 4, 5][..cases(2, 6)];
    for bits in KINDS {
        let mut left = vec![[0; 2]; queries().len()];
        for &seed in seeds {
            let scene = crumpled(seed, bits);
            for (query, left) in queries().into_iter().zip(&mut left) {
                assert_eq!(fault(engine(), &scene, query), None, "kinds {bits}, seed {seed}, {query:?}");
                left[0] += ask(engine(), &whole(&scene), query).len();
                left[1] += ask(engine(), &scene, query).len();
            }
        }
        // The query that keeps adjacent triangles lists no more than others do with ring 1.
        for (query, [before, behind]) in queries().into_iter().zip(left) {
            let is_listed = query.kind() != QueryKind::Earliest;
            assert!(
                !is_listed || behind > 6 * seeds.len() && behind + 3 * seeds.len() < before,
                "kinds {bits}, {query:?}: {before}, {behind}"
            );
        }
    }
}

#[test]
fn every_way_and_every_order_gives_one_answer() {
    for (seed, bits) in [(5, 15), (3, 3), (4, 12)] {
        let scene = crumpled(seed, bits);
        for (turn, query) in (seed as usize..).zip(queries()) {
            let one = ask(engine(), &scene, query);
            let same = |found: &Contacts, what: &str| {
                assert_eq!(found.rows, one.rows, "seed {seed}, {what}");
                assert_eq!(found.starts_crossing, one.starts_crossing, "seed {seed}, {what}");
            };
            assert_eq!(fault(engine(), &scene, query), None, "seed {seed}, {query:?}");
            for way in some_ways(query, turn) {
                same(&ask(engine(), &scene, way), &format!("{way:?}"));
            }
            for order in ORDERS {
                same(&ask(sanitizer(order), &scene, query), &format!("{order:?}, {query:?}"));
            }
            let devices = vec![engine(), engine(), engine()];
            let mut several = OneQueryOnSeveral::new(devices, scene.clone(), query).expect("detectors");
            for _ in 0..2 {
                same(&several.detect().expect("an answer"), &format!("three devices, {query:?}"));
            }
        }
    }
}

/// Lists that are too short at first: more pairs than a scene of so few triangles has room for.
#[test]
fn lists_grow() {
    let body = scene::soup(300, 3, true).expect("a soup");
    let mut scene = Scene::from(body);
    let id = scene.id(0).expect("a body");
    scene.exclude_pairs([id, id], &[[0, 3], [7, 12]]).expect("vertices");
    for query in [Query::near(0.5), Query::continuous(), Query::discrete()] {
        let query =
            if query.certified().is_some() { support::asked::with_tolerance(query, 1e-4) } else { query };
        assert_eq!(fault(engine(), &scene, query), None, "{query:?}");
    }
    assert!(ask(engine(), &scene, Query::near(0.5)).len() > 1 << 14);
}

/// The rings mean what the words say: on a strip of triangles, of which each has an edge in common
/// with the next.
#[test]
fn ring_one_has_common_vertices_and_ring_two_an_edge_between() {
    let points = (0..12).map(|i| [f64::from(i) / 2.0, f64::from(i % 2), 0.0]).collect();
    let faces: Vec<[u32; 3]> = (0..10).map(|i| [i, i + 1, i + 2]).collect();
    let mesh = Mesh::new("a strip", Positions::F64(points), faces).expect("a mesh");
    let mut scene = Scene::from(Body::deformable(mesh));
    let id = scene.id(0).expect("a body");
    let all = Query::near(100.0);
    let mut counts = Vec::new();
    for ring in [None, Some(1), Some(2), Some(3), Some(6), Some(u32::MAX)] {
        scene.exclude(id, Exclusions { ring, ..Exclusions::default() }).expect("a ring");
        assert_eq!(fault(engine(), &scene, all), None);
        let found = ask(engine(), &scene, all);
        // Vertex 0 and a face: the first that is left.
        let first = |row: &&nearmiss::contacts::NearPair| {
            row.kind == nearmiss::contacts::Kind::Vf && row.feature_a == 0
        };
        let first = found.near().iter().find(first).map(|row| row.feature_b);
        counts.push((first, found.len()));
    }
    // Two vertices further for each edge.
    let firsts: Vec<_> = counts.iter().map(|(first, _)| *first).collect();
    assert_eq!(firsts, [Some(1), Some(1), Some(3), Some(5), None, None]);
    assert_eq!(counts[0], counts[1]);
    assert_eq!(counts[5].1, 0);
}
