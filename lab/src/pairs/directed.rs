//! Motions with known answers at the ends of the range of floats, which random searches never
//! reach. They are built in integers. Then each axis is scaled by its own power of two, which is
//! exact and moves no time of contact.

use super::built::{Built, KINDS, Motion, case, near_miss, of_kind};
use crate::case::{Case, Features};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// Names of the families. Huge: products of lengths overflow. Mixed-scale: lengths, places and
/// speeds of many exponents in one pair. Axes-extreme: one axis is huge, and products of the other
/// two underflow. Tiny: every coordinate is a few of the smallest numbers.
pub const DIRECTED: [&str; 4] = ["huge", "mixed-scale", "axes-extreme", "tiny"];

/// The ends of a precision, as exponents.
struct Ends {
    /// The smallest number.
    least: i32,
    /// The largest power of a mesh.
    most: i32,
    /// Digits.
    digits: i32,
    /// Reach of the integers.
    reach: i64,
}

const SINGLE: Ends = Ends { least: -149, most: 60, digits: 24, reach: 8 };
const DOUBLE: Ends = Ends { least: -1074, most: 480, digits: 53, reach: 1 << 12 };

/// Returns `x 2^e`, for integers and within the range: exact. In two steps, as the power itself may
/// be out of range.
fn times(x: f64, e: i32) -> f64 {
    x * 2f64.powi(e / 2) * 2f64.powi(e - e / 2)
}

/// Returns `n` contacts of a family of [`DIRECTED`], vertex/face and edge/edge, of all kinds in
/// turn, and `n` near misses. If `single`, f32 holds them.
///
/// # Panics
/// If the family does not exist.
pub fn directed(seed: u64, family: usize, single: bool, n: usize) -> Vec<Built> {
    assert!(family < DIRECTED.len(), "family must be below {}, got {family}", DIRECTED.len());
    let mut r = SmallRng::seed_from_u64(seed);
    let ends = if single { SINGLE } else { DOUBLE };
    let mut all = Vec::with_capacity(2 * n);
    for i in 0..2 * n {
        let features = [Features::VertexFace, Features::EdgeEdge][i % 2];
        let face = features == Features::VertexFace;
        let (motion, toi, name) = if i < n {
            let (motion, toi, name) = of_kind(&mut r, i / 2 % KINDS, face, i / 2, ends.reach);
            let motion = if family == 1 { hurried(&mut r, &motion, toi, &ends) } else { motion };
            (motion, Some(toi), name)
        } else {
            (near_miss(&mut r, face, ends.reach), None, "near miss".into())
        };
        let by = powers(&mut r, family, bits(&motion), &ends);
        let Case { positions_t0, positions_t1, .. } = case(&motion, features);
        let [positions_t0, positions_t1] =
            [positions_t0, positions_t1].map(|all| all.map(|p| [0, 1, 2].map(|k| times(p[k], by[k]))));
        let case = Case { features, positions_t0, positions_t1 };
        all.push(Built { name: format!("{}, {name}", DIRECTED[family]), case, toi });
    }
    all
}

/// Returns the bits of the largest coordinate.
fn bits(motion: &Motion) -> i32 {
    let most = motion.iter().flatten().flatten().map(|x| x.unsigned_abs()).max().unwrap_or(0);
    (u64::BITS - most.leading_zeros()) as i32
}

/// Returns a power of two for each axis, for integers of so many bits.
fn powers(r: &mut SmallRng, family: usize, bits: i32, ends: &Ends) -> [i32; 3] {
    let top = ends.most - bits;
    match family {
        0 => [top - r.random_range(0..ends.most / 6); 3],
        1 => [0; 3].map(|_| r.random_range(-ends.most / 2..=ends.most / 2)),
        2 => {
            // Two factors whose product is near the smallest number; the third one is huge.
            let product = ends.least + r.random_range(0..8);
            let one = product / 2 - 5 + r.random_range(0..11);
            let mut by = [top - r.random_range(0..ends.most / 3), one, product - one];
            by.rotate_left(r.random_range(0..3));
            by
        }
        _ => [ends.least + r.random_range(0..ends.digits); 3],
    }
}

/// Returns the same contact, with its own speed for each point before and after it.
fn hurried(r: &mut SmallRng, m: &Motion, toi: f64, ends: &Ends) -> Motion {
    let sixteenths = (toi * 16.0) as i64;
    let spare = ends.digits - 4 - bits(m);
    let pace = [0; 4].map(|_| 1i64 << r.random_range(0..=spare.clamp(0, 24)));
    let speed = |i: usize, k: usize| (m[1][i][k] - m[0][i][k]) / 16;
    let at = |t: i64| {
        std::array::from_fn(|i| {
            std::array::from_fn(|k| m[0][i][k] + (sixteenths + (t - sixteenths) * pace[i]) * speed(i, k))
        })
    };
    [at(0), at(16)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::meet_at;

    /// Every number has the intended value, and each contact is one.
    #[test]
    fn directed_motions_are_as_they_say() {
        for (family, single) in (0..DIRECTED.len()).flat_map(|f| [(f, true), (f, false)]) {
            let all = directed(5, family, single, 60);
            let (mut least, mut most) = (f64::INFINITY, 0f64);
            for built in &all {
                assert!(!single || built.case.fits_f32(), "{built:?}");
                let points = [built.case.positions_t0, built.case.positions_t1];
                let sizes = points.as_flattened().as_flattened().iter().map(|x| x.abs()).filter(|x| *x > 0.0);
                sizes.for_each(|x| (least, most) = (least.min(x), most.max(x)));
                if let Some(t) = built.toi {
                    assert!(meet_at(&built.case, t), "{built:?}");
                }
            }
            let ends = if single { SINGLE } else { DOUBLE };
            let near = |x: f64, e: i32| (x.log2() - f64::from(e)).abs() < 16.0;
            match family {
                0 => assert!(near(most, ends.most), "{most}"),
                1 => assert!(most / least > 2f64.powi(ends.most / 2), "{least} {most}"),
                2 => {
                    assert!(near(most, ends.most) && least < 2f64.powi(ends.least / 2 + 8), "{least} {most}")
                }
                _ => assert!(near(least, ends.least), "{least}"),
            }
            assert!(most <= 2f64.powi(ends.most), "{most}");
        }
    }
}
