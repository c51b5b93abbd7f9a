//! Triangle pairs with the oracle's answers.

use super::input::Choice;
use super::judge::{Counts, Judged};
use super::row::Row;
use crate::oracle::{Triangle, triangles_meet};
use crate::pairs::{Stored, ask_triangles};
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::query::QueryKind;
use nearmiss::research::QueryExt;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use rayon::prelude::*;

/// Points per side of the grids.
pub const SIDES: [u32; 3] = [3, 4, 8];

/// Returns `n` pairs of random triangles with corners on a grid.
pub fn on_grid(r: &mut SmallRng, side: u32, n: usize) -> Vec<[Triangle; 2]> {
    let mut corner = || std::array::from_fn(|_| f64::from(r.random_range(0..side)));
    (0..n).map(|_| std::array::from_fn(|_| std::array::from_fn(|_| corner()))).collect()
}

/// Tests random triangles with corners on grids of 3, 4 and 8 points a side: most touch, are
/// coplanar or have no area. A row per discrete solver; `n` pairs per grid. Cost: about a
/// millisecond a pair, in rationals.
///
/// # Errors
/// Device errors.
pub fn triangles(device: &Device, n: usize, seed: u64) -> Result<Vec<Row>, Error> {
    let mut r = SmallRng::seed_from_u64(seed);
    let mut rows = Vec::new();
    for side in SIDES {
        let pairs = on_grid(&mut r, side, n);
        let truth: Vec<bool> = pairs.par_iter().map(|[p, q]| triangles_meet(p, q)).collect();
        for choice in Choice::every(QueryKind::Discrete, &[]) {
            // The first run on a GPU loads the kernels.
            ask_triangles(device, &pairs[..1.min(n)], &choice.asked, Stored::F64)?;
            let answers = ask_triangles(device, &pairs, &choice.asked, Stored::F64)?;
            let row = Row {
                input: format!("triangles on a grid of {side} a side"),
                reference: "exact",
                precision: "f64",
                escalated: answers.uncertain,
                ns: Some(answers.ms * 1e6 / n.max(1) as f64),
                ..Row::default()
            };
            let judged = Judged { counts: count(&answers.meet, &truth), ..Judged::default() };
            rows.push(row.judged(choice.asked.solver(), &judged));
        }
    }
    Ok(rows)
}

fn count(found: &[bool], truth: &[bool]) -> Counts {
    let of = |f: fn(bool, bool) -> bool| found.iter().zip(truth).filter(|(a, b)| f(**a, **b)).count() as u64;
    Counts {
        cases: truth.len() as u64,
        contacts: of(|_, truth| truth),
        missed: of(|found, truth| truth && !found),
        false_alarms: of(|found, truth| found && !truth),
        ..Counts::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planted_errors_are_counted() {
        let counts = count(&[true, false, true, false], &[true, true, false, false]);
        assert_eq!((counts.cases, counts.contacts, counts.missed, counts.false_alarms), (4, 2, 1, 1));
    }
}
