//! The rows of a certified solver depend on the pair alone, also for near misses and for pairs that
//! a rung cannot decide: the same pairs with the same times by every volume, walk and refit, at
//! every tolerance and limit of iterations. They are the pairs that the solver reports one by one.

use nearmiss::contacts::{Kind, Status};
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::Continuous;
use nearmiss::research::{BoundingVolume, Certified, QueryExt, Solver, WithSolver};
use nearmiss::{Contacts, Query};
use nearmiss_io::MeshFile;
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::{Params, Verdict};
use nearmiss_lab::Features;
use nearmiss_lab::pairs::built::built;
use nearmiss_lab::scene::Rng;
use std::collections::BTreeMap;
use support::asked::certified;
use support::brute::{Row, Seen, fault, verdict};
use support::{ask, data, engine, moving, some_ways, ways};

type Corner = [f64; 3];
/// A triangle at both ends of the step.
type Moved = [[Corner; 3]; 2];

/// A body of triangles that share no vertex; `single`: in f32, which must hold them.
fn body(triangles: &[Moved], single: bool) -> Body {
    let faces: Vec<_> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let points = |t: usize| -> Vec<Corner> { triangles.iter().flat_map(|moved| moved[t]).collect() };
    if single {
        let narrow = |t| -> Vec<[f32; 3]> { points(t).iter().map(|p| p.map(|x| x as f32)).collect() };
        let exact = |t| points(t).as_flattened().iter().all(|x| f64::from(*x as f32) == *x);
        assert!(exact(0) && exact(1), "f32 does not hold them");
        return moving(&narrow(0), &narrow(1), &faces);
    }
    let mesh = |t| Mesh::new("listed", Positions::F64(points(t)), faces.clone()).expect("a mesh");
    Body::moving(mesh(0), mesh(1)).expect("two frames")
}

/// A number from 0 below `n`.
fn below(rng: &mut Rng, n: u64) -> f64 {
    (rng.bits() % n) as f64
}

/// Triangles of a lattice within the plane x + y + z = 0, or on a line in it, that move within it: all at their own pace,
/// or all together. Their boxes overlap where they do not; gaps are small multiples of 2^-10.
fn flat(n: usize, seed: u64, line: bool, together: bool) -> Vec<Moved> {
    let mut rng = Rng::new(seed);
    let at = |i: f64, j: f64| [i + j, j - i, -2.0 * j].map(|x| x / 1024.0);
    let mut common = [0.0; 2];
    (0..n)
        .map(|_| {
            let mut spot = |reach: u64| {
                let [i, j] = [0; 2].map(|_| below(&mut rng, 2 * reach) - reach as f64);
                if line { [i, 0.0] } else { [i, j] }
            };
            let place = spot(160);
            let corners = [0; 3].map(|_| spot(32));
            let speed = spot(48);
            if common == [0.0; 2] {
                common = speed;
            }
            let speed = if together { common } else { speed };
            [0.0, 1.0]
                .map(|t| corners.map(|c| at(place[0] + c[0] + t * speed[0], place[1] + c[1] + t * speed[1])))
        })
        .collect()
}

/// Contacts and near misses built in integers, each feature in a triangle of its own; all in one heap.
fn heap(seed: u64) -> Vec<Moved> {
    let mut rng = Rng::new(seed);
    let mut all = Vec::new();
    for built in built(seed, 1, 16) {
        let frames = [built.case.positions_t0, built.case.positions_t1];
        let mut own = || [0; 3].map(|_| below(&mut rng, 64) - 32.0);
        let (first, second) = (own(), own());
        let near = |p: Corner, by: Corner| [0, 1, 2].map(|k| p[k] + by[k]);
        match built.case.features {
            Features::VertexFace => {
                all.push(frames.map(|p| [p[0], near(p[0], first), near(p[0], second)]));
                all.push(frames.map(|p| [p[1], p[2], p[3]]));
            }
            Features::EdgeEdge => {
                all.push(frames.map(|p| [p[0], p[1], near(p[0], first)]));
                all.push(frames.map(|p| [p[2], p[3], near(p[2], second)]));
            }
        }
    }
    let scaled = |moved: Moved| moved.map(|frame| frame.map(|p| p.map(|x| x / 1024.0)));
    all.into_iter().map(scaled).collect()
}

/// A triangle and others that touch its plane and turn back, outside of it and on it, by about a
/// tolerance.
fn turning() -> Vec<Moved> {
    let mut all = vec![[0.0, 1.0].map(|t| [[0.0; 3], [4.0, 0.0, 4.0 * t], [0.0, 4.0, 0.0]])];
    for i in 0..24 {
        // About the side x + y = 4, reached at t = 1/4: steps of 2^-9 over it, then of 2^-4.
        let off = f64::from(i - 8) / if i < 16 { 512.0 } else { 16.0 };
        let (time, x, y) = (0.25, 0.125, 3.625 + off);
        let corner = |t: f64| [x + t, y, (x + 2.0 * time) * t - time * time];
        let beside = |t: f64, by: Corner| [0, 1, 2].map(|k| corner(t)[k] + by[k]);
        all.push(
            [0.0, 1.0].map(|t| [corner(t), beside(t, [0.25, 0.5, -0.25]), beside(t, [0.5, 0.25, -0.5])]),
        );
    }
    all
}

/// Every scene: its name, one body or two, in f32 and in f64.
fn scenes() -> Vec<(String, Vec<Body>)> {
    let of = |name: &str, all: Vec<Moved>| {
        let (half, name) = (all.len() / 2, name.to_owned());
        [
            (format!("{name}, f32"), vec![body(&all, true)]),
            (format!("{name}, f64, two bodies"), vec![body(&all[..half], false), body(&all[half..], false)]),
        ]
    };
    let mut all = Vec::new();
    all.extend(of("in a plane", flat(40, 1, false, false)));
    all.extend(of("in a plane, together", flat(40, 2, false, true)));
    all.extend(of("on a line", flat(24, 3, true, false)));
    all.extend(of("a heap", heap(4)));
    all.extend(of("turning back", turning()));
    all
}

fn asking(tolerance: f64, boxes: Option<u32>) -> Query {
    Continuous::by(Certified { tolerance: Some(tolerance), max_iterations: boxes, ..Certified::default() })
        .into()
}

/// All pairs whose swept boxes meet and that the solver does not say to be apart.
fn brute(bodies: &[Body], p: &Params) -> BTreeMap<Row, Verdict> {
    let seen: Vec<Seen> = bodies.iter().map(Seen::of).collect();
    let (one, other, own) = (&seen[0], &seen[seen.len() - 1], seen.len() == 1);
    let mut near = BTreeMap::new();
    let last = bodies.len() - 1;
    let mut put = |kind, of: [usize; 2], a: usize, b: usize, x: [Moving<f64>; 4]| {
        let split = if kind == Kind::Ee { 2 } else { 1 };
        if meets(&x[..split], &x[split..]) {
            let v = verdict(Solver::Certified, kind, x, p);
            if !v.is_separated() {
                near.insert((kind, of, [a as u32, b as u32]), v);
            }
        }
    };
    let against = |v: u32, of: &Seen, f: usize, faces: &Seen| {
        let ([m], [a, b, c]) = (of.at([v]), faces.at(faces.faces[f]));
        [m, a, b, c]
    };
    for &v in &one.used {
        for (f, face) in other.faces.iter().enumerate().filter(|(_, face)| !(own && face.contains(&v))) {
            debug_assert!(!face.is_empty());
            put(Kind::Vf, [0, last], v as usize, f, against(v, one, f, other));
        }
    }
    for &v in other.used.iter().filter(|_| !own) {
        (0..one.faces.len()).for_each(|f| put(Kind::Vf, [last, 0], v as usize, f, against(v, other, f, one)));
    }
    for (i, a) in one.edges.iter().enumerate() {
        for (j, b) in other.edges.iter().enumerate() {
            if !own || i < j && !a.iter().any(|v| b.contains(v)) {
                let ([a, b], [c, d]) = (one.at(*a), other.at(*b));
                put(Kind::Ee, [0, last], i, j, [a, b, c, d]);
            }
        }
    }
    near
}

/// Whether the boxes around two features in motion share a point.
fn meets(a: &[Moving<f64>], b: &[Moving<f64>]) -> bool {
    let ends = |of: &[Moving<f64>], k: usize| {
        let all = of.iter().flat_map(|m| [m.t0[k], m.t1[k]]);
        (all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max))
    };
    (0..3).all(|k| {
        let ((a0, a1), (b0, b1)) = (ends(a, k), ends(b, k));
        a0 <= b1 && b0 <= a1
    })
}

fn near_misses(answer: &Contacts) -> usize {
    answer.contacts().iter().filter(|c| c.status == Status::Undecided).count()
}

/// Queries in some ways; returns the first that differs.
fn differs(bodies: &[Body], query: Query, ways: impl Iterator<Item = Query>) -> Result<Contacts, String> {
    let truth = ask(engine(), bodies.to_vec(), query);
    for way in ways {
        let answer = ask(engine(), bodies.to_vec(), way);
        if answer.hash() != truth.hash() || answer.rows != truth.rows {
            let [ours, theirs] = [&truth, &answer].map(|a| a.contacts().to_vec());
            let odd = theirs.iter().find(|c| !ours.contains(c)).or(ours.iter().find(|c| !theirs.contains(c)));
            return Err(format!("{} listed, by {way:?} {}: {odd:?}", ours.len(), theirs.len()));
        }
    }
    Ok(truth)
}

#[test]
fn near_misses_are_listed_by_every_way_or_by_none() {
    let (mut counts, mut turn) = (Vec::new(), 0);
    for (name, bodies) in scenes() {
        for (tolerance, budget) in
            [(1e-1, None), (1e-2, Some(1)), (1e-3, None), (1e-6, Some(1)), (0.0, None), (0.0, Some(1))]
        {
            let query = asking(tolerance, budget);
            let what = format!("{name}, {tolerance:e}, {budget:?}");
            let answer =
                differs(&bodies, query, some_ways(query, turn)).unwrap_or_else(|odd| panic!("{what}: {odd}"));
            let p =
                Params { max_iterations: budget.unwrap_or(Params::MAX_ITERATIONS), ..Params::new(tolerance) };
            assert_eq!(fault(answer.contacts(), &brute(&bodies, &p), &[]), None, "{what}");
            println!("{what}: {} listed, {} of them undecided", answer.len(), near_misses(&answer));
            turn += 1;
            counts.push((name.clone(), near_misses(&answer)));
        }
    }
    let near: usize = counts.iter().map(|(_, n)| n).sum();
    assert!(near > 1_000, "{near} near misses in all are too few to tell anything");
}

/// Inputs on which volumes once listed other near misses; by every tolerance, the default too.
#[test]
#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]
fn what_once_differed_is_alike() {
    for folder in ["bv-hash-default-f32ply", "extmix-100027-min"] {
        let folder = data(&format!("finds/{folder}"));
        let mesh = |name: &str| MeshFile::read(&folder.join(name)).expect("a mesh").into_mesh();
        let other = Body::deformable(mesh("b0.ply"));
        let bodies = vec![Body::moving(mesh("a0.ply"), mesh("a1.ply")).expect("two frames"), other];
        for tolerance in [None, Some(1e-1), Some(1e-3), Some(1e-6), Some(1e-9), Some(0.0)] {
            for boxes in [None, Some(1)] {
                let query =
                    Continuous::by(Certified { tolerance, max_iterations: boxes, ..Certified::default() })
                        .into();
                let said = differs(&bodies, query, ways(query));
                assert_eq!(said.err(), None, "{}, {tolerance:?}, {boxes:?}", folder.display());
            }
        }
    }
}

/// With a separation, too.
#[test]
fn what_is_near_a_separation_is_listed_by_every_way_or_by_none() {
    for (name, bodies) in scenes().into_iter().step_by(3) {
        for (tolerance, separation) in [(1e-2, 0.02), (1e-3, 1e-3), (0.0, 1.0 / 1024.0)] {
            let query = certified(asking(tolerance, None), |all| all.min_separation = separation);
            let said = differs(&bodies, query, ways(query));
            assert_eq!(said.err(), None, "{name}, {tolerance:e}, {separation}");
        }
    }
}

/// A way that left one near miss out would be named, by the other ways and by the pairs themselves.
#[test]
fn the_comparison_can_fail() {
    let bodies = vec![body(&flat(40, 1, false, false), true)];
    let (query, p) = (asking(1e-2, None), Params::new(1e-2));
    let answer = ask(engine(), bodies.clone(), query);
    let near = brute(&bodies, &p);
    let at = answer.contacts().iter().position(|c| c.status == Status::Undecided).expect("a near miss");
    let mut less = answer.contacts().to_vec();
    less.remove(at);
    assert!(fault(&less, &near, &[]).is_some_and(|fault| fault.contains("is missed")));
    let finer = ask(engine(), bodies, asking(1e-3, None).with_volume(BoundingVolume::Obb));
    assert_ne!(finer.hash(), answer.hash());
}
