//! Random triangles, and triangles in the form of a kernel or the oracle.

use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_lab::oracle::Triangle;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// Reproducible random numbers.
pub fn random(seed: u64) -> SmallRng {
    SmallRng::seed_from_u64(seed)
}

/// The triangle in a kernel's precision; its coordinates are rounded if they are not exact there.
pub fn corners<R: Real>(t: &Triangle) -> [Vec3<R>; 3] {
    t.map(|p| Vec3(p.map(R::of)))
}

/// The triangle for the oracle, with the kernels' coordinates.
pub fn seen<R: Real>(t: &[Vec3<R>; 3]) -> Triangle {
    t.map(|p| p.0.map(R::wide))
}

/// Corners on the grid 0..n: for a small n most triangles touch, align, coincide or collapse.
pub fn on_grid(r: &mut SmallRng, n: i32) -> Triangle {
    let mut t = [[0.0; 3]; 3];
    t.iter_mut().flatten().for_each(|x| *x = r.random_range(0..n) as f64);
    t
}

/// Corners anywhere in the unit cube.
pub fn anywhere(r: &mut SmallRng) -> Triangle {
    let mut t = [[0.0; 3]; 3];
    t.iter_mut().flatten().for_each(|x| *x = r.random::<f64>());
    t
}

/// The six orders of three corners.
pub const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];

/// Different triangles around the origin in the plane x + y + z = 0, with corners on a fine grid.
/// Sums are exact in floats, products are not, so the filters cannot detect the plane, and every
/// pair meets at the origin.
pub fn in_one_plane(count: u32) -> Vec<[[f32; 3]; 3]> {
    let mut rng = nearmiss_lab::scene::Rng::new(8);
    let mut corner = |x: f64, y: f64| {
        let [dx, dy, _] = rng.point(0.1);
        let [x, y] = [x + dx, y + dy].map(|x| (x * 1_048_576.0).round() / 1_048_576.0);
        [x as f32, y as f32, (-x - y) as f32]
    };
    (0..count).map(|_| [corner(0.5, 0.0), corner(-0.25, 0.5), corner(-0.25, -0.5)]).collect()
}
