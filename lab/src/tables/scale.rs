//! Cost of a frame by the number of triangles, on one device and divided among several.

use super::text::{Printed, digits};
use crate::OneQueryOnSeveral;
use crate::scene;
use nearmiss::Stages;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::query::{Query, QueryKind};
use serde::Serialize;
use std::time::Instant;

/// A size, with one query.
#[derive(Clone, Debug, Serialize)]
pub struct ScaleRow {
    /// The scene.
    pub scene: String,
    /// Triangles.
    pub triangles: usize,
    /// Kind of the query.
    pub motion: QueryKind,
    /// Number of devices that share the work.
    pub devices: usize,
    /// Whether they are one machine, run one after another as if each were alone.
    pub in_turn: bool,
    /// Median milliseconds of the slowest device: volumes.
    pub fit_ms: f64,
    /// Milliseconds of the traversal.
    pub traverse_ms: f64,
    /// Milliseconds of the narrow phase.
    pub narrow_ms: f64,
    /// Milliseconds of the frame.
    pub frame_ms: f64,
    /// Median milliseconds that a caller waits for the answer of all devices; `None` if they are one
    /// machine in turn.
    pub wait_ms: Option<f64>,
    /// Speed relative to one device: at most the number of devices. `None` for one device.
    pub speedup: Option<f64>,
    /// Growth of the frame's time with triangles, as an exponent relative to the size before.
    /// `None` for the first size.
    pub exponent: Option<f64>,
    /// Bytes that all devices hold.
    pub bytes: u64,
    /// Bytes of positions that each device receives, both ends of a step.
    pub positions: u64,
    /// Bytes of the answer that the host receives.
    pub answer: u64,
    /// Tiles of 32 triangles that devices met outside of their own, all devices together. Hosts
    /// without the other tiles would receive them.
    pub met_beyond: u64,
    /// Number of pairs that the narrow phase tested.
    pub candidates: u64,
    /// Number of contacts.
    pub contacts: usize,
    /// Hash of the answer: equal to that of one device.
    pub hash: String,
}

/// Warm-up frames: lists grow, and measured times divide the work.
const WARM_UP: u32 = 4;

/// Runs a draped cloth of each size, at one time and in motion. It runs on the first device, then
/// on all of them. `in_turn` is whether they are one machine.
///
/// # Errors
/// Device errors; [`Error::Bug`] if several devices find another answer than one.
pub fn scale(
    devices: &[Device],
    in_turn: bool,
    sizes: &[usize],
    frames: u32,
    mut row: impl FnMut(ScaleRow),
) -> Result<(), Error> {
    let mut before: Vec<(QueryKind, usize, usize, f64)> = Vec::new();
    for &size in sizes {
        let body = scene::draped(size)?;
        for query in [Query::discrete(), Query::continuous()] {
            let mut of_one: Option<ScaleRow> = None;
            let counts = if devices.len() > 1 { vec![1, devices.len()] } else { vec![1] };
            for count in counts {
                let held =
                    || devices[..if in_turn { 1 } else { count }].iter().map(|device| device.bytes().0);
                let others: u64 = held().sum();
                let detector = OneQueryOnSeveral::new(devices[..count].to_vec(), body.clone(), query)?;
                let mut detector = if in_turn { detector.in_turn() } else { detector };
                for _ in 0..WARM_UP {
                    detector.detect()?;
                }
                let (mut waits, mut stages, mut last) = (Vec::new(), Vec::new(), None);
                for _ in 0..frames {
                    // A caller who keeps the last answer alone: its memory is used again.
                    drop(last.take());
                    let start = Instant::now();
                    let found = detector.detect()?;
                    waits.push(start.elapsed().as_secs_f64() * 1e3);
                    stages.push(found.stats.stages);
                    last = Some(found);
                }
                let Some(last) = last else { return Ok(()) };
                let median = |mut ms: Vec<f64>| {
                    ms.sort_by(f64::total_cmp);
                    ms[ms.len() / 2]
                };
                let of = |stage: fn(&Stages) -> f64| median(stages.iter().map(stage).collect());
                let frame_ms = of(|s| s.total);
                let (motion, triangles) = (query.kind(), body.face_count());
                let hash = format!("{:016x}", last.hash());
                if let Some(one) =
                    of_one.as_ref().filter(|one| one.hash != hash || one.candidates != last.stats.candidates)
                {
                    return Err(Error::Bug {
                        what: format!(
                            "{triangles} triangles, {motion:?}: {count} devices found {hash} of {} candidates, one {} of {}",
                            last.stats.candidates, one.hash, one.candidates
                        ),
                    });
                }
                let smaller = before.iter().rfind(|(kind, devices, ..)| (*kind, *devices) == (motion, count));
                let exponent = smaller
                    .map(|&(_, _, size, ms)| (frame_ms / ms).ln() / (triangles as f64 / size as f64).ln());
                let each = if motion.is_at_rest() { 16 } else { 32 };
                let own = ScaleRow {
                    scene: "draped".into(),
                    triangles,
                    motion,
                    devices: count,
                    in_turn: in_turn && count > 1,
                    fit_ms: of(|s| s.fit + s.refit),
                    traverse_ms: of(|s| s.traverse),
                    narrow_ms: of(|s| s.narrow),
                    frame_ms,
                    wait_ms: (!in_turn || count == 1).then(|| median(waits)),
                    speedup: of_one.as_ref().map(|one| one.frame_ms / frame_ms),
                    exponent,
                    bytes: held().sum::<u64>() - others,
                    positions: each * body.vertex_count() as u64,
                    answer: (last.len() * if motion.is_at_rest() { 8 } else { 32 }) as u64,
                    met_beyond: detector.met_beyond()?.iter().sum(),
                    candidates: last.stats.candidates,
                    contacts: last.len(),
                    hash,
                };
                before.push((motion, count, triangles, frame_ms));
                of_one.get_or_insert_with(|| own.clone());
                row(own);
            }
        }
    }
    Ok(())
}

impl Printed for ScaleRow {
    const CAPTION: &'static str = "A frame by the number of triangles, and divided among devices: the slowest of them; bytes of them all";
    const HEADS: &'static [&'static str] = &[
        "scene",
        "motion",
        "triangles",
        "devices",
        "fit ms",
        "traverse ms",
        "narrow ms",
        "frame ms",
        "wait ms",
        "times",
        "exponent",
        "MB",
        "MB in",
        "MB out",
        "tiles met beyond",
        "candidates",
        "contacts",
        "hash",
    ];
    fn row(&self) -> Vec<String> {
        let maybe = |x: Option<f64>| x.map_or("-".into(), digits);
        vec![
            self.scene.clone(),
            format!("{:?}", self.motion).to_lowercase(),
            self.triangles.to_string(),
            format!("{}{}", self.devices, if self.in_turn { " in turn" } else { "" }),
            digits(self.fit_ms),
            digits(self.traverse_ms),
            digits(self.narrow_ms),
            digits(self.frame_ms),
            maybe(self.wait_ms),
            maybe(self.speedup),
            maybe(self.exponent),
            digits(self.bytes as f64 / 1e6),
            digits(self.positions as f64 / 1e6),
            digits(self.answer as f64 / 1e6),
            self.met_beyond.to_string(),
            self.candidates.to_string(),
            self.contacts.to_string(),
            self.hash.clone(),
        ]
    }
}
