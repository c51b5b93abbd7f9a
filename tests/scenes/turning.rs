//! Bodies that turn in a step meet on their arcs.

mod brute;
mod known;
mod laws;
mod refused;

use nearmiss::contacts::{Caveat, Contact, Kind, Rows, Status};
use nearmiss::mesh::Positions;
use nearmiss::scene::{BodyId, Motion, Pose, PoseStep, Scene};
use nearmiss::{Body, Contacts, Detector, Mesh, Query};
use nearmiss_lab::OneQuery;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use std::f64::consts::{FRAC_PI_2, PI};
use support::engine;
use support::solids::{cuboid, rotation};

/// A bar of a length along x from the origin, and a width.
fn bar(length: f64, width: f64) -> Mesh {
    cuboid([0.0, -width, -width], [length, width, width])
}

/// A pose turned about z, at a place.
fn turned(angle: f64, translation: [f64; 3]) -> Pose {
    let half = angle / 2.0;
    Pose { rotation: [0.0, 0.0, half.sin(), half.cos()], translation }
}

/// Bodies and their steps; a body without one rests.
struct Case {
    scene: Scene,
    motions: Vec<(BodyId, Motion<'static>)>,
}

impl Case {
    fn new(bodies: Vec<(Body, Option<PoseStep>)>) -> Case {
        let mut scene = Scene::new();
        let mut motions = Vec::new();
        for (body, step) in bodies {
            let id = scene.add(body);
            motions.extend(step.map(|step| (id, Motion::PoseStep(step))));
        }
        Case { scene, motions }
    }

    fn ask(&self, query: Query) -> Contacts {
        let mut detector = OneQuery::new(engine(), self.scene.clone(), query).expect("a detector");
        detector.frame(&self.motions).expect("an answer")
    }
}

/// The rows of an answer in motion.
fn contacts(found: &Contacts) -> &[Contact] {
    let Rows::Contacts(rows) = &found.rows else { panic!("contacts") };
    rows
}

/// An answer, with everything that is reported except how it was made.
fn rows(found: &Contacts) -> String {
    format!("{:?} {:?}", found.rows, found.caveats())
}

/// The first time of the rows that are certain.
fn first(found: &Contacts) -> Option<f64> {
    contacts(found).iter().filter(|row| row.status == Status::Certified).map(|row| row.toi).reduce(f64::min)
}

/// The step of a body, if it is rigid and has one.
fn step_of(motions: &[(BodyId, Motion<'static>)], of: BodyId) -> Option<PoseStep> {
    motions.iter().find_map(|(id, motion)| match motion {
        Motion::PoseStep(step) if *id == of => Some(*step),
        _ => None,
    })
}

/// Rigid bodies on straight lines between the same poses.
fn straight(motions: &[(BodyId, Motion<'static>)]) -> Vec<(BodyId, Motion<'static>)> {
    let of = |&(id, motion): &(BodyId, Motion<'static>)| match motion {
        Motion::PoseStep(step) => (id, Motion::PoseStep(step.straight())),
        other => (id, other),
    };
    motions.iter().map(of).collect()
}

fn vector(rng: &mut SmallRng, by: f64) -> [f64; 3] {
    [(); 3].map(|()| rng.random_range(-by..by))
}

/// Bodies about a place that turn about pivots by the shorter arc or by given vectors, one that goes
/// straight between two poses, a fixed one and a deformable one.
fn crowd(seed: u64, place: [f64; 3], size: f64) -> Case {
    let mut rng = SmallRng::seed_from_u64(seed);
    let mut case = Case { scene: Scene::new(), motions: Vec::new() };
    let at = |rng: &mut SmallRng| {
        let by = vector(rng, size);
        [0, 1, 2].map(|k| place[k] + by[k])
    };
    for body in 0..5 {
        let low = vector(&mut rng, 0.2);
        let mesh = cuboid(low, [0, 1, 2].map(|k| low[k] + rng.random_range(0.1..1.5)));
        let start = Pose { rotation: rotation(&mut rng), translation: at(&mut rng) };
        let end = Pose { rotation: rotation(&mut rng), translation: at(&mut rng) };
        let step = match body {
            0 | 1 => PoseStep::new(start, end).about(vector(&mut rng, 1.0)),
            2 => PoseStep::turning(start, vector(&mut rng, 3.0), vector(&mut rng, 1.0)),
            3 => PoseStep::new(start, Pose { rotation: start.rotation, ..end }),
            _ => PoseStep::new(start, end).straight(),
        };
        let id = case.scene.add(Body::rigid(mesh));
        case.motions.push((id, Motion::PoseStep(step)));
    }
    let mut corners = |by: f64| -> Vec<[f64; 3]> {
        (0..4)
            .map(|_| {
                let by = vector(&mut rng, by);
                [0, 1, 2].map(|k| place[k] + by[k])
            })
            .collect()
    };
    let (still, starts, ends) = (corners(size), corners(size), corners(size));
    let faces = vec![[0, 1, 2], [1, 3, 2]];
    let mesh =
        |points: Vec<[f64; 3]>| Mesh::new("a sheet", Positions::F64(points), faces.clone()).expect("a mesh");
    case.scene.add(Body::fixed(mesh(still)));
    let sheet = case.scene.add(Body::deformable(mesh(starts.clone())));
    // As long as the test.
    let [start, end]: [&'static [[f64; 3]]; 2] = [starts, ends].map(|points| &*points.leak());
    case.motions.push((sheet, Motion::step(start, end)));
    case
}
