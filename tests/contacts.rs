//! Continuous answers against public lists of all true contacts of two pairs of frames.

mod support;
mod truth;

use nearmiss::Contacts;
use nearmiss::Query;
use nearmiss::contacts::Kind;
use nearmiss::mesh::{Body, Topology};
use nearmiss::query::{Bv, Motion, Solver};
use support::{ask, engine};
use truth::frames::{BALLS, CLOTH, Row, Scene, difference, found, later};

fn asked(body: &Body, motion: Motion, solver: Solver) -> Contacts {
    let query = Query { motion, solver: Some(solver), ..Query::default() };
    ask(engine(), vec![body.clone()], query)
}

/// Most errors of the f32 cubic; origin: measured with this test (it is deterministic), no room above.
struct Bounds {
    /// Listed contacts that it does not find, and contacts that are not listed.
    missed: usize,
    invented: usize,
    /// Contacts later than the f64 cubic says by over 1e-4 of the step.
    late: usize,
}

/// The f64 cubic finds what is listed and no more, among the candidates that there are.
fn double(scene: &Scene, body: &Body, truth: &[Row]) -> Contacts {
    let answer = asked(body, Motion::Continuous, Solver::CubicF64);
    let boxes =
        ask(engine(), vec![body.clone()], Query { bv: Some(Bv::Aabb), ..Query::of(Motion::Continuous) });
    assert_eq!(boxes.candidates_vf_ee, scene.candidates, "candidates of {}", scene.name);
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
    let answer = asked(body, Motion::Continuous, Solver::CubicF32);
    assert_eq!(answer.candidates_vf_ee, double.candidates_vf_ee, "candidates do not depend on the solver");
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
    let earliest = asked(body, Motion::Earliest, Solver::CubicF64).earliest_toi();
    assert_eq!(earliest, all.earliest_toi(), "one answer, asked in two ways");
    let toi = earliest.expect("a contact");
    println!("{}: earliest {toi:e}, exactly {:e}", scene.name, scene.earliest);
    // The exact time is known to twelve digits, and the cubic agrees to all of them. It does not promise to be early.
    assert!((toi - scene.earliest).abs() <= 5e-12 * scene.earliest, "{toi:e}");
}

#[test]
fn cloth_on_a_ball() {
    let (Some(body), Some(truth)) = (CLOTH.body(), CLOTH.truth()) else { return };
    let all = double(&CLOTH, &body, &truth);
    single(&CLOTH, &body, &truth, &all, &Bounds { missed: 0, invented: 5, late: 0 });
    earliest(&CLOTH, &body, &all);
}

#[test]
fn balls_in_a_box() {
    let (Some(body), Some(truth)) = (BALLS.body(), BALLS.truth()) else { return };
    double(&BALLS, &body, &truth);
}

#[test]
#[ignore = "half a minute"]
fn balls_in_a_box_in_every_way() {
    let (Some(body), Some(truth)) = (BALLS.body(), BALLS.truth()) else { return };
    let all = double(&BALLS, &body, &truth);
    single(&BALLS, &body, &truth, &all, &Bounds { missed: 0, invented: 12, late: 0 });
    earliest(&BALLS, &body, &all);
}

/// The lists number edges by (larger vertex, smaller vertex), ascending; found here once more, from the faces alone.
#[test]
fn edges_are_numbered_as_in_the_lists() {
    for scene in [CLOTH, BALLS] {
        let (Some(mesh), Some(truth)) = (scene.mesh(), scene.truth()) else { return };
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
    let body = nearmiss::scene::scene("draped", 2000, 1).expect("a scene");
    let rows = found(&asked(&body, Motion::Continuous, Solver::CubicF64));
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
