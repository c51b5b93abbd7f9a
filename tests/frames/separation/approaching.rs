//! Features that are near at the start and must come nearer: pairs against exact fractions at many
//! times, whole frames against the query without that choice, known answers.

mod known;

use super::thick::{FAMILIES, of};
use super::{asking, thick};
use nearmiss::Query;
use nearmiss::contacts::{Contact, Status};
use nearmiss::query::QueryKind;
use nearmiss::research::Solver;
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::approach::{Course, Motion};
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::{Params, Verdict};
use nearmiss_kernels::prim::isolate::{Edges, Face};
use nearmiss_lab::OneQuery;
use nearmiss_lab::case::Features;
use nearmiss_lab::oracle::near::{Places, Squared};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use std::collections::BTreeMap;
use support::asked::certified;
use support::{ask, cases, engine, judged, machines, ways};
use thick::Ends;

/// Times at which a pair is compared: dyadic, so exact.
const TIMES: u32 = 64;

/// The course of one pair.
fn course<R: Real>(features: Features, ends: Ends, p: &Params) -> Course {
    let vertices = ends.map(|ends| ends.map(|at| Vec3(at.map(R::of))));
    let [a, b, c, d] = vertices.map(|[t0, t1]| Moving { t0, t1 });
    let pair = match features {
        Features::VertexFace => Face::new(a, [b, c, d], p).of_four(),
        Features::EdgeEdge => Edges::new([a, b], [c, d], p),
    };
    Motion { vertices: &vertices, pair: &pair }.course([0.0; 4], p)
}

/// The exact squared distance at a time.
fn squared(features: Features, ends: Ends, t: f64) -> Squared {
    Places::at(features, ends, t, [0.0; 4]).least()
}

/// Whether the distance falls at once: it is less at some time soon after the start.
fn falls_at_once(features: Features, ends: Ends) -> bool {
    let start = squared(features, ends, 0.0);
    (8..90).step_by(9).any(|k| squared(features, ends, 0.5f64.powi(k)) < start)
}

/// The fault of what becomes of a pair, if it has one.
fn fault(features: Features, ends: Ends, p: &Params, found: &Course) -> Option<String> {
    let start = squared(features, ends, 0.0);
    let is_within = start.is_within(p.min_separation);
    let met = |t: f64| {
        let now = squared(features, ends, t);
        if is_within { now < start } else { now.is_within(p.min_separation) }
    };
    let before =
        |from: f64| (0..=TIMES).map(|k| f64::from(k) / f64::from(TIMES)).find(|&t| t < from && met(t));
    match found {
        Course::Never => before(2.0).map(|t| format!("missed at {t}")),
        Course::Known(verdict) if verdict.is_contact() && !met(verdict.toi_upper) => {
            Some(format!("no contact at {}", verdict.toi_upper))
        }
        Course::Known(verdict) => before(verdict.toi).map(|t| format!("late: met at {t}")),
        Course::Solver if is_within && !falls_at_once(features, ends) => Some("does not fall at once".into()),
        Course::Solver => None,
    }
}

/// A pair within the separation: at rest, sliding, parting, coming, turning, or of several such.
fn near_pair(r: &mut SmallRng, name: &str) -> Ends {
    let dyadic = |r: &mut SmallRng| f64::from(r.random_range(-16..=16)) / 16.0;
    let point = |r: &mut SmallRng| -> [f64; 3] { [dyadic(r), dyadic(r), 0.0] };
    let low = [point(r), point(r), point(r)];
    let up = |[x, y, _]: [f64; 3], z: f64| [x, y, z];
    let high = point(r);
    let mut start = [up(high, 0.25), low[0], low[1], low[2]];
    if r.random() {
        // Edges, or a face above a vertex.
        start = [up(low[0], 0.25), up(low[1], 0.25), high, low[2]];
    }
    let [dx, dy, dz] = [dyadic(r), dyadic(r), dyadic(r)];
    let moved = |by: [[f64; 3]; 4]| -> Ends {
        std::array::from_fn(|k| [start[k], std::array::from_fn(|i| start[k][i] + by[k][i])])
    };
    let (rest, slide, rise) = ([0.0; 3], [dx, dy, 0.0], [dx, dy, dz.abs()]);
    match name {
        "resting" => moved([rest; 4]),
        "sliding" => moved([slide, slide, rest, rest]),
        "deforming in planes" => moved([slide, [dy, dx, 0.0], [-dx, dy, 0.0], [dy, -dy, 0.0]]),
        "parting" => moved([rise, [dx, dy, dz.abs()], [0.0, dx, 0.0], rest]),
        "moving alike" => moved([[dx, dy, dz]; 4]),
        "coming" => moved([[dx, dy, -dz.abs()]; 4]),
        "rocking" => moved([[0.0, 0.0, dz], [0.0, 0.0, -dz], rest, [0.0, 0.0, dx / 4.0]]),
        _ => std::array::from_fn(|k| [start[k], [dyadic(r), dyadic(r), dyadic(r)]]),
    }
}

const NEAR: [&str; 8] =
    ["resting", "sliding", "deforming in planes", "parting", "moving alike", "coming", "rocking", "any"];

/// Counts of what becomes of pairs.
#[derive(Debug, Default)]
struct Counts {
    all: u32,
    never: u32,
    solver: u32,
    contacts: u32,
    undecided: u32,
}

impl Counts {
    fn add(&mut self, found: &Course) {
        self.all += 1;
        match found {
            Course::Never => self.never += 1,
            Course::Solver => self.solver += 1,
            Course::Known(verdict) if verdict.is_contact() => self.contacts += 1,
            Course::Known(_) => self.undecided += 1,
        }
    }
}

fn check(features: Features, ends: Ends, separation: f64, counts: &mut Counts) {
    let p = Params { min_separation: separation, ..Params::new(1e-6) };
    let single = ends.iter().flatten().flatten().all(|&x| f64::from(x as f32) == x);
    let found = course::<f64>(features, ends, &p);
    if single {
        assert_eq!(course::<f32>(features, ends, &p), found, "f32: {features:?} {ends:?}");
    }
    if let Some(fault) = fault(features, ends, &p, &found) {
        panic!("{fault}: {features:?}, {ends:?}, {separation:e}: {found:?}");
    }
    counts.add(&found);
}

#[test]
fn no_pair_that_comes_nearer_is_missed_or_late() {
    let mut r = SmallRng::seed_from_u64(13);
    for name in NEAR {
        let mut counts = Counts::default();
        for i in 0..cases(30, 150) {
            let features = [Features::VertexFace, Features::EdgeEdge][i % 2];
            let ends = near_pair(&mut r, name);
            // Also scaled, far from the origin, and turned, so that signs need integers.
            let ends = match i % 5 {
                0 | 1 => ends,
                2 => ends.map(|ends| ends.map(|at| at.map(|x| x * 1e-3 + 7.0))),
                3 => ends.map(|ends| ends.map(|[x, y, z]| [0.6 * x - 0.8 * z, y, 0.8 * x + 0.6 * z])),
                _ => ends.map(|ends| ends.map(|[x, y, z]| [x + y, y - z, z + x].map(|x| x / 3.0))),
            };
            let start = squared(features, ends, 0.0).to_f64().sqrt();
            let separation = [2.0 * start, start, 0.5 * start][i % 3];
            check(features, ends, separation, &mut counts);
        }
        println!("{name}: {counts:?}");
        let decided = counts.all - counts.undecided;
        assert!(decided * 10 > counts.all * 8, "{name}: {counts:?}");
    }
}

/// The families of thick pairs, at their own distance, twice and half of it.
#[test]
fn no_pair_of_other_families_is_missed_or_late() {
    for name in FAMILIES {
        let (mut counts, mut r) = (Counts::default(), SmallRng::seed_from_u64(name.len() as u64));
        for i in 0..cases(24, 60) {
            let features = [Features::VertexFace, Features::EdgeEdge][i % 2];
            let ends = thick::family(&mut r, name);
            let start = squared(features, ends, 0.0).to_f64().sqrt();
            check(features, ends, [2.0, 1.0, 0.5][i % 3] * start, &mut counts);
        }
        println!("{name}: {counts:?}");
    }
}

/// The judge names a pair that is missed, one that is late, one that is falsely a contact, and one
/// that does not come nearer.
#[test]
fn the_judge_names_planted_faults() {
    let face = [[-1.0, -1.0, 0.0], [2.0, -1.0, 0.0], [-1.0, 2.0, 0.0]].map(|at| [at; 2]);
    let pair = |last: f64| -> Ends { [[[0.0, 0.0, 0.25], [0.0, 0.0, last]], face[0], face[1], face[2]] };
    let p = Params { min_separation: 0.5, ..Params::new(1e-6) };
    let of =
        |last: f64, found: Course| fault(Features::VertexFace, pair(last), &p, &found).unwrap_or_default();
    assert!(of(0.125, Course::Never).contains("missed"));
    assert!(of(0.125, Course::Known(Verdict::undecided(0.5, 1.0, 0, false))).contains("late"));
    assert!(of(0.5, Course::Known(Verdict::contact(0.1, 0.2, 0, false))).contains("no contact at 0.2"));
    assert!(of(0.5, Course::Solver).contains("does not fall"));
    assert_eq!([of(0.125, Course::Solver), of(0.5, Course::Never)], [String::new(), String::new()]);
}

fn approaching(motion: QueryKind, solver: Solver, separation: f64) -> Query {
    certified(asking(motion, solver, separation), |certified| certified.approaching = true)
}

type Row = (nearmiss::contacts::Kind, [nearmiss::scene::BodyId; 2], u32, u32);

fn row(contact: &Contact) -> Row {
    (contact.kind, contact.bodies, contact.feature_a, contact.feature_b)
}

/// Whole frames: rows are those of the query without that choice, and differ for pairs within the
/// separation at the start alone. Each of these is as the law says.
#[test]
fn frames_are_those_of_all_contacts_but_for_pairs_that_begin_near() {
    let scenes = [
        vec![thick::soup(40, 7)],
        vec![thick::turned(&thick::soup(30, 8))],
        vec![thick::soup(20, 3), thick::soup(20, 4)],
    ];
    for bodies in scenes {
        for (solver, separation) in
            [(Solver::Certified, 0.25), (Solver::CertifiedF64, 0.125), (Solver::CertifiedF32, 0.25)]
        {
            let query = approaching(QueryKind::Continuous, solver, separation);
            let all = ask(engine(), bodies.clone(), asking(QueryKind::Continuous, solver, separation));
            let found = ask(engine(), bodies.clone(), query);
            let of_all: BTreeMap<Row, &Contact> = all.contacts().iter().map(|c| (row(c), c)).collect();
            let kept: BTreeMap<Row, &Contact> = found.contacts().iter().map(|c| (row(c), c)).collect();
            assert!(kept.keys().all(|row| of_all.contains_key(row)));
            let p = Params { min_separation: separation, ..Params::new(super::TOLERANCE) };
            // Exact fractions take a millisecond a time: a part of the rows is judged.
            let part = of_all.len().div_ceil(cases(30, 120));
            let mut left_out = 0;
            for (row, contact) in of_all.iter().step_by(part) {
                let (features, ends, _) = of(&bodies, contact);
                let is_near = squared(features, ends, 0.0).is_within(separation);
                let course = match kept.get(row) {
                    None => Course::Never,
                    Some(own) if !is_near => {
                        assert_eq!((own.toi, own.toi_upper), (contact.toi, contact.toi_upper));
                        continue;
                    }
                    Some(own) if own.toi == 0.0 && own.status == Status::Certified => Course::Solver,
                    Some(own) if own.status == Status::Certified => {
                        Course::Known(Verdict::contact(own.toi, own.toi_upper, 0, false))
                    }
                    Some(own) => Course::Known(Verdict::undecided(own.toi, own.toi_upper, 0, false)),
                };
                left_out += u32::from(course == Course::Never);
                assert_eq!(fault(features, ends, &p, &course), None, "{contact:?} {:?}", kept.get(row));
            }
            assert!(left_out > 0 && kept.len() > 10, "{left_out} of {}", of_all.len());
            let first = ask(engine(), bodies.clone(), approaching(QueryKind::Earliest, solver, separation));
            assert_eq!(first.earliest_toi(), found.contacts().iter().map(|c| c.toi).reduce(f64::min));
        }
    }
}

/// The answer is the same by every way and on every machine.
#[test]
fn every_way_and_machine_has_the_same_answer() {
    for bodies in [vec![thick::soup(40, 7)], vec![thick::turned(&thick::soup(30, 3)), thick::soup(30, 4)]] {
        let query = approaching(QueryKind::Continuous, Solver::Certified, 0.25);
        let found = ask(engine(), bodies.clone(), query);
        assert!(found.len() > 10);
        for way in ways(query) {
            assert_eq!(ask(engine(), bodies.clone(), way).rows, found.rows, "{way:?}");
        }
        for device in machines() {
            let name = device.name();
            let mut detector = OneQuery::new(device, judged(bodies.clone()), query).expect("a detector");
            let answer = detector.detect().expect("an answer").hash();
            let wanted = ask(engine(), judged(bodies.clone()), query).hash();
            assert_eq!(answer, wanted, "{name}");
        }
    }
}
