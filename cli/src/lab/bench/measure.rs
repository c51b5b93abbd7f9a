//! One query of one case, frame after frame.

use super::cases::inputs;
use crate::args::Question;
use crate::detect::middle;
use nearmiss::Stages;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::mesh::Body;
use nearmiss::scene::Scene;
use nearmiss_lab::OneQuery;
use serde::Serialize;

/// Frames before those that count: lists grow to the demand.
pub const WARM_UP: u32 = 2;

/// Milliseconds of a frame.
type Getter = fn(&Stages) -> f64;

/// The parts of a frame by their names; `total` is a frame on the device's clock, `wall` the caller's wait, each as
/// [`Stages`] says.
pub const STAGES: [(&str, Getter); 11] = [
    ("place", |s| s.place),
    ("construct", |s| s.construct),
    ("fit", |s| s.fit),
    ("refit", |s| s.refit),
    ("traverse", |s| s.traverse),
    ("balance", |s| s.balance),
    ("narrow", |s| s.narrow),
    ("order", |s| s.order),
    (TOTAL, |s| s.total),
    ("launch", |s| s.launch),
    (WALL, |s| s.wall),
];
/// The frame.
pub const TOTAL: &str = "total";
/// The wait.
pub const WALL: &str = "wall";

/// A stage's milliseconds over all frames, to the nanosecond.
#[derive(Clone, Debug, Serialize)]
pub struct Times {
    /// Its name.
    pub stage: &'static str,
    /// In the middle; of an even number of frames the upper of two.
    pub median_ms: f64,
    /// The least.
    pub low_ms: f64,
    /// The most.
    pub high_ms: f64,
    /// The median of the earlier file, where there is one.
    pub earlier_ms: Option<f64>,
    /// The median over that; none over nothing.
    pub ratio: Option<f64>,
}

/// The figures of a query of a case.
#[derive(Clone, Debug, Serialize)]
pub struct Measured {
    /// The case.
    pub case: String,
    /// Triangles of all its bodies.
    pub triangles: usize,
    /// Its bodies.
    pub bodies: usize,
    /// The query.
    pub question: &'static str,
    /// Pairs that reached the narrow phase.
    pub candidates: u64,
    /// Contacts found.
    pub contacts: usize,
    /// Hash of the answer, sixteen hexadecimal digits: that of every frame.
    pub hash: String,
    /// The earlier file's.
    pub earlier_hash: Option<String>,
    /// Most device memory held at once.
    pub bytes: u64,
    /// Frames that counted and ran a part again for want of room: their times are too long.
    pub reruns: u64,
    /// In the order of [`STAGES`].
    pub stages: Vec<Times>,
}

impl Measured {
    /// How messages call it.
    pub fn called(&self) -> String {
        called(&self.case, self.question)
    }
}

/// How messages call a question of a case.
pub fn called(case: &str, question: &str) -> String {
    format!("{case}, {question}")
}

/// Runs the step of the scene `frames` times. Each frame is given all motions, and rebuilds its tree
/// before.
///
/// # Errors
/// Those of the device; [`Error::Bug`] where two frames differ.
pub fn measure(
    device: &Device,
    (case, scene): (&str, &Scene),
    question: Question,
    frames: u32,
) -> Result<Measured, Error> {
    let query = question.query(scene.bodies());
    let mut detector = OneQuery::new(device.clone(), scene.clone(), query)?;
    let inputs = inputs(scene);
    for _ in 0..WARM_UP {
        detector.rebuild()?;
        detector.frame(&inputs)?;
    }
    let (mut hashes, mut last, before) = (Vec::new(), [0; 2], detector.reruns());
    let mut frame = |detector: &mut OneQuery| {
        detector.rebuild()?;
        let found = detector.frame(&inputs)?;
        hashes.push(found.hash());
        last = [found.stats.candidates, found.len() as u64];
        Ok(found.stats.stages)
    };
    // Frames without marks between stages; then as many with them, for the times of stages.
    let mut all = detector.times(!device.is_gpu(), frames, &mut frame)?;
    if device.is_gpu() {
        let marked = detector.times(true, frames, &mut frame)?;
        all.iter_mut().zip(&marked).for_each(|(times, stages)| *times = times.with_stages(stages));
    }
    let hash = one(&hashes, &called(case, question.name()))?;
    Ok(Measured {
        case: case.into(),
        triangles: scene.bodies().iter().map(Body::face_count).sum(),
        bodies: scene.ids().count(),
        question: question.name(),
        candidates: last[0],
        contacts: last[1] as usize,
        hash: format!("{hash:016x}"),
        earlier_hash: None,
        bytes: device.bytes().1,
        reruns: detector.reruns() - before,
        stages: STAGES.iter().map(|(stage, of)| times(stage, all.iter().map(of).collect())).collect(),
    })
}

/// The hash that all frames have.
fn one(hashes: &[u64], called: &str) -> Result<u64, Error> {
    let first = hashes.first().copied().unwrap_or(0);
    match hashes.iter().position(|hash| *hash != first) {
        None => Ok(first),
        Some(at) => Err(Error::Bug {
            what: format!(
                "{called}: of the same step frame {at} has the answer {:016x}, frame 0 {first:016x}",
                hashes[at]
            ),
        }),
    }
}

fn times(stage: &'static str, ms: Vec<f64>) -> Times {
    let to_the_ns = |ms: f64| (ms * 1e6).round() / 1e6;
    let low = ms.iter().copied().reduce(f64::min).unwrap_or(0.0);
    let high = ms.iter().copied().reduce(f64::max).unwrap_or(0.0);
    let [median_ms, low_ms, high_ms] = [middle(ms), low, high].map(to_the_ns);
    Times { stage, median_ms, low_ms, high_ms, earlier_ms: None, ratio: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_a_median_and_its_spread() {
        let of = times("fit", vec![5.0, 1.0, 2.0000000004, 9.0, 1.5]);
        assert_eq!((of.low_ms, of.median_ms, of.high_ms), (1.0, 2.0, 9.0));
        assert_eq!(times("fit", Vec::new()).median_ms, 0.0);
    }

    #[test]
    fn a_frame_that_differs_is_named() {
        assert_eq!(one(&[7, 7, 7], "soup, near").expect("one"), 7);
        let error = one(&[7, 7, 8], "soup, near").expect_err("a planted fault").to_string();
        for part in ["soup, near", "frame 2", "0000000000000008", "0000000000000007"] {
            assert!(error.contains(part), "{part}: {error}");
        }
    }
}
