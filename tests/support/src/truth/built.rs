//! Accuracy of the cubics on motions built in integers.

use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::{Moving, ee_toi, vf_toi};
use rand::SeedableRng;
use rand::rngs::SmallRng;

use nearmiss_lab::pairs::built::{FAMILIES, Motion, REACH_F32, motion};

/// The time by the cubic in `S` for positions in `R`; all numbers times `scale`.
pub fn toi<R: Real, S: Real>(m: &Motion, face: bool, scale: f64) -> Option<S> {
    let x = |t: usize, i: usize| Vec3(m[t][i].map(|x| R::of(x as f64 * scale)));
    let p = |i: usize| Moving { t0: x(0, i), t1: x(1, i) };
    if face { vf_toi(p(0), [p(1), p(2), p(3)]) } else { ee_toi([p(0), p(1)], [p(2), p(3)]) }
}

/// Counts of the cubics on one family.
#[derive(Clone, Copy, Default)]
pub struct Count {
    pub family: usize,
    pub face: bool,
    pub asked: u32,
    /// Missed contacts, in f64 and in f32.
    pub missed: [u32; 2],
    /// Late times, by more than 1e-6 in f64, 1e-3 in f32. Every motion meets at a known time, or
    /// before.
    pub late: [u32; 2],
}

/// Tests `n` motions of every family and kind. The f32 cubic is tested only if f32 holds the
/// numbers.
pub fn count(seed: u64, n: u32, reach: i64) -> Vec<Count> {
    let mut r = SmallRng::seed_from_u64(seed);
    let kinds = (0..FAMILIES.len()).flat_map(|family| [(family, true), (family, false)]);
    let one = |(family, face)| {
        let mut c = Count { family, face, asked: n, ..Count::default() };
        for i in 0..n as usize {
            let time = [0, 16, 1, 8, 11][i % 5];
            let m = motion(&mut r, family, face, time, reach);
            let truth = time as f64 / 16.0;
            let mut answers = vec![toi::<f64, f64>(&m, face, 1.0)];
            if reach <= REACH_F32 {
                answers.push(toi::<f32, f32>(&m, face, 1.0).map(f64::from));
            }
            for (k, answer) in answers.into_iter().enumerate() {
                match answer {
                    None => c.missed[k] += 1,
                    Some(t) => {
                        assert!((0.0..=1.0).contains(&t) && t.is_sign_positive());
                        c.late[k] += (t > truth + [1e-6, 1e-3][k]) as u32;
                    }
                }
            }
        }
        c
    };
    kinds.map(one).collect()
}
