//! The earliest time is a function of the question: the least time of the continuous query of the
//! same scene and choices, undecided pairs included, and whether a contact begins then; by every
//! order of tiles, broad phase, volume, walk, number of threads and order of blocks, with a sample
//! and without one.

mod contacts;
mod law;

use nearmiss::contacts::{Caveat, Contact, Status};
use nearmiss::device::emulator::{Emulator, Mode};
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::QueryKind;
use nearmiss::research::{BoundingVolume, BroadPhase, QueryExt, Solver};
use nearmiss::{Contacts, Device, Query};
use nearmiss_kernels::abi::earliest;
use nearmiss_lab::scene::Rng;
use nearmiss_lab::{OneQuery, OneQueryOnSeveral};
use support::asked::{by, certified, with_tolerance};
use support::{ORDERS, ask, cases, engine, sanitizer};

type Corner = [f64; 3];
/// A triangle at both ends of the step.
type Moved = [[Corner; 3]; 2];

/// A number in [0, 1).
fn unit(rng: &mut Rng) -> f64 {
    (rng.bits() >> 11) as f64 / (1u64 << 53) as f64
}

/// A number in [-1, 1).
fn even(rng: &mut Rng) -> f64 {
    2.0 * unit(rng) - 1.0
}

fn point(rng: &mut Rng, [x, y, z]: Corner) -> Corner {
    [x * even(rng), y * even(rng), z * even(rng)]
}

/// Pairs of triangles, each pair far from the others, of one of these kinds.
fn triangles(kind: u64, pairs: usize, rng: &mut Rng) -> Vec<Moved> {
    let mut all = Vec::new();
    // Pairs of one scene are nearly alike, so that their windows begin within a rounding of each
    // other.
    let thin = [1.0, 10f64.powf(-7.0 * unit(rng)), 10f64.powf(-7.0 * unit(rng))];
    let model: Vec<Moved> = (0..2)
        .map(|_| {
            let mut triangle = |size: Corner| [0; 3].map(|_| point(rng, size));
            match kind {
                // Dust that grows to triangles.
                0 => {
                    let speck = 10f64.powf(-7.0 + 2.0 * unit(&mut Rng::new(kind)));
                    let grown = triangle([1.0; 3]);
                    let from = triangle([speck; 3]).map(|p| [p[0] + 2.0, p[1], p[2] - 2.0]);
                    [from, grown]
                }
                // Slivers.
                1 => [triangle(thin), triangle(thin)],
                // In one plane, or within a rounding of it.
                2 => [triangle([1.0, 1.0, 0.0]), triangle([1.0, 1.0, 0.0])],
                3 => [triangle([1.0, 1.0, 1e-9]), triangle([1.0, 1.0, 1e-9])],
                // Sliding past each other.
                4 => {
                    let at = triangle([1.0, 1.0, 1e-3]);
                    let by = point(rng, [2.0, 2.0, 1e-6]);
                    [at, at.map(|p| [p[0] + by[0], p[1] + by[1], p[2] + by[2]])]
                }
                // Anything.
                _ => [triangle([1.0; 3]), triangle([1.0; 3])],
            }
        })
        .collect();
    for i in 0..pairs {
        let off = 10.0 * i as f64;
        let jitter = [0.0, 1e-7, 1e-4][i % 3];
        for moved in &model {
            all.push(moved.map(|corners| {
                corners.map(|p| {
                    let d = point(rng, [jitter; 3]);
                    [p[0] + d[0] + off, p[1] + d[1], p[2] + d[2]]
                })
            }));
        }
    }
    all
}

/// A body of triangles that share no vertex, in f32 or in f64.
fn body(triangles: &[Moved], single: bool) -> Body {
    let faces: Vec<_> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mesh = |t: usize| {
        let points: Vec<Corner> = triangles.iter().flat_map(|moved| moved[t]).collect();
        let positions = if single {
            Positions::F32(points.iter().map(|p| p.map(|x| x as f32)).collect())
        } else {
            Positions::F64(points)
        };
        Mesh::new("earliest", positions, faces.clone()).expect("a mesh")
    };
    Body::moving(mesh(0), mesh(1)).expect("two frames")
}

/// An earliest time, and whether it is that of an undecided pair alone.
type First = Option<(f64, bool)>;

/// That of all contacts.
fn least(all: &Contacts) -> First {
    let keys = all.contacts().iter().map(|c| earliest::key(c.toi, c.status == Status::Undecided));
    keys.min().and_then(earliest::of_key)
}

/// That of an earliest query.
fn said(first: &Contacts) -> First {
    first.earliest_toi().map(|toi| (toi, first.caveats().contains(&Caveat::EarliestUndecided)))
}

/// The comparison: a fault in words, if the one answer is not the other.
fn fault(way: &str, wanted: First, said: First) -> Option<String> {
    (said != wanted).then(|| format!("{way}: {said:?} where the least of all is {wanted:?}"))
}

/// Ways of querying, each with its device.
fn ways(query: Query, all: bool) -> Vec<(String, Device, Query)> {
    let threads = |n| Device::emulator(Emulator::new(Mode::Engine, Some(n)).expect("threads"));
    let mut ways = Vec::new();
    for n in [1, 2, 4] {
        ways.push((format!("{n} threads"), threads(n), query.with_broad_phase(BroadPhase::Tiles)));
    }
    for volume in BoundingVolume::ALL {
        for broad in [BroadPhase::Tiles, BroadPhase::Tree] {
            let query = query.with_volume(volume).with_broad_phase(broad);
            ways.push((format!("{volume:?}, {broad:?}"), engine(), query));
        }
    }
    if all {
        for order in ORDERS {
            ways.push((format!("blocks {order:?}"), sanitizer(order), query));
            let device = Emulator::new(Mode::Sanitizer(order), None).expect("threads").with_lanes(32);
            ways.push((format!("warps {order:?}"), Device::emulator(device), query));
        }
        for seed in 1..4 {
            let device =
                Emulator::new(Mode::Sanitizer(ORDERS[2]), None).expect("threads").with_interleave(seed);
            ways.push((format!("interleaved by {seed}"), Device::emulator(device), query));
        }
    }
    ways
}

/// The answer to an earliest query, and the contacts at its time.
fn asked(device: Device, body: &Body, query: Query) -> (Contacts, Vec<Contact>) {
    let mut detector = OneQuery::new(device, body.clone(), query).expect("a detector");
    let first = detector.detect().expect("an answer");
    detector.check_volumes().expect("sound volumes");
    let contacts = detector.first_contacts(&first).expect("the contacts at its time");
    assert_eq!(contacts.undecided, contacts::undecided(&contacts));
    (first, contacts.to_vec())
}

/// Queries the earliest time of a body in every `part`-th way; returns the answer that all gave.
fn same(
    what: &str,
    body: &Body,
    (solver, tolerance, separation): (Solver, f64, f64),
    parts: (usize, usize),
) -> First {
    let choose = |kind| {
        let query = with_tolerance(by(kind, solver), tolerance);
        if separation > 0.0 { certified(query, |all| all.min_separation = separation) } else { query }
    };
    let all = ask(engine(), vec![body.clone()], choose(QueryKind::Continuous));
    let wanted = least(&all);
    let mut hashes = Vec::new();
    let (part, of) = parts;
    for (way, device, query) in ways(choose(QueryKind::Earliest), of == 1).into_iter().skip(part).step_by(of)
    {
        let (first, contacts) = asked(device, body, query);
        let odd = fault(&way, wanted, said(&first))
            .or_else(|| contacts::fault(&way, &all, (first.earliest_toi(), &contacts)));
        assert_eq!(odd, None, "{what}, {solver:?}, tolerance {tolerance:e}, separation {separation:e}");
        assert_eq!(first.undecided, u64::from(wanted.is_some_and(|(_, undecided)| undecided)), "{what}");
        hashes.push(first.hash());
    }
    assert!(hashes.windows(2).all(|two| two[0] == two[1]), "{what}: {hashes:x?}");
    wanted
}

const SOLVERS: [Solver; 5] =
    [Solver::Certified, Solver::CertifiedF32, Solver::CertifiedF64, Solver::CubicF32, Solver::CubicF64];
const TOLERANCES: [f64; 6] = [0.0, 1e-9, 1e-6, 1e-3, 1e-2, 0.1];

/// Nine nearly equal pairs of specks that grow to triangles: at a tolerance of 0.01 the order of
/// the tiles once chose among three times.
#[test]
fn specks_that_grow_have_one_earliest_time() {
    let near =
        |x: f64| [[x, 6.2e-7, -1.9999999], [x - 4e-7, 5.1e-7, -1.9999999], [x - 2e-7, 6.7e-7, -1.9999996]];
    let far = |x: f64| [[x, 8.1e-7, -1.9999994], [x, 4.3e-7, -1.9999993], [x - 2e-7, 7.8e-7, -1.9999995]];
    let mut rng = Rng::new(7);
    for scene in 0..40 {
        let mut all: Vec<Moved> = Vec::new();
        for i in 0..9 {
            let x = 10.0 * f64::from(i);
            let ends = [[x - 1.10105669, -1.0, -1.0], [x - 1.0, 1.0, 1.0], [x + 1.0, 0.0, 1.0]];
            let other = [[x - 1.0, 1.0, 0.97971], [x - 1.0, 0.91764, -1.0], [x - 1.0, -1.0, -1.0]];
            let mut shaken = |corners: [Corner; 3]| {
                corners.map(|p| {
                    let d = point(&mut rng, [2e-7; 3]);
                    [p[0] + d[0], p[1] + d[1], p[2] + d[2]]
                })
            };
            all.push([shaken(near(x + 2.0)), shaken(ends)]);
            all.push([shaken(far(x + 2.0)), shaken(other)]);
        }
        let first =
            same(&format!("specks {scene}"), &body(&all, true), (Solver::Certified, 1e-2, 0.0), (0, 2));
        assert!(first.is_some(), "specks {scene} meet, or nearly");
    }
}

/// Small hostile scenes, each in a part of the ways.
#[test]
fn hostile_scenes_have_one_earliest_time() {
    let mut rng = Rng::new(20_261_125);
    let mut found = [0; 3];
    let scenes = cases(360, 3_000);
    for scene in 0..scenes as u64 {
        let kind = scene % 6;
        let all = triangles(kind, 1 + (scene % 5) as usize, &mut rng);
        let solver = SOLVERS[(scene / 6 % 5) as usize];
        let tolerance = TOLERANCES[(rng.bits() % 6) as usize];
        let apart = solver.name().starts_with("certified") && scene % 7 == 0;
        let separation = if apart { 10f64.powf(-3.0 * unit(&mut rng)) * 0.1 } else { 0.0 };
        let body = body(&all, scene % 2 == 0);
        let parts = (scene as usize % 9, 9);
        let first =
            same(&format!("scene {scene} of kind {kind}"), &body, (solver, tolerance, separation), parts);
        found[first.map_or(0, |(_, undecided)| 1 + usize::from(undecided))] += 1;
    }
    println!("nothing, a contact, an undecided pair: {found:?}");
    assert!(found.iter().all(|n| *n > scenes / 30), "{found:?}: of each some");
}

/// The same in all ways, with blocks in any order and side by side.
#[test]
fn any_order_of_blocks_gives_one_earliest_time() {
    let mut rng = Rng::new(3);
    for scene in 0..12u64 {
        let all = triangles(scene % 6, 24, &mut rng);
        let solver = SOLVERS[(scene % 3) as usize];
        let tolerance = TOLERANCES[(rng.bits() % 6) as usize];
        same(&format!("scene {scene}"), &body(&all, scene % 2 == 1), (solver, tolerance, 0.0), (0, 1));
    }
}

/// Pairs of triangles of which one comes down on the other between 0.3 and 0.7 of the step, on a
/// lattice.
fn landing(pairs: usize, rng: &mut Rng) -> Vec<Moved> {
    let mut all = Vec::new();
    for i in 0..pairs {
        let at = [i % 32, i / 32 % 32, i / 1024].map(|k| 10.0 * k as f64);
        let flat = [1.0, 1.0, if i % 2 == 0 { 1e-4 } else { 0.5 }];
        let [lower, upper] = [0; 2].map(|_| [0; 3].map(|_| point(rng, flat)));
        let (height, turn) = (3.0 + 2.0 * unit(rng), point(rng, [0.3; 3]));
        let moved = |corners: [Corner; 3], z: f64, by: Corner| {
            corners.map(|p| [at[0] + p[0] + by[0], at[1] + p[1] + by[1], at[2] + p[2] + z + by[2]])
        };
        all.push([moved(lower, 0.0, [0.0; 3]), moved(lower, 0.0, turn)]);
        let mut later = upper;
        later.rotate_left(i % 3);
        all.push([moved(upper, height, [0.0; 3]), moved(later, height - 8.0, turn)]);
    }
    all
}

/// So many tiles that a sample bounds the time.
#[test]
fn a_sample_changes_nothing() {
    let mut rng = Rng::new(11);
    for (solver, tolerance, single) in [
        (Solver::Certified, 0.1, true),
        (Solver::CertifiedF32, 1e-2, true),
        (Solver::CertifiedF64, 0.1, false),
    ] {
        let body = body(&landing(32_800, &mut rng), single);
        let query = with_tolerance(by(QueryKind::Earliest, solver), tolerance);
        let first = ask(engine(), vec![body.clone()], query);
        let all =
            ask(engine(), vec![body.clone()], with_tolerance(by(QueryKind::Continuous, solver), tolerance));
        assert!(
            first.stats.candidates * 4 < all.stats.candidates,
            "no bound: {} of {}",
            first.stats.candidates,
            all.stats.candidates
        );
        let first = same("landing", &body, (solver, tolerance, 0.0), (1, 5));
        assert!(first.is_some_and(|(toi, _)| toi > 0.1), "{first:?}");
    }
}

/// A time that is not the least, and one that is said to be certain, are named; so is no time.
#[test]
fn the_comparison_can_fail() {
    let mut rng = Rng::new(9);
    let body = body(&triangles(2, 9, &mut rng), true);
    let query = with_tolerance(by(QueryKind::Continuous, Solver::Certified), 1e-2);
    let all = ask(engine(), vec![body], query);
    let mut times: Vec<f64> = all.contacts().iter().map(|c| c.toi).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let wanted = least(&all).expect("some meet");
    assert_eq!(wanted.0, times[0]);
    for wrong in [None, Some((times[1], wanted.1)), Some((wanted.0, !wanted.1))] {
        assert!(fault("planted", Some(wanted), wrong).is_some_and(|fault| fault.contains("planted")));
    }
}

/// The least of all devices' shares, and whether it is undecided, is that of the whole.
#[test]
fn slices_have_the_same_earliest_time() {
    let mut rng = Rng::new(13);
    let body = body(&triangles(3, 200, &mut rng), true);
    let query = with_tolerance(by(QueryKind::Earliest, Solver::Certified), 1e-2);
    let wanted = said(&ask(engine(), vec![body.clone()], query));
    for devices in 2..4 {
        let all = vec![engine(); devices];
        let mut detector = OneQueryOnSeveral::new(all, body.clone(), query).expect("devices");
        let first = detector.detect().expect("an answer");
        assert_eq!(said(&first), wanted, "{devices} devices");
        assert_eq!(first.undecided, u64::from(wanted.is_some_and(|(_, undecided)| undecided)));
    }
}
