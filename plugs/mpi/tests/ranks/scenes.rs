//! Scenes of the laws: small, and hostile.

use nearmiss::mesh::{Points, Positions};
use nearmiss::scene::{CollisionFilter, Motion, Pose, PoseStep, Scene};
use nearmiss::{Body, Mesh};

/// Numbers that look random.
pub struct Random(pub u64);

impl Random {
    /// From 0 to 1.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from((self.0 >> 40) as u32) / f64::from(1 << 24)
    }

    pub fn point(&mut self, size: f64) -> [f64; 3] {
        [0; 3].map(|_| size * (self.next() - 0.5))
    }

    fn below(&mut self, end: usize) -> u32 {
        (self.next() * end as f64) as u32
    }
}

/// A scene that moves.
pub struct Case {
    pub name: &'static str,
    pub scene: Scene,
    /// Length of its edges, about.
    pub edge: f64,
}

/// Positions in single or double precision.
pub fn positions(points: Vec<[f64; 3]>, is_f64: bool) -> Positions {
    match is_f64 {
        true => Positions::F64(points),
        false => Positions::F32(points.into_iter().map(|p| p.map(|x| x as f32)).collect()),
    }
}

fn mesh(name: &str, points: Vec<[f64; 3]>, faces: Vec<[u32; 3]>, is_f64: bool) -> Mesh {
    Mesh::new(name, positions(points, is_f64), faces).expect("a mesh")
}

/// A square sheet of `side` vertices, folded `folds` times, with a little noise.
pub fn sheet(side: usize, folds: f64, random: &mut Random) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let at = |i: usize, random: &mut Random| {
        let [u, v] = [i % side, i / side].map(|k| k as f64 / (side - 1) as f64);
        let fold = (u * folds * std::f64::consts::PI).sin();
        let [x, y, z] = random.point(0.02);
        [fold * 0.5 + x, v + y, 0.05 * u * folds + z]
    };
    let points = (0..side * side).map(|i| at(i, random)).collect();
    let cell = |i: usize| {
        let v = (i / (side - 1) * side + i % (side - 1)) as u32;
        [[v, v + 1, v + side as u32], [v + 1, v + side as u32 + 1, v + side as u32]]
    };
    (points, (0..(side - 1) * (side - 1)).flat_map(cell).collect())
}

fn soup(name: &str, (vertices, faces): (usize, usize), size: f64, is_f64: bool, random: &mut Random) -> Mesh {
    let mut points: Vec<[f64; 3]> = (0..vertices).map(|_| random.point(size)).collect();
    // Some coincide, one is used by no face.
    (1..vertices / 8).for_each(|i| points[8 * i] = points[8 * i - 1]);
    points[0] = [f64::NAN; 3];
    // Some faces repeat an index.
    let faces = (0..faces).map(|_| [0; 3].map(|_| 1 + random.below(vertices - 1))).collect();
    mesh(name, points, faces, is_f64)
}

fn scaled(points: &[[f64; 3]], by: f64, to: [f64; 3]) -> Vec<[f64; 3]> {
    points.iter().map(|p| [0, 1, 2].map(|k| by * p[k] + to[k])).collect()
}

/// The scenes of the laws.
pub fn cases() -> Vec<Case> {
    let mut random = Random(7);
    let (points, faces) = sheet(17, 3.0, &mut random);
    let of = |name, by, to, is_f64| Case {
        name,
        scene: Body::deformable(mesh("sheet", scaled(&points, by, to), faces.clone(), is_f64)).into(),
        edge: by / 16.0,
    };
    let mut cases = vec![
        of("one sheet", 1.0, [0.0; 3], false),
        of("in doubles", 1.0, [0.1; 3], true),
        of("far from the origin", 1.0, [3e5, -2e5, 1e5], false),
        of("huge, in doubles", 1e120, [1e121; 3], true),
        of("huge, in singles", 1e25, [0.0; 3], false),
        of("tiny", 1e-30, [0.0; 3], false),
        Case { name: "no bodies", scene: Scene::new(), edge: 1.0 },
        Case {
            name: "a soup",
            scene: Body::deformable(soup("soup", (60, 90), 1.0, false, &mut random)).into(),
            edge: 0.2,
        },
    ];
    cases.push(many(&mut random));
    cases.push(thick(&points, &faces));
    let few = mesh("few", scaled(&points, 1.0, [0.0; 3]), faces[..3].to_vec(), false);
    let none = mesh("none", Vec::new(), Vec::new(), false);
    cases.push(Case {
        name: "fewer triangles than ranks",
        scene: Scene::from(vec![Body::deformable(none), Body::deformable(few)]),
        edge: 0.1,
    });
    cases
}

/// Bodies of all kinds, precisions and filters.
fn many(random: &mut Random) -> Case {
    let mut scene = Scene::new();
    let (ground, ground_faces) = sheet(9, 0.0, random);
    let ground: Vec<[f64; 3]> = ground.iter().map(|p| [6.0 * p[1] - 3.0, 60.0 * p[2], p[0]]).collect();
    scene.add(Body::fixed(mesh("ground", ground, ground_faces, false)));
    for at in 0..7 {
        let body = soup(&format!("soup {at}"), (12, 14), 0.8, at % 3 == 1, random);
        let [x, y, z] = random.point(1.5);
        let filter = match at {
            2 => CollisionFilter::without_self_collision(),
            3 => CollisionFilter { environment: None, ..CollisionFilter::default() },
            4 => CollisionFilter::in_environment(1),
            5 => CollisionFilter { group: 2, mask: 5, ..CollisionFilter::default() },
            _ => CollisionFilter::default(),
        };
        let body = match at % 2 {
            0 => Body::deformable(body),
            _ => Body::rigid(body).at(Pose::at([x, y, z])).expect("a pose"),
        };
        scene.add(body.with_filter(filter));
    }
    let (points, faces) = sheet(9, 1.0, random);
    let turns = CollisionFilter::with_self_collision();
    scene.add(Body::rigid(mesh("rigid sheet", points, faces, false)).with_filter(turns));
    let ids: Vec<_> = scene.ids().collect();
    scene.leave_out(&[[ids[1], ids[8]]]).expect("a pair");
    Case { name: "many bodies", scene, edge: 0.3 }
}

fn thick(points: &[[f64; 3]], faces: &[[u32; 3]]) -> Case {
    let body = |name, to| Body::deformable(mesh(name, scaled(points, 1.0, to), faces.to_vec(), false));
    let scene = Scene::from(vec![
        body("thick", [0.0; 3]).with_thickness(0.01),
        body("thin", [0.3, 0.0, 0.02]).with_thickness(0.002),
        body("without", [-0.3, 0.1, 0.03]),
    ]);
    Case { name: "with a thickness", scene, edge: 1.0 / 16.0 }
}

/// Motions of a step, as the caller owns them.
pub struct Step(Vec<Own>);

enum Own {
    Positions(Positions),
    Step([Positions; 2]),
    Pose(Pose),
    PoseStep(PoseStep),
}

impl Step {
    /// A motion of all bodies, or of some, by a part of an edge; with one end, or with two.
    pub fn random(case: &Case, ends: usize, random: &mut Random) -> Vec<(usize, Step)> {
        let mut all = Vec::new();
        for (at, body) in case.scene.bodies().iter().enumerate() {
            if body.kind() == nearmiss::scene::BodyKind::Fixed || at > 0 && random.next() < 0.2 {
                continue;
            }
            let own = if body.kind() == nearmiss::scene::BodyKind::Rigid {
                rigid(body, ends, random)
            } else {
                let mut end = || {
                    let points = body.positions_t0().to_f64();
                    let moved = points.into_iter().map(|p| {
                        let by = random.point(1.5 * case.edge);
                        [0, 1, 2].map(|k| p[k] + by[k])
                    });
                    positions(moved.collect(), body.positions_t0().is_f64())
                };
                if ends == 1 { Own::Positions(end()) } else { Own::Step([end(), end()]) }
            };
            all.push((at, Step(vec![own])));
        }
        all
    }

    pub fn motion(&self) -> Motion<'_> {
        match &self.0[0] {
            Own::Positions(at) => Motion::positions(at),
            Own::Step([start, end]) => Motion::step(start, end),
            Own::Pose(pose) => Motion::Pose(*pose),
            Own::PoseStep(step) => Motion::PoseStep(*step),
        }
    }
}

fn rigid(body: &Body, ends: usize, random: &mut Random) -> Own {
    let mut pose = |near: Pose| {
        let [x, y, z] = random.point(0.6);
        let turn = PoseStep::turning(near, random.point(1.0), [x, y, z]);
        turn.end()
    };
    let start = pose(body.poses()[0]);
    if ends == 1 {
        return Own::Pose(start);
    }
    let end = pose(start);
    Own::PoseStep(match (random.next() * 4.0) as u32 {
        0 => PoseStep::new(start, end).straight(),
        1 => PoseStep::turning(start, random.point(4.0), random.point(0.5)).about([0.1, 0.2, 0.0]),
        2 => PoseStep::new(start, Pose { rotation: start.rotation, ..end }),
        _ => PoseStep::new(start, end).about([0.3, 0.0, -0.1]),
    })
}

/// Points of positions, for tests that change one.
pub fn changed(points: Points, vertex: usize, to: f64) -> Positions {
    let mut all: Vec<[f64; 3]> = match points {
        Points::F32(points) => points.iter().map(|p| p.map(f64::from)).collect(),
        Points::F64(points) => points.to_vec(),
    };
    all[vertex][1] = to;
    positions(all, matches!(points, Points::F64(_)))
}
