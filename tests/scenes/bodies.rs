//! Pairs of bodies that share a point, and distances of bodies. The judge takes all pairs of
//! triangles: exact signs, and distances in f64.

mod known;
mod laws;
mod nearest;
mod refused;

use nearmiss::contacts::NearestTriangles;
use nearmiss::device::emulator::{Emulator, Mode};
use nearmiss::mesh::Positions;
use nearmiss::query::{BodyDistances, BodyPairs};
use nearmiss::scene::{BodyId, BodyKind, CollisionFilter, Motion, Pose, Scene};
use nearmiss::{Body, Detector, Device, Discrete, Distance, Mesh};
use nearmiss_kernels::math::{Vec3, rigid};
use nearmiss_kernels::prim::nearest::Nearest;
use nearmiss_kernels::prim::tri_tri::{Certain, meets};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::solids::{cuboid, rotation, unit_sphere};
use support::{ORDERS, engine};

/// The corners of a triangle.
type Corners = [Vec3<f64>; 3];

/// The placed triangles of a body.
fn placed(body: &Body) -> Vec<Corners> {
    let points: Vec<Vec3<f64>> = body.positions_t0().to_f64().into_iter().map(Vec3).collect();
    let points: Vec<Vec3<f64>> = if body.kind() == BodyKind::Rigid {
        let Pose { rotation, translation } = body.poses()[0];
        let length = rotation.iter().map(|q| q * q).sum::<f64>().sqrt();
        let rows = rigid::rows(rotation.map(|q| q / length));
        points.iter().map(|&point| rigid::moved(&rows, &translation, point)).collect()
    } else {
        points
    };
    body.faces().iter().map(|face| face.map(|v| points[v as usize])).collect()
}

/// Whether filters allow two bodies to meet, and one of them moves.
fn allowed(a: &Body, b: &Body) -> bool {
    let (p, q) = (a.filter(), b.filter());
    let together = p.environment.zip(q.environment).is_none_or(|(p, q)| p == q);
    let moves = a.kind() != BodyKind::Fixed || b.kind() != BodyKind::Fixed;
    moves && together && p.group & q.mask != 0 && q.group & p.mask != 0
}

/// The least distance of two bodies, its triangles, and whether they share a point.
type Truth = ([usize; 2], f64, [u32; 2]);

/// The truth of every pair of bodies.
fn truth(bodies: &[Body]) -> Vec<Truth> {
    let triangles: Vec<Vec<Corners>> = bodies.iter().map(placed).collect();
    let mut all = Vec::new();
    for (i, a) in bodies.iter().enumerate() {
        for (j, b) in bodies.iter().enumerate().skip(i + 1) {
            if allowed(a, b) {
                let least = least(&triangles[i], &triangles[j]);
                all.extend(least.map(|(distance, own)| ([i, j], distance, own)));
            }
        }
    }
    all
}

/// The least distance of two sets of triangles, and the first triangles that have it.
fn least(a: &[Corners], b: &[Corners]) -> Option<(f64, [u32; 2])> {
    let mut best: Option<(f64, [u32; 2])> = None;
    for (i, p) in a.iter().enumerate() {
        for (j, q) in b.iter().enumerate() {
            let touch = meets::<f64, Certain>(p, q) != Some(false);
            let distance = if touch { 0.0 } else { Nearest::of(p, q).distance.max(f64::from_bits(1)) };
            if best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, [i as u32, j as u32]));
            }
        }
    }
    best
}

/// The fault of a list of pairs, if it has one.
fn fault_of_pairs(found: &[[usize; 2]], truth: &[Truth], first: usize) -> Result<(), String> {
    let meeting = truth.iter().filter(|(_, distance, _)| *distance == 0.0).map(|(bodies, ..)| *bodies);
    let expected: Vec<[usize; 2]> = meeting.take(first).collect();
    if found == expected { Ok(()) } else { Err(format!("{found:?}, truly {expected:?}")) }
}

/// The fault of a list of distances, if it has one.
fn fault_of_distances(found: &[NearestTriangles], truth: &[Truth], within: f64) -> Result<(), String> {
    let expected: Vec<&Truth> = truth.iter().filter(|(_, distance, _)| *distance <= within).collect();
    if found.len() != expected.len() {
        return Err(format!("{} rows within {within}, truly {}", found.len(), expected.len()));
    }
    for (row, (bodies, distance, triangles)) in found.iter().zip(expected) {
        let own = row.bodies.map(BodyId::index);
        if own != *bodies || row.distance.to_bits() != distance.to_bits() || row.triangles != *triangles {
            return Err(format!("{row:?}, truly {bodies:?} {distance:e} {triangles:?}"));
        }
        let [p, q] = row.points;
        let apart = (0..3).map(|k| p[k] - q[k]).fold(0.0, f64::hypot);
        let largest = p.iter().chain(&q).fold(0.0f64, |most, x| most.max(x.abs()));
        if (apart - row.distance).abs() > 1e-12 * (largest + row.distance) {
            return Err(format!("points {apart:e} apart: {row:?}"));
        }
    }
    Ok(())
}

/// The bodies of each pair that an answer lists.
fn pairs_of(detector: &mut Detector, query: BodyPairs) -> Result<Vec<[usize; 2]>, String> {
    let found = detector.query(&query).map_err(|error| error.to_string())?;
    Ok(found.iter().map(|pair| pair.bodies.map(BodyId::index)).collect())
}

/// Compares all queries of a detector with the judge; the numbers of pairs and of distances.
fn judged(detector: &mut Detector, limits: &[f64]) -> Result<[usize; 2], String> {
    let truth = truth(detector.scene().bodies());
    let pairs = pairs_of(detector, BodyPairs::default())?;
    fault_of_pairs(&pairs, &truth, usize::MAX)?;
    for first in [1, 2, 1_000] {
        fault_of_pairs(&pairs_of(detector, BodyPairs::first(first))?, &truth, first as usize)?;
    }
    let mut rows = 0;
    for &within in limits {
        let found = detector.query(&BodyDistances::within(within)).map_err(|error| error.to_string())?;
        fault_of_distances(&found, &truth, within).map_err(|fault| format!("within {within}: {fault}"))?;
        rows += found.len();
    }
    Ok([pairs.len(), rows])
}

/// A sphere about the origin, by rings and twice as many meridians.
fn sphere(rings: u32, radius: f64) -> Mesh {
    let (unit, faces) = unit_sphere(rings);
    let points = unit.iter().map(|p| p.map(|x| radius * x)).collect();
    Mesh::new("sphere", Positions::F64(points), faces).expect("a mesh")
}

/// A mesh moved by a shift.
fn moved(mesh: &Mesh, by: [f64; 3]) -> Mesh {
    let points = mesh.positions().to_f64().iter().map(|p| [0, 1, 2].map(|k| p[k] + by[k])).collect();
    Mesh::new("moved", Positions::F64(points), mesh.faces().to_vec()).expect("a mesh")
}
