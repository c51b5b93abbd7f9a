//! `plan`.

mod calibrate;
mod model;
mod table;
mod times;

use crate::args::PlanArgs;
use crate::detect::{Question, question};
use crate::output::{print, say};
use crate::progress::during;
use crate::sequence::Sequence;
use model::Sample;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::mesh::Body;
use nearmiss::pipeline::mean_side;
use nearmiss::plan::Plan;
use nearmiss::query::{Broad, Bv, Certified, Named, Order, Query, Traversal};
use nearmiss::scene::{BodyKind, Scene};
use nearmiss::words::counted;
use nearmiss_lab::OneQuery;
use std::fmt::Write;
use std::process::ExitCode;

/// Asks a frame and says what `detect` would do for each: what runs, is held and moved, how long it should take by what this machine
/// does, and what there is not.
pub fn plan(args: &PlanArgs) -> Result<ExitCode, Error> {
    let Question { scene, query, sequence, notes, .. } = question(&args.detect)?;
    notes.iter().for_each(|note| say(note));
    let device = args.detect.machine.open()?;
    let mut detector = during("building", || OneQuery::new(device.clone(), scene, query))?;
    let work = Work::of(detector.scene());
    let measured = during("measuring this machine", || {
        let side = mean_side(detector.scene().bodies());
        has_memory(calibrate::model(&device, &query, side))
    })?;
    let model = if detector.depths().is_empty() { None } else { measured };
    let frame = if args.no_run {
        None
    } else {
        Some(during("asking a frame", || asked(&mut detector, sequence.as_ref(), &query))?)
    };
    let (plan, sample) = frame.unzip();
    let uploads = sequence.is_some_and(|all| all.frames > 1);
    let moving = [work.triangles, if uploads { work.vertices } else { 0.0 }];
    let rows = model.as_ref().map(|model| times::rows(model, moving, sample.as_ref()));
    let times = model.as_ref().zip(rows.as_ref());
    let text = if args.detect.json {
        table::json(&mut detector, &device, (plan.as_ref(), times))?
    } else {
        let mut text = choices(&mut detector, &device);
        text.extend(plan.as_ref().map(table::text));
        text.extend(times.map(|(model, rows)| times::text(model, rows)));
        text
    };
    print(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// What moves.
struct Work {
    triangles: f64,
    vertices: f64,
}

impl Work {
    fn of(scene: &Scene) -> Work {
        let moving = || scene.bodies().iter().filter(|body| body.kind() != BodyKind::Fixed);
        let triangles: usize = moving().map(Body::face_count).sum();
        let vertices: usize = moving().map(Body::vertex_count).sum();
        Work { triangles: triangles as f64, vertices: vertices as f64 }
    }
}

/// Frames of which the medians are what was measured.
pub const MEASURED: usize = 3;

/// The plan of a frame, and one that is measured: each stage's launches, work and time.
fn asked(
    detector: &mut OneQuery,
    sequence: Option<&Sequence>,
    query: &Query,
) -> Result<(Plan, [Sample; 7]), Error> {
    // Where bodies move from frame to frame, what moves them is a part of it.
    let moving = sequence.filter(|all| all.frames > 1);
    let inputs =
        |scene: &Scene| moving.map_or(Vec::new(), |all| all.inputs(scene, 0, query.kind().is_at_rest()));
    for _ in 0..if moving.is_some() { 2 } else { 0 } {
        let inputs = inputs(detector.scene());
        detector.frame(&inputs)?;
    }
    let plan = detector.plan()?;
    if !keeps_front(query) {
        detector.rebuild()?;
    }
    let mut samples = Vec::new();
    for _ in 0..MEASURED {
        // A detector without inputs keeps the step that its bodies are in.
        let found = if moving.is_some() {
            let inputs = inputs(detector.scene());
            detector.frame(&inputs)?
        } else {
            detector.detect()?
        };
        samples.push(calibrate::taken(&plan, &found));
    }
    Ok((plan, calibrate::medians(&samples)))
}

/// Whether a tree built anew would lose what the walk keeps.
fn keeps_front(query: &Query) -> bool {
    matches!(query.search().traversal, Some(Traversal::Front(_)))
}

/// Bodies that are told one by one.
const MOST_TOLD: usize = 8;

/// What was chosen, and why.
fn choices(detector: &mut OneQuery, device: &Device) -> String {
    let query = *detector.query();
    let query = &query;
    let mut text = String::new();
    let tolerances = [detector.tolerance(), detector.largest_tolerance()];
    let depths = detector.depths();
    let bodies = detector.scene().bodies();
    for body in bodies.iter().take(MOST_TOLD) {
        let _ = writeln!(
            text,
            "{}: {}, {}, positions in {}, {}",
            body.name(),
            counted(body.face_count() as u64, "triangle", "triangles"),
            counted(body.vertex_count() as u64, "vertex", "vertices"),
            if body.positions_t0().is_f64() { "f64" } else { "f32" },
            if body.is_moving() { "two frames" } else { "one frame" }
        );
    }
    if let Some(more) = bodies.len().checked_sub(MOST_TOLD).filter(|more| *more > 0) {
        let _ = writeln!(text, "and {more} bodies more");
    }
    let own = query.kind().is_within_bodies() && bodies.iter().any(Body::self_collides);
    let _ = writeln!(
        text,
        "query      {:?}, {}",
        query.kind(),
        if bodies.len() == 1 {
            "self"
        } else if own {
            "within and between"
        } else {
            "between"
        }
    );
    let _ = writeln!(text, "machine    {} ({})", device.name(), device.backend());
    let swept = !query.kind().is_at_rest() && query.bv() != Bv::Linear;
    let _ = writeln!(text, "volume     {}{}", query.bv().name(), if swept { ", swept" } else { "" });
    let broad = query.broad_on(device.is_gpu());
    let why = if query.search().broad.is_some() { "as asked" } else { "the fastest on this machine" };
    if broad == Broad::Tiles {
        let _ = writeln!(text, "broad      tiles: 32 neighbours against 32, no tree; {why}");
        let asked = query.search().order;
        let why = if asked.is_some() { "as asked" } else { "by default" };
        let order = asked.unwrap_or(Order::DEFAULT);
        let _ = writeln!(text, "order      {order}: {}; {why}", in_a_sentence(order.about()));
    } else {
        text += &of_trees(query, device);
    }
    let _ = writeln!(text, "solver     {}", query.solver().promise());
    if let (Some(tolerance), Some(certified)) = (tolerances[0], query.certified()) {
        let why = if certified.tolerance.is_some() { "as asked" } else { "about 1e-4 of the mean edge" };
        let largest = tolerances[1].filter(|largest| *largest != tolerance);
        let largest =
            largest.map_or(String::new(), |largest| format!(" to {largest:e} by the bodies of a pair"));
        let boxes = certified.max_iterations.unwrap_or(Certified::MAX_ITERATIONS);
        let _ = writeln!(
            text,
            "tolerance  {tolerance:e}{largest}, {why}; at most {} a pair",
            counted(boxes.into(), "box", "boxes")
        );
        let separation = (certified.min_separation > 0.0).then_some(certified.min_separation);
        let _ = writeln!(
            text,
            "separation {}",
            separation.map_or("none: what touches is in contact".into(), |s| format!("{s:e}, as asked"))
        );
    }
    if let Query::Near(near) = query {
        let _ = writeln!(text, "distance   {:e}, as asked", near.distance);
    }
    let levels = depths.iter().map(|&n| counted(n as u64, "level", "levels")).collect::<Vec<_>>();
    let _ =
        writeln!(text, "tree       {}", if levels.is_empty() { "none".into() } else { levels.join(" and ") });
    text
}

/// A description within a sentence: without its capital and its full stop.
fn in_a_sentence(about: &str) -> String {
    let mut letters = about.trim_end_matches('.').chars();
    letters.next().map(char::to_lowercase).into_iter().flatten().chain(letters).collect()
}

/// How trees are refitted and walked.
fn of_trees(query: &Query, device: &Device) -> String {
    let mut text = String::new();
    let _ = writeln!(
        text,
        "refit      {}",
        match (query.search().refit, query.refit_on(device.is_gpu())) {
            (Some(choice), _) => format!("{choice:?}, as asked"),
            (None, choice) => format!("{choice:?}: the fastest on this machine"),
        }
    );
    let _ = writeln!(
        text,
        "traversal  {}",
        match query.search().traversal {
            Some(choice) => format!("{choice:?}, as asked"),
            None => match query.traversal_on(device.is_gpu()) {
                Traversal::PerLeaf { budget: None } =>
                    "per leaf, to the end: a CPU's threads balance by themselves".into(),
                Traversal::PerLeaf { .. } =>
                    "per leaf, long walks spill: a GPU must not wait for its longest walk".into(),
                Traversal::NearestFirst =>
                    "nearest first: samples bound the distance, then a walk a leaf".into(),
                choice => format!("{choice:?}: fewer tests, where tests cost more"),
            },
        }
    );
    text
}

/// What was measured; `None` if there is no memory for it.
///
/// # Errors
/// All others.
fn has_memory<T>(done: Result<T, Error>) -> Result<Option<T>, Error> {
    match done {
        Ok(done) => Ok(Some(done)),
        Err(Error::OutOfMemory { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}
