//! Random triangles.

use super::{Builder, Rng, cube_root_up, room};
use nearmiss::Error;
use nearmiss::mesh::{Body, Mesh};

/// Makes exactly `n` random triangles in the unit cube, no two with a common vertex. They are
/// still, or each corner moves on its own. Their size decreases with the cube root of `n`, so that
/// each meets a few others for any `n`.
///
/// # Errors
/// If there are more than [`super::MAX_TRIANGLES`].
pub fn soup(n: usize, seed: u64, moving: bool) -> Result<Body, Error> {
    let name = if moving { "soup-moving" } else { "soup" };
    room(name, n as u64)?;
    let size = 0.75 / cube_root_up(n) as f64;
    let mut rng = Rng::new(seed);
    let mut scene = Builder::default();
    for _ in 0..n {
        let centre = rng.point(0.5).map(|x| x + 0.5);
        let face = [(); 3].map(|()| {
            let p = add(centre, rng.point(size));
            if moving { scene.moving(p, add(p, rng.point(0.5 * size))) } else { scene.vertex(p) }
        });
        scene.faces.push(face);
    }
    scene.body(name)
}

/// The moving soup, of which one triangle in three stays. The others are threads of two edges, and
/// three points, by turns.
///
/// # Errors
/// As [`soup`].
pub fn threads(n: usize, seed: u64) -> Result<Body, Error> {
    let loose = |mesh: Mesh| {
        let (mut faces, mut edges, mut points) = (Vec::new(), Vec::new(), Vec::new());
        for (at, &[a, b, c]) in mesh.faces().iter().enumerate() {
            match at % 3 {
                0 => faces.push([a, b, c]),
                1 => edges.extend([[a, b], [b, c]]),
                _ => points.extend([a, b, c]),
            }
        }
        let (name, positions, _) = mesh.into_parts();
        Mesh::new(name, positions, faces)?.with_edges(edges)?.with_points(points)
    };
    // A moving soup has two frames.
    let mut ends = soup(n, seed, true)?.frames();
    let end = loose(ends.swap_remove(1))?;
    Body::moving(loose(ends.swap_remove(0))?, end)
}

pub(super) fn add(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [p[0] + q[0], p[1] + q[1], p[2] + q[2]]
}
