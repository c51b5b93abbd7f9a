//! Boxes, spheres, and rotations of them.

use nearmiss::Mesh;
use nearmiss::mesh::Positions;
use rand::Rng;
use rand::rngs::SmallRng;
use std::f64::consts::PI;

/// The unit sphere about the origin, by rings and twice as many meridians: its points, and its
/// `4 rings (rings - 1)` triangles.
pub fn unit_sphere(rings: u32) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let around = 2 * rings;
    let point = |ring: u32, k: u32| {
        let (up, turn) = (PI * f64::from(ring) / f64::from(rings), PI * f64::from(k) / f64::from(rings));
        [up.sin() * turn.cos(), up.sin() * turn.sin(), up.cos()]
    };
    let mut points = vec![point(0, 0), point(rings, 0)];
    points.extend((1..rings).flat_map(|ring| (0..around).map(move |k| point(ring, k))));
    let at = |ring: u32, k: u32| match ring {
        0 => 0,
        ring if ring == rings => 1,
        ring => 2 + (ring - 1) * around + k % around,
    };
    let quads = (0..rings).flat_map(|ring| (0..around).map(move |k| (ring, k)));
    let triangles = quads.flat_map(|(ring, k)| {
        let [a, b, c, d] = [at(ring, k), at(ring + 1, k), at(ring + 1, k + 1), at(ring, k + 1)];
        [[a, b, c], [a, c, d]]
    });
    (points, triangles.filter(|[a, b, c]| a != b && b != c && a != c).collect())
}

/// A box between two corners, in doubles.
pub fn cuboid(low: [f64; 3], high: [f64; 3]) -> Mesh {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] });
    Mesh::new("box", Positions::F64((0..8).map(corner).collect()), box_faces()).expect("a mesh")
}

/// Any rotation.
pub fn rotation(rng: &mut SmallRng) -> [f64; 4] {
    let q: [f64; 4] = [(); 4].map(|()| rng.random_range(-1.0..1.0));
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / length)
}

/// The faces of a box whose corner `k` is at bit 0, 1 and 2 of `k`.
pub fn box_faces() -> Vec<[u32; 3]> {
    let quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}
