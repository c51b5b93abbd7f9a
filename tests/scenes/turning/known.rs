//! Known answers: bars and pegs, a hinge, a wheel, a whole turn.

use super::*;

/// A bar of length 2 turns by half a turn about the origin, towards +y. A peg stands at a quarter
/// turn.
fn bar_and_peg(step: PoseStep, gap: f64) -> Case {
    let peg = cuboid([-0.05, 1.0 + gap, -0.05], [0.05, 1.1 + gap, 0.05]);
    Case::new(vec![(Body::rigid(bar(1.0, 0.01)), Some(step)), (Body::fixed(peg), None)])
}

fn half_turn() -> PoseStep {
    PoseStep::turning(Pose::default(), [0.0, 0.0, PI], [0.0; 3])
}

#[test]
fn a_bar_that_turns_by_180_degrees_meets_a_peg_that_straight_lines_pass() {
    let reach = (1.0f64 + 1e-4).sqrt() - 1.0;
    for (step, gap, meets) in [
        (half_turn(), -0.5, true),
        (half_turn(), -0.001, true),
        (half_turn(), reach - 1e-6, true),
        (half_turn(), reach + 1e-6, false),
        (half_turn().straight(), -0.001, false),
    ] {
        let case = bar_and_peg(step, gap);
        let found = case.ask(support::asked::with_tolerance(Query::continuous(), 1e-7));
        assert_eq!(first(&found).is_some(), meets, "{step:?} {gap}: {}", rows(&found));
        let earliest = case.ask(support::asked::with_tolerance(Query::earliest(), 1e-7));
        let Rows::Earliest(earliest) = earliest.rows else { panic!("a time") };
        assert_eq!(earliest, first(&found), "{gap}");
    }
}

/// The long side of the bar is at `y = x tan(angle)`, less its half width.
#[test]
fn the_time_is_that_of_the_arc() {
    let found = bar_and_peg(half_turn(), -0.5).ask(support::asked::with_tolerance(Query::continuous(), 1e-9));
    // The peg's corner (0.05, 0.5): it lies on the upper side of the bar, 0.01 from its axis.
    let corner = (0.5f64 * 0.5 + 0.05 * 0.05).sqrt();
    let angle = (0.5f64 / 0.05).atan() - (0.01 / corner).asin();
    let toi = first(&found).expect("a contact");
    assert!(toi <= angle / PI && toi > angle / PI - 1e-6, "{toi} {}", angle / PI);
    assert_eq!(found.caveats(), []);
}

#[test]
fn a_door_turns_about_its_hinge() {
    // A door from the origin of its mesh, which is far from its hinge.
    let door = cuboid([5.0, 0.0, 0.0], [6.0, 0.05, 2.0]);
    let hinge = [5.0, 0.0, 0.0];
    let about = |pivot| PoseStep::new(Pose::default(), turned_about(FRAC_PI_2, hinge)).about(pivot);
    let at = |angle: f64| [5.0 + 0.9 * angle.cos(), 0.9 * angle.sin()];
    let [x, y] = at(0.8);
    let stop = cuboid([x - 0.01, y - 0.01, 0.5], [x + 0.01, y + 0.01, 0.6]);
    let case =
        |step| Case::new(vec![(Body::rigid(door.clone()), Some(step)), (Body::fixed(stop.clone()), None)]);
    assert!(first(&case(about(hinge)).ask(Query::continuous())).is_some());
    // The same poses about the origin: the door flies on another arc.
    let other = case(about([0.0; 3])).ask(Query::continuous());
    let own = case(about(hinge)).ask(Query::continuous());
    assert_ne!(first(&other), first(&own));
}

/// The pose that a turn about z and a pivot leads to.
fn turned_about(angle: f64, pivot: [f64; 3]) -> Pose {
    let pose = turned(angle, [0.0; 3]);
    let moved = pose.apply(pivot);
    Pose { translation: [0, 1, 2].map(|k| pivot[k] - moved[k]), ..pose }
}

/// 350 degrees are not 10 backwards: two poses cannot say it, a rotation vector can.
#[test]
fn the_long_way_round_is_not_the_short_one() {
    let angle = 350f64.to_radians();
    let peg = cuboid([-1.0, -0.05, -0.05], [-0.9, 0.05, 0.05]);
    let case =
        |step| Case::new(vec![(Body::rigid(bar(1.0, 0.01)), Some(step)), (Body::fixed(peg.clone()), None)]);
    let long = case(PoseStep::turning(Pose::default(), [0.0, 0.0, angle], [0.0; 3]));
    let short = case(PoseStep::new(Pose::default(), turned(angle, [0.0; 3])));
    let toi = first(&long.ask(Query::continuous())).expect("a contact");
    assert!(toi > 0.45 && toi < PI / angle, "{toi}");
    assert_eq!(contacts(&short.ask(Query::continuous())).len(), 0);
}

/// A whole turn ends where it began: only its path shows that the body moves.
#[test]
fn a_whole_turn_ends_where_it_began() {
    let step = PoseStep::turning(Pose::default(), [0.0, 0.0, PoseStep::LONGEST_TURN], [0.0; 3]);
    let case = bar_and_peg(step, -0.1);
    let mut detector = OneQuery::new(engine(), case.scene.clone(), Query::continuous()).expect("a detector");
    let toi = first(&detector.frame(&case.motions).expect("an answer")).expect("a contact");
    assert!((toi - 0.25).abs() < 0.02, "{toi}");
    // Then it stands.
    let rests = detector.frame(&[]).expect("an answer");
    assert_eq!(contacts(&rests).len(), 0, "{}", rows(&rests));
}

/// A wheel of eight sides rolls over a plane that it presses, and over one that it clears.
#[test]
fn a_wheel_that_rolls_touches_only_what_it_reaches() {
    let corner = |k: u32, z: f64| {
        let angle = f64::from(k) * FRAC_PI_2 / 2.0;
        [angle.cos(), angle.sin(), z]
    };
    let points = (0..8).flat_map(|k| [corner(k, 0.0), corner(k, 0.5)]).collect();
    let faces = (0..8).flat_map(|k| {
        let [a, b, c, d] = [2 * k, 2 * k + 1, (2 * k + 2) % 16, (2 * k + 3) % 16];
        [[a, c, b], [b, c, d]]
    });
    let wheel = Mesh::new("a wheel", Positions::F64(points), faces.collect()).expect("a mesh");
    let floor = |y: f64| cuboid([-1.0, y - 1.0, -1.0], [9.0, y, 1.0]);
    for (y, meets) in [(-1.0 - 1e-6, false), (-1.0 + 1e-3, true)] {
        // Turned by half a side at first, so that no corner is at the bottom.
        let start = turned(0.39, [0.0; 3]);
        let step = PoseStep::turning(start, [0.0, 0.0, -6.0], [6.0, 0.0, 0.0]);
        let case = Case::new(vec![(Body::rigid(wheel.clone()), Some(step)), (Body::fixed(floor(y)), None)]);
        let found = case.ask(support::asked::with_tolerance(Query::continuous(), 1e-8));
        assert_eq!(first(&found).is_some(), meets, "{y}: {}", contacts(&found).len());
    }
}

/// Nearest points of a contact are on the arcs: they coincide, and the normal is against the motion.
#[test]
fn geometry_is_at_the_place_on_the_arc() {
    let case = bar_and_peg(half_turn(), -0.5);
    let query = nearmiss::Continuous::default();
    let mut detector = Detector::new(engine(), case.scene.clone()).expect("a detector");
    let found = detector.step(&case.motions, &query).expect("an answer");
    let geometry = detector.geometry(&found).expect("points");
    assert!(!geometry.is_empty());
    for (row, of_row) in found.rows.iter().zip(&geometry) {
        assert!(of_row.distance < 1e-3, "{row:?} {of_row:?}");
        // The bar meets the peg from the right; the peg pushes it back, down the arc.
        let towards_bar = if row.bodies[0].index() == 0 { 1.0 } else { -1.0 };
        let [x, y, _] = of_row.points[0];
        let arc = [-y, x];
        let along = arc[0] * of_row.normal[0] + arc[1] * of_row.normal[1];
        assert!(along * towards_bar <= 1e-9, "{row:?} {of_row:?}");
    }
}
