//! Edges of no face and points: against exact distances, and against the same scene whose edges and
//! points are faces that repeat a vertex.

use nearmiss::contacts::{Kind, Status, TrianglePair};
use nearmiss::mesh::{Mesh, Positions, Topology};
use nearmiss::research::{BoundingVolume, BroadPhase, Certified, CertifiedPrecision, QueryExt, WithSolver};
use nearmiss::scene::{BodyId, Exclusions, Pose, PoseStep};
use nearmiss::{Body, Continuous, Detector, Earliest, Near, Query, Scene};
use nearmiss_lab::oracle::near::{Shape, all_within};
use nearmiss_lab::scene::{Rng, threads};
use std::collections::{BTreeMap, BTreeSet};
use support::{ORDERS, ask, engine, sanitizer, walks_of};

/// A mesh with edges and points, in motion.
#[derive(Clone)]
struct Given {
    ends: [Vec<[f64; 3]>; 2],
    faces: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
    points: Vec<u32>,
}

impl Given {
    /// Faces, chains of edges, fans of edges around a vertex of a face, and points; some listed twice or
    /// part of others. All on a grid, so that many pairs touch.
    fn random(seed: u64, vertices: u32, single: bool) -> Given {
        let mut rng = Rng::new(seed);
        let mut below = |end: u32| (rng.bits() % u64::from(end)) as u32;
        let mut place = |wide: u32| {
            let x = [(); 3].map(|()| f64::from(below(wide)) / 8.0);
            if single { x.map(|x| f64::from(x as f32)) } else { x.map(|x| x + 1e-13) }
        };
        let t0: Vec<[f64; 3]> = (0..vertices).map(|_| place(17)).collect();
        let t1 = t0.iter().map(|&p| std::array::from_fn(|k| p[k] + place(9)[k] - 0.5)).collect();
        let third = vertices / 3;
        let faces = (0..third / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mut edges: Vec<[u32; 2]> = (third..2 * third - 1).map(|v| [v, v + 1]).collect();
        // Hair on a vertex of a face, a loop of three, an edge twice, and one of a face.
        edges.extend([[third, 0], [0, third + 4], [third + 2, third], [third + 1, third], [1, 2]]);
        let mut points: Vec<u32> = (2 * third..vertices).rev().collect();
        points.extend([0, third, vertices - 1]);
        Given { ends: [t0, t1], faces, edges, points }
    }

    fn mesh(&self, end: usize, single: bool) -> Mesh {
        let points = self.ends[end].clone();
        let positions = if single {
            Positions::F32(points.iter().map(|p| p.map(|x| x as f32)).collect())
        } else {
            Positions::F64(points)
        };
        Mesh::new("loose", positions, self.faces.clone()).expect("valid")
    }

    fn body(&self, single: bool) -> Body {
        let [t0, t1] = [0, 1].map(|end| {
            let mesh = self.mesh(end, single).with_edges(self.edges.clone()).expect("edges");
            mesh.with_points(self.points.clone()).expect("points")
        });
        Body::moving(t0, t1).expect("a body")
    }

    /// Edges of no face and points of nothing else, found one by one.
    fn elements(&self) -> (Vec<[u32; 2]>, Vec<u32>) {
        let has = |face: &[u32; 3], edge: &[u32; 2]| edge.iter().all(|v| face.contains(v));
        let mut own: Vec<[u32; 2]> = Vec::new();
        for &[a, b] in &self.edges {
            let edge = [a.max(b), a.min(b)];
            if !own.contains(&edge) && !self.faces.iter().any(|face| has(face, &edge)) {
                own.push(edge);
            }
        }
        let mut points: Vec<u32> = Vec::new();
        for &p in &self.points {
            let used =
                self.faces.iter().any(|face| face.contains(&p)) || own.iter().any(|edge| edge.contains(&p));
            if !used && !points.contains(&p) {
                points.push(p);
            }
        }
        (own, points)
    }

    /// The same with faces that repeat a vertex.
    fn as_faces(&self) -> Given {
        let (edges, points) = self.elements();
        let more = edges.iter().map(|&[a, b]| [a, b, b]).chain(points.iter().map(|&p| [p; 3]));
        let faces = self.faces.iter().copied().chain(more).collect();
        Given { faces, edges: Vec::new(), points: Vec::new(), ..self.clone() }
    }

    /// The row for a row of the scene of faces, and whether its edges are the other way round; `None` if
    /// it has none.
    fn row(&self, kind: &str, [a, b]: [u32; 2]) -> Option<((Kind, [u32; 2]), bool)> {
        let (edges, points) = self.elements();
        let faces = self.faces.len();
        let sorted = |[a, b]: [u32; 2]| [a.max(b), a.min(b)];
        let number = |edge: [u32; 2]| {
            let given = self.edges.iter().position(|&other| sorted(other) == edge);
            let sides = self.faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]].map(sorted));
            let others: BTreeSet<[u32; 2]> =
                sides.filter(|side| !self.edges.iter().any(|&other| sorted(other) == *side)).collect();
            let behind = || others.iter().position(|&other| other == edge).map(|at| at + self.edges.len());
            given.or_else(behind).expect("an edge") as u32
        };
        if kind == "ee" {
            let shape = Shape { points: Vec::new(), faces: self.as_faces().faces };
            let all = shape.edges();
            let [a, b] = [a, b].map(|edge| number(all[edge as usize]));
            return Some(((Kind::Ee, [a.min(b), a.max(b)]), a > b));
        }
        let row = match (b as usize).checked_sub(faces) {
            None => Some((Kind::Vf, [a, b])),
            Some(at) if at < edges.len() => Some((Kind::Ev, [number(edges[at]), a])),
            Some(at) => {
                let point = points[at - edges.len()];
                // Two points have one row.
                let is_second = points.contains(&a) && a > point;
                (!is_second).then_some((Kind::Vv, [a.min(point), a.max(point)]))
            }
        };
        row.map(|row| (row, false))
    }
}

/// A body with edges and points, in a step, with this thickness.
pub fn loose(seed: u64, thickness: f64) -> Body {
    Given::random(seed, 60, true).body(true).with_thickness(thickness)
}

/// A row's kind and features, and the bits of its numbers.
type Row = ((Kind, [u32; 2]), Vec<u64>);
type Rows = BTreeMap<(Kind, [u32; 2]), Vec<u64>>;

/// Rows with the bits of their numbers, in order.
fn rows_of(detector: &mut Detector, query: Query) -> Vec<Row> {
    let found = detector.query(&query).expect("an answer");
    let of_contacts = found.contacts().iter().map(|c| {
        ((c.kind, [c.feature_a, c.feature_b]), vec![c.toi.to_bits(), c.toi_upper.to_bits(), c.status as u64])
    });
    let of_near = found
        .near()
        .iter()
        .map(|p| ((p.kind, [p.feature_a, p.feature_b]), vec![p.squared_distance.to_bits()]));
    of_contacts.chain(of_near).collect()
}

fn detector(body: Body) -> Detector {
    Detector::new(engine(), body).expect("a detector")
}

fn queries() -> Vec<Query> {
    let apart = |min_separation| Certified { min_separation, tolerance: Some(1e-3), ..Certified::default() };
    vec![
        Near::within(0.4).into(),
        Continuous::by(apart(0.0)).into(),
        Continuous::by(apart(0.1)).into(),
        Continuous::by(Certified { approaching: true, ..apart(0.1) }).into(),
    ]
}

/// Rows are those of faces that repeat a vertex, under other names; those of two points once.
#[test]
fn elements_answer_as_faces_that_repeat_a_vertex() {
    let mut kinds = BTreeMap::new();
    for (seed, single) in [(1, true), (2, false), (3, true)] {
        let given = Given::random(seed, 60, single);
        let mut loose = detector(given.body(single));
        let mut faces = detector(given.as_faces().body(single));
        for query in queries() {
            let (mut wanted, mut found) = (Rows::new(), rows_of(&mut loose, query));
            assert!(found.is_sorted_by(|a, b| a.0 < b.0), "{query:?}");
            for ((kind, features), mut numbers) in rows_of(&mut faces, query) {
                let Some((row, is_turned)) = given.row(kind.name(), features) else { continue };
                if is_turned {
                    // Two edges in the other order are rounded in another way.
                    numbers.clear();
                    found.iter_mut().filter(|other| other.0 == row).for_each(|other| other.1.clear());
                }
                assert!(wanted.insert(row, numbers).is_none(), "{row:?} twice");
            }
            found.iter().for_each(|((kind, _), _)| *kinds.entry(*kind).or_insert(0) += 1);
            let found: Rows = found.into_iter().collect();
            let differs = |row: &&(Kind, [u32; 2])| found.get(*row) != wanted.get(*row);
            let first = found.keys().chain(wanted.keys()).find(differs);
            assert_eq!(first, None, "{query:?}, seed {seed}");
        }
        let earliest = Earliest::by(Certified { tolerance: Some(1e-3), ..Certified::default() });
        for query in [Query::discrete(), earliest.into()] {
            let [a, b] = [&mut loose, &mut faces].map(|detector| detector.query(&query).expect("an answer"));
            assert_eq!((a.rows, a.starts_crossing), (b.rows, b.starts_crossing), "{query:?}");
        }
    }
    assert!(kinds.len() == 4 && kinds.values().all(|&count| count > 10), "{kinds:?}");
}

/// Exact distances, pair by pair, named by the list of the test.
#[test]
fn near_rows_are_all_that_are_within() {
    for seed in 4..8 {
        let given = Given::random(seed, 50, true);
        let distance = 0.6;
        let shape = Shape { points: given.ends[0].clone(), faces: given.as_faces().faces };
        let within = all_within(&[shape], distance);
        let wanted: BTreeSet<_> =
            within.keys().filter_map(|&(kind, _, features)| Some(given.row(kind, features)?.0)).collect();
        let mut loose = detector(given.body(true));
        let found: BTreeSet<_> =
            rows_of(&mut loose, Near::within(distance).into()).into_iter().map(|(row, _)| row).collect();
        let fault = |wanted: &BTreeSet<_>| wanted.symmetric_difference(&found).next().copied();
        assert_eq!(fault(&wanted), None);
        let mut other = wanted.clone();
        let planted = other.iter().find(|(kind, _)| *kind == Kind::Vv).copied().expect("two points");
        other.remove(&planted);
        assert_eq!(fault(&other), Some(planted));
    }
}

/// Weights, points and gradients of every kind are those of the row's own vertices.
#[test]
fn geometry_has_the_vertices_of_a_row() {
    let given = Given::random(9, 60, false);
    let mut loose = detector(given.body(false));
    let near = loose.query(&Near::within(0.4)).expect("near");
    let edges = Topology::of(&given.body(false)).edges;
    let at = |v: u32| given.ends[0][v as usize];
    for (row, of) in near.iter().zip(loose.geometry(&near).expect("geometry")) {
        let (a, b) = (row.feature_a, row.feature_b);
        let vertices = match row.kind {
            Kind::Vf => {
                [a, given.faces[b as usize][0], given.faces[b as usize][1], given.faces[b as usize][2]]
            }
            Kind::Ee => {
                let ([w, x], [y, z]) = (edges[a as usize], edges[b as usize]);
                [w, x, y, z]
            }
            Kind::Ev => [edges[a as usize][0], edges[a as usize][1], b, b],
            Kind::Vv => [a, b, b, b],
        };
        assert_eq!(of.vertices, vertices, "{row:?}");
        let first = row.kind.vertices_of_a();
        let sums = [0..first, first..4].map(|range| of.weights[range].iter().sum::<f64>());
        assert!(sums.iter().all(|sum| (sum - 1.0).abs() < 1e-14) && of.weights.iter().all(|&w| w >= 0.0));
        let apart: [f64; 3] =
            std::array::from_fn(|k| (0..4).map(|i| of.signed_weights[i] * at(vertices[i])[k]).sum());
        let squared: f64 = apart.iter().map(|x| x * x).sum();
        assert!(
            (squared - row.squared_distance).abs() < 1e-12 && (of.distance - squared.sqrt()).abs() < 1e-7
        );
        assert!(row.weights().iter().zip(of.weights).all(|(p, q)| (p - q).abs() < 1e-12), "{row:?}");
    }
}

/// The answer is the same by any volume, broad phase, walk and schedule.
#[test]
fn the_way_does_not_change_an_answer() {
    let body = || threads(60, 5).expect("threads");
    for query in queries().into_iter().chain([Query::earliest(), Query::discrete()]) {
        let truth = ask(engine(), vec![body()], query);
        assert!(!truth.is_empty());
        let volumes = BoundingVolume::ALL.map(|volume| query.with_volume(volume));
        let phases = [BroadPhase::Tree, BroadPhase::Tiles].map(|phase| query.with_broad_phase(phase));
        let walks = walks_of(query.kind()).into_iter().flatten().map(|walk| query.with_traversal(walk));
        for way in volumes.into_iter().chain(phases).chain(walks) {
            assert_eq!(ask(engine(), vec![body()], way).hash(), truth.hash(), "{way:?}");
        }
        for order in ORDERS {
            assert_eq!(ask(sanitizer(order), vec![body()], query).hash(), truth.hash(), "{order:?}");
        }
    }
}

/// Each certified solver lists every pair that another one proves to meet.
#[test]
fn no_certified_solver_misses_what_another_proves() {
    for (count, seed) in [(500, 1), (1_000, 1), (300, 3)] {
        let mut detector = detector(threads(count, seed).expect("threads"));
        let lists = CertifiedPrecision::ALL.map(|precision| {
            let by = Continuous::by(Certified { precision, ..Certified::default() });
            rows_of(&mut detector, by.into()).into_iter().collect::<Rows>()
        });
        let proven = lists.iter().flatten().filter(|(_, numbers)| numbers[2] == Status::Certified as u64);
        let missed = proven.filter(|(row, _)| lists.iter().any(|list| !list.contains_key(*row)));
        assert_eq!(missed.map(|(row, _)| row).next(), None, "{count}, {seed}");
        assert!(lists[0].len() > 50);
    }
}

/// A list of all edges, in any order and direction, numbers them; nothing else changes.
#[test]
fn a_list_of_edges_numbers_them() {
    let given = Given::random(11, 60, true);
    let plain = Given { edges: Vec::new(), points: Vec::new(), ..given.clone() };
    let numbered = Topology::of(&plain.body(true)).edges;
    let mut listed: Vec<[u32; 2]> = numbered.iter().map(|&[a, b]| [b, a]).collect();
    let shift = listed.len() / 3;
    listed.rotate_left(shift);
    let listed = Given { edges: listed, ..plain.clone() };
    assert_eq!(listed.body(true).elements(), plain.body(true).elements());
    for query in queries() {
        let [a, b] = [&plain, &listed].map(|given| rows_of(&mut detector(given.body(true)), query));
        let count = numbered.len() as u32;
        let renumber = |((kind, [p, q]), _): Row| {
            let number = |edge: u32| (edge + count - shift as u32) % count;
            match kind {
                Kind::Ee => (kind, [number(p).min(number(q)), number(p).max(number(q))]),
                _ => (kind, [p, q]),
            }
        };
        let a: BTreeSet<_> = a.into_iter().map(renumber).collect();
        assert_eq!(a, b.into_iter().map(|(row, _)| row).collect(), "{query:?}");
    }
}

/// A thread between two bodies, rigid and turning, excluded and thick.
#[test]
fn bodies_of_all_kinds_have_threads() {
    let points = |z: f32| {
        Positions::F32(vec![[0.0, 0.0, z], [4.0, 0.0, z], [0.0, 4.0, z], [1.0, 1.0, z], [2.0, 1.0, z]])
    };
    let thread = |z: f32| {
        let mesh = Mesh::new("thread", points(z), Vec::new()).expect("points");
        mesh.with_edges(vec![[3, 4]]).and_then(|mesh| mesh.with_points(vec![0])).expect("a thread")
    };
    let sheet = |z: f32| Mesh::new("sheet", points(z), vec![[0, 1, 2]]).expect("a sheet");
    let near = |bodies: Vec<Body>, distance: f64| {
        let mut detector = Detector::new(engine(), Scene::from(bodies)).expect("a detector");
        let near = detector.query(&Near::within(distance)).expect("near");
        near.iter().map(|row| (row.kind, row.bodies.map(|body| body.index()))).collect::<Vec<_>>()
    };
    let vf = (Kind::Vf, [1, 0]);
    let (ee, vv) = ((Kind::Ee, [0, 1]), (Kind::Vv, [0, 1]));
    // Both ends and the point are over the sheet, the point over a corner; the thread is within 1.2 of
    // its three edges.
    assert_eq!(near(vec![Body::fixed(sheet(0.0)), Body::deformable(thread(0.5))], 0.6), [vf, vf, vf, vv]);
    let thick = Body::rigid(thread(0.5)).with_thickness(0.3);
    assert_eq!(near(vec![Body::fixed(sheet(0.0)), thick], 0.3), [vf, vf, vf, vv]);
    let wide = near(vec![Body::fixed(sheet(0.0)), Body::rigid(thread(0.5))], 1.2);
    assert_eq!(wide, [vf, vf, vf, ee, ee, ee, vv]);
    let both = near(vec![Body::rigid(thread(0.0)), Body::deformable(thread(0.5))], 0.6);
    let ev = [(Kind::Ev, [0, 1]), (Kind::Ev, [0, 1]), (Kind::Ev, [1, 0]), (Kind::Ev, [1, 0])];
    assert_eq!(both, [[(Kind::Ee, [0, 1])].as_slice(), &ev, &[(Kind::Vv, [0, 1])]].concat());

    // A face of one vertex, which has no edge, and one whose edge shares a vertex with the thread.
    let dot = Mesh::new("dot", Positions::F32(vec![[1.5, 1.1, 0.0]]), vec![[0, 0, 0]]).expect("valid");
    let dotted = near(vec![Body::deformable(thread(0.0)), Body::deformable(dot)], 0.2);
    assert_eq!(dotted, [(Kind::Ev, [0, 1])]);
    let bent = Positions::F32(vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 0.1, 0.0]]);
    let bent = Mesh::new("bent", bent, vec![[0, 1, 1]]).and_then(|mesh| mesh.with_edges(vec![[1, 2]]));
    assert!(near(vec![Body::deformable(bent.expect("valid"))], 0.2).contains(&(Kind::Ev, [0, 0])));
    // The ball around a thick vertex of a face holds a part of the line.
    let thick = [0.5, 0.0, 0.0];
    let face = Positions::F32(vec![[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [0.0, -9.0, 0.0]]);
    let face = Body::deformable(Mesh::new("face", face, vec![[0, 1, 2]]).expect("valid"));
    let line = Positions::F32(vec![[-9.0, 0.6, 0.0], [9.0, 0.2, 0.0]]);
    let line = Mesh::new("line", line, Vec::new()).and_then(|mesh| mesh.with_edges(vec![[0, 1]]));
    let bodies = vec![face.with_thickness(thick.to_vec()), Body::deformable(line.expect("valid"))];
    assert!(near(bodies, 0.0).contains(&(Kind::Ev, [1, 0])));

    // A thread turns onto the sheet: its far end goes through it.
    let mut scene = Scene::new();
    let ground = scene.add(Body::fixed(sheet(0.0)));
    let turns = scene.add(Body::rigid(thread(0.5)));
    let mut detector = Detector::new(engine(), scene).expect("a detector");
    let free = detector.query(&Earliest::default()).expect("an answer");
    assert!(free.is_free());
    let step = PoseStep::turning(Pose::default(), [0.0, 1.0, 0.0], [0.0; 3]).about([0.0, 0.0, 0.5]);
    detector.update(&[(turns, step.into())]).expect("a step");
    let meets = detector.query(&Continuous::default()).expect("an answer");
    let kinds: Vec<Kind> = meets.iter().map(|row| row.kind).collect();
    assert_eq!(kinds, [Kind::Vf, Kind::Vf]);
    detector.update(&[(turns, Pose::default().into())]).expect("back");
    // Faces of the list are elements: without the thread the point alone is near.
    let exclusions = Exclusions { faces: vec![0], ..Exclusions::default() };
    detector.exclude(turns, exclusions).expect("excluded");
    let left = detector.query(&Near::within(0.6)).expect("near");
    let rows: Vec<_> = left.iter().map(|row| (row.kind, row.bodies)).collect();
    assert_eq!(rows, [(Kind::Vf, [turns, ground]), (Kind::Vv, [ground, turns])]);
}

/// Pairs of a discrete query have the numbers of elements.
#[test]
fn a_discrete_query_has_elements() {
    let points = vec![
        [0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [0.0, 4.0, 0.0],
        [1.0, 1.0, -1.0],
        [1.0, 1.0, 1.0],
        [0.5, 0.5, 0.0],
    ];
    let mesh = Mesh::new("pierced", Positions::F64(points), vec![[0, 1, 2]]).expect("valid");
    let mesh = mesh.with_edges(vec![[3, 4]]).and_then(|mesh| mesh.with_points(vec![5])).expect("valid");
    let mut detector = detector(Body::deformable(mesh));
    let pairs = detector.query(&nearmiss::Discrete::default()).expect("pairs");
    let pair = |b| TrianglePair { bodies: [BodyId::default(); 2], triangles: [0, b] };
    assert_eq!(pairs.rows, vec![pair(1), pair(2)]);
    let geometry = detector.geometry(&pairs).expect("geometry");
    assert_eq!(geometry.len(), 2);
}
