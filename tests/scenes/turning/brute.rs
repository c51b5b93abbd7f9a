//! Every pair of features, tested alone: no volume, walk or advancement drops one.

use super::*;
use nearmiss::mesh::Points;
use nearmiss::research::{Certified, WithSolver};
use nearmiss_kernels::math::turn::between;
use nearmiss_kernels::math::{Vec3, rigid};
use nearmiss_kernels::prim::turning::{Side, edge_edge, vertex_face};
use std::collections::BTreeSet;

const TOLERANCE: f64 = 1e-4;

/// A body as the judge sees it: its topology, places of its vertices at both ends, and its step if
/// it turns.
struct Judged {
    faces: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
    mesh: Vec<[f64; 3]>,
    ends: [Vec<[f64; 3]>; 2],
    turn: Option<Turn>,
}

struct Turn {
    phi: Vec3<f64>,
    rows: [[f64; 3]; 3],
    pivot: [f64; 3],
    path: [Vec3<f64>; 2],
}

fn judged(case: &Case) -> Vec<Judged> {
    let of = |(id, body): (BodyId, &Body)| {
        let mesh = body.positions_t0().to_f64();
        let faces = body.faces().to_vec();
        let edges: BTreeSet<[u32; 2]> = faces
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|[a, b]| [a.max(b), a.min(b)])
            .collect();
        let step = step_of(&case.motions, id);
        let moves = case.motions.iter().find(|(of, _)| *of == id).map(|(_, motion)| *motion);
        let (ends, turn) = match step {
            None => match moves {
                Some(Motion::Step(ends)) => (ends.map(doubles), None),
                _ => ([mesh.clone(), mesh.clone()], None),
            },
            Some(step) => {
                let poses = [step.start(), step.end()];
                let turn = step.turns().then(|| turn(&step, poses));
                (poses.map(|pose| mesh.iter().map(|&p| pose.apply(p)).collect()), turn)
            }
        };
        Judged { faces, edges: edges.into_iter().collect(), mesh, ends, turn }
    };
    case.scene.ids().zip(case.scene.bodies()).map(of).collect()
}

fn doubles(points: Points) -> Vec<[f64; 3]> {
    match points {
        Points::F64(points) => points.to_vec(),
        other => panic!("{other:?}"),
    }
}

fn turn(step: &PoseStep, poses: [Pose; 2]) -> Turn {
    let unit = |pose: Pose| {
        let length = pose.rotation.iter().map(|q| q * q).sum::<f64>().sqrt();
        pose.rotation.map(|q| q / length)
    };
    let nearmiss::scene::PosePath::Turn { pivot, by } = step.path() else { panic!("it turns") };
    let phi = by.map_or_else(|| between(unit(poses[0]), unit(poses[1])), Vec3);
    let path = poses.map(|pose| Vec3(pose.apply(pivot)));
    Turn { phi, rows: rigid::rows(unit(poses[0])), pivot, path }
}

impl Judged {
    fn side(&self, vertices: &[u32], other: &Judged) -> Side {
        let mut points = [[Vec3([0.0; 3]); 2]; 3];
        let seen_from = other.turn.as_ref().map_or([Vec3([0.0; 3]); 2], |turn| turn.path);
        for (point, &v) in points.iter_mut().zip(vertices) {
            *point = match &self.turn {
                Some(turn) => {
                    let from = Vec3(self.mesh[v as usize]) - Vec3(turn.pivot);
                    [rigid::moved(&turn.rows, &[0.0; 3], from); 2]
                }
                None => [0, 1].map(|end| Vec3(self.ends[end][v as usize]) - seen_from[end]),
            };
        }
        match &self.turn {
            Some(turn) => Side { phi: turn.phi, pivot: turn.path, points },
            None => Side { phi: Vec3([0.0; 3]), pivot: seen_from, points },
        }
    }
}

/// The name of a row: kind, bodies, vertices, and whether it is certain.
type Name = (Kind, [usize; 2], Vec<u32>, bool);

/// The rows of two bodies of which one turns, by each pair of features alone.
fn expected(case: &Case, separation: f64) -> BTreeSet<Name> {
    let bodies = judged(case);
    let certified =
        Certified { tolerance: Some(TOLERANCE), min_separation: separation, ..Certified::default() };
    let params = certified.params();
    let mut all = BTreeSet::new();
    for (i, a) in bodies.iter().enumerate() {
        for (j, b) in bodies.iter().enumerate() {
            if i == j || (a.turn.is_none() && b.turn.is_none()) {
                continue;
            }
            for v in 0..a.mesh.len() as u32 {
                for face in &b.faces {
                    let verdict = vertex_face(&a.side(&[v], b), &b.side(face, a), &params);
                    if !verdict.is_separated() {
                        all.insert((Kind::Vf, [i, j], [&[v][..], face].concat(), verdict.is_contact()));
                    }
                }
            }
            if i < j {
                for own in &a.edges {
                    for other in &b.edges {
                        let verdict = edge_edge(&a.side(own, b), &b.side(other, a), &params);
                        if !verdict.is_separated() {
                            let vertices = [&own[..], other].concat();
                            all.insert((Kind::Ee, [i, j], vertices, verdict.is_contact()));
                        }
                    }
                }
            }
        }
    }
    all
}

/// The same rows of an answer; the others are those of bodies that go straight.
fn listed(case: &Case, detector: &mut Detector, query: &nearmiss::Continuous) -> BTreeSet<Name> {
    let found = detector.step(&case.motions, query).expect("an answer");
    let geometry = detector.geometry(&found).expect("points");
    let turns = |id: BodyId| step_of(&case.motions, id).is_some_and(|step| step.turns());
    let rows = found.rows.iter().zip(&geometry).filter(|(row, _)| row.bodies.iter().any(|&id| turns(id)));
    rows.map(|(row, at)| {
        let mut bodies = row.bodies.map(BodyId::index);
        let mut vertices = at.vertices.to_vec();
        if row.kind == Kind::Ee && bodies[0] > bodies[1] {
            bodies.reverse();
            vertices.rotate_left(2);
        }
        (row.kind, bodies, vertices, row.status == Status::Certified)
    })
    .collect()
}

#[test]
fn no_pair_is_dropped_on_the_way_to_the_solver() {
    let mut total = [0; 2];
    for seed in 0..6 {
        let case = crowd(seed, [0.0; 3], 1.2);
        for separation in [0.0, 0.05] {
            let wanted = expected(&case, separation);
            let query = nearmiss::Continuous::by(Certified {
                tolerance: Some(TOLERANCE),
                min_separation: separation,
                ..Certified::default()
            });
            let mut detector = Detector::new(engine(), case.scene.clone()).expect("a detector");
            let found = listed(&case, &mut detector, &query);
            let missing: Vec<_> = wanted.difference(&found).collect();
            let more: Vec<_> = found.difference(&wanted).collect();
            assert!(missing.is_empty() && more.is_empty(), "{seed} {separation}: {missing:?} {more:?}");
            total[usize::from(separation > 0.0)] += found.len();
        }
    }
    assert!(total[0] > 200 && total[1] > total[0], "{total:?}");
}
