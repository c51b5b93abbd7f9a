//! Instances: queries of rigid scenes that place no vertex in the scene, or only those of candidates. The judge is the
//! path by tiles, which places all: both must list the same pairs.

mod alike;
mod lent;
mod lists;
mod mixed;
mod mixed_lent;
mod mixed_used;
mod motion;
mod touching;
mod ways;

use nearmiss::mesh::Positions;
use nearmiss::research::{BroadPhase, QueryExt};
use nearmiss::scene::{BodyId, CollisionFilter, Motion, Pose, Scene};
use nearmiss::{Body, Detector, Device, Mesh, Query};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::engine;
use support::solids::{cuboid, rotation, unit_sphere};

/// The query that reads instances if it can.
fn query() -> Query {
    Query::discrete()
}

/// The same, with all vertices placed.
fn judge() -> Query {
    Query::discrete().with_broad_phase(BroadPhase::Tiles)
}

/// Whether the last frames of a detector's query read instances.
fn reads_instances(detector: &mut Detector) -> bool {
    let plan = detector.plan(&query()).expect("a plan");
    plan.frame.iter().flat_map(|stage| &stage.kernels).any(|kernel| kernel.kernel == "traverse_instances")
}

/// The answers of both, on detectors of their own that keep their memory from frame to frame.
struct Both {
    own: Detector,
    judge: Detector,
}

impl Both {
    fn new(device: &Device, scene: &Scene) -> Both {
        let of = |device: Device| Detector::new(device, scene.clone()).expect("a detector");
        Both { own: of(device.clone()), judge: of(engine()) }
    }

    /// Moves bodies and compares answers; the number of rows.
    fn alike(&mut self, motions: &[(BodyId, Motion)]) -> Result<usize, String> {
        for detector in [&mut self.own, &mut self.judge] {
            detector.update(motions).map_err(|error| error.to_string())?;
        }
        let found = self.own.query(&query()).map_err(|error| error.to_string())?;
        let expected = self.judge.query(&judge()).map_err(|error| error.to_string())?;
        if found.hash() != expected.hash() || found.rows != expected.rows {
            return Err(format!("{} rows, the judge has {}", found.len(), expected.len()));
        }
        Ok(found.len())
    }
}

/// A sphere about a place, by rings and twice as many meridians, with some radius.
fn sphere(rings: u32, radius: f64, about: [f64; 3]) -> Mesh {
    let (unit, faces) = unit_sphere(rings);
    let points = unit.iter().map(|p| [0, 1, 2].map(|axis| about[axis] + radius * p[axis])).collect();
    Mesh::new("sphere", Positions::F64(points), faces).expect("a mesh")
}

/// A box of that size.
fn cube(size: f64) -> Mesh {
    cuboid([0.0; 3], [size; 3])
}
