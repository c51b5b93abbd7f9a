//! `selftest`: known answers, every stage on every machine to the bit, on scenes that the program makes itself; and the
//! catalogue of extremes.

mod appends;

use super::args::SelftestArgs;
use super::detect::body;
use super::output::print;
use super::progress::during;
use nearmiss::BodyPairs;
use nearmiss::contacts::Contacts;
use nearmiss::device::Device;
use nearmiss::device::emulator::{Emulator, Mode, Order};
use nearmiss::error::Error;
use nearmiss::mesh::Body;
use nearmiss::query::{Continuous, Query};
use nearmiss::research::pipeline::of_edges;
use nearmiss::research::{
    BoundingVolume, BroadPhase, Certified, FrontShape, KindExt, QueryExt, QueueShape, Refit, Solver,
    StealShape, Traversal, WithSolver,
};
use nearmiss::words::counted;
use nearmiss_lab::OneQuery;
use nearmiss_lab::robustness::{self, Amount};
use nearmiss_lab::scene::{self, Bodies};
use std::process::ExitCode;

/// Triangles of the scenes that the sanitizer, which is some hundred times slower, looks at.
const SMALL: usize = 300;
/// Equal triangles: all pairs of their features touch at the start, which only exact signs decide.
const EQUAL: usize = 40;

/// Limit of distances of bodies whose diameter is about 1.
const WITHIN: f64 = 0.5;

/// Steps of a scene of many bodies.
const STEPS: u32 = 3;

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

/// Frames until one is a graph's.
const REPLAYED: u32 = 3;

fn print_of(device: &Device, bodies: &[Body], query: Query) -> Result<Print, Error> {
    let mut detector = OneQuery::new(device.clone(), bodies.to_vec(), query)?;
    let mut contacts = detector.detect()?;
    // A GPU replays a frame from the third time on. A front continues from frame to frame, and tests less.
    if device.is_gpu() && !matches!(query.search().traversal, Some(Traversal::Front(_))) {
        for _ in 1..REPLAYED {
            contacts = detector.detect()?;
        }
    }
    print_after(&mut detector, &contacts)
}

/// The same of a scene of many bodies, after some steps.
fn print_of_steps(device: &Device, scene: &Bodies, query: Query) -> Result<Print, Error> {
    let mut detector = OneQuery::new(device.clone(), scene.scene.clone(), query)?;
    let mut last = None;
    for step in 0..STEPS {
        let moves = scene.step(step);
        let inputs: Vec<_> = moves.iter().map(|(id, to)| (*id, to.input())).collect();
        last = Some(detector.frame(&inputs)?);
    }
    print_after(&mut detector, &last.unwrap_or_else(|| Contacts::none(query)))
}

fn print_after(detector: &mut OneQuery, contacts: &Contacts) -> Result<Print, Error> {
    detector.check_volumes()?;
    let mut stages = detector.fingerprints()?;
    stages.push(("contacts", contacts.hash()));
    Ok(Print { contacts: contacts.len(), stages })
}

/// The same query in every way that must leave the same results at every stage.
fn choices(query: Query) -> Vec<(&'static str, Query)> {
    let spill = Traversal::PerLeaf { budget: Some(8) };
    let refit = |refit| query.with_refit(refit).with_traversal(spill);
    let walk = |walk| query.with_traversal(walk);
    if !query.kind().takes_traversals() {
        let refit = |refit| query.with_refit(refit);
        return vec![
            ("by default", query),
            ("by levels", refit(Refit::Levels)),
            ("by treelets", refit(Refit::Treelets)),
        ];
    }
    vec![
        ("by default", query),
        ("tiles", query.with_broad_phase(BroadPhase::Tiles)),
        ("trees", query.with_broad_phase(BroadPhase::Tree)),
        ("spilling, by levels", refit(Refit::Levels)),
        ("spilling, by treelets", refit(Refit::Treelets)),
        ("queues", walk(Traversal::Queue(QueueShape::native()))),
        ("the paper's queues", walk(Traversal::Queue(QueueShape::gtx285()))),
        ("stealing", walk(Traversal::Steal(StealShape::native()))),
        ("a front", walk(Traversal::Front(FrontShape::native()))),
    ]
}

/// The engine's results, for each kind of search whose candidates may differ. Overlap tests with a slack
/// do not nest. So a pair may be a candidate or not, by a hair, depending on the node pairs before it.
/// Each search is compared with its own kind; contacts are compared with all.
struct Truths {
    by_leaf: Print,
    by_pair: Print,
    by_tiles: Print,
}

impl Truths {
    /// The results of `ask` by each way, or once if the query has no choice.
    fn of(query: Query, ask: impl Fn(Query) -> Result<Print, Error>) -> Result<Truths, Error> {
        let choice = query.kind().takes_traversals();
        let by = |other: Query| ask(if choice { other } else { query });
        Ok(Truths {
            by_leaf: by(query.with_traversal(Traversal::PerLeaf { budget: None }))?,
            by_pair: by(query.with_traversal(Traversal::Queue(QueueShape::native())))?,
            by_tiles: by(query.with_broad_phase(BroadPhase::Tiles))?,
        })
    }

    /// The expected results of a query on a machine.
    fn want(&self, query: Query, machine: &Device) -> &Print {
        let by_leaf = |walk| matches!(walk, Traversal::PerLeaf { .. } | Traversal::NearestFirst);
        if query.broad_phase_on(machine.is_gpu()) == BroadPhase::Tiles {
            &self.by_tiles
        } else if by_leaf(query.traversal_on(machine.is_gpu())) {
            &self.by_leaf
        } else {
            &self.by_pair
        }
    }

    /// The first of them that has another answer than the first, and the stage.
    fn disagree(&self) -> Option<(&'static str, &'static str)> {
        [("queues", &self.by_pair), ("tiles", &self.by_tiles)].into_iter().find_map(|(name, other)| {
            difference(&self.by_leaf.answer(), &other.answer()).map(|stage| (name, stage))
        })
    }
}

/// Every question with every solver, and what comes within a separation: about a hundredth of the mean edge.
fn questions(bodies: &[Body]) -> impl Iterator<Item = (String, Query)> {
    let hundredth = 0.01 / Certified::TOLERANCE * of_edges(bodies);
    let apart = Continuous::by(Certified { min_separation: hundredth, ..Certified::default() });
    // The paper's test of triangles may find lines that are apart: more of them with more candidates.
    let has_area = bodies.iter().all(|body| body.element_count() == body.face_count());
    let every = Query::every().filter(move |query| has_area || query.solver() != Solver::Moller);
    let every = every.map(|query| (query, false));
    every.chain([(apart.into(), true)]).map(move |(query, is_apart)| {
        // About a tenth of the mean edge, which a scene of points has not.
        let query = match query {
            Query::Near(_) if hundredth > 0.0 => Query::near(10.0 * hundredth),
            other => other,
        };
        let how = if is_apart { ", a separation" } else { "" };
        (format!("{:?} by {:?}{how}", query.kind(), query.solver()), query)
    })
}

/// The first stage on which two machines differ.
fn difference(one: &Print, other: &Print) -> Option<&'static str> {
    one.stages.iter().zip(&other.stages).find(|(a, b)| a != b).map(|(a, _)| a.0)
}

/// The machines, and the faults so far.
struct Bench {
    machine: Device,
    engine: Device,
    faults: Vec<String>,
}

/// Runs it all and prints a table that can be pasted into a bug report, line by line.
pub fn selftest(args: &SelftestArgs) -> Result<ExitCode, Error> {
    let machine = Device::open(args.backend, None)?;
    let engine = Device::emulator(Emulator::new(Mode::Engine, None)?);
    line(format!("nearmiss {} selftest on {}", env!("CARGO_PKG_VERSION"), machine.name()))?;
    let mut bench = Bench { machine, engine, faults: Vec::new() };
    bench.known_answer()?;
    bench.stages(args)?;
    bench.under_the_microscope()?;
    let report = during("counting appended rows", || appends::compare(&bench.machine, &bench.engine))?;
    line(report.table)?;
    bench.faults.extend(report.faults);
    if args.cases > 0 {
        bench.extremes(args.cases)?;
    }
    for fault in &bench.faults {
        line(format!("DIFFERS        {fault}"))?;
    }
    line(if bench.faults.is_empty() { "ok: every stage agrees to the bit" } else { "FAILED" }.into())?;
    match bench.faults.first() {
        None => Ok(ExitCode::SUCCESS),
        Some(first) => Err(Error::Bug { what: format!("a check of this machine failed: {first}") }),
    }
}

fn line(text: String) -> Result<(), Error> {
    print(&(text + "\n"))
}

impl Bench {
    fn known_answer(&mut self) -> Result<(), Error> {
        let known = scene::grid(8)?;
        let pairs = print_of(&self.machine, &[known], Query::discrete())?.contacts as u64;
        line(format!("known answer   grid: {pairs} pairs, {} expected", scene::grid_pairs(8)))?;
        if pairs != scene::grid_pairs(8) {
            self.faults.push("the grid's known answer".to_owned());
        }
        Ok(())
    }

    /// Every scene, on the machine in every way and on the CPU.
    fn stages(&mut self, args: &SelftestArgs) -> Result<(), Error> {
        for name in scene::FORMULAS {
            // All n² / 2 pairs of n equal triangles meet: few will do.
            let triangles = if name == "identical" { EQUAL } else { args.triangles };
            self.compare(name, &[scene::scene(name, triangles, 1)?])?;
        }
        let [draped, soup] = [("draped", args.triangles, 1), ("soup", args.triangles / 10, 2)]
            .map(|(name, triangles, seed)| scene::scene(name, triangles, seed));
        self.compare("draped with soup", &[draped?, soup?])?;
        self.compare("threads and points", &[scene::threads(args.triangles / 2, 1)?])?;
        if !args.mesh.is_empty() {
            self.compare(&args.mesh[0].display().to_string(), &[body(&args.mesh)?])?;
        }
        let balls = (args.triangles / 200).max(4);
        for (name, scene) in [
            ("a pile of bodies", Bodies::pile(balls, 40, 20)?),
            ("worlds", Bodies::worlds(balls as u32 / 4, 4)?),
        ] {
            self.compare_bodies(name, &scene)?;
            self.compare_pairs_of_bodies(name, &scene)?;
        }
        Ok(())
    }

    /// Pairs of bodies and their distances, step after step. There is one way to find them.
    fn compare_pairs_of_bodies(&mut self, name: &str, scene: &Bodies) -> Result<(), Error> {
        let first = BodyPairs::first(1).into();
        for query in [Query::body_pairs(), first, Query::body_distances(0.0), Query::body_distances(WITHIN)] {
            let own = |device| during("comparing machines", || print_of_steps(device, scene, query));
            let (want, there) = (own(&self.engine)?, own(&self.machine)?);
            let kind = query.kind();
            if let Some(stage) = difference(&want, &there) {
                self.faults.push(format!("{name}, {kind}: {stage}"));
            }
            let hash = want.stages.last().map_or(0, |stage| stage.1);
            let rows = counted(want.contacts as u64, "row", "rows");
            line(format!("{hash:016x} {rows:>18}  {name}, {kind}"))?;
        }
        Ok(())
    }

    /// A scene of many bodies, step after step.
    fn compare_bodies(&mut self, name: &str, scene: &Bodies) -> Result<(), Error> {
        let Bench { machine, engine, faults } = self;
        for query in [Query::discrete(), Query::continuous(), Query::earliest(), Query::distance()] {
            let kind = query.kind();
            for volume in BoundingVolume::ALL {
                let query = query.with_volume(volume);
                let on_engine = |query| during("comparing machines", || print_of_steps(engine, scene, query));
                let truths = Truths::of(query, on_engine)?;
                if let Some((other, stage)) = truths.disagree() {
                    faults.push(format!("{name}, {kind}, {}, {other}: {stage}", volume.name()));
                }
                for (what, other) in choices(query) {
                    let there = during("comparing machines", || print_of_steps(machine, scene, other))?;
                    let want = truths.want(other, machine);
                    // The tests of a front depend on the step before. The answer does not.
                    let differs = match other.search().traversal {
                        Some(Traversal::Front(_)) => difference(&want.answer(), &there.answer()),
                        _ => difference(want, &there),
                    };
                    if let Some(stage) = differs {
                        faults.push(format!("{name}, {kind}, {}, {what}: {stage}", volume.name()));
                    }
                }
                if volume == BoundingVolume::Aabb {
                    let hash = truths.by_leaf.stages.last().map_or(0, |stage| stage.1);
                    let contacts = counted(truths.by_leaf.contacts as u64, "contact", "contacts");
                    line(format!("{hash:016x} {contacts:>18}  {name}, {kind}"))?;
                }
            }
        }
        Ok(())
    }

    /// One scene.
    fn compare(&mut self, name: &str, bodies: &[Body]) -> Result<(), Error> {
        let Bench { machine, engine, faults } = self;
        for (asked, query) in questions(bodies) {
            let mut hashes = Vec::new();
            for volume in BoundingVolume::ALL {
                let query = query.with_volume(volume);
                let on_engine = |query| during("comparing machines", || print_of(engine, bodies, query));
                let truths = Truths::of(query, on_engine)?;
                if let Some((other, stage)) = truths.disagree() {
                    faults.push(format!("{name}, {asked}, {}, {other}: {stage}", volume.name()));
                }
                for (what, other) in choices(query) {
                    let on_machine = during("comparing machines", || print_of(machine, bodies, other))?;
                    let want = truths.want(other, machine);
                    if let Some(stage) = difference(want, &on_machine) {
                        faults.push(format!("{name}, {asked}, {}, {what}: {stage}", volume.name()));
                    }
                }
                // All prints of a query have the same stages, and contacts are always last.
                let found = &truths.by_leaf;
                hashes.push((found.stages.last().map_or(0, |stage| stage.1), found.contacts));
            }
            let (hash, contacts) = hashes[0];
            // A float solver may be wrong about a pair that one volume lets through and another does not.
            if query.solver() == Solver::Exact && hashes.iter().any(|other| *other != hashes[0]) {
                faults.push(format!("{name}, {asked}: volumes disagree on the contacts"));
            }
            let noun = if contacts == 1 { "contact " } else { "contacts" };
            line(format!("{hash:016x} {contacts:>9} {noun}  {name}, {asked}"))?;
        }
        Ok(())
    }

    /// Small scenes on the emulated GPU, in three orders.
    fn under_the_microscope(&mut self) -> Result<(), Error> {
        let Bench { machine, faults, .. } = self;
        let scenes = scene::FORMULAS.map(|name| {
            let triangles = if name == "identical" { EQUAL } else { SMALL };
            (name, scene::scene(name, triangles, 3))
        });
        let scenes = scenes.into_iter().chain([("threads and points", scene::threads(SMALL, 3))]);
        let count = scene::FORMULAS.len() + 1;
        for (name, body) in scenes {
            let bodies = [body?];
            for (asked, query) in questions(&bodies) {
                // The default of the machine, on both.
                let query = query.with_broad_phase(query.broad_phase_on(machine.is_gpu()));
                let want = print_of(machine, &bodies, query)?;
                for order in [Order::Forward, Order::Reverse, Order::Shuffled(3)] {
                    let sanitizer = Device::emulator(Emulator::new(Mode::Sanitizer(order), None)?);
                    if let Some(stage) = difference(&print_of(&sanitizer, &bodies, query)?, &want) {
                        faults.push(format!("{name}, {asked}, sanitizer {order:?}: {stage}"));
                    }
                }
            }
        }
        let queries = questions(&[]).count();
        line(format!("sanitizer     {count} scenes x {queries} queries x 3 orders"))
    }

    /// The catalogue, a line a suite as it ends.
    fn extremes(&mut self, cases: usize) -> Result<(), Error> {
        let amount = Amount::on(self.machine.is_gpu(), cases);
        let mut told = Ok(());
        let tell = |report: &robustness::Report| {
            if told.is_ok() {
                told = line(format!("extremes       {report}"));
            }
        };
        let reports = during("running extreme cases", || robustness::run(&self.machine, amount, tell))?;
        for report in reports.iter().filter(|report| !report.is_right()) {
            let failures = counted(report.failed, "failure", "failures");
            self.faults.push(format!("extremes, {}: {failures}", report.suite));
        }
        told
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
