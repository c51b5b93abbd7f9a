//! Bodies with known answers.

use super::*;

/// A detector of these bodies.
fn detector(bodies: Vec<Body>) -> Detector {
    Detector::new(engine(), bodies).expect("a detector")
}

#[test]
fn boxes_that_touch_at_a_corner_share_a_point() {
    for place in [0.0, 1e6] {
        let at = |low: f64, high: f64| cuboid([place + low; 3], [place + high; 3]);
        let bodies = vec![Body::rigid(at(0.0, 1.0)), Body::rigid(at(1.0, 2.0)), Body::rigid(at(2.5, 3.0))];
        let mut own = detector(bodies);
        assert_eq!(pairs_of(&mut own, BodyPairs::default()), Ok(vec![[0, 1]]));
        let zero = own.query(&BodyDistances::within(0.0)).expect("an answer");
        assert_eq!(zero.iter().map(|row| row.distance).collect::<Vec<_>>(), [0.0]);
        judged(&mut own, &[0.0, -0.0, 0.5, 1.0, 3.0]).expect("alike");
        // The corners are half a unit apart along each axis.
        let near = own.query(&BodyDistances::within(1.0)).expect("an answer");
        let apart: Vec<f64> = near.iter().map(|row| row.distance).collect();
        assert_eq!(apart[0], 0.0);
        assert!((apart[1] - 0.75_f64.sqrt()).abs() < 1e-9 && apart.len() == 2, "{apart:?}");
    }
}

#[test]
fn a_body_inside_another_is_as_far_as_its_surface() {
    let mut own = detector(vec![Body::rigid(sphere(12, 1.0)), Body::rigid(sphere(5, 0.25))]);
    assert_eq!(pairs_of(&mut own, BodyPairs::default()), Ok(vec![]));
    let found = judged(&mut own, &[0.1, 0.5, 0.76, 2.0]).expect("alike");
    assert_eq!(found, [0, 2]);
}

#[test]
fn a_limit_at_the_distance_itself_lists_it() {
    let mut own = detector(vec![
        Body::rigid(cuboid([0.0; 3], [1.0; 3])),
        Body::rigid(cuboid([1.25, 0.0, 0.0], [2.0, 1.0, 1.0])),
    ]);
    let count =
        |own: &mut Detector, within: f64| own.query(&BodyDistances::within(within)).expect("rows").len();
    assert_eq!(count(&mut own, 0.25), 1);
    assert_eq!(count(&mut own, 0.25_f64.next_down()), 0);
    assert_eq!(count(&mut own, f64::MAX), 1);
}

#[test]
fn nothing_meets_without_two_bodies_that_may() {
    let one = || cuboid([0.0; 3], [1.0; 3]);
    let none = Mesh::new("none", Positions::F64(vec![[0.0; 3]]), vec![]).expect("a mesh");
    for bodies in [
        vec![Body::rigid(one())],
        vec![Body::deformable(one())],
        vec![Body::rigid(one()), Body::rigid(none.clone())],
        vec![Body::fixed(one()), Body::fixed(one())],
        vec![Body::rigid(none)],
        vec![Body::rigid(one()).with_filter(CollisionFilter::with_self_collision())],
    ] {
        let mut own = detector(bodies);
        assert_eq!(judged(&mut own, &[0.0, 10.0]), Ok([0, 0]));
    }
}

#[test]
fn bodies_that_collide_with_themselves_are_pairs_like_others() {
    let ball = || Body::rigid(sphere(5, 1.0)).with_filter(CollisionFilter::with_self_collision());
    let mut own = detector(vec![ball(), ball(), ball()]);
    let shift = |x: f64| Motion::Pose(Pose::at([x, 0.2, 0.1]));
    let ids: Vec<_> = own.scene().ids().collect();
    own.update(&[(ids[1], shift(1.5)), (ids[2], shift(4.0))]).expect("moved");
    assert_eq!(judged(&mut own, &[0.0, 10.0]), Ok([1, 4]));
}

/// Other queries, new bodies and frames in between change nothing.
#[test]
fn other_frames_in_between_change_nothing() {
    let mut own = detector(vec![
        Body::rigid(sphere(5, 1.0)),
        Body::fixed(moved(&sphere(5, 1.0), [1.2, 0.3, 0.0])),
        Body::rigid(sphere(4, 0.5)),
    ]);
    let ids: Vec<_> = own.scene().ids().collect();
    own.update(&[(ids[2], Motion::Pose(Pose::at([3.0, 0.0, 0.0])))]).expect("moved");
    assert_eq!(judged(&mut own, &[5.0]), Ok([1, 3]));
    own.query(&Discrete::default()).expect("an answer");
    own.query(&Distance::default()).expect("an answer");
    assert_eq!(judged(&mut own, &[5.0, 0.1]), Ok([1, 4]));
    // A deformable body comes: vertices are now in the scene.
    let soft = own.add(Body::deformable(moved(&sphere(4, 0.5), [3.0, 0.7, 0.0]))).expect("added");
    assert_eq!(judged(&mut own, &[5.0]), Ok([2, 6]));
    let far = Positions::F64(moved(&sphere(4, 0.5), [3e3, 1.0, 0.0]).positions().to_f64());
    own.update(&[(soft, Motion::Positions((&far).into()))]).expect("moved");
    judged(&mut own, &[5.0, 1e4]).expect("alike");
    own.remove(ids[0]).expect("removed");
    judged(&mut own, &[5.0, 1e4]).expect("alike");
    own.query(&Discrete::default()).expect("an answer");
    judged(&mut own, &[1e4]).expect("alike");
}

/// Boxes at rest beyond the range of f32, of every kind.
#[test]
fn bodies_beyond_the_range_of_f32_meet() {
    for scale in [1e30, 1e39, 1e42] {
        let at = |low: f64| cuboid([low * scale, 0.0, 0.0], [(low + 1.0) * scale, scale, scale]);
        for kind in [Body::deformable, Body::rigid] {
            let mut own = detector(vec![kind(at(0.0)), kind(at(1.0)), kind(at(2.5))]);
            // The first two touch; the third is half a side from the second.
            assert_eq!(judged(&mut own, &[0.0, scale]), Ok([1, 3]), "{scale:e}");
        }
    }
}
