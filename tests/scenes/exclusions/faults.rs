//! The judge names a fault in each kind of exclusion.

use super::law::differ;
use super::*;

/// Whether the judge notices that an answer of one scene is not that of another.
fn named(scene: &Scene, faulty: &Scene, query: Query) -> Option<String> {
    differ(&ask(engine(), faulty, query), &less(&ask(engine(), &whole(scene), query), &Law::of(scene)))
}

#[test]
fn an_exclusion_that_is_lost_or_too_many_is_named() {
    for query in [Query::discrete(), Query::near(0.1)] {
        for bits in [1, 2, 4, 8] {
            let mut seen = 0;
            for seed in 0..8 {
                let scene = crumpled(seed, bits);
                assert_eq!(named(&scene, &scene, query), None, "kinds {bits}, seed {seed}");
                let mut faulty = scene.clone();
                for id in scene.ids().collect::<Vec<_>>() {
                    let mut own = scene.exclusions(id).cloned().unwrap_or_default();
                    own.ring = own.ring.map(|ring| ring + 1);
                    if let Some(rest) = &mut own.rest {
                        rest.within *= 0.5;
                    }
                    own.faces.pop();
                    faulty.exclude(id, own).expect("exclusions");
                    for other in scene.ids() {
                        faulty.exclude_pairs([id, other], &[]).expect("none");
                    }
                }
                seen += u32::from(named(&scene, &faulty, query).is_some());
            }
            assert!(seen >= 4, "kinds {bits}, {query:?}: {seen} of 8");
        }
    }
}

/// An earliest query that counts an excluded pair, and a start that does, differ from the law.
#[test]
fn a_pair_that_is_not_dropped_lowers_the_least_time() {
    let mut lower = [0; 2];
    for seed in 0..12 {
        let scene = crumpled(seed, 15);
        let query = support::asked::with_tolerance(Query::earliest(), 1e-4);
        let (with, without) = (ask(engine(), &scene, query), ask(engine(), &whole(&scene), query));
        let toi = |found: &Contacts| found.earliest_toi().unwrap_or(2.0);
        assert!(toi(&without) <= toi(&with) && without.starts_crossing >= with.starts_crossing);
        lower[0] += u32::from(toi(&without) < toi(&with));
        lower[1] += u32::from(without.starts_crossing > with.starts_crossing);
    }
    assert!(lower[0] > 0 && lower[1] > 6, "{lower:?}");
}
