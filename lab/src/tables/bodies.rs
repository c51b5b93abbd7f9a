//! Cost of scenes of many bodies: a frame in one submission, compared with many worlds one by one.

use super::text::{Printed, digits};
use crate::OneQuery;
use crate::scene::{Bodies, Move};
use nearmiss::Body;
use nearmiss::Stages;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::query::{Query, QueryKind};
use nearmiss::scene::{BodyId, BodyKind, Motion, Scene};
use serde::Serialize;

/// A scene with one query.
#[derive(Clone, Debug, Serialize)]
pub struct BodiesRow {
    /// The scene.
    pub scene: String,
    /// The machine.
    pub device: String,
    /// Kind of the query.
    pub motion: QueryKind,
    /// Number of bodies.
    pub bodies: usize,
    /// Triangles of all bodies.
    pub triangles: usize,
    /// Triangles of moving bodies.
    pub moving: usize,
    /// Kernel launches per frame.
    pub launches: u64,
    /// Device memory held after the last frame, in bytes.
    pub bytes: u64,
    /// Mean milliseconds per frame: placing moving bodies.
    pub place_ms: f64,
    /// Mean milliseconds per frame: from positions to contacts.
    pub frame_ms: f64,
    /// Mean milliseconds per frame that the caller waits.
    pub wall_ms: f64,
    /// Number of contacts of all frames.
    pub contacts: u64,
    /// One hash over those of all frames.
    pub hash: String,
    /// For worlds: milliseconds that the caller waits for all of them, one by one.
    pub one_by_one_ms: Option<f64>,
}

/// Number of worlds that run one by one, from which the time of all is estimated.
const ASKED: usize = 20;

/// Runs a scene's steps twice; the second run is measured.
///
/// # Errors
/// Device errors.
pub fn bodies(
    device: &Device,
    name: &str,
    all: &Bodies,
    query: Query,
    frames: u32,
) -> Result<BodiesRow, Error> {
    let mut detector = OneQuery::new(device.clone(), all.scene.clone(), query)?;
    let steps: Vec<Vec<(BodyId, Move)>> = (0..frames).map(|step| all.step(step)).collect();
    let mut launches = 0;
    let mut pass = |detector: &mut OneQuery| -> Result<(Vec<Stages>, Vec<u64>, u64), Error> {
        let (mut stages, mut hashes, mut contacts) = (Vec::new(), Vec::new(), 0);
        for step in &steps {
            let inputs: Vec<(BodyId, Motion)> = step.iter().map(|(id, to)| (*id, to.input())).collect();
            let before = device.launches();
            let found = detector.frame(&inputs)?;
            launches = device.launches() - before;
            stages.push(found.stats.stages);
            hashes.push(found.hash());
            contacts += found.len() as u64;
        }
        Ok((stages, hashes, contacts))
    };
    pass(&mut detector)?;
    let (stages, hashes, contacts) = pass(&mut detector)?;
    let mean = Stages::each(|of| stages.iter().map(of).sum::<f64>() / stages.len() as f64);
    let bytes = device.bytes().0;
    drop(detector);
    let triangles = |of: fn(&&Body) -> bool| all.scene.bodies().iter().filter(of).map(Body::face_count).sum();
    let words: Vec<u64> = hashes.iter().map(|hash| hash.to_le()).collect();
    Ok(BodiesRow {
        scene: name.into(),
        device: device.name(),
        motion: query.kind(),
        bodies: all.scene.ids().count(),
        triangles: triangles(|_| true),
        moving: triangles(|body| body.kind() != BodyKind::Fixed),
        launches,
        bytes,
        place_ms: mean.place,
        frame_ms: mean.total,
        wall_ms: mean.wall,
        contacts,
        hash: format!("{:016x}", xxhash_rust::xxh3::xxh3_64(bytemuck::cast_slice(&words))),
        one_by_one_ms: one_by_one(device, all, query, &steps)?,
    })
}

/// Returns the time of a caller who runs world after world, for a scene of more than one. Each is
/// warm, as the whole scene is.
fn one_by_one(
    device: &Device,
    all: &Bodies,
    query: Query,
    steps: &[Vec<(BodyId, Move)>],
) -> Result<Option<f64>, Error> {
    let of = |id: BodyId| all.scene.get(id).and_then(|body| body.filter().environment);
    let worlds = all.scene.ids().filter_map(of).max().map_or(0, |last| last as usize + 1);
    if worlds < 2 {
        return Ok(None);
    }
    let (mut ms, asked) = (0.0, ASKED.min(worlds));
    for world in 0..asked {
        let own: Vec<BodyId> = all.scene.ids().filter(|&id| of(id) == Some(world as u32)).collect();
        let mut scene = Scene::new();
        own.iter().filter_map(|&id| all.scene.get(id)).for_each(|body| _ = scene.add(body.clone()));
        let ids: Vec<BodyId> = scene.ids().collect();
        let mut detector = OneQuery::new(device.clone(), scene, query)?;
        for counts in [false, true] {
            for step in steps {
                let named =
                    |(id, to)| own.iter().position(|own| own == id).map(|at| (ids[at], Move::input(to)));
                let inputs: Vec<(BodyId, Motion)> =
                    step.iter().filter_map(|(id, to)| named((id, to))).collect();
                let found = detector.frame(&inputs)?;
                ms += if counts { found.stats.stages.wall } else { 0.0 };
            }
        }
    }
    Ok(Some(ms * worlds as f64 / (asked * steps.len()) as f64))
}

impl Printed for BodiesRow {
    const CAPTION: &'static str =
        "Scenes of many bodies, a frame in one submission, compared with worlds one by one";
    const HEADS: &'static [&'static str] = &[
        "scene",
        "motion",
        "bodies",
        "triangles",
        "moving",
        "launches",
        "MB",
        "place ms",
        "frame ms",
        "waited ms",
        "contacts",
        "one by one ms",
        "times",
        "hash",
    ];
    fn row(&self) -> Vec<String> {
        let one_by_one = self.one_by_one_ms;
        vec![
            self.scene.clone(),
            format!("{:?}", self.motion).to_lowercase(),
            self.bodies.to_string(),
            self.triangles.to_string(),
            self.moving.to_string(),
            self.launches.to_string(),
            digits(self.bytes as f64 / 1e6),
            digits(self.place_ms),
            digits(self.frame_ms),
            digits(self.wall_ms),
            self.contacts.to_string(),
            one_by_one.map_or("-".into(), digits),
            one_by_one.map_or("-".into(), |ms| digits(ms / self.wall_ms)),
            self.hash.clone(),
        ]
    }
}
