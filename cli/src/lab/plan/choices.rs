//! The options in use, and why.

use nearmiss::device::Device;
use nearmiss::mesh::Body;
use nearmiss::query::Query;
use nearmiss::research::QueryExt;
use nearmiss::research::{Balance, BoundingVolume, BroadPhase, Certified, QueueShape, Traversal};
use nearmiss::words::counted;
use nearmiss_lab::OneQuery;
use std::fmt::Write;

/// Bodies that are printed one by one.
const MOST_PRINTED: usize = 8;

/// The options in use, one on a line.
pub fn text(detector: &mut OneQuery, device: &Device) -> String {
    let query = *detector.query();
    let (depths, limits) = (detector.depths(), accuracy(detector, &query));
    let bodies = detector.scene().bodies();
    let mut text = listed(bodies);
    let mut line = |name: &str, value: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name:<16}{value}");
    };
    let own = query.kind().is_within_bodies() && bodies.iter().any(Body::self_collides);
    let pairs = match (bodies.len(), own) {
        (1, _) => "of one body with itself",
        (_, true) => "within and between bodies",
        (_, false) => "between bodies",
    };
    line("query", format!("{}, {pairs}", query.kind()));
    line("machine", format!("{} ({})", device.name(), device.backend()));
    line("kernels", device.code());
    let swept = !query.kind().is_at_rest() && query.volume() != BoundingVolume::Linear;
    line("bounding volume", format!("{}{}", query.volume().name(), if swept { ", swept" } else { "" }));
    let broad = query.broad_phase_on(device.is_gpu());
    let why = if query.search().broad_phase.is_some() { "as given" } else { "the default of this machine" };
    line("broad phase", format!("{broad}: {why}"));
    if broad != BroadPhase::Tiles {
        trees(&query, device).into_iter().for_each(|(name, value)| line(name, value));
    }
    line("solver", query.solver().promise().into());
    limits.into_iter().for_each(|(name, value)| line(name, value));
    let levels = depths.iter().map(|&n| counted(n as u64, "level", "levels")).collect::<Vec<_>>();
    line("tree", if levels.is_empty() { "none".into() } else { levels.join(" and ") });
    text
}

/// The bodies, one on a line.
fn listed(bodies: &[Body]) -> String {
    let mut text = String::new();
    for body in bodies.iter().take(MOST_PRINTED) {
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
    if let Some(more) = bodies.len().checked_sub(MOST_PRINTED).filter(|more| *more > 0) {
        let _ = writeln!(text, "and {more} more bodies");
    }
    text
}

/// The refit and the walk of trees.
fn trees(query: &Query, device: &Device) -> [(&'static str, String); 2] {
    let why = |given: bool| if given { "as given" } else { "the default of this machine" };
    let search = query.search();
    let refit = query.refit_on(device.is_gpu());
    let walk = walked(query.traversal_on(device.is_gpu()));
    [
        ("refit", format!("{refit}: {}", why(search.refit.is_some()))),
        ("traversal", format!("{walk}: {}", why(search.traversal.is_some()))),
    ]
}

/// A walk with its sizes.
fn walked(walk: Traversal) -> String {
    match walk {
        Traversal::PerLeaf { budget: None } => "per leaf, to the end".into(),
        Traversal::PerLeaf { budget: Some(budget) } => format!("per leaf, spilling after {budget} steps"),
        Traversal::NearestFirst => "nearest first, then per leaf".into(),
        Traversal::Queue(shape) => queues(&shape),
        Traversal::Steal(shape) => {
            format!("{} that share work, {} units on chip", count(shape.cores), shape.local)
        }
        Traversal::Front(shape) => format!("front of the last frame, by {}", queues(&shape.queue)),
    }
}

fn queues(shape: &QueueShape) -> String {
    let balance = match shape.balance {
        Balance::Copy => "balanced by copying",
        Balance::View => "balanced through one list",
    };
    let count = count(shape.cores);
    format!("{count}, {} units on chip, {} taken at a time, {balance}", shape.local, shape.take)
}

fn count(cores: Option<u32>) -> String {
    cores.map_or("as many queues as run at once".into(), |n| counted(n.into(), "queue", "queues"))
}

/// The accuracy, with its limits.
fn accuracy(detector: &mut OneQuery, query: &Query) -> Vec<(&'static str, String)> {
    let mut all = Vec::new();
    if let (Some(tolerance), Some(certified)) = (detector.tolerance(), query.certified()) {
        let why = if certified.tolerance.is_some() { "as given" } else { "about 1e-4 of the mean edge" };
        let largest = detector.largest_tolerance().filter(|largest| *largest != tolerance);
        let largest =
            largest.map_or(String::new(), |largest| format!(" to {largest:e} by the pair of bodies"));
        let most = certified.max_iterations.unwrap_or(Certified::MAX_ITERATIONS);
        all.push(("tolerance", format!("{tolerance:e}{largest}, {why}")));
        all.push(("iterations", format!("at most {most} for a pair")));
        let apart = Some(certified.min_separation).filter(|apart| *apart > 0.0);
        all.push((
            "min separation",
            apart.map_or("0: touching".into(), |apart| format!("{apart:e}, as given")),
        ));
        if certified.approaching {
            all.push(("approaching", "near features at the start must come nearer".into()));
        }
    }
    if let Query::Near(near) = query {
        all.push(("distance", format!("{:e}, as given", near.distance)));
    }
    all
}
