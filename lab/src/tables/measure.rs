//! One cell: an animation run in one way.

use super::frames::Frames;
use super::way::Way;
use crate::OneQuery;
use nearmiss::Stages;
use nearmiss::contacts::Contacts;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::mesh::Body;
use nearmiss::query::Query;
use nearmiss::research::{QueryExt, Solver};

/// Results of an animation run in one way.
#[derive(Clone, Debug)]
pub struct Cell {
    /// The way.
    pub way: Way,
    /// The solver.
    pub solver: Solver,
    /// Mean milliseconds of each stage over all frames.
    pub mean: Stages,
    /// Number of contacts of all frames.
    pub contacts: u64,
    /// Overlap tests of two volumes, of all frames.
    pub node_tests: u64,
    /// Triangle pairs that passed the volumes, of all frames.
    pub triangle_pairs: u64,
    /// Hash of each frame's contacts.
    pub hashes: Vec<u64>,
    /// Frames with a rerun although the warm-up had grown the lists: their times are too long.
    pub reruns: u64,
    /// Device memory held after the last frame, in bytes.
    pub bytes: u64,
}

impl Cell {
    /// Returns one hash over those of all frames.
    pub fn hash(&self) -> u64 {
        xxhash_rust::xxh3::xxh3_64(bytemuck::cast_slice(
            &self.hashes.iter().map(|h| h.to_le()).collect::<Vec<_>>(),
        ))
    }

    /// Returns the mean per frame of a sum over all frames.
    pub fn a_frame(&self, sum: u64) -> f64 {
        sum as f64 / self.hashes.len().max(1) as f64
    }
}

/// Runs all frames in one way, twice; the second run is measured. The tree is that of the first
/// frame. If `rebuild` is set, it is rebuilt at every `rebuild`th frame.
///
/// # Errors
/// Device errors.
pub fn measure(
    device: &Device,
    frames: &Frames,
    way: Way,
    query: Query,
    rebuild: Option<usize>,
) -> Result<Cell, Error> {
    let bodies = frames.bodies(way.moves)?;
    let held = device.bytes().0;
    let mut detector = OneQuery::new(device.clone(), vec![bodies[0].clone()], query)?;
    pass(&mut detector, &bodies, rebuild, |_| ())?;
    let before = detector.reruns();
    let mut all = Vec::new();
    let mut cell = Cell {
        way,
        solver: query.solver(),
        mean: Stages::default(),
        contacts: 0,
        node_tests: 0,
        triangle_pairs: 0,
        hashes: Vec::new(),
        reruns: 0,
        bytes: 0,
    };
    pass(&mut detector, &bodies, rebuild, |contacts| {
        all.push(contacts.stats.stages);
        cell.contacts += contacts.len() as u64;
        cell.node_tests += contacts.stats.overlap_tests();
        cell.triangle_pairs += contacts.stats.triangle_pairs;
        cell.hashes.push(contacts.hash());
    })?;
    cell.mean = mean(&all);
    cell.reruns = detector.reruns() - before;
    cell.bytes = device.bytes().0 - held;
    Ok(cell)
}

/// Runs every frame once, from the first on, with the first one's tree.
fn pass(
    detector: &mut OneQuery,
    bodies: &[Body],
    rebuild: Option<usize>,
    mut each: impl FnMut(&Contacts),
) -> Result<(), Error> {
    for (at, body) in bodies.iter().enumerate() {
        detector.move_to(0, body.clone())?;
        if at == 0 || rebuild.is_some_and(|every| at % every == 0) {
            detector.rebuild()?;
        }
        each(&detector.detect()?);
    }
    Ok(())
}

/// Returns each stage's mean.
pub fn mean(all: &[Stages]) -> Stages {
    Stages::each(|stage| all.iter().map(stage).fold(0.0, |sum, ms| sum + ms) / all.len().max(1) as f64)
}
