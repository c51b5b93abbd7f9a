//! Scenes without bodies, or without triangles: nothing is found, and bodies may come.

use super::*;
use nearmiss::contacts::Rows;
use nearmiss::research::{BroadPhase, DetectorExt, QueryExt};
use nearmiss_lab::OneQueryOnSeveral;

fn queries() -> Vec<Query> {
    let all =
        [Query::discrete(), Query::continuous(), Query::earliest(), Query::near(0.1), Query::distance()];
    let trees =
        [Query::discrete(), Query::continuous()].map(|query| query.with_broad_phase(BroadPhase::Tree));
    all.into_iter().chain(trees).collect()
}

fn is_nothing(found: &Contacts, what: &str) {
    assert!(found.is_empty() && found.caveats().is_empty(), "{what}: {:?}", found.rows);
    assert!(found.earliest_toi().is_none() && found.distance().is_none(), "{what}");
}

/// Every way to query.
fn ask_all(detector: &mut OneQuery, what: &str) {
    is_nothing(&detector.detect().expect(what), what);
    is_nothing(&detector.frame(&[]).expect(what), what);
    detector.update(&[]).expect(what);
    detector.rebuild().expect(what);
    is_nothing(&detector.prepare(&[]).expect(what), what);
    assert!(detector.is_prepared() && detector.on_device().is_none());
    for _ in 0..2 {
        detector.submit().expect(what);
        let found = detector.collect().expect(what);
        is_nothing(&found, what);
        assert_eq!(detector.summary(&found).contacts, 0);
        let has_rows = matches!(found.rows, Rows::Contacts(_) | Rows::Near(_) | Rows::Pairs(_));
        let geometry = detector.geometry(&found);
        assert!(if has_rows { geometry.expect(what).is_empty() } else { geometry.is_err() }, "{what}");
    }
    detector.download_positions().expect(what);
    detector.plan().expect(what);
    detector.check_volumes().expect(what);
    assert!(
        detector.fingerprints().expect(what).is_empty() && detector.narrow_steps().expect(what).is_empty()
    );
}

#[test]
fn a_scene_without_bodies_answers_nothing_until_they_come() {
    let (mesh, ends) = soup(40, 3);
    let bodies = [Body::deformable(mesh.clone()), Body::rigid(mesh.clone())];
    for query in queries() {
        let what = format!("{:?}", query.kind());
        let mut detector = OneQuery::new(engine(), Scene::new(), query).expect(&what);
        ask_all(&mut detector, &what);
        let ids = bodies.each_ref().map(|body| detector.add(body.clone()).expect(&what));
        let mut scene = Scene::new();
        assert_eq!(ids, bodies.each_ref().map(|body| scene.add(body.clone())));
        let input = [(ids[0], Motion::step(&ends[0], &ends[1]))];
        let mut whole = OneQuery::new(engine(), scene, query).expect(&what);
        let found = detector.frame(&input).expect(&what);
        assert_eq!(found.rows, whole.frame(&input).expect(&what).rows, "{what}");
        assert!(!found.is_empty(), "{what}");
        for id in ids {
            detector.remove(id).expect(&what);
        }
        ask_all(&mut detector, &what);
    }
}

/// Two alike with nothing else, so that the tolerance is that of the two as well.
#[test]
fn the_tolerance_is_that_of_the_bodies_that_come() {
    let mesh = soup(40, 3).0;
    let mut detector = OneQuery::new(engine(), Scene::new(), Query::continuous()).expect("a detector");
    assert!((0..2).all(|_| detector.add(Body::rigid(mesh.clone())).is_ok()));
    let whole =
        OneQuery::new(engine(), vec![Body::rigid(mesh.clone()), Body::rigid(mesh)], Query::continuous());
    assert_eq!(detector.tolerance(), whole.expect("a detector").tolerance());
    assert!(detector.tolerance().is_some_and(|tolerance| tolerance > 0.0));
}

#[test]
fn bodies_without_triangles_and_several_devices_answer_nothing() {
    let points = Mesh::new("points", Positions::F32(vec![[0.0; 3]; 4]), Vec::new()).expect("a mesh");
    for query in queries() {
        let what = format!("{:?}", query.kind());
        let mut detector = OneQuery::new(engine(), Body::deformable(points.clone()), query).expect(&what);
        ask_all(&mut detector, &what);
        if query.kind() != QueryKind::Distance && query.search().broad_phase.is_none() {
            let mut several =
                OneQueryOnSeveral::new(vec![engine(), engine()], Scene::new(), query).expect(&what);
            is_nothing(&several.detect().expect(&what), &what);
            is_nothing(&several.frame(&[]).expect(&what), &what);
        }
    }
}
