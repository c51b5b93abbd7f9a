//! Continuous answers against public lists of all true contacts of two pairs of frames.

use nearmiss::Contacts;
use nearmiss::contacts::{Kind, Status};
use nearmiss::mesh::{Body, Topology};
use nearmiss::query::QueryKind;
use nearmiss::research::{BoundingVolume, QueryExt, Solver};
use support::asked::by;
use support::truth::frames::{BALLS, CLOTH, Row, Scene, difference, found, later};
use support::{ask, engine};

fn asked(body: &Body, motion: QueryKind, solver: Solver) -> Contacts {
    ask(engine(), vec![body.clone()], by(motion, solver))
}

/// Most errors of the f32 cubic; origin: measured with this test (it is deterministic), no room above.
struct Bounds {
    /// Listed contacts that it does not find, and contacts that are not listed.
    missed: usize,
    invented: usize,
    /// Contacts later than the f64 cubic says by over 1e-4 of the step.
    late: usize,
}

/// A certified solver misses nothing, and what it calls certain is listed; of what it leaves undecided at most four in a
/// million candidates are no contacts. No time is late, and what is certain has happened by the end of its interval.
fn certified(scene: &Scene, body: &Body, truth: &[Row], solver: Solver, cubic: &Contacts) -> Contacts {
    let answer = asked(body, QueryKind::Continuous, solver);
    let errors = difference(&found(&answer), truth);
    let sure: Vec<Row> = rows(&answer, |status| status == Status::Certified);
    let undecided = rows(&answer, |status| status == Status::Undecided).len();
    println!(
        "{}: {solver:?} misses {}, invents {}, {undecided} undecided, {:?} escalated",
        scene.name,
        errors.missed.len(),
        errors.invented.len(),
        answer.stats.escalated_vf_ee
    );
    assert_eq!(errors.missed, [], "{}", scene.name);
    assert_eq!(difference(&sure, truth).invented, [], "{}: what is certain is true", scene.name);
    assert_eq!((sure.len() + undecided, undecided as u64), (answer.len(), answer.undecided));
    // The share of the candidates, however many the volumes leave out.
    let candidates: u64 = scene.candidates.iter().sum();
    assert!(errors.invented.len() as u64 * 1_000_000 <= 4 * candidates, "{:?}", errors.invented);
    assert_eq!(later(&answer, cubic, ROUNDING).0, 0, "late");
    let mut others = cubic.contacts().iter();
    for c in answer.contacts().iter().filter(|c| c.status == Status::Certified) {
        let same = others
            .find(|o| (o.kind, o.feature_a, o.feature_b) == (c.kind, c.feature_a, c.feature_b))
            .expect("the cubic finds all");
        assert!(c.toi <= c.toi_upper && same.toi <= c.toi_upper + ROUNDING, "{c:?}, {}", same.toi);
    }
    answer
}

/// By how much the f64 cubic's times err on these frames: it agrees with the exact earliest to twelve digits. Step.
const ROUNDING: f64 = 1e-9;

/// The rows of an answer with that status.
fn rows(answer: &Contacts, status: impl Fn(Status) -> bool) -> Vec<Row> {
    answer
        .contacts()
        .iter()
        .filter(|c| status(c.status))
        .map(|c| (c.kind, c.feature_a, c.feature_b))
        .collect()
}

/// The earliest by a certified solver is the least of all, not late, and early by little.
fn certified_earliest(scene: &Scene, body: &Body, all: &Contacts) {
    let answer = asked(body, QueryKind::Earliest, Solver::Certified);
    assert_eq!((answer.earliest_toi(), answer.undecided), (all.earliest_toi(), all.undecided));
    let toi = answer.earliest_toi().expect("a contact");
    println!("{}: earliest {toi:e}, certified; exactly {:e}", scene.name, scene.earliest);
    assert!(toi <= scene.earliest && scene.earliest - toi < 1e-4, "{toi:e}");
}

/// With a budget of two boxes nothing is lost; and nothing changes, as these frames need no search by boxes.
fn starved(scene: &Scene, body: &Body, truth: &[Row], solver: Solver, whole: &Contacts) {
    let query = support::asked::certified(by(QueryKind::Continuous, solver), |certified| {
        certified.max_iterations = Some(2)
    });
    let answer = ask(engine(), vec![body.clone()], query);
    assert_eq!(difference(&found(&answer), truth).missed, [], "{}, {solver:?}", scene.name);
    assert_eq!(answer.hash(), whole.hash(), "{}, {solver:?}", scene.name);
}

/// The f64 cubic finds what is listed and no more, among the candidates that there are.
fn double(scene: &Scene, body: &Body, truth: &[Row]) -> Contacts {
    let answer = asked(body, QueryKind::Continuous, Solver::CubicF64);
    let boxes = ask(
        engine(),
        vec![body.clone()],
        by(QueryKind::Continuous, Solver::CubicF64).with_volume(BoundingVolume::Aabb),
    );
    // The same by any volumes, and fewer than overlaps of boxes swept over the whole step.
    assert_eq!(boxes.stats.candidates_vf_ee, scene.near, "candidates of {}", scene.name);
    assert_eq!(answer.stats.candidates_vf_ee, scene.near, "candidates of {}", scene.name);
    assert!(
        (0..2).all(|kind| answer.stats.candidates_vf_ee[kind] < scene.candidates[kind]),
        "{}",
        scene.name
    );
    assert_eq!(boxes.hash(), answer.hash(), "boxes that move lose no contact");
    let errors = difference(&found(&answer), truth);
    let (missed, invented) = (errors.missed.len(), errors.invented.len());
    println!("{}: {} contacts; cubic-f64 misses {missed}, invents {invented}", scene.name, truth.len());
    assert_eq!(errors.missed, [], "{}", scene.name);
    // Origin: measured; no promise of the solver.
    assert_eq!(errors.invented, [], "{}", scene.name);
    answer
}

/// The f32 cubic's errors stay within what was measured.
fn single(scene: &Scene, body: &Body, truth: &[Row], double: &Contacts, most: &Bounds) {
    let answer = asked(body, QueryKind::Continuous, Solver::CubicF32);
    assert_eq!(
        answer.stats.candidates_vf_ee, double.stats.candidates_vf_ee,
        "candidates do not depend on the solver"
    );
    let errors = difference(&found(&answer), truth);
    let (missed, invented) = (errors.missed.len(), errors.invented.len());
    let (late, latest) = later(&answer, double, 1e-4);
    println!(
        "{}: cubic-f32 misses {missed}, invents {invented}, late by over 1e-4 in {late}, at most by {latest:.1e}",
        scene.name
    );
    assert!(missed <= most.missed, "{:?}", errors.missed);
    assert!(invented <= most.invented, "{:?}", errors.invented);
    assert!(late <= most.late, "{late} late");
}

/// The earliest contact is the first of all of them.
fn earliest(scene: &Scene, body: &Body, all: &Contacts) {
    let earliest = asked(body, QueryKind::Earliest, Solver::CubicF64).earliest_toi();
    assert_eq!(earliest, all.earliest_toi(), "one answer, asked in two ways");
    let toi = earliest.expect("a contact");
    println!("{}: earliest {toi:e}, exactly {:e}", scene.name, scene.earliest);
    // The exact time is known to twelve digits, and the cubic agrees to all of them. It does not promise to be early.
    assert!((toi - scene.earliest).abs() <= 5e-12 * scene.earliest, "{toi:e}");
}

#[test]
#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]
fn cloth_on_a_ball() {
    let (body, truth) = (CLOTH.body(), CLOTH.truth());
    let all = double(&CLOTH, &body, &truth);
    single(&CLOTH, &body, &truth, &all, &Bounds { missed: 0, invented: 5, late: 0 });
    earliest(&CLOTH, &body, &all);
    certified(&CLOTH, &body, &truth, Solver::CertifiedF32, &all);
    // In f32 alone there are no boxes, and no budget of them.
    for solver in [Solver::CertifiedF64, Solver::Certified] {
        let answer = certified(&CLOTH, &body, &truth, solver, &all);
        starved(&CLOTH, &body, &truth, solver, &answer);
        if solver == Solver::Certified {
            certified_earliest(&CLOTH, &body, &answer);
        }
    }
}

#[test]
#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]
fn balls_in_a_box() {
    let (body, truth) = (BALLS.body(), BALLS.truth());
    let all = double(&BALLS, &body, &truth);
    certified(&BALLS, &body, &truth, Solver::Certified, &all);
}

#[test]
#[ignore = "half a minute"]
fn balls_in_a_box_in_every_way() {
    let (body, truth) = (BALLS.body(), BALLS.truth());
    let all = double(&BALLS, &body, &truth);
    single(&BALLS, &body, &truth, &all, &Bounds { missed: 0, invented: 12, late: 0 });
    earliest(&BALLS, &body, &all);
    let answer = certified(&BALLS, &body, &truth, Solver::Certified, &all);
    certified_earliest(&BALLS, &body, &answer);
}

/// The lists number edges by (larger vertex, smaller vertex), ascending; found here once more, from the faces alone.
#[test]
#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]
fn edges_are_numbered_as_in_the_lists() {
    for scene in [CLOTH, BALLS] {
        let (mesh, truth) = (scene.mesh(), scene.truth());
        let sides = |f: &[u32; 3]| [[f[0], f[1]], [f[1], f[2]], [f[2], f[0]]];
        let mut edges: Vec<[u32; 2]> =
            mesh.faces().iter().flat_map(sides).map(|[a, b]| [a.max(b), a.min(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        assert!(Topology::new(mesh.faces(), mesh.vertex_count()).edges == edges, "{}", scene.name);
        for &(kind, a, b) in &truth {
            let corners = |face: u32| mesh.faces()[face as usize];
            let common = match kind {
                Kind::Ee => edges[a as usize].iter().any(|v| edges[b as usize].contains(v)),
                _ => corners(b).contains(&a),
            };
            assert!(!common && (kind != Kind::Ee || a < b), "{kind:?} {a} {b}");
        }
    }
}

/// A row planted in the list is missed; a row taken from it is an invention; another numbering is both.
#[test]
fn the_comparison_can_fail() {
    let body = nearmiss_lab::scene::scene("draped", 2000, 1).expect("a scene");
    let rows = found(&asked(&body, QueryKind::Continuous, Solver::CubicF64));
    assert!(rows.len() > 10);
    let same = difference(&rows, &rows);
    assert!(same.missed.is_empty() && same.invented.is_empty());
    let mut planted = rows.clone();
    let row = (Kind::Ee, u32::MAX - 1, u32::MAX);
    planted.push(row);
    assert_eq!(difference(&rows, &planted).missed, [row]);
    let taken = planted.remove(3);
    assert_eq!(difference(&rows, &planted).invented, [taken]);
    let mut shifted: Vec<_> = rows.iter().map(|r| (r.0, r.1, r.2 + (r.0 == Kind::Ee) as u32)).collect();
    shifted.sort_unstable();
    let errors = difference(&rows, &shifted);
    assert!(!errors.missed.is_empty() && !errors.invented.is_empty());
}
