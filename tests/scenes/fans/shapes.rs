//! Fans, cones and what lies round them.

use nearmiss::mesh::{Body, Mesh, Positions};
use std::f64::consts::TAU;

/// Points, and faces between them.
#[derive(Clone)]
pub struct Shape {
    pub points: Vec<[f32; 3]>,
    pub faces: Vec<[u32; 3]>,
}

/// A number from -1 to 1 that depends on all of these alone.
fn noise(seed: u64, i: u64, k: u64) -> f32 {
    let mut x = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (i << 8 | k);
    for _ in 0..3 {
        x = (x ^ (x >> 31)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    }
    ((x >> 40) as f64 / f64::from(1 << 23) - 1.0) as f32
}

/// A point of the unit circle.
fn on_circle(k: u32, n: u32) -> [f32; 3] {
    let angle = TAU * f64::from(k) / f64::from(n);
    [angle.cos() as f32, angle.sin() as f32, 0.0]
}

impl Shape {
    /// `n` faces round vertex 0, which is `height` above the circle of the others.
    pub fn fan(n: u32, height: f32) -> Shape {
        let points = std::iter::once([0.0, 0.0, height]).chain((0..n).map(|k| on_circle(k, n))).collect();
        Shape { points, faces: (0..n).map(|k| [0, 1 + k, 1 + (k + 1) % n]).collect() }
    }

    /// The same with a rim so uneven that faces cross.
    pub fn folded(n: u32, seed: u64) -> Shape {
        let mut shape = Shape::fan(n, 0.1);
        for (i, point) in shape.points.iter_mut().enumerate().skip(1) {
            (0..3).for_each(|k| point[k] += 0.3 * noise(seed, i as u64, k as u64));
        }
        shape
    }

    /// A second fan over the rim of a fan, round a hub below it.
    pub fn and_fan_below(mut self, height: f32) -> Shape {
        let (n, hub) = (self.faces.len() as u32, self.points.len() as u32);
        self.points.push([0.0, 0.0, height]);
        self.faces.extend((0..n).map(|k| [hub, 1 + (k + 1) % n, 1 + k]));
        self
    }

    /// Two shapes in one mesh.
    pub fn beside(mut self, other: Shape, by: [f32; 3]) -> Shape {
        let first = self.points.len() as u32;
        self.points.extend(other.points.iter().map(|p| [0, 1, 2].map(|k| p[k] + by[k])));
        self.faces.extend(other.faces.iter().map(|face| face.map(|v| v + first)));
        self
    }

    /// A plate round a fan, of twice as many faces: a ring as wide as its faces are, that shares the rim.
    pub fn with_plate(mut self) -> Shape {
        let n = self.faces.len() as u32;
        let first = self.points.len() as u32;
        self.points.extend((0..n).map(|k| on_circle(k, n).map(|x| x * (1.0 + TAU as f32 / n as f32))));
        self.faces.extend((0..n).map(|k| [1 + k, first + k, 1 + (k + 1) % n]));
        self.faces.extend((0..n).map(|k| [1 + (k + 1) % n, first + k, first + (k + 1) % n]));
        self
    }

    /// Positions of its points after so many steps of so far.
    pub fn moved(&self, steps: u64, by: f32) -> Vec<[f32; 3]> {
        let point =
            |(i, p): (usize, &[f32; 3])| [0, 1, 2].map(|k| p[k] + by * noise(steps, i as u64, k as u64));
        self.points.iter().enumerate().map(point).collect()
    }

    fn mesh(&self, points: Vec<[f32; 3]>) -> Mesh {
        Mesh::new("fan", Positions::F32(points), self.faces.clone()).expect("a mesh")
    }

    /// At rest.
    pub fn body(&self) -> Body {
        Body::deformable(self.mesh(self.points.clone()))
    }

    /// Fixed.
    pub fn fixed(&self) -> Body {
        Body::fixed(self.mesh(self.points.clone()))
    }

    /// In motion.
    pub fn moving(&self, seed: u64, by: f32) -> Body {
        Body::moving(self.mesh(self.points.clone()), self.mesh(self.moved(seed, by))).expect("two frames")
    }
}
