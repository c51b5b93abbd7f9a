//! Discrete answers equal the exact ones: public meshes with lists decided in exact arithmetic by other programs.

use nearmiss::mesh::Body;
use nearmiss::{Contacts, Query};
use support::{ORDERS, ask, engine, mesh, rows, sanitizer, some_ways, ways};

/// Pairs of a list.
fn listed(path: &str) -> Vec<[u32; 2]> {
    let number = |text: &String| text.trim().parse().expect("a number");
    rows(path).iter().map(|row| [number(&row[0]), number(&row[1])]).collect()
}

fn bodies(names: &[&str]) -> Vec<Body> {
    names.iter().map(|name| Body::deformable(mesh(name))).collect()
}

/// First difference of two ascending lists: what is missing, or what is too many.
fn difference(found: &[[u32; 2]], truth: &[[u32; 2]]) -> Option<String> {
    let (found, truth): (std::collections::BTreeSet<_>, std::collections::BTreeSet<_>) =
        (found.iter().collect(), truth.iter().collect());
    let missed = truth.difference(&found).next().map(|pair| format!("missed {pair:?}"));
    missed.or_else(|| found.difference(&truth).next().map(|pair| format!("invented {pair:?}")))
}

fn discrete(device: nearmiss::Device, bodies: Vec<Body>) -> Contacts {
    ask(device, bodies, Query::discrete())
}

/// Meshes (one against itself, two against each other), the list of their pairs, and whether the sanitizer, which
/// is slow, looks at them too.
const SETS: [(&[&str], &str, bool); 8] = [
    (&["exact/bunny.ply"], "exact/bunny.pairs.csv.gz", true),
    (&["exact/bunny.ply", "exact/bunny_b.ply"], "exact/bunny_with_bunny_b.pairs.csv.gz", true),
    (&["exact/coplanar_same.ply"], "exact/coplanar_same.pairs.csv.gz", true),
    (&["exact/coplanar_z0_shift.ply"], "exact/coplanar_z0_shift.pairs.csv.gz", true),
    (&["exact/degenerate.ply"], "exact/degenerate.pairs.csv.gz", true),
    (&["exact/height-field.ply"], "exact/height-field.pairs.csv.gz", true),
    (&["cloth-ball/cloth_ball92.ply"], "exact/cloth_ball92.pairs.csv.gz", false),
    (&["exact/noisy.ply"], "exact/noisy.pairs.csv.gz", false),
];

/// If data are required, as in CI, tests without data fail.
#[test]
fn there_are_data_where_they_are_required() {
    let required = std::env::var_os("NEARMISS_REQUIRE_DATA").is_some();
    assert!(cfg!(public_data) || !required, "no public test data when this was built: set NEARMISS_DATA");
}

#[test]
#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]
fn every_pair_set_equals_the_exact_one() {
    for (meshes, pairs, small) in SETS {
        let (bodies, truth) = (bodies(meshes), listed(pairs));
        let found = discrete(engine(), bodies.clone());
        assert_eq!(difference(&found.triangles(), &truth), None, "{meshes:?}");
        for order in ORDERS.into_iter().filter(|_| small) {
            let again = discrete(sanitizer(order), bodies.clone());
            assert_eq!(again.hash(), found.hash(), "{meshes:?}, {order:?}");
        }
    }
}

/// For every volume, refit and walk.
#[test]
#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]
fn every_way_finds_the_exact_pairs() {
    for (turn, (meshes, pairs, small)) in SETS.into_iter().enumerate() {
        let (bodies, truth) = (bodies(meshes), listed(pairs));
        // The small sets take turns: together they have nearly every way. The large ones have fewer.
        let few = |i: usize| i % 3 == i / 3 % 3 && i.is_multiple_of(5);
        let few = ways(Query::discrete()).enumerate().filter(|(i, _)| few(*i)).map(|(_, way)| way);
        let some: Vec<Query> =
            if small { some_ways(Query::discrete(), turn).collect() } else { few.collect() };
        for (i, way) in some.into_iter().enumerate() {
            let found = ask(engine(), bodies.clone(), way);
            assert_eq!(difference(&found.triangles(), &truth), None, "{meshes:?}, way {i}: {way:?}");
        }
    }
}

#[test]
#[ignore = "minutes: the sanitizer watches every access of two large scenes"]
fn the_large_sets_are_the_same_in_every_order() {
    for (meshes, pairs, _) in SETS.into_iter().filter(|(_, _, small)| !small) {
        let (bodies, truth) = (bodies(meshes), listed(pairs));
        for order in ORDERS {
            let found = discrete(sanitizer(order), bodies.clone());
            assert_eq!(difference(&found.triangles(), &truth), None, "{meshes:?}, {order:?}");
        }
    }
}

#[test]
fn the_comparison_can_fail() {
    let truth = [[1, 2], [3, 4]];
    assert_eq!(difference(&[[1, 2]], &truth), Some("missed [3, 4]".into()));
    assert_eq!(difference(&[[1, 2], [3, 4], [3, 5]], &truth), Some("invented [3, 5]".into()));
    assert_eq!(difference(&truth, &truth), None);
}
