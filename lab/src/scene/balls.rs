//! Balls that fly through each other.

use super::soup::add;
use super::sphere::sphere;
use super::{Builder, Rng, cube_root_up, room};
use nearmiss::Error;
use nearmiss::mesh::Body;

/// Triangles of a ball of the usual subdivision (3).
const USUAL: usize = 512;

/// Makes `count` balls of radius 1, each of `8 * 4^subdivisions` triangles. They only translate, as
/// in the n-body scene of UNC. They start at random in a cube of which they fill about a quarter,
/// some overlapping. Each moves by a random vector of up to 1/2 along each axis: about five edges
/// of a ball of subdivision 3.
///
/// # Errors
/// If there are more than [`super::MAX_TRIANGLES`].
pub fn balls(count: usize, subdivisions: u32, seed: u64) -> Result<Body, Error> {
    let of_each = 8u64.saturating_mul(4u64.saturating_pow(subdivisions));
    room("balls", of_each.saturating_mul(count as u64))?;
    let ball = sphere(if count == 0 { 1 } else { 1 << subdivisions });
    let half = 1.3 * cube_root_up(count) as f64;
    let mut rng = Rng::new(seed);
    let mut scene = Builder::default();
    for _ in 0..count {
        let (centre, step) = (rng.point(half), rng.point(0.5));
        let first = scene.t0.len() as u32;
        for &p in &ball.points {
            let p = add(p, centre);
            scene.moving(p, add(p, step));
        }
        scene.faces.extend(ball.faces.iter().map(|face| face.map(|i| i + first)));
    }
    scene.body("balls")
}

/// Returns the count and subdivisions for about `triangles`: at least eight balls if possible, of
/// the usual subdivision if there are enough triangles.
pub(super) fn nearest(triangles: usize) -> (usize, u32) {
    let mut of_each = USUAL;
    let mut subdivisions = 3;
    while subdivisions > 0 && triangles < 8 * of_each {
        of_each /= 4;
        subdivisions -= 1;
    }
    (triangles.saturating_add(of_each / 2).div_euclid(of_each).max(1), subdivisions)
}
