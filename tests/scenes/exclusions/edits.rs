//! Exclusions change between frames, end with their bodies, and are refused by name.

use super::*;

/// A sheet and another, and their numbers.
fn two() -> (Scene, [BodyId; 2]) {
    let mut rng = SmallRng::seed_from_u64(1);
    let mut scene = Scene::new();
    let mut body = |name: &str| {
        let mesh = Mesh::new(name, sheet(4, 0.3, false, &mut rng), sheet_faces(4)).expect("a mesh");
        scene.add(Body::deformable(mesh))
    };
    let ids = ["cloth", "shirt"].map(&mut body);
    (scene, ids)
}

#[test]
fn they_change_between_frames_and_end_with_their_bodies() {
    let query = Query::near(0.1);
    let (scene, [cloth, shirt]) = two();
    let mut detector = OneQuery::new(engine(), scene.clone(), query).expect("a detector");
    let same = |detector: &mut OneQuery, what: &str| {
        let found = detector.detect().expect("an answer");
        let truth = less(&ask(engine(), &whole(detector.scene()), query), &Law::of(detector.scene()));
        assert_eq!(law::differ(&found, &truth), None, "{what}");
        found.len()
    };
    let whole = same(&mut detector, "none");
    let ring = Exclusions { ring: Some(2), ..Exclusions::default() };
    detector.exclude(cloth, ring.clone()).expect("a ring");
    let ringed = same(&mut detector, "a ring");
    assert!(ringed < whole);
    detector.exclude_pairs([shirt, cloth], &[[3, 4], [9, 0], [3, 4]]).expect("vertices");
    assert_eq!(detector.scene().excluded_pairs([shirt, cloth]), [[3, 4], [9, 0]]);
    assert_eq!(detector.scene().excluded_pairs([cloth, shirt]), [[0, 9], [4, 3]]);
    let listed = same(&mut detector, "pairs");
    assert!(listed < ringed);
    let builds = detector.builds();
    detector.exclude(cloth, ring.clone()).expect("the same");
    detector.exclude_pairs([cloth, shirt], &[[4, 3], [0, 9]]).expect("the same");
    assert_eq!((same(&mut detector, "the same"), detector.builds()), (listed, builds));
    // Another mesh: vertices have other numbers, so nothing is excluded.
    let old = detector.scene().get(cloth).expect("a body").clone();
    detector.replace(cloth, old.clone()).expect("a body");
    assert_eq!(detector.scene().exclusions(cloth), None);
    assert_eq!(detector.scene().excluded_pairs([cloth, shirt]), [[0; 2]; 0]);
    assert_eq!(same(&mut detector, "replaced"), whole);
    detector.exclude(cloth, ring.clone()).expect("a ring");
    assert_eq!(same(&mut detector, "told again"), ringed);
    detector.remove(cloth).expect("a body");
    same(&mut detector, "removed");
    assert_eq!(detector.add(old).expect("room"), cloth);
    assert_eq!(same(&mut detector, "added"), whole);
    detector.exclude(cloth, ring).expect("a ring");
    detector.exclude(cloth, Exclusions::default()).expect("none");
    assert_eq!(same(&mut detector, "none again"), whole);
}

#[test]
fn exclusions_that_cannot_be_are_refused_by_name() {
    let (scene, [cloth, shirt]) = two();
    let missing = {
        let mut more = scene.clone();
        more.add(scene.bodies()[0].clone())
    };
    let mut detector = OneQuery::new(engine(), scene.clone(), Query::near(0.1)).expect("a detector");
    let ring = Exclusions { ring: Some(2), ..Exclusions::default() };
    detector.exclude(cloth, ring.clone()).expect("a ring");
    let before = detector.detect().expect("an answer");
    let own = Exclusions::default;
    let rest = |within, count: usize, x: f32| {
        let positions = Positions::F32(vec![[x; 3]; count]);
        Exclusions { rest: Some(RestShape { within, positions }), ..own() }
    };
    let refused: [(BodyId, Exclusions, &str); 9] = [
        (missing, ring.clone(), "body 2"),
        (
            cloth,
            Exclusions { ring: Some(0), ..own() },
            "ring of neighbours of cloth must be at least 1, got 0",
        ),
        (cloth, rest(-1e-9, 25, 0.0), "finite and at least 0, got -0.000000001"),
        (shirt, rest(f64::NAN, 25, 0.0), "at rest of shirt must be finite and at least 0, got NaN"),
        (shirt, rest(f64::INFINITY, 25, 0.0), "got inf"),
        (cloth, rest(0.1, 24, 0.0), "cloth has 24 positions, and the body 25 vertices"),
        (cloth, rest(0.1, 25, f32::NAN), "NaN"),
        (
            cloth,
            Exclusions { faces: vec![3, 32, 31], ..own() },
            "face 32 of cloth cannot be excluded: it has 32 faces",
        ),
        (cloth, Exclusions { faces: vec![u32::MAX], ..own() }, "face 4294967295 of cloth"),
    ];
    for (id, exclusions, says) in refused {
        let error = detector.exclude(id, exclusions).expect_err("refused");
        assert!(error.to_string().contains(says), "{error}");
        assert_eq!(detector.scene().exclusions(cloth), Some(&ring));
        assert_eq!(detector.detect().expect("an answer").rows, before.rows, "{says}");
    }
    for (bodies, pair, says) in [
        ([cloth, missing], [0, 0], "body 2"),
        ([cloth, shirt], [0, 25], "vertex 25 of shirt cannot be excluded: it has 25 vertices"),
        ([cloth, cloth], [7, 7], "(7, 7) of cloth is a vertex with itself"),
    ] {
        let error = detector.exclude_pairs(bodies, &[[1, 2], pair]).expect_err("refused");
        assert!(error.exit_code() == 2 && error.to_string().contains(says), "{error}");
        assert_eq!(detector.detect().expect("an answer").rows, before.rows, "{says}");
    }
    // After a mesh of fewer vertices a number that was one is none.
    let small = Mesh::new("cloth", sheet(2, 0.1, false, &mut SmallRng::seed_from_u64(2)), sheet_faces(2));
    detector.replace(cloth, Body::deformable(small.expect("a mesh"))).expect("a body");
    let error = detector.exclude_pairs([cloth, cloth], &[[1, 24]]).expect_err("refused").to_string();
    assert!(error.contains("vertex 24 of cloth") && error.contains("9 vertices"), "{error}");
}

#[test]
fn queries_that_cannot_obey_are_refused() {
    let (mut scene, [cloth, shirt]) = two();
    let kinds = [QueryKind::Distance, QueryKind::BodyPairs, QueryKind::BodyDistances];
    let query = |kind| support::asked::at(kind, 1e-4, 0.1);
    let device = || engine();
    for kind in kinds {
        assert!(OneQuery::new(device(), scene.clone(), query(kind)).expect("a detector").detect().is_ok());
    }
    scene.exclude_pairs([cloth, shirt], &[[0, 0]]).expect("vertices");
    for kind in kinds {
        let mut detector = nearmiss::Detector::new(device(), scene.clone()).expect("a detector");
        let error = detector.query(&query(kind)).expect_err("refused");
        assert!(
            error.exit_code() == 2 && error.to_string().contains("cannot leave out"),
            "{kind:?}: {error}"
        );
        // Others answer still, and it does without exclusions.
        assert!(!detector.query(&Query::near(0.1)).expect("an answer").is_empty());
        detector.exclude_pairs([shirt, cloth], &[]).expect("none");
        assert!(detector.query(&query(kind)).is_ok());
    }
}

#[test]
fn several_devices_have_the_same_exclusions() {
    let scene = crumpled(2, 0);
    let id = scene.ids().next().expect("a body");
    let query = Query::near(0.1);
    let mut one = OneQuery::new(engine(), scene.clone(), query).expect("a detector");
    let mut several = OneQueryOnSeveral::new(vec![engine(), engine()], scene, query).expect("detectors");
    let mut counts = Vec::new();
    for ring in [None, Some(3), None] {
        let own = Exclusions { ring, ..Exclusions::default() };
        one.exclude(id, own.clone()).expect("a ring");
        several.exclude(id, &own).expect("a ring");
        let pairs: &[[u32; 2]] = if ring.is_some() { &[[0, 5], [1, 7]] } else { &[] };
        one.exclude_pairs([id, id], pairs).expect("vertices");
        several.exclude_pairs([id, id], pairs).expect("vertices");
        let (want, found) = (one.detect().expect("an answer"), several.detect().expect("an answer"));
        assert_eq!((&want.rows, want.hash()), (&found.rows, found.hash()));
        counts.push(found.len());
    }
    assert!(counts[1] < counts[0] && counts[0] == counts[2], "{counts:?}");
    assert!(several.exclude_pairs([id, id], &[[0, 0]]).is_err());
}
