//! Parts of a frame that a scene does not need, and so does not have.

use super::Plan;
use crate::pipeline::{Layout, purpose};
use crate::query::{Query, QueryKind};

/// A part that was left out.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct LeftOut {
    /// The part.
    pub what: &'static str,
    /// The reason.
    pub why: String,
}

/// Lists the parts that this frame did without, by the device's counts.
pub fn of(plan: &Plan, layout: &Layout, query: &Query, is_gpu: bool) -> Vec<LeftOut> {
    let mut all = Vec::new();
    let mut put = |none: bool, what: &'static str, why: &str| {
        all.extend(none.then(|| LeftOut { what, why: why.into() }));
    };
    let [moving, fixed] = &layout.trees;
    if !layout.may_meet() {
        let why = match (moving.is_empty(), fixed.is_empty()) {
            (true, true) => "no body has triangles",
            (true, false) => "fixed bodies are not tested against each other",
            _ => "a body alone is not tested against itself",
        };
        put(plan.frame.is_empty() && plan.buffers.is_empty(), "everything", why);
        return all;
    }
    let (stage, buffer) = (|name| plan.stage(name).is_none(), |what| plan.buffer(what).is_none());
    let uploads = |what: &str| plan.transfers.iter().any(|t| t.what == what && t.to_device.bytes > 0);
    let placed = uploads(purpose::VERTICES);
    let why = if buffer(purpose::VERTICES) {
        "vertices are placed as they are read"
    } else if placed {
        "all bodies moved, and all are deformable: uploads are in place"
    } else {
        "no body moved in this frame"
    };
    put(stage("place"), "placing of vertices", why);
    put(stage("construct"), "construction", "the tree is kept and refitted, until a rebuild");
    put(fixed.is_empty(), "fixed tree", "no body is fixed");
    let (instances, vertices) = (buffer(purpose::INSTANCES), buffer(purpose::VERTICES));
    put(buffer(purpose::REST) && instances, "poses", "no body is rigid");
    let why = "rigid and fixed bodies are a mesh and a pose each";
    put(vertices && !instances, "vertices in the scene", why);
    let why = if query.keeps_adjacent() {
        "one body alone: every pair of its triangles is tested"
    } else {
        "one body alone, no vertex of 32 faces or more: every pair of its triangles is tested"
    };
    put(buffer(purpose::FILTERS), "filters of pairs", why);
    let groups = layout.has_several() && !layout.has_groups();
    put(groups, "groups in the walk", "every body is in all groups, and meets all groups");
    let listed = layout.has_several() && layout.left_out.is_empty();
    put(listed, "list of pairs in the walk", "no pair of bodies is left out");
    let obeys = query.kind().is_within_bodies() && !query.kind().is_of_bodies();
    put(obeys && layout.excluded.is_empty(), "exclusions", "no pair of features is excluded");
    put(query.kind().is_at_rest(), "positions at the end of the step", "only t = 0 is tested");
    put(buffer(purpose::EDGES), "edges", "triangles are tested as a whole");
    let between = !query.kind().is_within_bodies();
    put(between, "pairs within a body", "a distance is that of two bodies");
    let assumed = !query.kind().is_at_rest() && !query.checks_start();
    put(assumed, "check of the start", "the query assumes that nothing crosses there");
    let earliest = query.kind() == QueryKind::Earliest;
    put(earliest, "lists of contacts", "only the smallest time is computed");
    put(stage("fit"), "launch for the leaves", "treelets fit leaves and nodes in one launch");
    put(stage("balance"), "balancing", "the walk needs no step that balances its work");
    let why = match (earliest, is_gpu) {
        (true, _) => "there is one time, and no list",
        (_, false) => "the host orders contacts on a CPU",
        _ => "there was nothing to order",
    };
    put(stage("order"), "ordering on the device", why);
    all
}
