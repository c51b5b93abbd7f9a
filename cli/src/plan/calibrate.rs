//! A machine measured: a few frames of a cloth of ours at two sizes, asked as the scene will be.

use super::model::{Model, STAGES, Sample};
use nearmiss::contacts::Contacts;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::pipeline::{Stages, mean_side};
use nearmiss::plan::Plan;
use nearmiss::query::Query;
use nearmiss::scene::{BodyId, Motion, Scene};
use nearmiss_lab::OneQuery;
use std::time::Instant;

/// The scene that is asked.
pub const SCENE: &str = "draped";
/// Its sizes on a CPU: one that is hardly more than its launches, whose number goes with the size too where there is one a level, and one that
/// fills the machine. A GPU is filled by eight times as many triangles: with 16,000 an H200 takes twice to four times as long for each.
const SIZES: [usize; 2] = [64, 16_000];
const GPU_SIZES: [usize; 2] = [64, 128_000];
/// Frames of which the medians count, after two that find out how long lists are.
pub const FRAMES: usize = 5;
/// Bytes that are copied to the device to know how fast that is.
const COPIED: usize = 16 << 20;

/// Measures a machine; `side` is the mean side of the triangles of the scene, by which lengths are told.
///
/// # Errors
/// Those of the device.
pub fn model(device: &Device, query: &Query, side: f64) -> Result<Model, Error> {
    let (mut triangles, mut samples) = ([0; 2], [[Sample::default(); 2]; 7]);
    let sizes = if device.is_gpu() { GPU_SIZES } else { SIZES };
    for (run, size) in sizes.into_iter().enumerate() {
        let body = nearmiss_lab::scene::scene(SCENE, size, 1)?;
        triangles[run] = body.face_count();
        let own = mean_side(std::slice::from_ref(&body));
        let [t0, t1] = body.ends().map(Clone::clone);
        let scene = Scene::from(body);
        let id = scene.ids().next();
        let input = if query.kind().is_at_rest() { Motion::positions(&t0) } else { Motion::step(&t0, &t1) };
        let inputs: Vec<(BodyId, Motion)> = id.map(|id| (id, input)).into_iter().collect();
        let query = scaled(query, if side > 0.0 { own / side } else { 1.0 });
        let mut detector = OneQuery::new(device.clone(), scene, query)?;
        let mut frames = Vec::new();
        for frame in 0..FRAMES + 2 {
            if !super::keeps_front(&query) {
                detector.rebuild()?;
            }
            let found = detector.frame(&inputs)?;
            if frame >= 2 {
                frames.push(taken(&detector.plan()?, &found));
            }
        }
        medians(&frames).iter().zip(&mut samples).for_each(|(own, all)| all[run] = *own);
    }
    Ok(Model::new(triangles, samples, copying(device)?))
}

/// The query with its lengths in the other scene's measure.
fn scaled(query: &Query, by: f64) -> Query {
    let mut query = *query;
    if let Some(certified) = query.certified_mut() {
        certified.tolerance = certified.tolerance.map(|tolerance| tolerance * by);
        certified.min_separation *= by;
    }
    if let Query::Near(near) = &mut query {
        near.distance *= by;
    }
    query
}

/// Bytes a second from the host to the device: the best of three.
fn copying(device: &Device) -> Result<f64, Error> {
    let bytes = vec![1u8; COPIED];
    let mut buffer = device.upload(&bytes)?;
    let mut best = f64::INFINITY;
    for _ in 0..3 {
        let start = Instant::now();
        buffer.write(&bytes)?;
        // Behind the copy.
        buffer.read(1)?;
        best = best.min(start.elapsed().as_secs_f64());
    }
    Ok(COPIED as f64 / best)
}

/// What each stage of a frame launched, and what it worked on.
pub fn taken(plan: &Plan, found: &Contacts) -> [Sample; 7] {
    let launches = |name: &str| match name {
        // Balancing is a part of the walk.
        "traverse" => {
            [plan.stage(name), plan.stage("balance")].into_iter().flatten().map(|s| s.launches).sum()
        }
        "construct" => plan.build.iter().find(|stage| stage.stage == name).map_or(0, |stage| stage.launches),
        _ => plan.stage(name).map_or(0, |stage| stage.launches),
    };
    let moving = plan.bodies.rigid[1] + plan.bodies.deformable[1];
    let ms = stage_ms(&found.stats.stages);
    std::array::from_fn(|at| {
        let (name, _) = STAGES[at];
        // Of a stage that copies alone the whole counts as one.
        let least = u64::from(name == "place" && ms[at] > 0.0);
        let items = match name {
            "place" if ms[at] == 0.0 => 0.0,
            "place" => plan.bodies.moving_vertices as f64,
            "traverse" => found.stats.steps as f64,
            "narrow" => found.stats.candidates as f64,
            "order" => found.len() as f64,
            _ => moving as f64,
        };
        Sample { launches: launches(name).max(least) as f64, items, ms: ms[at] }
    })
}

/// The last of several frames, with the median of each stage's times.
pub fn medians(frames: &[[Sample; 7]]) -> [Sample; 7] {
    let mut all = frames.last().copied().unwrap_or_default();
    for (at, own) in all.iter_mut().enumerate() {
        let mut ms: Vec<f64> = frames.iter().map(|frame| frame[at].ms).collect();
        ms.sort_by(f64::total_cmp);
        own.ms = ms.get(ms.len() / 2).copied().unwrap_or(0.0);
    }
    all
}

/// Milliseconds of each stage.
fn stage_ms(ms: &Stages) -> [f64; 7] {
    [ms.place, ms.construct, ms.fit, ms.refit, ms.traverse + ms.balance, ms.narrow, ms.order]
}
