//! Meshes for the examples. Other sources are `Mesh::read` and arrays in memory.
#![allow(dead_code, reason = "each example uses some of them")]

use nearmiss::{Error, Mesh, mesh::Positions};

/// Vertices of a sheet of `n` by `n` squares over the unit square, at positions `at(x, y)`.
pub fn points(n: u32, at: impl Fn(f32, f32) -> [f32; 3]) -> Positions {
    let side = |i: u32| i as f32 / n as f32;
    Positions::F32(
        (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j))).map(|(i, j)| at(side(i), side(j))).collect(),
    )
}

/// The sheet as a mesh.
pub fn sheet(n: u32, at: impl Fn(f32, f32) -> [f32; 3]) -> Result<Mesh, Error> {
    let square = |i: u32| {
        let low = i / n * (n + 1) + i % n;
        [[low, low + 1, low + n + 1], [low + 1, low + n + 2, low + n + 1]]
    };
    Mesh::new("sheet", points(n, at), (0..n * n).flat_map(square).collect())
}

/// A cube with sides of this length, centred at the origin.
pub fn cube(side: f32) -> Result<Mesh, Error> {
    let corner = |k: u32| [0, 1, 2].map(|axis| side * ((k >> axis & 1) as f32 - 0.5));
    let quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let faces = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh::new("cube", Positions::F32((0..8).map(corner).collect()), faces)
}
