//! Savings of a front by the amount of motion: two frames, and every fraction of the step between
//! them.

use super::figures::Paper;
use super::frames::Frames;
use super::way::Way;
use crate::OneQuery;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::Query;
use nearmiss::research::{QueryExt, QueueShape, Traversal};
use serde::Serialize;

/// Fractions of the step.
pub const PARTS: [f64; 9] =
    [0.0, 1.0 / 64.0, 1.0 / 32.0, 1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0, 3.0 / 4.0, 1.0];
/// Number of runs in a mean time, after one warm-up.
const RUNS: usize = 3;

/// Cost of the frame after a fraction of the step, in one way.
#[derive(Clone, Debug, Serialize)]
pub struct FrontRow {
    pub scene: String,
    pub triangles: usize,
    pub device: String,
    pub motion: &'static str,
    pub bv: &'static str,
    pub front: bool,
    /// The fraction of the step, 0 to 1.
    pub part: f64,
    /// Overlap tests of two volumes.
    pub node_tests: u64,
    /// Milliseconds of traversal with balancing.
    pub traverse_ms: f64,
    /// Milliseconds of the whole frame.
    pub frame_ms: f64,
    /// Node tests relative to those of the same way without the front.
    pub tests_ratio: f64,
    /// The same for the traversal's time.
    pub time_ratio: f64,
    pub hash: String,
}

/// Runs the step of the first two frames, fraction by fraction, in every way of `ways`; those
/// without a front come first. Without a front a frame is independent of the one before. With one
/// it starts at the front of the unmoved first frame.
///
/// # Errors
/// Device errors; [`Error::Bug`] if two ways give an exact solver different contacts.
pub fn front(
    paper: &Paper,
    device: &Device,
    frames: &Frames,
    ways: &[Way],
    walk: Option<Traversal>,
) -> Result<Vec<FrontRow>, Error> {
    let mut rows: Vec<FrontRow> = Vec::new();
    for &way in ways {
        let mut query = way.query(walk);
        if walk.is_none() && !way.front {
            // The same kernels, from the roots: only the front differs.
            query = query.with_traversal(Traversal::Queue(QueueShape::native()));
        }
        for part in PARTS {
            let (first, second) = step(frames, way.moves, part)?;
            let mut row = one(paper, device, way, query, [first, second])?;
            row.part = part;
            let alike =
                |r: &&FrontRow| !r.front && r.part == part && r.motion == row.motion && r.bv == row.bv;
            let base = rows.iter().find(alike);
            if let Some(base) = base {
                row.tests_ratio = ratio(row.node_tests as f64, base.node_tests as f64);
                row.time_ratio = ratio(row.traverse_ms, base.traverse_ms);
                if base.hash != row.hash && query.solver() == nearmiss::research::Solver::Exact {
                    let what = format!(
                        "{}, {way}, part {part} of a step: contacts differ from those without a front",
                        paper.scene
                    );
                    return Err(Error::Bug { what });
                }
            }
            rows.push(row);
        }
    }
    Ok(rows)
}

fn ratio(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 1.0 }
}

/// Returns the bodies before and after the fraction of the step.
fn step(frames: &Frames, moves: bool, part: f64) -> Result<(Body, Body), Error> {
    // There are at least two frames.
    let (t0, t1) = (&frames.meshes[0], &frames.meshes[1]);
    let moved = between(t0, t1, part)?;
    Ok(if moves {
        (Body::moving(t0.clone(), t0.clone())?, Body::moving(t0.clone(), moved)?)
    } else {
        (Body::deformable(t0.clone()), Body::deformable(moved))
    })
}

/// Returns the first mesh, moved by a fraction of the way to the second, rounded to its precision.
fn between(t0: &Mesh, t1: &Mesh, part: f64) -> Result<Mesh, Error> {
    let (a, b) = (t0.positions().to_f64(), t1.positions().to_f64());
    let points = a.iter().zip(&b).map(|(a, b)| [0, 1, 2].map(|axis| a[axis] + part * (b[axis] - a[axis])));
    let positions = if t0.positions().is_f64() {
        Positions::F64(points.collect())
    } else {
        Positions::F32(points.map(|p| p.map(|x| x as f32)).collect())
    };
    Mesh::new(t0.name(), positions, t0.faces().to_vec())
}

fn one(paper: &Paper, device: &Device, way: Way, query: Query, bodies: [Body; 2]) -> Result<FrontRow, Error> {
    let [first, second] = bodies;
    let mut detector = OneQuery::new(device.clone(), vec![first.clone()], query)?;
    let (mut traverse_ms, mut frame_ms, mut tests, mut hash) = (0.0, 0.0, 0, 0);
    for run in 0..=RUNS {
        detector.move_to(0, first.clone())?;
        detector.rebuild()?;
        detector.detect()?;
        detector.move_to(0, second.clone())?;
        let contacts = detector.detect()?;
        if run > 0 {
            traverse_ms += (contacts.stats.stages.traverse + contacts.stats.stages.balance) / RUNS as f64;
            frame_ms += contacts.stats.stages.total / RUNS as f64;
        }
        (tests, hash) = (contacts.stats.overlap_tests(), contacts.hash());
    }
    Ok(FrontRow {
        scene: paper.scene.clone(),
        triangles: paper.triangles,
        device: paper.device.clone(),
        motion: way.asked(),
        bv: way.volume.name(),
        front: way.front,
        part: 0.0,
        node_tests: tests,
        traverse_ms,
        frame_ms,
        tests_ratio: 1.0,
        time_ratio: 1.0,
        hash: format!("{hash:016x}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_a_step_lies_between() {
        let mesh = |x: f32| {
            Mesh::new(
                "m",
                Positions::F32(vec![[x, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
                vec![[0, 1, 2]],
            )
            .expect("a mesh")
        };
        let part = |part| between(&mesh(0.0), &mesh(8.0), part).expect("a mesh").positions().get_f64(0);
        assert_eq!(part(0.0), Some([0.0, 0.0, 1.0]));
        assert_eq!(part(0.25), Some([2.0, 0.0, 1.0]));
        assert_eq!(part(1.0), Some([8.0, 0.0, 1.0]));
    }
}
