//! Bodies in memory of the caller, and submitted frames.

use super::{interrupted, looks, same, threads};
use nearmiss::mesh::Positions;
use nearmiss::scene::{BodyId, CollisionFilter, DeviceMotion, DeviceRows, Motion, Number};
use nearmiss::{Body, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;

fn soup(seed: u64) -> Body {
    scene::soup(200, seed, true).expect("a scene").with_filter(CollisionFilter::with_self_collision())
}

fn points(body: &Body) -> [Vec<[f32; 3]>; 2] {
    body.ends().map(|positions| match positions {
        Positions::F32(points) => points.clone(),
        Positions::F64(_) => panic!("in single precision"),
    })
}

/// Both ends of a step, where the caller has them.
fn rows(ends: &[Vec<[f32; 3]>; 2]) -> DeviceMotion {
    let of = |points: &Vec<[f32; 3]>| {
        let address = points.as_ptr().expose_provenance() as u64;
        // SAFETY: the test holds the points while the detector reads them.
        unsafe { DeviceRows::new(address, points.len(), 12, Number::F32) }.expect("rows")
    };
    DeviceMotion::Step([of(&ends[0]), of(&ends[1])])
}

fn detector() -> (OneQuery, Vec<BodyId>) {
    let scene = nearmiss::Scene::from(vec![soup(1), soup(2)]);
    let ids = scene.ids().collect();
    (OneQuery::new(threads(2), scene, Query::continuous()).expect("a detector"), ids)
}

#[test]
fn rows_of_the_caller_were_read_by_a_frame_that_was_interrupted() {
    let ((mut wanted, ids), (mut own, _)) = (detector(), detector());
    let interrupt = own.interrupter();
    for (k, at) in [1, 2, 5, 60].into_iter().enumerate() {
        let mut ends = points(&soup(30 + k as u64));
        let input = |ends| [(ids[0], Motion::OnDevice(rows(ends)))];
        let want = wanted.frame(&input(&ends)).expect("an answer");
        interrupt.trigger_at(at);
        interrupted(&interrupt, own.frame(&input(&ends)));
        // The caller may write there again, and the body stays.
        ends.iter_mut().flatten().for_each(|point| *point = [f32::NAN; 3]);
        same(&own.detect().expect("an answer"), &want, &format!("look {at}"));
        // Then all rest.
        same(&own.frame(&[]).expect("an answer"), &wanted.frame(&[]).expect("an answer"), "at rest");
    }
}

#[test]
fn a_submission_that_was_interrupted_is_prepared_again() {
    let ((mut wanted, ids), (mut own, _)) = (detector(), detector());
    let ends = points(&soup(5));
    let inputs = [(ids[0], rows(&ends)), (ids[1], rows(&ends))];
    wanted.prepare(&inputs).expect("prepared");
    wanted.submit().expect("submitted");
    let want = wanted.collect().expect("an answer");
    own.prepare(&inputs).expect("prepared");
    let interrupt = own.interrupter();
    let (count, submitted) = looks(&interrupt, || own.submit());
    submitted.expect("submitted");
    same(&own.collect().expect("an answer"), &want, "not interrupted");
    for at in [1, count / 2, count * 9 / 10] {
        assert!(own.is_prepared());
        interrupt.trigger_at(at);
        interrupted(&interrupt, own.submit());
        assert!(!own.is_prepared() && own.on_device().is_none());
        // Bodies are where the submission has placed them.
        same(&own.detect().expect("an answer"), &want, &format!("look {at} of {count}"));
        same(&own.prepare(&inputs).expect("prepared"), &want, "prepared again");
        own.submit().expect("submitted");
        same(&own.collect().expect("an answer"), &want, "submitted again");
    }
}

#[test]
fn an_answer_whose_collection_was_interrupted_can_be_had_again() {
    let (mut own, ids) = detector();
    let ends = points(&soup(6));
    let want = own.prepare(&[(ids[0], rows(&ends))]).expect("prepared");
    own.submit().expect("submitted");
    let interrupt = own.interrupter();
    interrupt.trigger();
    interrupted(&interrupt, own.collect());
    same(&own.detect().expect("an answer"), &want, "the bodies where they were placed");
}
