//! Elementary pairs in motion, against all of them tested one by one with the same cubic: a pair
//! that the volumes, the walk or the sift leave out must be one without a contact by the solver.

use nearmiss::Contacts;
use nearmiss::contacts::{Contact, Kind, Status};
use nearmiss::mesh::Body;
use nearmiss::query::QueryKind;
use nearmiss::research::Solver;
use nearmiss_kernels::math::Real;
use nearmiss_kernels::prim::cubic::{Moving, ee_toi, vf_toi};
use nearmiss_lab::scene::{self, Rng};
use support::asked::by;
use support::brute::{Seen, row};
use support::{ask, engine, machines, moving, still};

/// Whether the closed boxes of two sets of moving vertices overlap: two features whose boxes are
/// apart never meet, for any tolerance of the solver.
pub fn boxes_meet(p: &[Moving<f64>], q: &[Moving<f64>]) -> bool {
    let reach = |of: &[Moving<f64>], axis: usize| {
        let all = || of.iter().flat_map(|m| [m.t0[axis], m.t1[axis]]);
        (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max))
    };
    (0..3).all(|axis| {
        let ((lo, hi), (from, to)) = (reach(p, axis), reach(q, axis));
        lo <= to && from <= hi
    })
}

fn vf<S: Real>(of: &Seen, v: u32, against: &Seen, face: [u32; 3]) -> Option<f64> {
    let ([v], face) = (of.at([v]), against.at(face));
    let toi = boxes_meet(&[v], &face).then(|| vf_toi::<f64, S>(v, face))?;
    toi.map(Real::wide)
}

fn ee<S: Real>(of: &Seen, ea: [u32; 2], against: &Seen, eb: [u32; 2]) -> Option<f64> {
    let (ea, eb) = (of.at(ea), against.at(eb));
    let toi = boxes_meet(&ea, &eb).then(|| ee_toi::<f64, S>(ea, eb))?;
    toi.map(Real::wide)
}

/// All contacts of one body with itself, or of two with each other, in canonical order.
fn brute<S: Real>(bodies: &[Body]) -> Vec<Contact> {
    let seen: Vec<Seen> = bodies.iter().map(Seen::of).collect();
    let (one, other, own) = (&seen[0], &seen[seen.len() - 1], seen.len() == 1);
    let mut all = Vec::new();
    let last = bodies.len() - 1;
    let scene = nearmiss::Scene::from(bodies.to_vec());
    let mut found = |kind, of: [usize; 2], a: usize, b: usize, toi: Option<f64>| {
        all.extend(toi.map(|toi| Contact {
            kind,
            bodies: of.map(|body| scene.id(body).expect("a body")),
            feature_a: a as u32,
            feature_b: b as u32,
            toi,
            toi_upper: toi,
            status: Status::Unverified,
        }));
    };
    for &v in &one.used {
        for (f, face) in other.faces.iter().enumerate() {
            if !(own && face.contains(&v)) {
                found(Kind::Vf, [0, last], v as usize, f, vf::<S>(one, v, other, *face));
            }
        }
    }
    for &v in other.used.iter().filter(|_| !own) {
        for (f, face) in one.faces.iter().enumerate() {
            found(Kind::Vf, [last, 0], v as usize, f, vf::<S>(other, v, one, *face));
        }
    }
    for (a, ea) in one.edges.iter().enumerate() {
        for (b, eb) in other.edges.iter().enumerate().skip(if own { a + 1 } else { 0 }) {
            if !(own && ea.iter().any(|v| eb.contains(v))) {
                found(Kind::Ee, [0, last], a, b, ee::<S>(one, *ea, other, *eb));
            }
        }
    }
    all.sort_by_key(|c| (c.kind, c.bodies[0], c.feature_a, c.bodies[1], c.feature_b));
    all
}

/// The first thing in which two lists differ: times to the bit.
fn difference(found: &[Contact], truth: &[Contact]) -> Option<String> {
    let bits = |c: &Contact| (row(c), c.toi.to_bits(), c.toi_upper.to_bits());
    let differs = found.iter().map(bits).zip(truth.iter().map(bits)).position(|(a, b)| a != b);
    match differs {
        Some(at) => Some(format!("{:?} is found, {:?} is true", found[at], truth[at])),
        None if found.len() == truth.len() => None,
        None => Some(format!("{} are found, {} are true", found.len(), truth.len())),
    }
}

/// Queries every machine; returns the truth in f64.
fn everywhere(what: &str, bodies: &[Body]) -> Contacts {
    let truth = brute::<f64>(bodies);
    let mut first = None;
    for device in machines() {
        let name = device.name();
        let found = ask(device.clone(), bodies.to_vec(), by(QueryKind::Continuous, Solver::CubicF64));
        assert_eq!(difference(found.contacts(), &truth), None, "{what}, {name}");
        let earliest = ask(device, bodies.to_vec(), by(QueryKind::Earliest, Solver::CubicF64));
        let least = truth.iter().map(|c| c.toi).min_by(f64::total_cmp);
        assert_eq!(earliest.earliest_toi().map(f64::to_bits), least.map(f64::to_bits), "{what}, {name}");
        assert_eq!(found.earliest_toi(), least);
        first.get_or_insert(found);
    }
    first.expect("there are machines")
}

/// A sheet of `n` by `n` squares in a plane across axis `up`, whose vertices lie and move about at random: adjacent
/// triangles fold over each other.
pub fn crumpled(n: u32, seed: u64, up: usize, height: f64) -> Body {
    let mut rng = Rng::new(seed);
    let mut frames = [Vec::new(), Vec::new()];
    for i in 0..=n {
        for j in 0..=n {
            let mut p = [0.0; 3];
            (p[(up + 1) % 3], p[(up + 2) % 3], p[up]) = (f64::from(i), f64::from(j), height);
            for frame in &mut frames {
                let d = rng.point(0.8);
                frame.push([0, 1, 2].map(|k| (p[k] + d[k]) as f32));
            }
        }
    }
    let at = |i: u32, j: u32| i * (n + 1) + j;
    let squares = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let faces: Vec<_> = squares
        .flat_map(|(i, j)| {
            [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
        })
        .collect();
    moving(&frames[0], &frames[1], &faces)
}

/// Moving triangles on small whole coordinates, vertices shared at random, some without area, some that repeat a vertex.
pub fn crowded(seed: u64, vertices: u32, count: usize) -> Body {
    let mut rng = Rng::new(seed);
    let mut below = |n: u64| rng.bits() % n;
    let mut frame = || (0..vertices).map(|_| [(); 3].map(|()| below(6) as f32)).collect::<Vec<_>>();
    let (t0, t1) = (frame(), frame());
    let faces: Vec<_> = (0..count).map(|_| [(); 3].map(|()| below(u64::from(vertices)) as u32)).collect();
    moving(&t0, &t1, &faces)
}

/// How many vertices of the first body meet faces of the second, vertices of the second faces of the first, and edges edges.
fn kinds(contacts: &Contacts) -> [usize; 3] {
    let of = |kind, turned| {
        let is = |c: &&Contact| c.kind == kind && (c.bodies[0] > c.bodies[1]) == turned;
        contacts.contacts().iter().filter(is).count()
    };
    [of(Kind::Vf, false), of(Kind::Vf, true), of(Kind::Ee, false)]
}

#[test]
fn a_soup_in_motion() {
    let body = scene::soup(100, 21, true).expect("a scene");
    let [vf, fv, ee] = kinds(&everywhere("soup", &[body]));
    assert!(vf > 10 && fv == 0 && ee > 10, "{vf} {fv} {ee}");
}

#[test]
fn adjacent_triangles_find_what_they_own() {
    // Few triangles with much folding: contacts that only triangles with a common vertex can know of.
    for n in [1, 2, 5] {
        let body = crumpled(n, 40 + u64::from(n), 2, 0.0);
        let found = everywhere("crumpled", &[body]);
        assert!(n == 1 || !found.is_empty(), "{n}");
    }
}

#[test]
fn degenerate_triangles_in_motion() {
    for (seed, vertices, count) in [(1, 60, 30), (2, 20, 24), (3, 9, 20)] {
        let found = everywhere("crowded", &[crowded(seed, vertices, count)]);
        let [vf, _, ee] = kinds(&found);
        assert!(vf > 5 && ee > 20, "seed {seed}: {vf} {ee}");
    }
}

#[test]
fn two_bodies_in_motion() {
    let sets = [
        [crumpled(4, 1, 2, 0.5), crumpled(5, 2, 0, 2.0)],
        [scene::soup(60, 1, true).expect("a scene"), scene::soup(40, 2, true).expect("a scene")],
        [crowded(7, 20, 14), crowded(8, 30, 12)],
    ];
    for bodies in sets {
        let [vf, fv, ee] = kinds(&everywhere("two", &bodies));
        assert!(vf > 3 && fv > 3 && ee > 10, "{vf} {fv} {ee}");
    }
}

#[test]
fn a_body_that_stands_still_is_met() {
    let still = scene::soup(60, 31, false).expect("a scene");
    let moves = scene::soup(60, 32, true).expect("a scene");
    let one = everywhere("moving, still", &[moves.clone(), still.clone()]);
    let other = everywhere("still, moving", &[still.clone(), moves]);
    assert!(
        kinds(&one).iter().chain(&kinds(&other)).all(|n| *n > 3),
        "{:?} {:?}",
        kinds(&one),
        kinds(&other)
    );
    // If all bodies stand still, contacts are at t = 0; on whole coordinates there are some.
    let frozen = |seed| Body::deformable(crowded(seed, 30, 20).frames().remove(0));
    for bodies in [vec![frozen(1)], vec![frozen(1), frozen(2)]] {
        let found = everywhere("still", &bodies);
        assert!(!found.is_empty() && found.contacts().iter().all(|c| c.toi == 0.0));
    }
}

/// The body in doubles: the precision of the positions decides how differences are rounded before a solver in floats.
pub fn promoted(body: Body) -> Body {
    let frames = body.frames();
    let f64s = |mesh: &nearmiss::Mesh| {
        let positions = nearmiss::mesh::Positions::F64(mesh.positions().to_f64());
        nearmiss::Mesh::new(body.name(), positions, mesh.faces().to_vec()).expect("a mesh")
    };
    Body::moving(f64s(&frames[0]), f64s(&frames[1])).expect("two frames")
}

/// The cubic in f32 is not certain, but the pipeline is the same: it must find what the brute force finds with it.
#[test]
fn the_solver_in_floats_gets_the_same_pairs() {
    for body in [crumpled(4, 12, 1, 0.0), scene::soup(80, 5, true).expect("a scene"), crowded(4, 40, 24)] {
        let bodies = vec![promoted(body)];
        let found = ask(engine(), bodies.clone(), by(QueryKind::Continuous, Solver::CubicF32));
        assert_eq!(difference(found.contacts(), &brute::<f32>(&bodies)), None);
        assert!(!found.is_empty());
    }
}

#[test]
fn bodies_of_few_triangles_in_motion() {
    let t0 = [
        [0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [0.0, 4.0, 0.0],
        [1.0, 1.0, 1.0],
        [1.0, 1.0, 2.0],
        [2.0, 1.0, 2.0],
    ];
    let mut t1 = t0;
    t1[3..].iter_mut().for_each(|p| p[2] -= 2.0);
    let falling = moving(&t0, &t1, &[[0, 1, 2], [3, 4, 5]]);
    let found = everywhere("falling", &[falling]);
    // The lowest corner starts one above the face and falls by two: it meets it half way. The other two end on it.
    let times: Vec<_> = found
        .contacts()
        .iter()
        .filter(|c| c.kind == Kind::Vf)
        .map(|c| (c.feature_a, c.feature_b, c.toi))
        .collect();
    assert_eq!(times, [(3, 0, 0.5), (4, 0, 1.0), (5, 0, 1.0)]);
    assert!(everywhere("single", &[scene::single().expect("a scene")]).is_empty());
    let none = still(&[], &[]);
    assert!(everywhere("none", std::slice::from_ref(&none)).is_empty());
    assert!(everywhere("none and one", &[none, scene::single().expect("a scene")]).is_empty());
}

#[test]
fn the_comparison_can_fail() {
    let truth = brute::<f64>(&[scene::soup(40, 21, true).expect("a scene")]);
    assert_eq!(difference(&truth, &truth), None);
    let with = |fault: fn(&mut Vec<Contact>)| {
        let mut found = truth.clone();
        fault(&mut found);
        difference(&found, &truth)
    };
    let faults: [fn(&mut Vec<Contact>); 5] = [
        |all| all.truncate(all.len() - 1),
        |all| all.insert(1, all[1]),
        |all| all[1].toi = f64::from_bits(all[1].toi.to_bits() + 1),
        |all| all[0].feature_b += 1,
        |all| all[0].kind = Kind::Ee,
    ];
    assert!(faults.into_iter().all(|fault| with(fault).is_some()));
}
