//! A search for the largest error: random starts, then steps that change a few numbers and are kept if they do no worse.
//! And the judge of what is found.

use nearmiss_kernels::math::Real;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// How long to search.
#[derive(Clone, Copy)]
pub struct Hunt {
    pub seed: u64,
    pub starts: usize,
    pub steps: usize,
}

/// The worst that was found: an error in parts of its bound, and its input.
#[derive(Clone, Debug)]
pub struct Found {
    pub ratio: f64,
    pub input: Vec<f64>,
}

/// The part of a bound that must be reached.
pub const LEAST: f64 = 1.0 / 20.0;

impl Hunt {
    pub fn new(seed: u64) -> Hunt {
        Hunt { seed, starts: 8, steps: 1500 }
    }

    /// The largest ratio over inputs of numbers of `R`. `start` makes an input; `ratio` measures one, and gives NaN where
    /// the input is none. The same for the same seed.
    pub fn most<R: Real>(
        self,
        start: impl Fn(&mut SmallRng) -> Vec<f64>,
        ratio: impl Fn(&[f64]) -> f64,
    ) -> Found {
        let mut r = SmallRng::seed_from_u64(self.seed);
        let round = |x: f64| R::of(x).wide();
        let mut best = Found { ratio: f64::NEG_INFINITY, input: Vec::new() };
        for _ in 0..self.starts {
            let mut at: Vec<f64> = start(&mut r).into_iter().map(round).collect();
            let mut here = ratio(&at);
            let mut tried = at.clone();
            for _ in 0..self.steps {
                tried.copy_from_slice(&at);
                for _ in 0..r.random_range(1..4) {
                    let k = r.random_range(0..tried.len());
                    tried[k] = round(changed::<R>(&mut r, tried[k]));
                }
                let there = ratio(&tried);
                if there >= here || here.is_nan() {
                    (here, at) = (there, tried.clone());
                }
            }
            if here > best.ratio {
                best = Found { ratio: here, input: at };
            }
        }
        best
    }
}

/// Another number: by any part of itself, down to one unit in the last place; rarely of the other sign.
fn changed<R: Real>(r: &mut SmallRng, x: f64) -> f64 {
    let digits = if R::WIDE { 53 } else { 24 };
    match r.random_range(0..8) {
        0 => x + x.abs() * R::U.wide() * f64::from(r.random_range(-3..4)),
        1 if r.random_range(0..8) == 0 => -x,
        _ => x * (1.0 + r.random_range(-1.0..1.0) * 2f64.powi(-r.random_range(0..digits))),
    }
}

/// The fault of a bound of which an error takes that part.
pub fn fault(ratio: f64) -> Option<&'static str> {
    if !(ratio <= 1.0) {
        Some("the bound is broken")
    } else if ratio < LEAST {
        Some("the bound is far too wide, or the search too weak")
    } else {
        None
    }
}

/// Both numbers, and the verdict: the error is within its bound, and a bound of a twentieth would be broken.
pub fn held(constant: &str, of: &str, found: &Found) {
    println!("{constant}, {of}: {:.4} of the bound", found.ratio);
    if let Some(fault) = fault(found.ratio) {
        panic!("{constant}, {of}: {fault}: {} by {:?}", found.ratio, found.input);
    }
}

/// The verdict on an allowance that no input can come near, since a bound rounds it up generously: the error, in units,
/// is within what the proof counts, and at least a twentieth of that; and the allowance covers the count.
pub fn argued(constant: &str, of: &str, found: &Found, counted: f64, allowed: f64) {
    println!("{constant}, {of}: {:.3} units of {counted} counted, {allowed:.4e} allowed", found.ratio);
    assert!(counted <= allowed, "{constant}, {of}: less than is counted");
    if let Some(fault) = fault(found.ratio / counted) {
        panic!("{constant}, {of}: {fault}: {} units by {:?}", found.ratio, found.input);
    }
}

/// Numbers of plain size and any sign; some that nearly cancel one another.
pub fn plain(r: &mut SmallRng, n: usize) -> Vec<f64> {
    let near = r.random_range(0..3) == 0;
    (0..n)
        .map(|_| if near { 1.0 + r.random_range(-1.0..1.0) / 1024.0 } else { r.random_range(-1.0..1.0) })
        .collect()
}

#[test]
fn faults_are_named() {
    assert_eq!(fault(0.5), None);
    assert!(fault(1.0 + 1e-9).is_some() && fault(0.049).is_some() && fault(f64::NAN).is_some());
    // A search that measures nothing is no proof.
    let nothing = Hunt::new(1).most::<f32>(|r| plain(r, 2), |_| f64::NAN);
    assert!(fault(nothing.ratio).is_some());
    // A planted fault is found: the rounding of a sum, at half a unit and not beyond.
    let sum = |x: &[f64]| (f64::from((x[0] + x[1]) as f32) - (x[0] + x[1])).abs() / (x[0] + x[1]).abs();
    let found = Hunt::new(2).most::<f32>(|r| plain(r, 2), sum);
    let part = found.ratio / f64::from(f32::EPSILON / 2.0);
    assert!(part > 0.9 && part <= 1.0, "{part}");
    // A bound of a twentieth, or of nothing, is broken by what is within the whole.
    assert!(fault(20.0 * LEAST * 1.001).is_some() && fault(1.0 / 0.0).is_some());
}
