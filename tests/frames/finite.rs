//! Floats of every finite size: beyond 2^60 they are kept as doubles, and every choice answers them as it answers the
//! same scene at ordinary size.

use nearmiss::contacts::{Contact, Status};
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::QueryKind;
use nearmiss::research::{BoundingVolume, QueryExt, Solver};
use nearmiss::{Contacts, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use std::collections::BTreeMap;
use support::asked::{by, certified, of};
use support::{ask, engine, sanitizer, ways};

/// The coordinates of a soup reach to about 1; the powers of two to beyond 2^60, half way, and just below the end of f32.
const POWERS: [i32; 4] = [50, 62, 100, 126];

/// The body times a power of two, by floats; exactly.
fn times(body: &Body, power: i32) -> Body {
    let size = 2f32.powi(power);
    let mesh = |positions: &Positions| {
        let Positions::F32(points) = positions else { panic!("floats") };
        let points: Vec<_> = points.iter().map(|p| p.map(|x| x * size)).collect();
        assert!(points.iter().flatten().all(|x| x.is_finite() && (*x == 0.0 || x.is_normal())));
        Mesh::new("scaled", Positions::F32(points), body.faces().to_vec()).expect("a mesh")
    };
    let t0 = mesh(body.positions_t0());
    match body.positions_t1() {
        None => Body::deformable(t0),
        Some(t1) => Body::moving(t0, mesh(t1)).expect("two frames"),
    }
}

/// In numbers of at most 2.
fn soup(moving: bool) -> Body {
    let body = scene::soup(60, 5, moving).expect("a scene");
    let most =
        body.ends().into_iter().flat_map(Positions::to_f64).flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    times(&body, -(most.log2().floor() as i32))
}

/// The difference of an answer from that of ordinary size. Times may have other certificates, as
/// f32 cannot be used at the ends of its range. But both hold the truth, so they overlap.
fn fault(truth: &Contacts, found: &Contacts) -> Option<String> {
    if truth.triangles() != found.triangles() {
        return Some(format!("{} pairs, not {}", found.triangles().len(), truth.triangles().len()));
    }
    let rows = |all: &Contacts| -> BTreeMap<_, Contact> {
        all.contacts().iter().map(|c| ((c.kind, c.feature_a, c.feature_b), *c)).collect()
    };
    let (truth, found) = (rows(truth), rows(found));
    let sure = |c: &&Contact| c.status == Status::Certified;
    let missed = |one: &BTreeMap<_, Contact>, other: &BTreeMap<_, Contact>| {
        one.values().filter(sure).find_map(|c| match other.get(&(c.kind, c.feature_a, c.feature_b)) {
            None => Some(format!("{c:?} is only in one")),
            Some(o) if o.toi > c.toi_upper || o.status == Status::Certified && c.toi > o.toi_upper => {
                Some(format!("{c:?} and {o:?}"))
            }
            Some(_) => None,
        })
    };
    missed(&truth, &found).or_else(|| missed(&found, &truth))
}

#[test]
fn every_choice_answers_floats_of_any_size() {
    for motion in [QueryKind::Discrete, QueryKind::Continuous] {
        let body = soup(motion == QueryKind::Continuous);
        let truth = ask(engine(), vec![body.clone()], of(motion));
        assert!(truth.len() > 3, "{} contacts", truth.len());
        for power in POWERS {
            let large = times(&body, power);
            assert_eq!(large.positions_t0().is_f64(), power > 60);
            for query in ways(of(motion)) {
                let found = ask(engine(), vec![large.clone()], query);
                assert_eq!(fault(&truth, &found), None, "2^{power}, {query:?}");
            }
            for volume in BoundingVolume::ALL {
                let query = of(motion).with_volume(volume);
                let seen = ask(sanitizer(support::ORDERS[2]), vec![large.clone()], query);
                assert_eq!(
                    seen.rows,
                    ask(engine(), vec![large.clone()], query).rows,
                    "2^{power}, {volume:?}"
                );
            }
        }
    }
}

/// In doubles nothing but the exponents differs.
#[test]
fn in_doubles_the_times_are_the_same_bits() {
    let body = soup(true);
    let mesh =
        |p: &Positions| Mesh::new("f64", Positions::F64(p.to_f64()), body.faces().to_vec()).expect("a mesh");
    let [t0, t1] = body.ends().map(mesh);
    let doubles = Body::moving(t0, t1).expect("two frames");
    for motion in [QueryKind::Continuous, QueryKind::Earliest] {
        let query = by(motion, Solver::CertifiedF64);
        let truth = ask(engine(), vec![doubles.clone()], query);
        for power in POWERS {
            assert_eq!(ask(engine(), vec![times(&body, power)], query).rows, truth.rows, "2^{power}");
        }
    }
}

#[test]
fn a_separation_of_any_size() {
    let body = soup(true);
    let apart =
        |separation| certified(Query::continuous(), |certified| certified.min_separation = separation);
    let near = |power: i32| apart(2f64.powi(power - 6));
    let truth = ask(engine(), vec![body.clone()], near(0));
    for power in POWERS {
        for volume in BoundingVolume::ALL {
            let query = near(power).with_volume(volume);
            let found = ask(engine(), vec![times(&body, power)], query);
            assert_eq!(fault(&truth, &found), None, "2^{power}, {query:?}");
        }
    }
    // All within a separation that no float holds.
    let all = apart(1e60);
    let few =
        |volume| ask(engine(), vec![scene::soup(6, 5, true).expect("a scene")], all.with_volume(volume));
    let pairs = few(BoundingVolume::Aabb).len();
    assert!(
        BoundingVolume::ALL.into_iter().all(|volume| few(volume).len() == pairs) && pairs == 15 * (9 + 6),
        "{pairs}"
    );
}

/// A detector goes over to doubles when the first frame or body needs them, whichever it is.
#[test]
fn a_session_goes_over_to_doubles() {
    for motion in [QueryKind::Discrete, QueryKind::Continuous] {
        let body = soup(motion == QueryKind::Continuous);
        let truth = ask(engine(), vec![body.clone()], of(motion));
        let mut detector = OneQuery::new(engine(), vec![body.clone()], of(motion)).expect("a detector");
        for power in [0, 40, 62, 126, 0, 100] {
            detector.move_to(0, times(&body, power)).expect("a frame of the mesh");
            let found = detector.detect().expect("an answer");
            assert_eq!(fault(&truth, &found), None, "{motion:?}, 2^{power}");
            detector.check_volumes().expect("sound trees");
        }
        let pair = vec![body.clone(), times(&body, 100)];
        let swapped = vec![times(&body, 100), body.clone()];
        let [one, other] = [pair, swapped].map(|bodies| ask(engine(), bodies, of(motion)).len());
        assert_eq!(one, other);
    }
}

/// A frame whose memory ends is an error, and stays one; no frame of old positions is given out.
#[test]
fn going_over_without_memory_is_an_error() {
    let body = soup(false);
    let device = engine();
    let mut detector =
        OneQuery::new(device.clone(), vec![body.clone()], Query::discrete()).expect("a detector");
    detector.detect().expect("an answer");
    // From now on there is half of what floats took; doubles take more.
    let _ = device.clone().with_memory_limit(device.bytes().0 / 2);
    for _ in 0..2 {
        let moved = detector.move_to(0, times(&body, 100)).and_then(|()| detector.detect().map(drop));
        assert_eq!(moved.expect_err("doubles take more").exit_code(), 4);
        assert_eq!(detector.detect().expect_err("still not enough").exit_code(), 4);
    }
}

#[test]
fn the_comparison_can_fail() {
    let body = soup(true);
    let truth = ask(engine(), vec![body.clone()], Query::continuous());
    let other = ask(engine(), vec![soup(false)], Query::discrete());
    assert!(fault(&truth, &other).is_some());
    let nearer = certified(Query::continuous(), |certified| certified.min_separation = 0.125);
    assert!(fault(&truth, &ask(engine(), vec![body], nearer)).is_some());
}
