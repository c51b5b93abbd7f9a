//! `plan`.

mod table;

use crate::args::DetectArgs;
use crate::detect::{Question, question};
use crate::output::print;
use crate::progress::during;
use nearmiss::Detector;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::query::{Bv, Query, Traversal};
use nearmiss::words::counted;
use std::fmt::Write;
use std::process::ExitCode;

/// Asks a frame and says what `detect` would do for each: what runs, what is held and moved, and what there is not.
pub fn plan(args: &DetectArgs) -> Result<ExitCode, Error> {
    let Question { scene, query, sequence } = question(args)?;
    let device = args.machine.open()?;
    let mut detector = during("building", || Detector::new(device.clone(), scene, query))?;
    let plan = during("asking a frame", || {
        // Where bodies move from frame to frame, what moves them is a part of it.
        for _ in 0..sequence.as_ref().filter(|all| all.frames > 1).map_or(0, |_| 2) {
            let inputs =
                sequence.as_ref().map(|all| all.inputs(detector.scene(), 0, query.motion.is_at_rest()));
            detector.frame(&inputs.unwrap_or_default())?;
        }
        detector.plan()
    })?;
    let text = if args.json {
        table::json(&detector, &device, &plan)?
    } else {
        choices(&detector, &device) + &table::text(&plan)
    };
    print(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// What was chosen, and why.
fn choices(detector: &Detector, device: &Device) -> String {
    let query = detector.query();
    let mut text = String::new();
    for body in detector.scene().bodies() {
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
    let _ = writeln!(
        text,
        "query      {:?}, {}",
        query.motion,
        if detector.scene().bodies().len() == 1 { "self" } else { "between" }
    );
    let _ = writeln!(text, "machine    {} ({})", device.name(), device.backend());
    let swept = !query.motion.is_at_rest() && query.bv() != Bv::Linear;
    let _ = writeln!(text, "volume     {}{}", query.bv().name(), if swept { ", swept" } else { "" });
    let _ = writeln!(
        text,
        "refit      {}",
        match (query.refit, query.refit_on(device.is_gpu())) {
            (Some(choice), _) => format!("{choice:?}, as asked"),
            (None, choice) => format!("{choice:?}: the fastest on this machine"),
        }
    );
    let _ = writeln!(
        text,
        "traversal  {}",
        match query.traversal {
            Some(choice) => format!("{choice:?}, as asked"),
            None => match query.traversal_on(device.is_gpu()) {
                Traversal::PerLeaf { budget: None } =>
                    "per leaf, to the end: a CPU's threads balance by themselves".into(),
                Traversal::PerLeaf { .. } =>
                    "per leaf, long walks spill: a GPU must not wait for its longest walk".into(),
                choice => format!("{choice:?}: fewer tests, where tests cost more"),
            },
        }
    );
    let _ = writeln!(text, "solver     {}", query.solver().promise());
    if let Some(tolerance) = detector.tolerance() {
        let why = if query.tolerance.is_some() { "as asked" } else { "about 1e-4 of the mean edge" };
        let boxes = query.boxes.unwrap_or(Query::BOXES);
        let _ = writeln!(
            text,
            "tolerance  {tolerance:e}, {why}; at most {} a pair",
            counted(boxes.into(), "box", "boxes")
        );
        let separation = query.separation.filter(|s| *s > 0.0);
        let _ = writeln!(
            text,
            "separation {}",
            separation.map_or("none: what touches is in contact".into(), |s| format!("{s:e}, as asked"))
        );
    }
    if let Some(distance) = query.distance {
        let _ = writeln!(text, "distance   {distance:e}, as asked");
    }
    let levels = detector.depths().iter().map(|&n| counted(n as u64, "level", "levels")).collect::<Vec<_>>();
    let _ =
        writeln!(text, "tree       {}", if levels.is_empty() { "none".into() } else { levels.join(" and ") });
    text
}
