//! Construction and refit alone, for figure 6.12: no whole frame runs.

use super::frames::Frames;
use super::measure::mean;
use super::way::Way;
use crate::OneQuery;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::research::{BoundingVolume, Traversal};
use nearmiss::{Stage, Stages};

/// Milliseconds of the stages that build a tree and fit its volumes, means over all frames.
#[derive(Clone, Copy, Debug)]
pub struct Built {
    /// The volume.
    pub volume: BoundingVolume,
    /// `construct`, `fit` and `refit`; the others are zero.
    pub mean: Stages,
}

/// Builds a tree at every frame, and refits the first frame's tree at every frame. Each frame's
/// work runs twice; the second run is measured.
///
/// # Errors
/// Device errors.
pub fn build(
    device: &Device,
    frames: &Frames,
    volume: BoundingVolume,
    walk: Option<Traversal>,
) -> Result<Built, Error> {
    let bodies = frames.bodies(false)?;
    let query = Way { moves: false, volume, front: false }.query(walk);
    let mut detector = OneQuery::new(device.clone(), vec![bodies[0].clone()], query)?;
    let mut all = vec![Stages::default(); bodies.len()];
    let last = |ms: Vec<f64>| ms.last().copied().unwrap_or(0.0);
    // First the stages on the first frame's tree, then those that replace it.
    for (body, stages) in bodies.iter().zip(&mut all) {
        detector.move_to(0, body.clone())?;
        stages.fit = last(detector.repeat_stage(Stage::Fit, 2)?);
        stages.refit = last(detector.repeat_stage(Stage::Refit, 2)?);
    }
    for (body, stages) in bodies.iter().zip(&mut all) {
        detector.move_to(0, body.clone())?;
        stages.construct = last(detector.repeat_stage(Stage::Construct, 2)?);
    }
    Ok(Built { volume, mean: mean(&all) })
}
