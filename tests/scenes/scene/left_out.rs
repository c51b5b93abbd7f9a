//! Pairs of bodies that a list leaves out. An answer is the one without the list, less the rows of
//! these pairs.

use super::cost::pile;
use super::pairwise::{LISTS, Truth, differ, mixed, query, some_pairs, two_by_two};
use super::*;
use nearmiss::research::{BroadPhase, QueryExt};
use nearmiss_lab::OneQueryOnSeveral;

/// The rows of an answer, less those of pairs of bodies.
fn less(whole: &Contacts, list: &[[BodyId; 2]]) -> Truth {
    let stays = |&[a, b]: &[BodyId; 2]| !list.contains(&[a, b]) && !list.contains(&[b, a]);
    let pairs = whole.pairs().iter().filter(|pair| stays(&pair.bodies)).copied().collect();
    let contacts = whole.contacts().iter().filter(|contact| stays(&contact.bodies)).copied().collect();
    let near = whole.near().iter().filter(|pair| stays(&pair.bodies)).copied().collect();
    (pairs, contacts, near)
}

fn ask(scene: &Scene, query: Query) -> Contacts {
    support::ask_scene(engine(), scene.clone(), query)
}

#[test]
fn an_answer_is_the_one_without_a_list_less_its_rows() {
    let mut fewer = [0; 3];
    for seed in 0..24 {
        let mut scene = mixed(seed);
        scene.leave_out(&[]).expect("none");
        let list = some_pairs(&mut SmallRng::seed_from_u64(seed), &scene, 0.3);
        let mut listed = scene.clone();
        listed.leave_out(&list).expect("bodies");
        for (k, kind) in LISTS.into_iter().enumerate() {
            let (whole, found) = (ask(&scene, query(kind)), ask(&listed, query(kind)));
            assert_eq!(differ(&found, &less(&whole, &list)), None, "seed {seed}, {kind:?}");
            fewer[k] += whole.len() - found.len();
        }
    }
    assert!(fewer.iter().all(|&fewer| fewer > 200), "{fewer:?}");
}

/// Crates in a row, each a little into the next: more than groups can separate.
fn chain(kind: fn(Mesh) -> Body) -> (Scene, Vec<[BodyId; 2]>) {
    let kind = |mesh| kind(mesh).with_filter(CollisionFilter::without_self_collision());
    let mut scene = Scene::new();
    for body in pile(100, Body::fixed, false).bodies() {
        scene.add(kind(body.frames().swap_remove(0)));
    }
    let ids: Vec<BodyId> = scene.ids().collect();
    (scene, ids.windows(2).map(|pair| [pair[0], pair[1]]).collect())
}

#[test]
fn neighbours_in_a_chain_of_a_hundred_are_left_out() {
    for kind in [Body::rigid as fn(Mesh) -> Body, Body::deformable] {
        let (mut scene, neighbours) = chain(kind);
        let (most, few) = neighbours.split_at(90);
        let tiles = |query: Query| query.with_broad_phase(BroadPhase::Tiles);
        let queries = [Query::discrete(), tiles(Query::discrete()), Query::near(0.85)];
        let whole = queries.map(|query| ask(&scene, query));
        // As a list may be written: in any order, and more than once.
        let written: Vec<_> = most.iter().rev().chain(&most[7..20]).map(|&[a, b]| [b, a]).collect();
        scene.leave_out(&written).expect("bodies");
        assert_eq!(scene.left_out(), most);
        for (query, whole) in queries.into_iter().zip(whole) {
            let found = ask(&scene, query);
            assert_eq!(differ(&found, &less(&whole, most)), None, "{query:?}");
            let tested = |pair: &[BodyId; 2]| found.pairs().iter().any(|row| row.bodies == *pair);
            assert!(query.kind() == QueryKind::Near || few.iter().all(tested) && !most.iter().any(tested));
        }
        scene.leave_out(&neighbours).expect("bodies");
        assert!(ask(&scene, Query::discrete()).is_empty());
        // From each to the next but one.
        let nearest = ask(&scene, Query::distance()).distance().expect("pairs are left");
        assert!((nearest - 0.8).abs() < 1e-3, "{nearest}");
    }
}

#[test]
fn steps_that_turn_leave_them_out_too() {
    let (mut scene, neighbours) = chain(Body::rigid);
    let inputs: Vec<_> = scene
        .ids()
        .map(|id| {
            let half = (0.01 * id.index() as f64).sin_cos();
            let end = Pose { rotation: [0.0, 0.0, half.0, half.1], ..Pose::default() };
            (id, Motion::PoseStep([Pose::default(), end].into()))
        })
        .collect();
    let frame = |scene: &Scene, query: Query| {
        let mut detector = OneQuery::new(engine(), scene.clone(), query).expect("a detector");
        detector.frame(&inputs).expect("an answer")
    };
    let small = |query| support::asked::with_tolerance(query, 1e-3);
    let whole = frame(&scene, small(Query::continuous()));
    scene.leave_out(&neighbours[..80]).expect("bodies");
    let found = frame(&scene, small(Query::continuous()));
    assert_eq!(differ(&found, &less(&whole, &neighbours[..80])), None);
    assert!(!found.is_empty() && found.len() < whole.len() / 2);
    let first = frame(&scene, small(Query::earliest())).earliest_toi();
    assert!(first.is_some() && first == found.earliest_toi());
    // All neighbours share points at the start: with a list, those that are left do.
    let start = ask(&scene, Query::discrete()).len() as u64;
    assert_eq!(found.starts_crossing, Some(start));
    assert!(whole.starts_crossing > Some(4 * start));
}

#[test]
fn a_list_changes_between_frames() {
    for kind in LISTS {
        let mut rng = SmallRng::seed_from_u64(6);
        let mut detector = OneQuery::new(engine(), mixed(4), query(kind)).expect("a detector");
        let same = |detector: &mut OneQuery, what: &str| {
            let found = detector.detect().expect("an answer");
            detector.check_volumes().expect("sound trees");
            assert_eq!(differ(&found, &two_by_two(detector.scene(), query(kind))), None, "{kind:?}, {what}");
            found.len()
        };
        let whole = same(&mut detector, "no list");
        let list = some_pairs(&mut rng, detector.scene(), 0.5);
        detector.leave_out(&list).expect("bodies");
        assert!(same(&mut detector, "a list") < whole);
        let before = detector.left_out().to_vec();
        let [a, b] = before[0];
        let builds = detector.builds();
        detector.leave_out(&before).expect("the same list");
        same(&mut detector, "the same list");
        assert_eq!(detector.builds(), builds);
        for (pairs, says) in [
            (&[[a, b], [b, b]][..], format!("body {b} with itself")),
            (&[[scene_end(detector.scene()), b]], "no body".into()),
        ] {
            let error = detector.leave_out(pairs).expect_err("refused");
            assert!(error.exit_code() == 2 && error.to_string().contains(&says), "{error}");
            assert_eq!(detector.left_out(), before);
            same(&mut detector, "after a refusal");
        }
        // A body that is replaced keeps its pairs, one that is removed does not.
        detector.replace(b, Body::deformable(soup(30, 77).0)).expect("a body");
        assert_eq!(detector.left_out(), before);
        same(&mut detector, "replaced");
        detector.remove(b).expect("a body");
        assert!(detector.left_out().iter().all(|pair| !pair.contains(&b)));
        same(&mut detector, "removed");
        assert_eq!(detector.add(Body::rigid(soup(30, 78).0)).expect("room"), b);
        same(&mut detector, "added");
        detector.leave_out(&[]).expect("none");
        assert!(detector.left_out().is_empty());
        same(&mut detector, "none left");
    }
}

/// A number that no body has yet.
fn scene_end(scene: &Scene) -> BodyId {
    let mut more = scene.clone();
    loop {
        let id = more.add(Body::fixed(soup(1, 1).0));
        if scene.bodies().get(id.index()).is_none() {
            return id;
        }
    }
}

#[test]
fn several_devices_have_the_same_list() {
    let scene = mixed(6);
    let list = some_pairs(&mut SmallRng::seed_from_u64(1), &scene, 0.3);
    for kind in LISTS.into_iter().chain([QueryKind::Earliest]) {
        let mut one = OneQuery::new(engine(), scene.clone(), query(kind)).expect("a detector");
        let devices = vec![engine(), engine(), engine()];
        let mut several = OneQueryOnSeveral::new(devices, scene.clone(), query(kind)).expect("detectors");
        for list in [scene.left_out(), &list, &[]] {
            one.leave_out(list).expect("bodies");
            several.leave_out(list).expect("bodies");
            assert_eq!(one.left_out(), several.left_out());
            let (want, found) = (one.detect().expect("an answer"), several.detect().expect("an answer"));
            assert_eq!((&want.rows, want.hash()), (&found.rows, found.hash()), "{kind:?}, {list:?}");
        }
        let [a, _] = scene.left_out()[0];
        assert!(several.leave_out(&[[a, a]]).is_err() && several.left_out().is_empty());
    }
}

/// A list costs its own bytes. Without one there are none: `matrix` counts all others.
#[test]
fn a_list_costs_its_bytes() {
    let (scene, neighbours) = chain(Body::rigid);
    for kind in QueryKind::ALL {
        let device = engine();
        let mut detector = OneQuery::new(device.clone(), scene.clone(), query(kind)).expect("a detector");
        let mut cost = |list: &[[BodyId; 2]]| {
            detector.leave_out(list).expect("bodies");
            detector.detect().expect("an answer");
            let plan = detector.plan().expect("a plan");
            let bytes = plan.buffer("pairs of bodies that are left out").map(|buffer| buffer.held.bytes);
            (plan.launches(), bytes)
        };
        let (launches, none) = cost(&[]);
        assert_eq!(none, None);
        // All queries of rigid bodies read instances, which look it up for related bodies.
        assert_eq!(cost(&neighbours), (launches, Some(4 * (100 + 1 + 99))), "{kind:?}");
    }
}

/// A pair that is left out is no reason for a caveat: large bodies near each other, and a small one
/// far away.
#[test]
fn a_pair_that_is_left_out_is_below_no_precision() {
    let frame = |seed, by: f64| {
        let (mesh, ends) = soup(20, seed);
        let place = |points: &Positions| {
            let moved = points.to_f64().iter().map(|p| p.map(|x| by * x + 8.0 * (by - 1.0))).collect();
            Mesh::new("soup", Positions::F64(moved), mesh.faces().to_vec()).expect("a mesh")
        };
        let body = Body::moving(place(&ends[0]), place(&ends[1])).expect("two frames");
        body.with_filter(CollisionFilter::without_self_collision())
    };
    let mut scene = Scene::new();
    let [a, b, _] = [frame(1, 1.0), frame(2, 1.0), frame(3, 1e-9)].map(|body| scene.add(body));
    let tiny = support::asked::with_tolerance(Query::earliest(), 1e-18);
    let caveats = |scene: &Scene| ask(scene, tiny).caveats().len();
    assert_eq!(caveats(&scene), 1);
    scene.leave_out(&[[a, b]]).expect("bodies");
    assert_eq!(caveats(&scene), 0);
}

/// The judge names the pair of a list that has lost one.
#[test]
fn a_pair_that_a_list_has_lost_is_named() {
    for asked in [Query::discrete(), Query::near(0.03)] {
        let (mut scene, neighbours) = chain(Body::deformable);
        let whole = ask(&scene, asked);
        let mut lost = neighbours.clone();
        let [a, b] = lost.remove(37);
        scene.leave_out(&lost).expect("bodies");
        let error = differ(&ask(&scene, asked), &less(&whole, &neighbours)).expect("a row too many");
        assert!(
            error.contains(&format!("BodyId({a})")) && error.contains(&format!("BodyId({b})")),
            "{error}"
        );
    }
}
