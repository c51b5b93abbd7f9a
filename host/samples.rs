//! Bodies and random words for unit tests. The lab has more scenes, but a unit test that used it
//! would link this crate twice.

use crate::mesh::{Mesh, Positions};
use crate::scene::Body;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// Random words that depend on `seed` alone.
pub fn words(seed: u64) -> impl Iterator<Item = u64> {
    let mut rng = SmallRng::seed_from_u64(seed);
    std::iter::repeat_with(move || rng.random())
}

/// A right triangle with sides of 3, 4 and 5 times that size, in doubles.
pub fn right_triangle(size: f64) -> Mesh {
    let points = vec![[0.0; 3], [3.0 * size, 0.0, 0.0], [0.0, 4.0 * size, 0.0]];
    Mesh::new("test", Positions::F64(points), vec![[0, 1, 2]]).expect("a mesh")
}

/// A triangle at that height.
pub fn level(z: f32) -> Mesh {
    let points = vec![[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
    Mesh::new("cloth", Positions::F32(points), vec![[0, 1, 2]]).expect("a mesh")
}

/// `n` random triangles in the unit cube, so large that each meets a few others; still, or each corner moving on its own.
pub fn soup(n: usize, seed: u64, moving: bool) -> Body {
    let size = 0.75 / (n as f32).cbrt();
    let mut rng = SmallRng::seed_from_u64(seed);
    let mut near = |p: [f32; 3], size: f32| p.map(|x| x + rng.random_range(-size..size));
    let corners = |_| {
        let centre = near([0.5; 3], 0.5);
        [(); 3].map(|()| near(centre, size))
    };
    let t0: Vec<[f32; 3]> = (0..n).flat_map(corners).collect();
    let t1: Vec<[f32; 3]> = t0.iter().map(|&p| near(p, 0.5 * size)).collect();
    let frame = |positions| {
        let faces = (0..n as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Mesh::new("soup", Positions::F32(positions), faces).expect("a mesh")
    };
    if moving { Body::moving(frame(t0), frame(t1)).expect("a body") } else { Body::deformable(frame(t0)) }
}

/// The soup, of which every second triangle is an edge of no face and a point.
pub fn loose(n: usize, seed: u64, moving: bool) -> Body {
    let cut = |mesh: Mesh| {
        let (name, positions, all) = mesh.into_parts();
        let of = |odd: usize| all.iter().skip(odd).step_by(2);
        let (edges, points) = of(1).map(|&[a, b, c]| ([a, b], c)).unzip();
        let mesh = Mesh::new(name, positions, of(0).copied().collect()).expect("a mesh");
        mesh.with_edges(edges).and_then(|mesh| mesh.with_points(points)).expect("valid")
    };
    let mut ends = soup(n, seed, moving).frames().into_iter().map(cut);
    match (ends.next(), ends.next()) {
        (Some(t0), Some(t1)) => Body::moving(t0, t1).expect("a body"),
        (t0, _) => Body::deformable(t0.expect("a frame")),
    }
}

/// A sheet with waves of `n` by `n` squares, of two triangles each, that sinks.
pub fn sheet(n: u32) -> Body {
    let at = |sunk: f32| -> Vec<[f32; 3]> {
        let height = |x: u32, y: u32| (x % 5 * (y % 3)) as f32 / 7.0 - sunk;
        (0..=n).flat_map(|y| (0..=n).map(move |x| [x as f32, y as f32, height(x, y)])).collect()
    };
    let square = |i: u32| {
        let low = i / n * (n + 1) + i % n;
        [[low, low + 1, low + n + 1], [low + 1, low + n + 2, low + n + 1]]
    };
    let frame = |sunk| {
        Mesh::new("sheet", Positions::F32(at(sunk)), (0..n * n).flat_map(square).collect()).expect("a mesh")
    };
    Body::moving(frame(0.0), frame(0.25)).expect("a body")
}
