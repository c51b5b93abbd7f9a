//! A sphere of triangles: an octahedron with subdivided sides, projected to radius 1.

use std::collections::HashMap;

/// Points on the unit sphere, and `8 frequency^2` outward triangles with common vertices.
pub(super) struct Sphere {
    pub points: Vec<[f64; 3]>,
    pub faces: Vec<[u32; 3]>,
}

/// Makes the sphere whose octahedron has `frequency` small edges along each edge.
pub(super) fn sphere(frequency: u32) -> Sphere {
    let n = frequency as i64;
    let mut sphere = Sphere { points: Vec::new(), faces: Vec::new() };
    let mut ids: HashMap<[i64; 3], u32> = HashMap::new();
    for octant in 0..8 {
        let sign = [0, 1, 2].map(|axis| 1 - 2 * ((octant >> axis) & 1));
        let mirrored = sign.iter().product::<i64>() < 0;
        let mut face = |corners: [[i64; 3]; 3]| {
            let mut face = corners.map(|c| {
                let lattice = [c[0] * sign[0], c[1] * sign[1], c[2] * sign[2]];
                *ids.entry(lattice).or_insert_with(|| {
                    sphere.points.push(unit(lattice.map(|x| x as f64)));
                    sphere.points.len() as u32 - 1
                })
            });
            if mirrored {
                face.swap(1, 2);
            }
            sphere.faces.push(face);
        };
        // Points (i, j, k) with i + j + k = n: one triangle above each (i, j) of n - 1, one below
        // each of n - 2.
        for i in 0..n {
            for j in 0..n - i {
                let k = n - 1 - i - j;
                face([[i + 1, j, k], [i, j + 1, k], [i, j, k + 1]]);
                if k > 0 {
                    face([[i, j + 1, k], [i + 1, j, k], [i + 1, j + 1, k - 1]]);
                }
            }
        }
    }
    sphere
}

fn unit(p: [f64; 3]) -> [f64; 3] {
    let length = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
    p.map(|x| x / length)
}
