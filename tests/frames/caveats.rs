//! Every way in which an answer can be incomplete is forced here, and must be reported: by its
//! reason, with a count. None of them may lose a contact.

use nearmiss::contacts::{Caveat, Contact, Status};
use nearmiss::mesh::{Body, Mesh};
use nearmiss::query::QueryKind;
use nearmiss::research::{DetectorExt, FrontShape, QueryExt, Solver, Traversal};
use nearmiss::{Contacts, Device, Error, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use std::collections::BTreeMap;
use support::asked::{certified, with_tolerance};
use support::shrinking::SHRINKING;
use support::{ask, cases, engine, sanitizer};

fn soup() -> Vec<Body> {
    vec![scene::soup(60, 5, true).expect("a scene")]
}

fn shrinking() -> Vec<Body> {
    vec![support::moving(&SHRINKING[0], &SHRINKING[1], &[[0, 1, 2], [3, 4, 5]])]
}

fn by(solver: Solver) -> Query {
    support::asked::by(QueryKind::Continuous, solver)
}

/// All contacts of the one are in the other, as early or earlier.
fn none_is_lost(truth: &Contacts, other: &Contacts) {
    let listed: BTreeMap<_, _> =
        other.contacts().iter().map(|c| ((c.kind, c.feature_a, c.feature_b), c.toi)).collect();
    for c in truth.contacts().iter().filter(|c| c.status == Status::Certified) {
        let toi = listed.get(&(c.kind, c.feature_a, c.feature_b)).unwrap_or_else(|| panic!("{c:?} is lost"));
        assert!(*toi <= c.toi_upper, "{c:?} is late: {toi}");
    }
}

fn count(all: &[Contact], is: impl Fn(&Contact) -> bool) -> u64 {
    all.iter().filter(|c| is(c)).count() as u64
}

#[test]
fn an_answer_that_is_all_that_was_asked_says_nothing() {
    for query in Query::every().filter(|query| query.solver() != Solver::CertifiedF32) {
        let contacts = ask(engine(), vec![scene::draped(300).expect("a scene")], query);
        assert_eq!(contacts.caveats(), [], "{query:?}");
        // A distance is that of two bodies.
        let asks = query.kind().is_within_bodies();
        assert!(contacts.undecided == 0 && contacts.is_empty() != asks, "{query:?}");
    }
    let none = ask(engine(), vec![support::still(&[], &[])], by(Solver::Certified));
    assert_eq!(none.caveats(), []);
}

#[test]
fn a_budget_that_ends_is_told() {
    let by = |solver| with_tolerance(by(solver), 4e-3);
    let truth = ask(engine(), shrinking(), by(Solver::Certified));
    let met =
        |all: &Contacts| all.contacts().iter().filter(|c| c.toi <= 0.0625 && c.toi_upper >= 0.0625).count();
    assert!(met(&truth) > 0, "{:?}", truth.contacts());
    // In f32 alone nothing is searched by boxes.
    for solver in [Solver::Certified, Solver::CertifiedF64] {
        for boxes in [1, 2] {
            for device in [engine(), sanitizer(support::ORDERS[2])] {
                let all =
                    ask(device, shrinking(), certified(by(solver), |all| all.max_iterations = Some(boxes)));
                none_is_lost(&truth, &all);
                assert!(met(&all) > 0, "{:?}", all.contacts());
                let ended = all.caveats().iter().find_map(|reason| match reason {
                    Caveat::Iterations { pairs } => Some(*pairs),
                    _ => None,
                });
                let ended = ended.expect("a budget of a box or two ends");
                let touching = all.caveats().iter().find_map(|reason| match reason {
                    Caveat::Undecided { pairs } => Some(*pairs),
                    _ => None,
                });
                assert!(ended >= all.undecided - touching.unwrap_or(0), "{solver:?}, {boxes}: {ended}");
                assert!(ended > 0, "{solver:?}, {boxes}: {ended}");
                assert!(all.caveats().iter().any(Caveat::affects_answer));
            }
        }
        // An earliest query counts none: its time says whether it is certain.
        let first = with_tolerance(support::asked::by(QueryKind::Earliest, solver), 4e-3);
        let first = certified(first, |all| all.max_iterations = Some(1));
        let first = ask(engine(), shrinking(), first);
        assert_eq!(first.caveats(), [Caveat::EarliestUndecided]);
        assert!(first.undecided == 1 && first.earliest_toi() <= truth.earliest_toi());
    }
}

#[test]
fn what_touches_without_passing_is_told() {
    // A triangle slides against the side of another, in its plane: they touch, and nothing passes through.
    let still = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    let slides = |x: f32| [[x, 1.0, 0.0], [x - 2.0, 1.5, 0.0], [x - 2.0, 0.5, 0.0]];
    let frame = |x: f32| [still, slides(x)].concat();
    let body = support::moving(&frame(-1.0), &frame(1.0), &[[0, 1, 2], [3, 4, 5]]);
    let all = ask(engine(), vec![body], by(Solver::Certified));
    let undecided = count(all.contacts(), |c| c.status == Status::Undecided);
    assert!(undecided > 0 && all.undecided == undecided);
    let told = all.caveats().iter().map(|reason| match reason {
        Caveat::Undecided { pairs } | Caveat::Iterations { pairs } => *pairs,
        other => panic!("{other:?}"),
    });
    assert_eq!(told.sum::<u64>(), undecided, "{:?}", all.caveats());
}

#[test]
fn a_tolerance_below_the_precision_is_told() {
    let told_by = |device, solver, motion, tolerance| {
        let query = with_tolerance(support::asked::by(motion, solver), tolerance);
        let all = ask(device, soup(), query);
        let told = all.caveats().iter().find_map(|reason| match reason {
            Caveat::ToleranceBelowPrecision { pairs } => Some(*pairs),
            _ => None,
        });
        (told, all.len() as u64)
    };
    let told = |solver, motion, tolerance| told_by(engine(), solver, motion, tolerance);
    for (solver, tolerance) in
        [(Solver::CertifiedF32, 1e-9), (Solver::Certified, 1e-18), (Solver::CertifiedF64, 1e-18)]
    {
        let (pairs, listed) = told(solver, QueryKind::Continuous, tolerance);
        assert_eq!(pairs, Some(Some(listed)), "{solver:?}: no pair here is small enough");
        assert_eq!(told(solver, QueryKind::Earliest, tolerance).0, Some(None), "{solver:?}");
        // All that the precision gives is as required, or as fine as it can resolve.
        for enough in [0.0, 1e-4] {
            assert_eq!(told(solver, QueryKind::Continuous, enough).0, None, "{solver:?}");
            assert_eq!(told(solver, QueryKind::Earliest, enough).0, None, "{solver:?}");
        }
    }
    // A tolerance that large pairs cannot have and small ones can.
    let (some, listed) = told(Solver::CertifiedF32, QueryKind::Continuous, 1.3e-6);
    assert!(some.flatten().is_some_and(|some| 0 < some && some < listed), "{some:?} of {listed}");
    for device in support::machines() {
        assert_eq!(told_by(device, Solver::CertifiedF32, QueryKind::Continuous, 1.3e-6), (some, listed));
    }
}

#[test]
fn lists_that_grew_are_counted_once_and_degrade_nothing() {
    for motion in [QueryKind::Discrete, QueryKind::Continuous] {
        let bodies =
            vec![scene::identical(if motion == QueryKind::Discrete { 150 } else { 60 }).expect("a scene")];
        let query = if motion == QueryKind::Discrete { Query::discrete() } else { by(Solver::CubicF64) };
        let mut detector = OneQuery::new(engine(), bodies, query).expect("a detector");
        let first = detector.detect().expect("an answer");
        let times = detector.reruns();
        assert!(times > 0, "the scene no longer overflows the first room: make it larger");
        assert_eq!((first.stats.reruns, detector.summary(&first).reruns), (times, times));
        assert_eq!(first.caveats(), [], "the answer is whole");
        let second = detector.detect().expect("an answer");
        assert!(second.stats.reruns == 0 && second.caveats().is_empty() && second.rows == first.rows);
    }
}

#[test]
fn a_front_that_is_dropped_is_told() {
    // Far between two frames: what the front kept is worth less than a descent from the roots.
    let bodies = [scene::soup(400, 7, false), scene::soup(400, 8, false)].map(|body| body.expect("a scene"));
    let shape = FrontShape { drop: true, prune_every: 0, ..FrontShape::native() };
    let told = |drop| {
        let query = Query::discrete().with_traversal(Traversal::Front(FrontShape { drop, ..shape }));
        let mut detector = OneQuery::new(engine(), vec![bodies[0].clone()], query).expect("a detector");
        let frames = (0..4).map(|i| {
            let points = bodies[i % 2].positions_t0().clone();
            let mesh = Mesh::new("soup", points, bodies[0].faces().to_vec()).expect("a mesh");
            detector.move_to(0, Body::deformable(mesh)).expect("the same mesh");
            detector.detect().expect("an answer").caveats().contains(&Caveat::FrontDropped)
        });
        frames.collect::<Vec<_>>()
    };
    let dropped = told(true);
    assert!(!dropped[0] && dropped.contains(&true), "{dropped:?}");
    assert_eq!(told(false), [false; 4]);
}

/// Counts of one frame do not carry over to the next, nor do shapes of bodies before they moved.
#[test]
fn each_frame_is_told_by_itself() {
    let query = with_tolerance(by(Solver::CertifiedF32), 1.3e-6);
    let frames = [scene::soup(60, 5, true), scene::soup(60, 6, true), scene::soup(60, 5, true)];
    let mut told = Vec::new();
    let mut detector = OneQuery::new(engine(), soup(), query).expect("a detector");
    for frame in frames.map(|frame| frame.expect("a scene")) {
        detector.move_to(0, frame.clone()).expect("a frame");
        let alone = ask(engine(), vec![frame], query);
        assert!(!alone.caveats().is_empty());
        told.push(alone.caveats().to_vec());
        for _ in 0..2 {
            assert_eq!(detector.detect().expect("an answer").caveats(), alone.caveats());
        }
    }
    assert!(told[0] != told[1] && told[0] == told[2], "{told:?}");
}

/// As much memory as a frame needs, a little less, and so on down to none. The result is the
/// answer, in slices if the lists of all have no room, or an error with the bytes needed and
/// available. A second query gives the same: no half-grown list answers.
#[test]
fn memory_that_ends_is_an_error() {
    let [equal, cloth] =
        [scene::identical(150), scene::draped(1_500)].map(|body| vec![body.expect("a scene")]);
    let ways = [Query::discrete(), by(Solver::CubicF32), by(Solver::Certified)];
    for (query, bodies) in ways
        .into_iter()
        .map(|query| (query, if query.kind() == QueryKind::Discrete { equal.clone() } else { cloth.clone() }))
    {
        let device = engine();
        let truth = ask(device.clone(), bodies.clone(), query);
        let (_, peak) = device.bytes();
        let (mut answered, mut sliced, mut built, mut refused) = (0, 0, 0, 0);
        for part in (0..=40).step_by(cases(2, 1)) {
            let limited = engine().with_memory_limit(peak * part / 40);
            let mut detector = match OneQuery::new(limited.clone(), bodies.clone(), query) {
                Ok(detector) => detector,
                Err(error) => {
                    is_room(&error, &limited);
                    built += 1;
                    continue;
                }
            };
            match detector.detect() {
                Ok(contacts) => {
                    assert_eq!(contacts.rows, truth.rows, "{part}");
                    assert_eq!(contacts.stats.candidates, truth.stats.candidates, "{part}");
                    assert_eq!(contacts.starts_crossing, truth.starts_crossing, "{part}");
                    let again = detector.detect().expect("as much memory as before");
                    assert_eq!(
                        (again.hash(), again.stats.slices),
                        (contacts.hash(), contacts.stats.slices),
                        "{part}"
                    );
                    answered += 1;
                    sliced += (contacts.stats.slices > 1) as u32;
                }
                Err(error) => {
                    is_room(&error, &limited);
                    is_room(&detector.detect().expect_err("no more memory than before"), &limited);
                    refused += 1;
                }
            }
        }
        println!(
            "{query:?}: {answered} answered, {sliced} of them in slices, {refused} refused, {built} not begun"
        );
        assert!(answered > sliced && sliced > 0 && built > 0, "{answered} {sliced} {refused} {built}");
    }
}

fn is_room(error: &Error, device: &Device) {
    let Error::OutOfMemory { asked, given, .. } = error else { panic!("{error}") };
    assert!(asked > given && error.exit_code() == 4, "{error}");
    assert!(error.to_string().contains("use a smaller scene"), "{error}");
    assert!(device.bytes().0 <= device.bytes().1);
}
