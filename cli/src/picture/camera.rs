//! From points in space to places in the picture. Parallel lines stay parallel: without perspective,
//! lengths can be compared.

use super::{cross, dot, scaled, unit};

/// How much of the picture what is framed takes, and how much smaller than all bodies that may be.
const FILLED: f64 = 0.9;
const SMALLEST: f64 = 1e-3;

/// Looks at bodies from a direction.
pub struct Camera {
    /// Directions of the picture: to the right, up, and towards the one who looks; of length 1, each at right angles to the others.
    axes: [[f64; 3]; 3],
    /// The middle of all bodies, and their longest side, in the unit of the positions.
    middle: [f64; 3],
    side: f64,
    /// The point of the first two axes that is in the picture's middle, and pixels a longest side.
    centre: [f64; 2],
    scale: f64,
    /// Width and height in pixels.
    size: [f64; 2],
}

impl Camera {
    /// Looks from `view` at those points, with `up` up if the two are not parallel; both of length 1.
    /// The frame holds the points of `framed`, or all points if it has none.
    pub fn new(
        points: impl Iterator<Item = [f64; 3]> + Clone,
        framed: impl Iterator<Item = [f64; 3]> + Clone,
        [view, up]: [[f64; 3]; 2],
        size: [usize; 2],
    ) -> Camera {
        let (low, high) = bounds(points.clone());
        let longest = (0..3).fold(0.0f64, |most, k| most.max(high[k] - low[k]));
        let across = [up, [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]].map(|up| cross(up, view));
        let steep = |across: &&[f64; 3]| dot(**across, **across) > 1e-6;
        let right = unit(*across.iter().find(steep).unwrap_or(&across[0]));
        let mut camera = Camera {
            axes: [right, cross(view, right), view],
            middle: [0, 1, 2].map(|k| low[k] / 2.0 + high[k] / 2.0),
            side: if longest > 0.0 { longest } else { 1.0 },
            centre: [0.0; 2],
            scale: 1.0,
            size: size.map(|side| side as f64),
        };
        let place = |point: [f64; 3]| camera.turned(camera.near_origin(point));
        let (low, high) = match framed.clone().next() {
            None => bounds(points.map(place)),
            Some(_) => bounds(framed.map(place)),
        };
        let sides = [0, 1].map(|k| (high[k] - low[k]).max(SMALLEST));
        (camera.centre, camera.scale) = (
            [0, 1].map(|k| (low[k] + high[k]) / 2.0),
            FILLED * (camera.size[0] / sides[0]).min(camera.size[1] / sides[1]),
        );
        camera
    }

    /// A point from the middle of all bodies, in units of their longest side.
    fn near_origin(&self, point: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| (point[k] - self.middle[k]) / self.side)
    }

    /// A direction in the picture's axes.
    pub fn turned(&self, of: [f64; 3]) -> [f64; 3] {
        self.axes.map(|axis| dot(axis, of))
    }

    /// The place of a point: pixels from the left, from the top, and towards the viewer.
    pub fn place(&self, point: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = self.turned(self.near_origin(point));
        let [right, up, near] = scaled([x - self.centre[0], y - self.centre[1], z], self.scale);
        [self.size[0] / 2.0 + right, self.size[1] / 2.0 - up, near]
    }
}

/// The least and the most of each coordinate; zeros of no points.
pub fn bounds(points: impl Iterator<Item = [f64; 3]>) -> ([f64; 3], [f64; 3]) {
    let one = |point: [f64; 3]| (point, point);
    let both = |(a, b): ([f64; 3], [f64; 3]), (c, d): ([f64; 3], [f64; 3])| {
        ([0, 1, 2].map(|k| a[k].min(c[k])), [0, 1, 2].map(|k| b[k].max(d[k])))
    };
    points.map(one).reduce(both).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: [[f64; 3]; 2] = [[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]];
    const Z: [f64; 3] = [0.0, 0.0, 1.0];

    /// Looks at all points, or at those that are named.
    fn looking(points: &[[f64; 3]], framed: &[usize], directions: [[f64; 3]; 2], size: [usize; 2]) -> Camera {
        Camera::new(points.iter().copied(), framed.iter().map(|at| points[*at]), directions, size)
    }

    fn close(a: [f64; 3], b: [f64; 3]) {
        assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-9), "{a:?}, not {b:?}");
    }

    #[test]
    fn axes_are_those_of_the_picture() {
        let front = looking(&CUBE, &[], [[0.0, -1.0, 0.0], Z], [200, 100]);
        // The height of 2 fills nine tenths of 100 pixels.
        close(front.place([0.0; 3]), [100.0, 50.0, 0.0]);
        close(front.place([1.0, 0.0, 0.0]), [145.0, 50.0, 0.0]);
        close(front.place([0.0, 0.0, 1.0]), [100.0, 5.0, 0.0]);
        close(front.place([0.0, -1.0, 0.0]), [100.0, 50.0, 45.0]);
        // From above there is no up but another one.
        let above = looking(&CUBE, &[], [Z, Z], [100, 100]);
        close(above.place([1.0, 1.0, 1.0]), [95.0, 5.0, 45.0]);
    }

    #[test]
    fn what_is_framed_fills_the_picture() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [100.0, 0.0, 100.0]];
        let camera = looking(&points, &[0, 1], [[0.0, -1.0, 0.0], Z], [100, 100]);
        close(camera.place([0.5, 0.0, 0.5]), [50.0, 50.0, 0.0]);
        assert_eq!(camera.place(points[1])[0].round(), 95.0);
        // One point alone is not looked at without end.
        let one = looking(&points, &[0], [[0.0, -1.0, 0.0], Z], [100, 100]);
        assert!((one.place(points[2])[0] - 50.0).abs() < 100.0 / SMALLEST);
    }

    #[test]
    fn no_size_is_too_large_or_too_small() {
        for size in [1e-300, 2f64.powi(480)] {
            let camera = looking(&CUBE.map(|point| scaled(point, size)), &[], [Z, Z], [100, 100]);
            close(camera.place([size, size, size]), [95.0, 5.0, 45.0]);
        }
        close(looking(&[[3.0; 3]], &[], [Z, Z], [100, 100]).place([3.0; 3]), [50.0, 50.0, 0.0]);
    }
}
