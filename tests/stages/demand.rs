//! Answers without room are refused by their count: early, with the number, and with a way out.

use nearmiss::device::Interrupt;
use nearmiss::query::Continuous;
use nearmiss::research::{BroadPhase, Certified, QueryExt, WithSolver};
use nearmiss::scene::CollisionFilter;
use nearmiss::{Body, Device, Error, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use support::engine;

/// How a frame was refused: rows, bytes that they need and that there are, the sentence; and how often it looked at its handle,
/// which counts its work.
fn refused(device: Device, bodies: Vec<Body>, query: Query) -> ([u64; 3], String, u64) {
    let interrupt = Interrupt::new();
    interrupt.trigger_at(u64::MAX);
    let device = device.with_interrupt(&interrupt);
    let answer = OneQuery::new(device, bodies, query).and_then(|mut own| own.detect());
    match answer {
        Err(error @ Error::AnswerTooLarge { pairs, asked, given, .. }) => {
            let looks = u64::MAX - interrupt.looks_left();
            assert!(error.exit_code() == 4 && asked > given, "{error}");
            ([pairs, asked, given], error.to_string(), looks)
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn near_within_a_huge_distance_is_refused_by_what_is_certain() {
    // 6,000 triangles, each with three vertices and edges of its own: 1.1e8 and 1.6e8 pairs, of 64 bytes.
    let body = || vec![scene::soup(6_000, 1, false).expect("a scene")];
    let own = 18_000u64;
    let all = own * 6_000 + own * (own - 1) / 2 - 6_000 * 6;
    for query in [Query::near(50.0), Query::near(50.0).with_broad_phase(BroadPhase::Tree)] {
        let device = || engine().with_memory_limit(2 << 30).limited_answers(1 << 30);
        let ([pairs, asked, given], text, looks) = refused(device(), body(), query);
        assert_eq!((pairs, given), (all, 1 << 30), "all are certain within 50");
        assert!(asked >= 48 * pairs && text.contains("use a smaller distance"), "{text}");
        assert!(text.contains(&pairs.to_string()), "{text}");
        // One traversal, in which trees look once a candidate, and no narrow phase.
        assert!(looks < all / 8, "{looks} looks");
    }
}

#[test]
fn a_huge_separation_is_refused() {
    let apart = Certified { min_separation: 30.0, ..Certified::default() };
    let body = || vec![scene::soup(6_000, 1, true).expect("a scene")];
    let (_, text, looks) = refused(engine().limited_answers(1 << 26), body(), Continuous::by(apart).into());
    assert!(
        text.contains("use a smaller minimum separation or tolerance") && looks < 20_000_000,
        "{text}: {looks}"
    );
}

#[test]
fn equal_triangles_are_refused_by_their_count() {
    for (query, rows) in [(Query::discrete(), 800u64 * 799 / 2), (Query::continuous(), 1)] {
        let bodies = vec![scene::identical(800).expect("a scene")];
        let bytes = 1 << 20;
        let ([pairs, ..], text, _) = refused(engine().limited_answers(bytes), bodies, query);
        assert!(pairs >= rows && text.contains("at least"), "{text}");
    }
}

#[test]
fn slices_are_refused_together() {
    // Each slice has room for its rows; all of them have not.
    let body = || scene::draped(2_000).expect("a cloth");
    for query in [Query::discrete(), Query::near(0.01), Query::continuous()] {
        let whole = engine();
        let mut one = OneQuery::new(whole.clone(), body(), query).expect("a detector");
        let found = one.detect().expect("an answer");
        let row = match found.rows {
            nearmiss::Rows::Pairs(_) => size_of::<nearmiss::contacts::TrianglePair>(),
            nearmiss::Rows::Near(_) => size_of::<nearmiss::contacts::NearPair>(),
            _ => size_of::<nearmiss::Contact>(),
        } as u64;
        let bytes = found.len() as u64 * row;
        let peak = whole.bytes().1;
        let sliced = |answers: u64| {
            (1..40).rev().step_by(2).map(move |part| {
                let device = engine().with_memory_limit(peak * part / 40).limited_answers(answers);
                OneQuery::new(device, body(), query).and_then(|mut own| own.detect())
            })
        };
        // Exactly as many as there are: there is room, also in slices.
        let fits = sliced(bytes).filter_map(Result::ok).find(|found| found.stats.slices > 1);
        assert_eq!(fits.expect("slices").rows, found.rows);
        let whole = engine().limited_answers(bytes - 1);
        let least = refused(whole, vec![body()], query).0;
        assert_eq!(least[0], found.len() as u64, "{query:?}: one byte less");
        for answer in sliced(bytes - 1) {
            match answer {
                Err(Error::AnswerTooLarge { pairs, .. }) => assert!(pairs <= found.len() as u64 && pairs > 0),
                Err(Error::OutOfMemory { .. }) => {}
                other => panic!("{query:?}: {other:?}"),
            }
        }
    }
}

#[test]
fn a_refused_detector_answers_when_bodies_are_apart() {
    let device = engine().limited_answers(1 << 17);
    let mut own =
        OneQuery::new(device, scene::identical(200).expect("a scene"), Query::discrete()).expect("one");
    assert!(matches!(own.detect(), Err(Error::AnswerTooLarge { pairs: 19_900, .. })));
    let id = own.scene().ids().next().expect("a body");
    let apart =
        || scene::soup(200, 1, false).expect("a scene").with_filter(CollisionFilter::with_self_collision());
    own.replace(id, apart()).expect("there");
    let want = support::ask(engine(), vec![apart()], Query::discrete());
    assert_eq!(own.detect().expect("an answer").rows, want.rows);
}
