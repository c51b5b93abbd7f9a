//! Axes for oriented boxes. Any will do for soundness, if they are nearly orthonormal; good ones
//! make tight boxes.

use crate::math::tolerance::{BOX_AXES, COVARIANCE_ZERO};
use crate::math::{Real, Vec3};

/// Two axes; the third follows from them.
pub type Frame = [Vec3<f32>; 2];

/// The axes of the world.
pub const WORLD: Frame = [Vec3([1.0, 0.0, 0.0]), Vec3([0.0, 1.0, 0.0])];

/// All three axes: the third is the rounded cross product, the same wherever it is recomputed.
#[inline]
pub fn three([x, y]: Frame) -> [Vec3<f32>; 3] {
    [x, y, x.cross(y)]
}

#[inline]
fn unit(v: Vec3<f32>) -> Vec3<f32> {
    let length = v.dot(v).sqrt();
    v.map(|x| x / length)
}

/// The axes with the first along `v` and the second towards `w`; none if that is not well defined.
/// The components of `v` should be about 1 in size.
#[inline]
pub fn frame(v: Vec3<f32>, w: Vec3<f32>) -> Option<Frame> {
    let x = unit(v);
    // Twice: the first difference may cancel, and then leans towards x.
    let y = unit(w - x * x.dot(w));
    let y = unit(y - x * x.dot(y));
    let z = x.cross(y);
    // Every comparison with NaN is false.
    let near = |a: f32, b: f32| (a - b).abs() <= BOX_AXES;
    let sound = near(x.dot(x), 1.0)
        & near(y.dot(y), 1.0)
        & near(z.dot(z), 1.0)
        & near(x.dot(y), 0.0)
        & near(y.dot(z), 0.0)
        & near(z.dot(x), 0.0);
    sound.then_some([x, y])
}

/// The axes of a triangle with the edges `e`: its longest edge, and across it in its plane. No box
/// around a triangle has a smaller face. A segment takes any axis across it, a point the axes of
/// the world.
#[inline]
pub fn of_edges(e: [Vec3<f32>; 3]) -> Frame {
    let (mut longest, mut next, mut most) = (e[0], e[1], e[0].dot(e[0]));
    for k in 1..3 {
        let length = e[k].dot(e[k]);
        if length > most {
            (longest, next, most) = (e[k], e[(k + 1) % 3], length);
        }
    }
    frame(longest, next).or_else(|| frame(longest, across(longest))).unwrap_or(WORLD)
}

/// The axis of the world that `v` leans to the least.
#[inline]
fn across(v: Vec3<f32>) -> Vec3<f32> {
    let [x, y, z] = v.map(Real::abs).0;
    if x <= y && x <= z {
        Vec3([1.0, 0.0, 0.0])
    } else if y <= z {
        Vec3([0.0, 1.0, 0.0])
    } else {
        Vec3([0.0, 0.0, 1.0])
    }
}

/// A symmetric matrix.
#[derive(Clone, Copy)]
pub struct Covariance {
    /// Entries 00, 11, 22.
    pub on: [f32; 3],
    /// Entries 12, 20, 01: each is opposite its row and column.
    pub off: [f32; 3],
}

impl Covariance {
    /// Zero.
    pub const ZERO: Covariance = Covariance { on: [0.0; 3], off: [0.0; 3] };

    /// Adds `v v^T`.
    #[inline]
    pub fn add(&mut self, v: Vec3<f32>) {
        for k in 0..3 {
            self.on[k] += v[k] * v[k];
            self.off[k] += v[(k + 1) % 3] * v[(k + 2) % 3];
        }
    }

    /// About the mean of `count` vectors with this sum, all of which were added.
    #[inline]
    pub fn about(mut self, sum: Vec3<f32>, count: f32) -> Covariance {
        let mean = sum.map(|x| x / count);
        for k in 0..3 {
            self.on[k] -= sum[k] * mean[k];
            self.off[k] -= sum[(k + 1) % 3] * mean[(k + 2) % 3];
        }
        self
    }

    /// The principal axes, that of the largest variance first, then that of the second. The world's
    /// axes if there are none (no variance, NaN). Cyclic Jacobi rotations on the matrix divided by
    /// its largest entry.
    #[inline]
    pub fn axes(mut self) -> Frame {
        let most = Real::max(Real::max(self.on[0], self.on[1]), self.on[2]);
        self.on = self.on.map(|x| x / most);
        self.off = self.off.map(|x| x / most);
        let mut v = [Vec3([1.0, 0.0, 0.0]), Vec3([0.0, 1.0, 0.0]), Vec3([0.0, 0.0, 1.0])];
        for _ in 0..SWEEPS {
            if !self.off.iter().any(|x| x.abs() > COVARIANCE_ZERO) {
                break;
            }
            self.rotate::<0, 1, 2>(&mut v);
            self.rotate::<1, 2, 0>(&mut v);
            self.rotate::<2, 0, 1>(&mut v);
        }
        let [x, y, z] = self.on;
        // The one with the least variance is left out: it is the one that follows.
        let (p, q, a, b) = if z <= x && z <= y {
            (v[0], v[1], x, y)
        } else if y <= x {
            (v[2], v[0], z, x)
        } else {
            (v[1], v[2], y, z)
        };
        let pair = if a >= b { frame(p, q) } else { frame(q, p) };
        pair.unwrap_or(WORLD)
    }

    /// Turns rows P and Q, so that the entry PQ (opposite K) becomes zero.
    #[inline(always)]
    fn rotate<const P: usize, const Q: usize, const K: usize>(&mut self, v: &mut [Vec3<f32>; 3]) {
        let m = self.off[K];
        if m.abs() <= COVARIANCE_ZERO {
            return;
        }
        // tan = 2m / (d + sign(d) hypot(d, 2m)), the smaller root: it turns by at most 45 degrees.
        let d = self.on[Q] - self.on[P];
        let h = (d * d + 4.0 * m * m).sqrt();
        let tan = if d >= 0.0 { 2.0 * m / (d + h) } else { 2.0 * m / (d - h) };
        let cos = 1.0 / (1.0 + tan * tan).sqrt();
        let sin = tan * cos;
        self.on[P] -= tan * m;
        self.on[Q] += tan * m;
        self.off[K] = 0.0;
        // Entry PK is opposite Q, entry QK opposite P.
        let (pk, qk) = (self.off[Q], self.off[P]);
        self.off[Q] = cos * pk - sin * qk;
        self.off[P] = sin * pk + cos * qk;
        let (p, q) = (v[P], v[Q]);
        v[P] = p * cos - q * sin;
        v[Q] = p * sin + q * cos;
    }
}

/// Sweeps of Jacobi rotations at most. Convergence is quadratic; after three, boxes are as small as
/// after six.
const SWEEPS: u32 = 3;
