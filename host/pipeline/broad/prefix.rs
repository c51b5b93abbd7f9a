//! The tree over the bodies, as prefixes of their triangles' codes.
//!
//! Each body takes a range of the codes. Its length is about proportional to the body's part of all
//! triangles. Ranges follow a curve through the bodies' boxes, environment by environment. This is
//! the Shannon-Fano-Elias code (Cover, Thomas, "Elements of Information Theory", section 5.9). It
//! keeps the order, and no prefix begins another. A body with a part p of all triangles has
//! ceil(log2(1/p)) + 1 bits. So the tree over bodies is balanced by triangles, and its depth counts
//! like that of codes. A large body keeps nearly all bits for itself.

use nearmiss_kernels::abi::{BodyRecord, TreeBody};
use nearmiss_kernels::bvh::CODE_BITS;

/// Bits per axis of the curve through the bodies.
const BITS: u32 = 20;

/// A body's weight: the box of its triangles' centres, and its number of triangles.
#[derive(Clone, Copy, Debug)]
pub struct Weight {
    /// The box, lower corner first.
    pub bounds: [[f64; 3]; 2],
    /// Number of triangles, at least one.
    pub triangles: u32,
}

/// Sets the bodies' prefixes; `weights` and `records` are in the same order. A single body has no
/// prefix. Cost: a sort.
pub fn prefixes(bodies: &mut [TreeBody], weights: &[Weight], records: &[BodyRecord]) {
    if bodies.len() < 2 {
        return;
    }
    let centres: Vec<[f64; 3]> = weights
        .iter()
        // Halve first: the sum of two large coordinates may overflow.
        .map(|w| [0, 1, 2].map(|k| 0.5 * w.bounds[0][k] + 0.5 * w.bounds[1][k]))
        .collect();
    let order = along(&centres, |i| records[i].environment);
    let all: u64 = weights.iter().map(|w| u64::from(w.triangles)).sum();
    let mut before = 0u64;
    for i in order {
        let own = u64::from(weights[i].triangles);
        let bits = (all.div_ceil(own)).next_power_of_two().ilog2() + 1;
        let middle = (((2 * before + own) as u128) << CODE_BITS) / (2 * all as u128);
        let prefix = middle as u64 >> (CODE_BITS - bits) << (CODE_BITS - bits);
        bodies[i].prefix = prefix as u32;
        bodies[i].prefix_bits = bits;
        before += own;
    }
}

/// Returns the numbers of bodies by environment, then along a curve through their centres. Cost: a
/// sort.
pub fn along(centres: &[[f64; 3]], environment: impl Fn(usize) -> u32) -> Vec<usize> {
    let least = |k: usize| centres.iter().map(|c| c[k]).fold(f64::INFINITY, f64::min);
    let most = |k: usize| centres.iter().map(|c| c[k]).fold(f64::NEG_INFINITY, f64::max);
    let low = [least(0), least(1), least(2)];
    let extent = (0..3).map(|k| most(k) - low[k]).fold(0.0, f64::max);
    let cells = f64::from(1u32 << BITS);
    let code = |centre: &[f64; 3]| {
        let cell = |k: usize| {
            // `as` saturates and converts NaN to 0: no extent.
            (((centre[k] - low[k]) / extent * cells) as u64).min((1 << BITS) - 1)
        };
        (0..BITS).rev().fold(0u64, |code, bit| (0..3).fold(code, |code, k| code << 1 | cell(k) >> bit & 1))
    };
    let mut order: Vec<(u32, u64, usize)> =
        centres.iter().enumerate().map(|(i, centre)| (environment(i), code(centre), i)).collect();
    order.sort_unstable();
    order.into_iter().map(|(_, _, i)| i).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(triangles: &[u32], environments: &[u32], x: &[f64]) -> Vec<TreeBody> {
        let weight = |(&triangles, &x): (&u32, &f64)| Weight {
            bounds: [[x, 0.0, 0.0], [x + 1.0, 1.0, 1.0]],
            triangles,
        };
        let weights: Vec<Weight> = triangles.iter().zip(x).map(weight).collect();
        let record = |&environment: &u32| BodyRecord { environment, ..BodyRecord::default() };
        let records: Vec<BodyRecord> = environments.iter().map(record).collect();
        let mut bodies = vec![TreeBody::default(); triangles.len()];
        prefixes(&mut bodies, &weights, &records);
        bodies
    }

    /// Returns the codes that begin with a body's prefix.
    fn range(body: &TreeBody) -> (u64, u64) {
        (body.prefix.into(), u64::from(body.prefix) + (1u64 << (CODE_BITS - body.prefix_bits)))
    }

    #[test]
    fn ranges_follow_one_another_and_are_as_large_as_bodies_are() {
        let triangles = [1, 1_000_000, 12, 12, 500, 1, 77_777];
        let x = [5.0, 0.0, 9.0, 1.0, 2.0, 2.0, 4.0];
        let bodies = of(&triangles, &[0, 0, 0, 0, 1, 1, 0], &x);
        let mut order: Vec<usize> = (0..7).collect();
        order.sort_by_key(|&i| bodies[i].prefix);
        assert_eq!(order, [1, 3, 6, 0, 2, 4, 5], "by environment, then along x, then by number");
        for pair in order.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|i| range(&bodies[i]));
            assert!(a.1 <= b.0, "{a:?} {b:?}");
        }
        let all: u32 = triangles.iter().sum();
        for (body, &own) in bodies.iter().zip(&triangles) {
            let share = (1u64 << (CODE_BITS - body.prefix_bits)) as f64 / (1u64 << CODE_BITS) as f64;
            let part = f64::from(own) / f64::from(all);
            assert!(share <= part && share > part / 8.0, "{share} of {part}");
        }
    }

    #[test]
    fn one_body_has_all_codes_and_a_billion_have_one_each() {
        assert_eq!(of(&[5], &[0], &[0.0])[0], TreeBody::default());
        let bodies = of(&[1, (1 << 30) - 2, 1], &[0; 3], &[0.0, 1.0, 2.0]);
        assert_eq!(bodies.iter().map(|b| b.prefix_bits).collect::<Vec<_>>(), [31, 2, 31]);
        // All in one place: the extent is 0, so their cells are NaN.
        let bodies = of(&[1, 1], &[0; 2], &[f64::MAX, f64::MAX]);
        assert!(bodies[0].prefix < bodies[1].prefix);
    }
}
