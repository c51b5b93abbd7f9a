//! Frames whose lists outgrow the memory: run slice by slice, with the answer of a whole one, while
//! bodies move, come and go, and on several devices.

use nearmiss::query::{Query, QueryKind};
use nearmiss::research::{BroadPhase, QueryExt};
use nearmiss::scene::CollisionFilter;
use nearmiss::{Contacts, Device};
use nearmiss_lab::scene::{self, Bodies};
use nearmiss_lab::{OneQuery, OneQueryOnSeveral};
use support::{asked, engine};

fn queries() -> Vec<Query> {
    let kinds = [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Earliest];
    kinds.map(asked::of).into_iter().chain([Query::near(0.01)]).collect()
}

/// The largest part of a whole frame's memory that is too little for one; returns the first such
/// frame's answer.
fn too_little<T>(peak: u64, mut of: impl FnMut(Device) -> Option<(T, Contacts)>) -> (T, Contacts) {
    let parts = (1..40).rev().map(|part| peak * part / 40);
    let mut asked = parts.filter_map(|bytes| of(engine().with_memory_limit(bytes)));
    asked.find(|(_, found)| found.stats.slices > 1).expect("a part of the memory in which slices have room")
}

#[test]
fn bodies_that_move_are_found_alike_in_slices() {
    let scene = Bodies::pile(16, 8, 6).expect("a pile");
    for query in queries() {
        let whole = engine();
        // Without slices there would be instances, whose candidates are fewer.
        let tiles = query.with_broad_phase(BroadPhase::Tiles);
        let mut one = OneQuery::new(whole.clone(), scene.scene.clone(), tiles).expect("a detector");
        one.detect().expect("an answer");
        let (mut sliced, first) = too_little(whole.bytes().1, |device| {
            let mut detector = OneQuery::new(device, scene.scene.clone(), query).ok()?;
            let found = detector.detect().ok()?;
            Some((detector, found))
        });
        for step in 0..4 {
            let moves = scene.step(step);
            let inputs: Vec<_> = moves.iter().map(|(id, to)| (*id, to.input())).collect();
            let want = one.frame(&inputs).expect("an answer");
            let found = sliced.frame(&inputs).expect("an answer");
            assert_eq!(want.rows, found.rows, "{query:?}, step {step}");
            assert_eq!((want.stats.slices, want.hash()), (1, found.hash()), "{query:?}, step {step}");
            assert!(found.stats.slices >= first.stats.slices, "{query:?}: once in slices, so to the end");
            if !matches!(want.rows, nearmiss::Rows::Earliest(_)) {
                assert_eq!(want.stats.triangle_pairs, found.stats.triangle_pairs, "{query:?}, step {step}");
                assert_eq!(
                    want.stats.candidates_vf_ee, found.stats.candidates_vf_ee,
                    "{query:?}, step {step}"
                );
            }
            if step == 2 {
                one.rebuild().expect("tiles");
                sliced.rebuild().expect("tiles");
            }
        }
    }
}

#[test]
fn bodies_that_come_and_go_begin_with_a_whole_frame() {
    let ball = |n, seed| {
        scene::soup(n, seed, true).expect("a soup").with_filter(CollisionFilter::with_self_collision())
    };
    let query = asked::of(QueryKind::Continuous);
    let whole = engine();
    let mut one = OneQuery::new(whole.clone(), ball(2_000, 1), query).expect("a detector");
    one.detect().expect("an answer");
    let (mut sliced, _) = too_little(whole.bytes().1, |device| {
        let mut detector = OneQuery::new(device, ball(2_000, 1), query).ok()?;
        let found = detector.detect().ok()?;
        Some((detector, found))
    });
    let first = one.scene().ids().next().expect("a body");
    for seed in [2, 3] {
        let small = ball(100, seed);
        one.replace(first, small.clone()).expect("there");
        sliced.replace(first, small).expect("there");
        let (want, found) = (one.detect().expect("an answer"), sliced.detect().expect("an answer"));
        assert_eq!((want.rows, found.stats.slices), (found.rows, 1), "a small body has room");
        let large = ball(2_000, seed);
        one.replace(first, large.clone()).expect("there");
        sliced.replace(first, large).expect("there");
        let (want, found) = (one.detect().expect("an answer"), sliced.detect().expect("an answer"));
        assert_eq!(want.rows, found.rows);
        assert!(found.stats.slices > 1);
    }
}

#[test]
fn several_devices_slice_their_shares() {
    let body = scene::draped(5_000).expect("a cloth");
    for query in queries() {
        let whole = engine();
        let mut one = OneQuery::new(whole.clone(), body.clone(), query).expect("a detector");
        let want = one.detect().expect("an answer");
        // One of the two has room for its share at once.
        let (mut several, first) = too_little(whole.bytes().1, |device| {
            let mut several = OneQueryOnSeveral::new(vec![device, engine()], body.clone(), query).ok()?;
            let found = several.detect().ok()?;
            Some((several, found))
        });
        assert_eq!((&want.rows, want.hash()), (&first.rows, first.hash()), "{query:?}");
        let before = several.shares();
        for frame in 0..3 {
            let found = several.detect().expect("an answer");
            assert_eq!((&want.rows, want.hash()), (&found.rows, found.hash()), "{query:?}, frame {frame}");
            assert!(found.stats.slices > 1);
        }
        let after = several.shares();
        let tiles: f64 = after.iter().map(|share| share.tiles).sum();
        assert!((tiles - 1.0).abs() < 1e-9, "{before:?}, {after:?}");
    }
}

#[test]
fn trees_and_distances_are_not_sliced() {
    let body = scene::draped(2_000).expect("a cloth");
    for query in [asked::of(QueryKind::Continuous).with_broad_phase(BroadPhase::Tree), Query::distance()] {
        let whole = engine();
        let bodies = || {
            vec![
                body.clone().with_filter(CollisionFilter::with_self_collision()),
                scene::soup(50, 1, false).expect("a soup"),
            ]
        };
        let want = support::ask(whole.clone(), bodies(), query);
        let mut refused = 0;
        for part in 1..20 {
            let device = engine().with_memory_limit(whole.bytes().1 * part / 20);
            let found = OneQuery::new(device, bodies(), query).and_then(|mut detector| detector.detect());
            match found {
                Ok(found) => {
                    assert_eq!((found.rows, found.stats.slices), (want.rows.clone(), 1), "{query:?}")
                }
                Err(error) => {
                    assert!(matches!(error, nearmiss::Error::OutOfMemory { .. }), "{error}");
                    refused += 1;
                }
            }
        }
        assert!(refused > 0, "{query:?}");
    }
}
