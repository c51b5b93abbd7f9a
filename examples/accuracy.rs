//! Prints as Markdown how each solver does where the answer is known exactly: the tables of `docs/accuracy.md`.
//!
//! `NEARMISS_DATA=/path/to/data cargo run --release --example accuracy`; without the data, what needs none.

#[path = "../tests/support/mod.rs"]
mod support;
#[path = "../tests/truth/mod.rs"]
mod truth;

use nearmiss::mesh::Body;
use nearmiss::query::{Motion, Solver};
use nearmiss::{Contacts, Query};
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::{inclusion::Params, moller::moller, tri_tri::meets_exactly};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::{ask, engine, mesh, rows};
use truth::built::{FAMILIES, REACH_F32, REACH_F64, count};
use truth::frames::{BALLS, CLOTH, Scene, difference, found, later};
use truth::queries::folders;

fn main() {
    println!("## Discrete\n");
    discrete();
    println!("\n## Continuous: two public pairs of frames\n");
    println!(
        "| frames | solver | contacts | missed | false | unresolved | escalated | late | latest | early |"
    );
    println!("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    [CLOTH, BALLS].iter().for_each(frames);
    println!("\n## Continuous: handcrafted queries\n");
    handcrafted();
    println!("\n## Continuous: contacts built in integers\n");
    built();
}

fn asked(bodies: &[Body], motion: Motion, solver: Solver) -> Contacts {
    ask(engine(), bodies.to_vec(), Query { motion, solver: Some(solver), ..Query::default() })
}

/// Meshes with the list of all their pairs.
const SETS: [(&[&str], &str); 8] = [
    (&["bunny"], "bunny"),
    (&["bunny", "bunny_b"], "bunny_with_bunny_b"),
    (&["height-field"], "height-field"),
    (&["cloth_ball92"], "cloth_ball92"),
    (&["noisy"], "noisy"),
    (&["degenerate"], "degenerate"),
    (&["coplanar_same"], "coplanar_same"),
    (&["coplanar_z0_shift"], "coplanar_z0_shift"),
];

fn discrete() {
    println!("| triangles | candidates | pairs | exact: missed | false | moller: missed | false |");
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for (names, list) in SETS {
        let file = |name: &str| {
            let folder = if name.starts_with("cloth") { "cloth-ball" } else { "exact" };
            format!("{folder}/{name}.ply")
        };
        let bodies: Option<Vec<Body>> = names.iter().map(|name| mesh(&file(name)).map(Body::still)).collect();
        let (Some(bodies), Some(rows)) = (bodies, rows(&format!("exact/{list}.pairs.csv.gz"))) else {
            continue;
        };
        let index = |text: &String| text.trim().parse::<u32>().expect("an index");
        let mut truth: Vec<[u32; 2]> = rows.iter().map(|row| [index(&row[0]), index(&row[1])]).collect();
        truth.sort_unstable();
        let answers = [Solver::Exact, Solver::Moller].map(|s| asked(&bodies, Motion::Discrete, s));
        let [exact, float] = answers.each_ref().map(|a| difference(a.pairs(), &truth));
        println!(
            "| {list} | {} | {} | {} | {} | {} | {} |",
            answers[0].candidates,
            truth.len(),
            exact.missed.len(),
            exact.invented.len(),
            float.missed.len(),
            float.invented.len()
        );
    }
    let mut r = SmallRng::seed_from_u64(5);
    for n in [3, 4, 8] {
        let mut corner = || Vec3(std::array::from_fn(|_| r.random_range(0..n) as f32));
        let asked = 100_000;
        let (mut meet, mut missed, mut invented) = (0, 0, 0);
        for _ in 0..asked {
            let [p, q] = std::array::from_fn(|_| std::array::from_fn(|_| corner()));
            let (truth, float) = (meets_exactly(&p, &q), moller(&p, &q));
            meet += truth as u32;
            missed += (truth && !float) as u32;
            invented += (float && !truth) as u32;
        }
        println!(
            "| soup on a grid of {n}³, f32 | {asked} | {meet} | judge | judge | {missed} | {invented} |"
        );
    }
}

fn frames(scene: &Scene) {
    let (Some(body), Some(truth)) = (scene.body(), scene.truth()) else { return };
    let bodies = [body];
    let double = asked(&bodies, Motion::Continuous, Solver::CubicF64);
    let solvers = [Solver::Certified, Solver::CertifiedF32, Solver::CertifiedF64, Solver::CubicF32];
    for solver in solvers.into_iter().chain([Solver::CubicF64]) {
        let answer = asked(&bodies, Motion::Continuous, solver);
        let errors = difference(&found(&answer), &truth);
        let ((late, most), (_, early)) = (later(&answer, &double, 1e-6), later(&double, &answer, 0.0));
        println!(
            "| {} | {solver:?} | {} | {} | {} | {} | {} | {late} | {most:.1e} | {early:.1e} |",
            scene.name,
            truth.len(),
            errors.missed.len(),
            errors.invented.len(),
            answer.unresolved,
            answer.escalated_vf_ee.iter().sum::<u64>()
        );
    }
    for solver in [Solver::Certified, Solver::CertifiedF64, Solver::CubicF64] {
        let toi = asked(&bodies, Motion::Earliest, solver).earliest_toi();
        println!("\nearliest by {solver:?}: {toi:?}, exactly {:e}", scene.earliest);
    }
}

fn handcrafted() {
    println!(
        "| folder | kind | queries | true | certified: missed | false | f64: missed | false | f32: missed | false |"
    );
    println!("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for folder in folders() {
        let mut errors = [0; 6];
        for m in &folder.motions {
            let certified = m.certified(folder.face, &Params::new(1e-6));
            let answers = [certified, m.found::<f64, f64>(folder.face), m.found::<f64, f32>(folder.face)];
            for (k, answer) in answers.into_iter().enumerate() {
                errors[2 * k] += (m.meets && !answer) as u32;
                errors[2 * k + 1] += (!m.meets && answer) as u32;
            }
        }
        println!(
            "| {} | {} | {} | {} | {} |",
            folder.name,
            if folder.face { "vertex/face" } else { "edge/edge" },
            folder.motions.len(),
            folder.motions.iter().filter(|m| m.meets).count(),
            errors.map(|n| n.to_string()).join(" | ")
        );
    }
}

fn built() {
    let n = 4000;
    println!("Missed, late, of {n} contacts each, by the size of the integers.\n");
    println!("| family | kind | f64, small | f64, to 2^24 | f64, to 2^52 | f32, small | f32, to 2^24 |");
    println!("| --- | --- | ---: | ---: | ---: | ---: | ---: |");
    let reaches = [8, REACH_F32, REACH_F64].map(|reach| count(41, n, reach));
    for (i, row) in reaches[0].iter().enumerate() {
        let of = |reach: usize, k: usize| {
            let c = &reaches[reach][i];
            format!("{}, {}", c.missed[k], c.late[k])
        };
        println!(
            "| {} | {} | {} | {} | {} | {} | {} |",
            FAMILIES[row.family],
            if row.face { "vertex/face" } else { "edge/edge" },
            of(0, 0),
            of(1, 0),
            of(2, 0),
            of(0, 1),
            of(1, 1)
        );
    }
}
