//! What a scene does not need, and so does not have.

use super::Plan;
use crate::pipeline::{Layout, purpose};
use crate::query::{Query, QueryKind};

/// Something that there is not.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct LeftOut {
    /// What.
    pub what: &'static str,
    /// Why.
    pub why: String,
}

/// All that this frame did without: told only where the device counted none.
pub fn of(plan: &Plan, layout: &Layout, query: &Query, is_gpu: bool) -> Vec<LeftOut> {
    let mut all = Vec::new();
    let mut put = |none: bool, what: &'static str, why: &str| {
        all.extend(none.then(|| LeftOut { what, why: why.into() }));
    };
    let [moving, fixed] = &layout.trees;
    if !layout.may_meet() {
        let why = match (moving.is_empty(), fixed.is_empty()) {
            (true, true) => "no body has triangles",
            (true, false) => "what is static is not asked about what is static",
            _ => "a body alone is not tested against itself",
        };
        put(plan.frame.is_empty() && plan.buffers.is_empty(), "everything", why);
        return all;
    }
    let (stage, buffer) = (|name| plan.stage(name).is_none(), |what| plan.buffer(what).is_none());
    let uploads = |what: &str| plan.transfers.iter().any(|t| t.what == what && t.to_device.bytes > 0);
    let placed = uploads(purpose::VERTICES);
    let why = if placed {
        "all bodies moved, and all are deformable: what is uploaded is where it belongs"
    } else {
        "no body moved in this frame"
    };
    put(stage("place"), "placing of vertices", why);
    put(stage("construct"), "construction", "the tree is kept and refitted; a rebuild is asked for by name");
    put(fixed.is_empty(), "static tree", "no body is static");
    put(buffer(purpose::REST), "poses", "no body is rigid");
    let why = if query.keeps_adjacent() {
        "one body alone: every pair of its triangles is asked"
    } else {
        "one body alone, no vertex of 32 faces or more: every pair of its triangles is asked"
    };
    put(buffer(purpose::FILTERS), "filters of pairs", why);
    let groups = layout.has_several() && !layout.has_groups();
    put(groups, "groups in the walk", "every body is in all groups, and meets all");
    put(query.kind().is_at_rest(), "positions at the end of the step", "only t = 0 is looked at");
    put(buffer(purpose::EDGES), "edges", "triangles are asked about as a whole");
    let between = !query.kind().is_within_bodies();
    put(between, "pairs within a body", "a distance is that of two bodies");
    let assumed = !query.kind().is_at_rest() && !query.checks_start();
    put(assumed, "check of the start", "the query assumes that nothing crosses there");
    let earliest = query.kind() == QueryKind::Earliest;
    put(earliest, "lists of contacts", "only the smallest time is asked for");
    put(stage("fit"), "launch for the leaves", "treelets fit them where they merge them");
    put(stage("balance"), "balancing", "the walk needs no step that evens its work");
    let why = match (earliest, is_gpu) {
        (true, _) => "there is one time, and no list",
        (_, false) => "the host orders contacts on a CPU",
        _ => "there was nothing to order, or names and places do not fit a word",
    };
    put(stage("order"), "ordering on the device", why);
    all
}
