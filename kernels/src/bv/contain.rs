//! Is a point in a volume? Exactly: the judge of the builders, which shares no arithmetic with
//! them. For hosts.

use super::Volume;
use crate::math::Vec3;

/// Volumes with an exact test of containment.
pub trait Contain: Volume {
    /// Whether a vertex that moves linearly from `t0` to `t1` is inside at every t in [0, 1]. For a
    /// point at rest pass it twice. Coordinates are finite and at most `2^480`. Exact.
    fn holds(&self, t0: Vec3<f64>, t1: Vec3<f64>) -> bool;
}

/// Whether a box holds it.
pub fn between(lo: [f32; 3], p: Vec3<f64>, hi: [f32; 3]) -> bool {
    (0..3).all(|k| lo[k] as f64 <= p[k] && p[k] <= hi[k] as f64)
}

/// A power of two that lifts products of subnormals out of the underflow. Coordinates are multiples
/// of `2^-1074`, axes of `2^-149`. So lifted products are multiples of `2^-823`, and at most
/// `2^480 2^400` in size.
const LIFT: f64 = f64::from_bits((400 + 1023) << 52);

/// Whether `|a . (p - c)| <= h`.
pub fn within(a: Vec3<f32>, p: Vec3<f64>, c: [f32; 3], h: f32) -> bool {
    if h == f32::INFINITY {
        return true;
    }
    let mut sum = Sum::default();
    for k in 0..3 {
        sum.add_product(a[k], p[k] * LIFT);
        sum.add_product(-a[k], c[k] as f64 * LIFT);
    }
    let (mut above, mut below) = (sum, sum);
    above.add(-(h as f64 * LIFT));
    below.add(h as f64 * LIFT);
    above.sign() <= 0 && below.sign() >= 0
}

/// An exact sum: doubles that do not overlap, ascending (Shewchuk, "Adaptive precision
/// floating-point arithmetic", 1997, figure 6).
#[derive(Clone, Copy, Default)]
struct Sum {
    parts: [f64; 13],
    len: usize,
}

impl Sum {
    /// Adds a double; thirteen at most.
    fn add(&mut self, x: f64) {
        let mut x = x;
        for part in &mut self.parts[..self.len] {
            let sum = x + *part;
            let rest = sum - x;
            *part = (x - (sum - rest)) + (*part - rest);
            x = sum;
        }
        self.parts[self.len] = x;
        self.len += 1;
    }

    /// Adds `a x`, in two products without rounding: 24 bits times 26, and times 27.
    fn add_product(&mut self, a: f32, x: f64) {
        let high = f64::from_bits(x.to_bits() >> 27 << 27);
        self.add(a as f64 * high);
        self.add(a as f64 * (x - high));
    }

    /// -1, 0 or 1.
    fn sign(&self) -> i32 {
        match self.parts[..self.len].iter().rev().find(|x| **x != 0.0) {
            Some(x) if *x > 0.0 => 1,
            Some(_) => -1,
            None => 0,
        }
    }
}
