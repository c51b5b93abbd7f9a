//! Known answers: a box above a floor.

use super::approaching;
use nearmiss::contacts::{Contact, Status};
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::QueryKind;
use nearmiss::research::Solver;
use nearmiss::scene::{Pose, PoseStep, Thickness};
use nearmiss::{Continuous, Detector, Earliest, Scene};
use support::solids::cuboid;
use support::{ask, engine};

/// A floor and a box that is `gap` above it, and moves.
fn scene(gap: f64, by: [f64; 3], thickness: impl Into<Thickness>) -> Vec<Body> {
    let floor = Body::fixed(cuboid([-2.0, -2.0, -1.0], [2.0, 2.0, 0.0]));
    let corner = |z: f64| cuboid([-0.5, -0.5, gap + z], [0.5, 0.5, gap + 1.0 + z]);
    let start = corner(0.0);
    let moved = start.positions().to_f64().into_iter().map(|p| std::array::from_fn(|k| p[k] + by[k]));
    let end = Mesh::new("end", Positions::F64(moved.collect()), start.faces().to_vec()).expect("a mesh");
    let start = Mesh::new("start", Positions::F64(start.positions().to_f64()), start.faces().to_vec());
    let moving = Body::moving(start.expect("a mesh"), end).expect("a step");
    vec![floor, moving.with_thickness(thickness)]
}

fn times(bodies: Vec<Body>, separation: f64) -> Vec<f64> {
    let found = ask(engine(), bodies, approaching(QueryKind::Continuous, Solver::Certified, separation));
    let undecided = |contact: &&Contact| contact.status == Status::Undecided;
    assert_eq!(found.contacts().iter().find(undecided), None, "{separation}");
    found.contacts().iter().map(|contact| contact.toi).collect()
}

/// It may rest, slide and leave; what sinks is in contact at once.
#[test]
fn a_box_rests_slides_leaves_and_sinks() {
    for gap in [0.0, 1.0 / 2048.0, 0.0009] {
        for separation in [0.0, 1.0 / 1024.0, 0.01] {
            let of = |by| times(scene(gap, by, 0.0), separation);
            for by in [[0.0; 3], [0.25, 0.125, 0.0], [0.0, 0.0, 0.75], [-0.25, 0.5, 0.125]] {
                assert_eq!(of(by), [0.0; 0], "{gap} {separation} {by:?}");
            }
            let sinks = of([0.125, 0.0, -1.0 / 16384.0]);
            match (gap, gap <= separation) {
                // At a distance of 0 there is no side: either way it parts.
                (0.0, _) => assert!(sinks.is_empty()),
                (_, true) => assert!(!sinks.is_empty() && sinks.iter().all(|&toi| toi == 0.0)),
                (_, false) => assert!(sinks.is_empty()),
            }
        }
    }
}

/// A body with a thickness rests on its thickness.
#[test]
fn a_thickness_is_a_separation() {
    let thick = 1.0 / 256.0;
    assert!(times(scene(0.001, [0.2, 0.0, 0.3], thick), 0.0).is_empty());
    assert!(times(scene(0.001, [0.2, 0.0, -0.0005], thick), 0.0).iter().all(|&toi| toi == 0.0));
    let each: Vec<f64> = (0..8).map(|vertex| thick * f64::from(1 + vertex % 3)).collect();
    assert!(times(scene(0.001, [0.2, 0.0, 0.3], each.clone()), 0.0).is_empty());
    assert!(!times(scene(0.001, [0.2, 0.0, -0.0005], each), 0.0).is_empty());
}

/// A vertex that leaves and comes back is in contact when it is nearer than at the start.
#[test]
fn what_leaves_and_comes_back_is_found_later() {
    // A face tilts: above the vertex it first moves away, then the far corner comes over.
    let faces = vec![[0, 1, 2], [3, 3, 3]];
    let start = vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, -0.75, 0.125]];
    let end = vec![[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [0.0, 1.0, 2.0], [0.0, 0.75, 0.125]];
    let mesh = |points| Mesh::new("face", Positions::F64(points), faces.clone()).expect("a mesh");
    let body = || Body::moving(mesh(start.clone()), mesh(end.clone())).expect("a step");
    let found = times(vec![body()], 0.25);
    assert!(found.len() == 1 && found[0] > 0.01 && found[0] < 0.5, "{found:?}");
    let all = ask(engine(), vec![body()], super::asking(QueryKind::Continuous, Solver::Certified, 0.25));
    assert_eq!(all.earliest_toi(), Some(0.0));
}

/// A step in which a body may turn is refused by name, and the detector answers other queries.
#[test]
fn a_body_that_turns_is_refused() {
    let bar = Body::rigid(cuboid([-2.0, -0.1, -0.1], [2.0, 0.1, 0.1]));
    let end = Pose { rotation: [0.0, 0.0, 0.6, 0.8], ..Pose::default() };
    let bar = bar.at(PoseStep::new(Pose::default(), end)).expect("a step");
    let peg = Body::fixed(cuboid([-0.1, 1.0, -1.0], [0.1, 1.2, 1.0]));
    let mut detector = Detector::new(engine(), Scene::from(vec![bar, peg])).expect("a detector");
    let refused = detector.query(&Continuous::default().with_approaching(true)).expect_err("refused");
    assert!(refused.to_string().contains("approaching cannot be tested in this step: "), "{refused}");
    assert!(detector.query(&Earliest::default().with_approaching(true)).is_err());
    assert!(detector.query(&Continuous::default()).is_ok());
}
