//! Corners to vertices: formats without shared vertices repeat each vertex in each of its faces.

use nearmiss::mesh::Positions;
use std::collections::HashMap;

/// Vertices gathered corner by corner. Corners with equal coordinates are one vertex.
#[derive(Default)]
pub(crate) struct Welded {
    known: HashMap<[u64; 3], u32>,
    /// Vertices so far, those of earlier parts included.
    pub points: Vec<[f64; 3]>,
    /// Corners so far.
    pub corners: u64,
}

impl Welded {
    /// The vertex at these coordinates.
    pub fn corner(&mut self, point: [f64; 3]) -> u32 {
        self.corners += 1;
        // Both zeros are one place.
        let key = point.map(|x| if x == 0.0 { 0 } else { x.to_bits() });
        let next = self.points.len() as u32;
        let vertex = *self.known.entry(key).or_insert(next);
        if vertex == next {
            self.points.push(point);
        }
        vertex
    }

    /// Begins another part, whose vertices are its own.
    pub fn part(&mut self) {
        self.known.clear();
    }
}

/// The positions of points: floats only if each coordinate is one exactly.
pub(crate) fn positions(points: Vec<[f64; 3]>) -> Positions {
    // NaN is a float too.
    let is_float = |x: &f64| x.is_nan() || f64::from(*x as f32).to_bits() == x.to_bits();
    if points.iter().flatten().all(is_float) {
        Positions::F32(points.iter().map(|point| point.map(|x| x as f32)).collect())
    } else {
        Positions::F64(points)
    }
}
