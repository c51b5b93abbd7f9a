//! `selftest`: known answers, every stage on every machine to the bit, on scenes that the program makes itself; and the
//! catalogue of extremes.

mod appends;

use super::args::SelftestArgs;
use super::detect::body;
use super::progress::during;
use nearmiss::device::Device;
use nearmiss::device::emulator::{Emulator, Mode, Order};
use nearmiss::error::Error;
use nearmiss::mesh::Body;
use nearmiss::pipeline::{Session, of_edges};
use nearmiss::query::{Bv, FrontShape, Motion, Query, QueueShape, Refit, Solver, StealShape, Traversal};
use nearmiss_lab::extremes::{self, Amount};
use nearmiss_lab::scene;
use std::fmt::Write;
use std::process::ExitCode;

/// Triangles of the scenes that the microscope, which is some hundred times slower, looks at.
const SMALL: usize = 300;
/// Equal triangles: all pairs of their features touch from the start, which only exact signs can tell.
const EQUAL: usize = 40;

/// One answer, and what every stage left behind.
struct Print {
    contacts: usize,
    stages: Vec<(&'static str, u64)>,
}

impl Print {
    /// The answer alone.
    fn answer(&self) -> Print {
        Print { contacts: self.contacts, stages: self.stages.last().copied().into_iter().collect() }
    }
}

fn print_of(device: &Device, bodies: &[Body], query: Query) -> Result<Print, Error> {
    let mut session = Session::new(device.clone(), bodies.to_vec(), query)?;
    let contacts = session.detect()?;
    session.check_trees()?;
    let mut stages = session.fingerprints()?;
    stages.push(("contacts", contacts.hash()));
    Ok(Print { contacts: contacts.len(), stages })
}

/// The same question, asked in every way that must leave the same behind at every stage.
fn choices(query: Query) -> Vec<(&'static str, Query)> {
    let spill = Traversal::PerLeaf { budget: Some(8) };
    let refit = |refit| Query { refit: Some(refit), traversal: Some(spill), ..query };
    let walk = |walk| Query { traversal: Some(walk), ..query };
    vec![
        ("by default", query),
        ("spilling, by levels", refit(Refit::Levels)),
        ("spilling, by treelets", refit(Refit::Treelets)),
        ("spilling, bottom-up", refit(Refit::BottomUp)),
        ("queues", walk(Traversal::Queue(QueueShape::native()))),
        ("the paper's queues", walk(Traversal::Queue(QueueShape::gtx285()))),
        ("stealing", walk(Traversal::Steal(StealShape::native()))),
        ("a front", walk(Traversal::Front(FrontShape::native()))),
    ]
}

/// Every question with every solver, and what comes within a separation: about a hundredth of the mean edge.
fn questions(bodies: &[Body]) -> impl Iterator<Item = (String, Query)> {
    let separation = Some(0.01 / Query::TOLERANCE * of_edges(bodies));
    let near = Query { separation, ..Query::of(Motion::Continuous) };
    Query::every().chain([near]).map(|query| {
        let how = if query.separation.is_some() { ", a separation" } else { "" };
        (format!("{:?} by {:?}{how}", query.motion, query.solver()), query)
    })
}

/// The first stage on which two machines differ.
fn difference(one: &Print, other: &Print) -> Option<&'static str> {
    one.stages.iter().zip(&other.stages).find(|(a, b)| a != b).map(|(a, _)| a.0)
}

/// Runs it all and prints a table that can be pasted into a bug report.
pub fn selftest(args: &SelftestArgs) -> Result<ExitCode, Error> {
    let machine = Device::open(args.backend, None)?;
    let engine = Device::emulator(Emulator::new(Mode::Engine, None)?);
    let mut table = String::new();
    // Writing to a String cannot fail.
    let _ = writeln!(table, "nearmiss {} selftest on {}", env!("CARGO_PKG_VERSION"), machine.name());
    let mut faults = Vec::new();

    let known = scene::grid(8)?;
    let pairs = print_of(&machine, &[known], Query::of(Motion::Discrete))?.contacts as u64;
    let _ = writeln!(table, "known answer   grid: {pairs} pairs, {} expected", scene::grid_pairs(8));
    if pairs != scene::grid_pairs(8) {
        faults.push("the grid's known answer".to_owned());
    }

    let mut scenes: Vec<(String, Vec<Body>)> = Vec::new();
    for name in scene::FORMULAS {
        // Of n equal triangles all n² / 2 pairs meet: few will do.
        let triangles = if name == "identical" { EQUAL } else { args.triangles };
        scenes.push((name.to_owned(), vec![scene::scene(name, triangles, 1)?]));
    }
    scenes.push((
        "draped with soup".into(),
        vec![scene::scene("draped", args.triangles, 1)?, scene::scene("soup", args.triangles / 10, 2)?],
    ));
    if !args.mesh.is_empty() {
        scenes.push((args.mesh[0].display().to_string(), vec![body(&args.mesh)?]));
    }
    for (name, bodies) in &scenes {
        for (asked, query) in questions(bodies) {
            let mut hashes = Vec::new();
            for bv in Bv::ALL {
                let query = Query { bv: Some(bv), ..query };
                // Overlap tests with a slack do not nest: whether a pair is a candidate may depend, by a hair, on which
                // pairs of nodes were asked before it. Each kind of walk is compared with its own; contacts with all.
                let on_engine = |walk| {
                    let query = Query { traversal: Some(walk), ..query };
                    during("comparing machines", || print_of(&engine, bodies, query))
                };
                let by_leaf = on_engine(Traversal::PerLeaf { budget: None })?;
                let by_pair = on_engine(Traversal::Queue(QueueShape::native()))?;
                if let Some(stage) = difference(&by_leaf.answer(), &by_pair.answer()) {
                    faults.push(format!("{name}, {asked}, {}, two walks: {stage}", bv.name()));
                }
                for (what, other) in choices(query) {
                    let on_machine = during("comparing machines", || print_of(&machine, bodies, other))?;
                    let walk = other.traversal_on(machine.is_card());
                    let want = if matches!(walk, Traversal::PerLeaf { .. }) { &by_leaf } else { &by_pair };
                    if let Some(stage) = difference(want, &on_machine) {
                        faults.push(format!("{name}, {asked}, {}, {what}: {stage}", bv.name()));
                    }
                }
                // All prints of a query have the same stages, and contacts are always last.
                hashes.push((by_leaf.stages.last().map_or(0, |stage| stage.1), by_leaf.contacts));
            }
            let (hash, contacts) = hashes[0];
            // A float solver may be wrong about a pair that one volume lets through and another does not.
            if query.solver() == Solver::Exact && hashes.iter().any(|other| *other != hashes[0]) {
                faults.push(format!("{name}, {asked}: volumes disagree on the contacts"));
            }
            let _ = writeln!(table, "{hash:016x} {contacts:>9} contacts  {name}, {asked}");
        }
    }
    for name in scene::FORMULAS {
        let triangles = if name == "identical" { EQUAL } else { SMALL };
        let bodies = [scene::scene(name, triangles, 3)?];
        for (asked, query) in questions(&bodies) {
            // The walk that is fastest on the machine, on both.
            let query = Query { traversal: Some(query.traversal_on(machine.is_card())), ..query };
            let want = print_of(&machine, &bodies, query)?;
            for order in [Order::Forward, Order::Reverse, Order::Shuffled(3)] {
                let microscope = Device::emulator(Emulator::new(Mode::Microscope(order), None)?);
                if let Some(stage) = difference(&print_of(&microscope, &bodies, query)?, &want) {
                    faults.push(format!("{name}, {asked}, microscope {order:?}: {stage}"));
                }
            }
        }
    }
    let _ = writeln!(
        table,
        "microscope     {} scenes x {} queries x 3 orders",
        scene::FORMULAS.len(),
        questions(&[]).count()
    );
    let report = during("counting what is appended", || appends::compare(&machine, &engine))?;
    let _ = writeln!(table, "{}", report.table);
    faults.extend(report.faults);
    if args.cases > 0 {
        let amount = Amount::on(machine.is_card(), args.cases);
        for report in during("asking the extremes", || extremes::run(&machine, amount, |_| ()))? {
            let _ = writeln!(table, "extremes       {report}");
            if !report.is_right() {
                faults.push(format!("extremes, {}: {} failures", report.suite, report.failed));
            }
        }
    }
    for fault in &faults {
        let _ = writeln!(table, "DIFFERS        {fault}");
    }
    let _ =
        writeln!(table, "{}", if faults.is_empty() { "ok: every stage agrees to the bit" } else { "FAILED" });
    super::print(&table);
    match faults.first() {
        None => Ok(ExitCode::SUCCESS),
        Some(first) => Err(Error::Bug { what: format!("a check of this machine fails: {first}") }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_is_named_by_its_stage() {
        let one = Print { contacts: 1, stages: vec![("fit", 1), ("refit", 2), ("contacts", 3)] };
        let other = Print { contacts: 1, stages: vec![("fit", 1), ("refit", 9), ("contacts", 3)] };
        assert_eq!(difference(&one, &other), Some("refit"));
        assert_eq!(difference(&one, &one), None);
    }
}
