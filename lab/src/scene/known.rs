//! Scenes with a known answer.

use super::{Builder, room, square_root};
use nearmiss::Error;
use nearmiss::mesh::Body;

/// Makes two grids of triangles, `4 cells^2` in all, still. The floor has `cells` by `cells` unit
/// squares in z = 0. A wall of 1 by `cells` unit squares stands across the middle of each of its
/// rows. Each wall is shifted by a quarter along its row.
///
/// The discrete answer is [`grid_pairs`]. All coordinates are multiples of 1/4, exact in floats.
/// Every test of the answer has a margin of 1/4 (a third would not be exact). No rounding, volume
/// or order may change it.
///
/// # Errors
/// If there are more than [`super::MAX_TRIANGLES`].
pub fn grid(cells: u32) -> Result<Body, Error> {
    room("grid", u64::from(cells).saturating_mul(u64::from(cells)).saturating_mul(4))?;
    let mut scene = Builder::default();
    let line = |from: f64| (0..=cells).map(move |i| from + f64::from(i));
    let rows: Vec<Vec<u32>> =
        line(0.0).map(|y| line(0.0).map(|x| scene.vertex([x, y, 0.0])).collect()).collect();
    rows.windows(2).for_each(|pair| strip(&mut scene, &pair[0], &pair[1]));
    for y in line(0.5).take(cells as usize) {
        let [low, high] =
            [-0.5, 0.5].map(|z| line(0.25).map(|x| scene.vertex([x, y, z])).collect::<Vec<u32>>());
        strip(&mut scene, &low, &high);
    }
    scene.body("grid")
}

/// Adds two triangles for each square between two rows of vertices.
pub(super) fn strip(scene: &mut Builder, low: &[u32], high: &[u32]) {
    scene.faces.extend(strip_faces(low, high));
}

/// Returns two triangles for each square between two rows of vertices.
pub(super) fn strip_faces<'a>(low: &'a [u32], high: &'a [u32]) -> impl Iterator<Item = [u32; 3]> + 'a {
    low.windows(2).zip(high.windows(2)).flat_map(|(l, h)| [[l[0], l[1], h[1]], [l[0], h[1], h[0]]])
}

/// Returns how many pairs of triangles of [`grid`] meet and share no vertex: `cells (4 cells - 1)`.
///
/// A wall meets the floor in a line. The floor's triangles cut it at multiples of 1/2, the wall's
/// at odd multiples of 1/4. The common part, from 1/4 to `cells`, has `4 cells - 2` cuts, so one
/// pair more.
pub fn grid_pairs(cells: u32) -> u64 {
    let cells = u64::from(cells);
    cells.saturating_mul((4 * cells).saturating_sub(1))
}

/// Returns the `cells` for about `triangles`.
pub(super) fn nearest(triangles: usize) -> u32 {
    square_root(triangles as f64 / 4.0)
}

/// Returns the whole number nearest to `x`, at least 1.
pub(super) fn at_least_one(x: f64) -> u32 {
    (x + 0.5).floor().clamp(1.0, 1e9) as u32
}

/// Makes `n` triangles with the same three corners, each with its own vertices: all `n (n - 1) / 2`
/// pairs meet. Still.
///
/// # Errors
/// If there are more than [`super::MAX_TRIANGLES`].
pub fn identical(n: usize) -> Result<Body, Error> {
    repeated("identical", n, |_| [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
}

/// Makes `n` parallel triangles with centroids on the x axis, 1 apart: no pair meets. Still.
///
/// Exact up to 2^24 triangles; past that, floats merge neighbours.
///
/// # Errors
/// If there are more than [`super::MAX_TRIANGLES`].
pub fn line(n: usize) -> Result<Body, Error> {
    repeated("line", n, |i| [[i as f64, 1.0, 0.0], [i as f64, -1.0, 1.0], [i as f64, 0.0, -1.0]])
}

/// Makes one triangle: no pair. Still.
///
/// # Errors
/// None in practice.
pub fn single() -> Result<Body, Error> {
    repeated("single", 1, |_| [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
}

fn repeated(name: &str, n: usize, corners: impl Fn(usize) -> [[f64; 3]; 3]) -> Result<Body, Error> {
    room(name, n as u64)?;
    let mut scene = Builder::default();
    for i in 0..n {
        let face = corners(i).map(|p| scene.vertex(p));
        scene.faces.push(face);
    }
    scene.body(name)
}
