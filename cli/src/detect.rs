//! `detect` and `plan`.

use super::args::DetectArgs;
use super::progress::during;
use crate::report;
use nearmiss::contacts::{Contacts, Summary};
use nearmiss::error::Error;
use nearmiss::mesh::{Body, Mesh};
use nearmiss::pipeline::{Session, Stages};
use nearmiss::query::{Bv, Motion, Query, Traversal};
use std::fmt::Write;
use std::path::PathBuf;
use std::process::ExitCode;

/// A body from one file, or from two frames.
pub fn body(files: &[PathBuf]) -> Result<Body, Error> {
    match files {
        [t0, t1] => Body::moving(Mesh::read(t0)?, Mesh::read(t1)?),
        [still] => Ok(Body::still(Mesh::read(still)?)),
        // clap asks for one or two.
        _ => Err(Error::Bug { what: format!("{} files for a mesh", files.len()) }),
    }
}

/// The bodies that the arguments name, and what is asked of them.
fn question(args: &DetectArgs) -> Result<(Vec<Body>, Query), Error> {
    let mut bodies = Vec::new();
    match &args.scene {
        Some(name) => bodies.push(during("making the scene", || {
            nearmiss_lab::scene::scene(
                name,
                args.triangles.unwrap_or(nearmiss_lab::scene::usual(name)),
                args.seed,
            )
        })?),
        None => bodies.push(during("reading", || body(&args.meshes))?),
    }
    if !args.with.is_empty() {
        bodies.push(during("reading", || body(&args.with))?);
    }
    let query = args.query(bodies.iter().any(Body::is_moving));
    query.check()?;
    Ok((bodies, query))
}

/// Finds contacts, writes and prints what was asked for.
pub fn detect(args: &DetectArgs) -> Result<ExitCode, Error> {
    if let Some(out) = &args.out {
        report::Format::of(out)?;
    }
    let (bodies, query) = question(args)?;
    let device = args.machine.open()?;
    if !query.solver().is_certain() {
        eprintln!("nearmiss: the solver is {}", query.solver().promise());
    }
    let mut session = during("building", || Session::new(device, bodies, query))?;
    let often = if args.only.is_some() { 1 } else { args.repeat };
    let (contacts, runs) = during("detecting", || repeated(&mut session, often))?;
    let mut summary = session.summary(&contacts);
    summary.ms = median(&runs);
    if let Some(stage) = args.only {
        let times = during("repeating a stage", || session.repeat_stage(stage, args.repeat))?;
        *summary.ms.of_mut(stage) = middle(times);
    }
    if let Some(out) = &args.out {
        report::write(out, &contacts, &summary)?;
    }
    if args.json {
        let text = serde_json::to_string(&summary).map_err(|e| Error::Bug { what: e.to_string() })?;
        super::print(&(text + "\n"));
    } else {
        super::print(&human(&summary, &contacts));
    }
    Ok(ExitCode::SUCCESS)
}

/// The answer, and the times of each run; of several runs the first only warms up.
fn repeated(session: &mut Session, repeat: u32) -> Result<(Contacts, Vec<Stages>), Error> {
    let keeps_front = matches!(session.query().traversal, Some(Traversal::Front(_)));
    let mut contacts = session.detect()?;
    let mut runs = vec![contacts.stages];
    if repeat > 1 {
        runs.clear();
        for _ in 0..repeat {
            // A tree built anew would forget the front.
            if !keeps_front {
                session.rebuild()?;
            }
            contacts = session.detect()?;
            runs.push(contacts.stages);
        }
    }
    Ok((contacts, runs))
}

/// Each stage's median.
fn median(runs: &[Stages]) -> Stages {
    Stages::each(|stage| middle(runs.iter().map(stage).collect()))
}

/// The median; of an even number the upper of the two in the middle, of none 0.
fn middle(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(0.0)
}

/// The summary for people.
fn human(summary: &Summary, contacts: &Contacts) -> String {
    let mut text = String::new();
    let ms = &summary.ms;
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "{} triangles, {} vertices; {:?} by {:?} on {}",
        summary.triangles, summary.vertices, summary.query, summary.solver, summary.device
    );
    let _ = writeln!(
        text,
        "  {} triangle pairs, {} candidates, {} contacts{}",
        summary.triangle_pairs,
        summary.candidates,
        summary.contacts,
        summary.earliest_toi.map_or(String::new(), |toi| format!(", the first at t = {toi}"))
    );
    if let Some(tolerance) = summary.tolerance {
        let escalated: u64 = contacts.escalated_vf_ee.iter().sum();
        let _ = writeln!(
            text,
            "  {} unresolved, {escalated} asked again in f64; tolerance {tolerance:e}{}",
            summary.unresolved,
            match summary.separation {
                Some(s) if s > 0.0 => format!(", separation {s:e}"),
                _ => String::new(),
            }
        );
    }
    for reason in &summary.degraded {
        let _ = writeln!(text, "  degraded: {reason}");
    }
    let _ = writeln!(
        text,
        "  ms: construct {:.3}, fit {:.3}, refit {:.3}, traverse {:.3}{}, narrow {:.3}; a frame {:.3}{}, waited for {:.3}",
        ms.construct,
        ms.fit,
        ms.refit,
        ms.traverse,
        if ms.balance > 0.0 { format!(", balance {:.3}", ms.balance) } else { String::new() },
        ms.narrow,
        ms.total,
        if ms.order > 0.0 { format!(", ordering {:.3}", ms.order) } else { String::new() },
        ms.wall
    );
    if !matches!(summary.traversal, Traversal::PerLeaf { .. }) {
        let q = &summary.queues;
        let _ = writeln!(
            text,
            "  queues: {} rounds, {} times dry, {} units spilled, {} moved, {} stolen; {} waited at most",
            q.rounds, q.idle_exits, q.spills, q.moves, q.stolen, q.longest
        );
    }
    if let Traversal::Front(_) = summary.traversal {
        let f = &summary.front;
        let _ = writeln!(
            text,
            "  front: {} pairs; {} tests of pairs kept, {} gave way to an ancestor",
            f.pairs, f.tests, f.pruned
        );
    }
    let _ = writeln!(
        text,
        "  {} node tests, {} units spilled, {} undecided by floats ({} in f64); {:.1} MB; hash {}",
        contacts.steps,
        contacts.spilled,
        contacts.undecided,
        contacts.undecided_wide,
        summary.bytes as f64 / 1e6,
        summary.hash
    );
    text
}

/// Says what `detect` would do.
pub fn plan(args: &DetectArgs) -> Result<ExitCode, Error> {
    let (bodies, query) = question(args)?;
    let device = args.machine.open()?;
    let before = device.launches();
    let session = Session::new(device.clone(), bodies.clone(), query)?;
    let mut text = String::new();
    for body in &bodies {
        let _ = writeln!(
            text,
            "{}: {} triangles, {} vertices, positions in {}, {}",
            body.name(),
            body.face_count(),
            body.vertex_count(),
            if body.positions_t0().is_f64() { "f64" } else { "f32" },
            if body.is_moving() { "two frames" } else { "one frame" }
        );
    }
    let _ = writeln!(
        text,
        "query      {:?}, {}",
        query.motion,
        if bodies.len() == 1 { "self" } else { "between" }
    );
    let _ = writeln!(text, "machine    {} ({})", device.name(), device.backend());
    let swept = query.motion != Motion::Discrete && query.bv() != Bv::Linear;
    let _ = writeln!(text, "volume     {}{}", query.bv().name(), if swept { ", swept" } else { "" });
    let _ = writeln!(
        text,
        "refit      {}",
        match (query.refit, query.refit_on(device.is_card())) {
            (Some(choice), _) => format!("{choice:?}, as asked"),
            (None, choice) => format!("{choice:?}: the fastest on this machine"),
        }
    );
    let _ = writeln!(
        text,
        "traversal  {}",
        match query.traversal {
            Some(choice) => format!("{choice:?}, as asked"),
            None => match query.traversal_on(device.is_card()) {
                Traversal::PerLeaf { budget: None } =>
                    "per leaf, to the end: a CPU's threads balance by themselves".into(),
                Traversal::PerLeaf { .. } =>
                    "per leaf, long walks spill: a card must not wait for its longest walk".into(),
                choice => format!("{choice:?}: fewer tests, where tests cost more"),
            },
        }
    );
    let _ = writeln!(text, "solver     {}", query.solver().promise());
    if let Some(tolerance) = session.tolerance() {
        let why = if query.tolerance.is_some() { "as asked" } else { "about 1e-4 of the mean edge" };
        let boxes = query.boxes.unwrap_or(Query::BOXES);
        let _ = writeln!(text, "tolerance  {tolerance:e}, {why}; at most {boxes} boxes a pair");
        let separation = query.separation.filter(|s| *s > 0.0);
        let _ = writeln!(
            text,
            "separation {}",
            separation.map_or("none: what touches is in contact".into(), |s| format!("{s:e}, as asked"))
        );
    }
    let _ = writeln!(
        text,
        "tree       {} levels, built with {} launches",
        session.depths().iter().map(usize::to_string).collect::<Vec<_>>().join(" and "),
        device.launches() - before
    );
    let _ = writeln!(
        text,
        "memory     {:.1} MB to begin with; lists grow to the demand",
        device.bytes().0 as f64 / 1e6
    );
    super::print(&text);
    Ok(ExitCode::SUCCESS)
}
