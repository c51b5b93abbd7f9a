//! A plan as tables, and as JSON.

use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::plan::{Plan, PlannedStage};
use nearmiss::research::QueryExt;
use nearmiss::words::counted;
use nearmiss_lab::OneQuery;
use serde::Serialize;
use std::fmt::Write;

/// For people.
pub fn text(plan: &Plan) -> String {
    let mut text = String::new();
    let built = plan.build.iter().map(|stage| stage.launches).sum();
    // Writing to a String cannot fail.
    let _ = writeln!(text, "\nto build: {}", counted(built, "launch", "launches"));
    plan.build.iter().for_each(|stage| stage_rows(&mut text, stage));
    let _ = writeln!(text, "\na frame: {}", counted(plan.launches(), "launch", "launches"));
    plan.frame.iter().for_each(|stage| stage_rows(&mut text, stage));
    let _ = writeln!(text, "\nmemory: {} bytes", plan.bytes());
    for buffer in &plan.buffers {
        let _ = writeln!(text, "  {:>12}  {:>2}  {}", buffer.held.bytes, buffer.held.count, buffer.what);
    }
    let _ = writeln!(
        text,
        "\na frame's transfers: {} bytes to the device, {} to the host",
        plan.bytes_to_device(),
        plan.bytes_to_host()
    );
    for transfer in &plan.transfers {
        for (way, moved) in [("to the device", transfer.to_device), ("to the host", transfer.to_host)] {
            if moved.count > 0 {
                let _ = writeln!(text, "  {:>12}  {:>2}  {way}: {}", moved.bytes, moved.count, transfer.what);
            }
        }
    }
    if plan.clears.count > 0 {
        let _ = writeln!(text, "  {:>12}  {:>2}  set to zero", plan.clears.bytes, plan.clears.count);
    }
    let _ = writeln!(text, "\nleft out:");
    for left in &plan.left_out {
        let what =
            if left.what == "everything" { "nothing at all".into() } else { format!("no {}", left.what) };
        let _ = writeln!(text, "  {what}: {}", left.why);
    }
    text
}

fn stage_rows(text: &mut String, stage: &PlannedStage) {
    let _ = writeln!(text, "  {:<9} {:>4}  {}", stage.stage, stage.launches, stage.what);
    for kernel in &stage.kernels {
        let _ = writeln!(text, "            {:>4}  {}: {}", kernel.launches, kernel.kernel, kernel.what);
    }
}

/// For programs: one object on a line.
///
/// # Errors
/// None that is known.
pub fn json(detector: &mut OneQuery, device: &Device, plan: Option<&Plan>) -> Result<String, Error> {
    #[derive(Serialize)]
    struct All<'a> {
        device: String,
        backend: &'static str,
        query: nearmiss::query::QueryKind,
        bounding_volume: &'static str,
        solver: nearmiss::research::Solver,
        tolerance: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        largest_tolerance: Option<f64>,
        depths: Vec<usize>,
        launches: Option<u64>,
        bytes: Option<u64>,
        bytes_to_device: Option<u64>,
        bytes_to_host: Option<u64>,
        #[serde(flatten)]
        plan: Option<&'a Plan>,
    }
    let query = *detector.query();
    let (tolerance, largest) = (detector.tolerance(), detector.largest_tolerance());
    let all = All {
        device: device.name(),
        backend: device.backend(),
        query: query.kind(),
        bounding_volume: query.volume().name(),
        solver: query.solver(),
        tolerance,
        largest_tolerance: largest.filter(|_| largest != tolerance),
        depths: detector.depths(),
        launches: plan.map(Plan::launches),
        bytes: plan.map(Plan::bytes),
        bytes_to_device: plan.map(Plan::bytes_to_device),
        bytes_to_host: plan.map(Plan::bytes_to_host),
        plan,
    };
    serde_json::to_string(&all).map(|text| text + "\n").map_err(|e| Error::Bug { what: e.to_string() })
}
