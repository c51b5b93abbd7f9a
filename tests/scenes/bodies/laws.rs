//! Random scenes against the judge, on every machine, frame after frame.

use super::*;

/// The kinds of bodies of a scene.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kinds {
    Rigid,
    RigidAndFixed,
    Deformable,
    Mixed,
}

/// A scene about a place: some spheres, boxes and single triangles, one of them without a triangle.
pub(super) fn scene(rng: &mut SmallRng, kinds: Kinds, count: usize, place: f64, filters: bool) -> Scene {
    let mut scene = Scene::new();
    for i in 0..count {
        let mesh = match rng.random_range(0..5) {
            0 => sphere(3, 1.0),
            1 => sphere(6, 0.7),
            2 => sphere(9, 0.5),
            3 => cuboid([-0.4; 3], [0.6; 3]),
            _ => {
                let corner = |rng: &mut SmallRng| [(); 3].map(|()| rng.random_range(-1.0..1.0));
                let points = vec![corner(rng), corner(rng), corner(rng)];
                Mesh::new("one", Positions::F64(points), vec![[0, 1, 2]]).expect("a mesh")
            }
        };
        let by = [(); 3].map(|()| place + rng.random_range(-3.0..3.0));
        let body = match (kinds, i % 4) {
            (Kinds::Rigid, _) | (Kinds::RigidAndFixed, 1..) | (Kinds::Mixed, 2 | 3) => Body::rigid(mesh),
            (Kinds::RigidAndFixed, _) | (Kinds::Mixed, 0) => Body::fixed(moved(&mesh, by)),
            (Kinds::Deformable, _) | (Kinds::Mixed, _) => Body::deformable(moved(&mesh, by)),
        };
        let filter = CollisionFilter {
            environment: if rng.random_bool(0.3) { None } else { Some(rng.random_range(0..2)) },
            group: 1 << rng.random_range(0..3),
            mask: rng.random_range(1..8),
            ..CollisionFilter::default()
        };
        scene.add(if filters { body.with_filter(filter) } else { body });
    }
    scene.add(Body::rigid(Mesh::new("none", Positions::F64(vec![[0.0; 3]]), vec![]).expect("a mesh")));
    scene
}

/// New positions of a scene: poses, and vertices that shift and deform.
pub(super) struct Next {
    poses: Vec<(BodyId, Pose)>,
    points: Vec<(BodyId, Positions)>,
}

impl Next {
    pub(super) fn of(rng: &mut SmallRng, scene: &Scene, place: f64) -> Next {
        let (mut poses, mut points) = (Vec::new(), Vec::new());
        for id in scene.ids().filter(|_| rng.random_bool(0.8)).collect::<Vec<_>>() {
            let body = scene.get(id).expect("a body");
            match body.kind() {
                BodyKind::Rigid => {
                    let translation = [(); 3].map(|()| place + rng.random_range(-3.0..3.0));
                    poses.push((id, Pose { rotation: rotation(rng), translation }));
                }
                BodyKind::Deformable => {
                    let by = [(); 3].map(|()| rng.random_range(-0.5..0.5));
                    let new =
                        |p: &[f64; 3]| [0, 1, 2].map(|k| p[k] + by[k] + 0.05 * (7.0 * p[(k + 1) % 3]).sin());
                    let at = body.positions_t0().to_f64();
                    points.push((id, Positions::F64(at.iter().map(new).collect())));
                }
                _ => {}
            }
        }
        Next { poses, points }
    }

    pub(super) fn motions(&self) -> Vec<(BodyId, Motion<'_>)> {
        let poses = self.poses.iter().map(|&(id, pose)| (id, Motion::Pose(pose)));
        poses.chain(self.points.iter().map(|(id, at)| (*id, Motion::Positions(at.into())))).collect()
    }
}

#[test]
fn rows_are_those_of_all_pairs_of_triangles() {
    let (mut rng, mut meeting) = (SmallRng::seed_from_u64(3), 0);
    for kinds in [Kinds::Rigid, Kinds::RigidAndFixed, Kinds::Deformable, Kinds::Mixed] {
        for (place, filters) in [(0.0, false), (0.0, true), (1e6, false)] {
            let scene = scene(&mut rng, kinds, 11, place, filters);
            let mut detector = Detector::new(engine(), scene).expect("a detector");
            let mut all = [0; 2];
            for frame in 0..2 {
                let next = Next::of(&mut rng, detector.scene(), place);
                detector.update(&next.motions()).expect("moved");
                let found = judged(&mut detector, &[0.0, 0.3, 2.0, 1e9, 0.05]);
                let found = found.unwrap_or_else(|fault| panic!("{kinds:?} at {place}, {frame}: {fault}"));
                all = [all[0] + found[0], all[1] + found[1]];
            }
            assert!(all[1] > 16, "{kinds:?} at {place}, {filters}: {all:?}");
            meeting += all[0];
        }
    }
    assert!(meeting > 3, "{meeting}");
}

#[test]
fn answers_are_those_of_discrete_and_distance_queries() {
    let mut rng = SmallRng::seed_from_u64(4);
    for kinds in [Kinds::Rigid, Kinds::RigidAndFixed, Kinds::Deformable, Kinds::Mixed] {
        let scene = scene(&mut rng, kinds, 12, 0.0, true);
        let mut detector = Detector::new(engine(), scene).expect("a detector");
        for _ in 0..3 {
            let next = Next::of(&mut rng, detector.scene(), 0.0);
            detector.update(&next.motions()).expect("moved");
            let discrete = detector.query(&Discrete::default()).expect("an answer");
            let mut meeting: Vec<_> = discrete.iter().map(|pair| pair.bodies).collect();
            meeting.retain(|[a, b]| a != b);
            meeting.sort_unstable();
            meeting.dedup();
            let pairs = detector.query(&BodyPairs::default()).expect("an answer");
            assert_eq!(pairs.iter().map(|pair| pair.bodies).collect::<Vec<_>>(), meeting, "{kinds:?}");
            let nearest = detector.query(&Distance::default()).expect("an answer");
            let all = detector.query(&BodyDistances::within(1e6)).expect("an answer");
            let first = all.iter().min_by(|a, b| a.distance.total_cmp(&b.distance));
            let bits = |row: &NearestTriangles| (row.bodies, row.triangles, row.distance.to_bits());
            let wanted = nearest.as_ref().map(|row| row.distance.to_bits());
            assert_eq!(first.map(|row| row.distance.to_bits()), wanted, "{kinds:?}");
            let is_there = nearest.as_ref().is_none_or(|row| all.iter().any(|own| bits(own) == bits(row)));
            assert!(is_there, "{kinds:?}: {nearest:?}");
        }
    }
}

#[test]
fn every_machine_has_the_same_rows() {
    for (seed, kinds) in [(5, Kinds::RigidAndFixed), (6, Kinds::Mixed)] {
        let answers = |device: Device| {
            let mut rng = SmallRng::seed_from_u64(seed);
            let scene = scene(&mut rng, kinds, 16, 0.0, false);
            let mut detector = Detector::new(device, scene).expect("a detector");
            let mut hashes = Vec::new();
            for _ in 0..2 {
                let next = Next::of(&mut rng, detector.scene(), 0.0);
                detector.update(&next.motions()).expect("moved");
                let [pairs, first] = [BodyPairs::default(), BodyPairs::first(1)]
                    .map(|query| detector.query(&query).expect("an answer").rows.to_vec());
                let near = detector.query(&BodyDistances::within(1.0)).expect("an answer").rows.to_vec();
                hashes.push((pairs, first, near));
            }
            hashes
        };
        let expected = answers(engine());
        let alike = |(pairs, first, near): &(Vec<_>, Vec<_>, Vec<NearestTriangles>)| {
            !pairs.is_empty() && first[..] == pairs[..1] && near.len() > pairs.len()
        };
        assert!(expected.iter().all(alike));
        for order in ORDERS {
            let device = Emulator::new(Mode::Sanitizer(order), None).expect("threads");
            assert_eq!(answers(Device::emulator(device)), expected, "{order:?}");
        }
        for device in support::engine_and_gpu().into_iter().skip(1) {
            assert_eq!(answers(device), expected);
        }
        let one = Emulator::new(Mode::Engine, Some(1)).expect("a thread");
        assert_eq!(answers(Device::emulator(one)), expected);
    }
}

/// Lists that are too short grow: many bodies in nearly one place.
#[test]
fn lists_grow_until_nothing_is_dropped() {
    let mut scene = Scene::new();
    let motions: Vec<_> = (0..80)
        .map(|i| {
            let id = scene.add(Body::rigid(sphere(4, 1.0)));
            (id, Motion::Pose(Pose::at([1e-3 * f64::from(i), 0.0, 0.0])))
        })
        .collect();
    let mut detector = Detector::new(engine(), scene).expect("a detector");
    detector.update(&motions).expect("moved");
    let pairs = detector.query(&BodyPairs::default()).expect("an answer").len();
    let near = detector.query(&BodyDistances::within(0.5)).expect("an answer").len();
    assert_eq!([pairs, near], [80 * 79 / 2; 2]);
    assert!(detector.reruns() > 0, "no list was too short");
}

/// The judge names a bound that is too small, and a flag that is set wrongly.
#[test]
fn the_judge_names_planted_faults() {
    let scene = scene(&mut SmallRng::seed_from_u64(7), Kinds::RigidAndFixed, 10, 0.0, false);
    let mut detector = Detector::new(engine(), scene).expect("a detector");
    let truth = truth(detector.scene().bodies());
    let rows = detector.query(&BodyDistances::within(3.0)).expect("an answer").rows.to_vec();
    assert_eq!(fault_of_distances(&rows, &truth, 3.0), Ok(()));
    // A bound that is too small drops the farthest row, or returns another pair.
    assert!(fault_of_distances(&rows[1..], &truth, 3.0).is_err());
    let last = rows.iter().position(|row| row.distance > 0.0).expect("bodies apart");
    for plant in [
        |row: &mut NearestTriangles| row.distance = row.distance.next_up(),
        |row: &mut NearestTriangles| row.distance = 0.0,
        |row: &mut NearestTriangles| row.triangles[1] += 1,
        |row: &mut NearestTriangles| row.points[0][1] += 1e-6,
    ] {
        let mut wrong = rows.clone();
        plant(&mut wrong[last]);
        assert!(fault_of_distances(&wrong, &truth, 3.0).is_err(), "{:?}", wrong[last]);
    }
    // A flag that is set wrongly lists bodies that are apart; one that is not set misses them.
    let pairs = pairs_of(&mut detector, BodyPairs::default()).expect("an answer");
    assert_eq!(fault_of_pairs(&pairs, &truth, usize::MAX), Ok(()));
    let apart = rows[last].bodies.map(BodyId::index);
    let mut more = pairs.clone();
    more.push(apart);
    more.sort_unstable();
    assert!(fault_of_pairs(&more, &truth, usize::MAX).is_err());
    assert!(fault_of_pairs(&pairs[1..], &truth, usize::MAX).is_err());
}
