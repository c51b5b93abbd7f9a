//! Sweeps over three difficulties: distance from the origin, scale, degeneracy.

use super::input::{Choice, Input};
use super::row::Row;
use crate::pairs::Stored;
use crate::pairs::built::built;
use crate::pairs::degenerate::{Degeneracy, MOST, degenerate};
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::query::QueryKind;
use nearmiss::research::Certified;

/// Size of a sweep.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Number of cases of a kind.
    pub cases: usize,
    /// Steps from one point of the sweep to the next.
    pub step: u32,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Returns every continuous solver at the default tolerance.
fn choices() -> Vec<Choice> {
    Choice::every(QueryKind::Continuous, &[Certified::TOLERANCE])
}

/// Tests the built contacts of small integers at several offsets from the origin, in edges. In f64
/// the positions are exact. Cast to f32 they change the problem; the answers are judged by the
/// original one.
///
/// # Errors
/// Device errors.
pub fn offsets(device: &Device, extent: Extent) -> Result<Vec<Row>, Error> {
    let input = Input::built("offset", built(extent.seed, extent.cases, 8))?;
    let mut rows = Vec::new();
    for edges in [0.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7] {
        let by = (edges * input.edge).round();
        let moved = input.with("offset from the origin, edges".into(), |x| x + by);
        let cast = moved.with(moved.name.clone(), |x| f64::from(x as f32));
        for choice in choices() {
            let exact = moved.row(device, choice, Stored::F64, 0)?;
            rows.push(Row { at: Some(edges), ..exact });
            // The tolerance of the original, though the edges have changed.
            let cast = Input { edge: moved.edge, ..cast.with(cast.name.clone(), |x| x) };
            let other = cast.row(device, choice, Stored::F32, 0)?;
            rows.push(Row { at: Some(edges), precision: "f32 cast", ..other });
        }
    }
    Ok(rows)
}

/// Tests the built contacts of small integers times powers of two from 2^-100 to 2^100.
///
/// # Errors
/// Device errors.
pub fn scales(device: &Device, extent: Extent) -> Result<Vec<Row>, Error> {
    let input = Input::built("scale", built(extent.seed, extent.cases, 8))?;
    let mut rows = Vec::new();
    for k in (-100..=100).step_by(if extent.step == 1 { 10 } else { 25 }) {
        let scaled = input.with("scale, 2^k".into(), |x| x * 2f64.powi(k));
        for choice in choices() {
            let row = scaled.row(device, choice, Stored::F64, 0)?;
            rows.push(Row { at: Some(f64::from(k)), ..row });
        }
    }
    Ok(rows)
}

/// Tests each kind of degeneracy by degrees.
///
/// # Errors
/// Device errors.
pub fn degeneracies(device: &Device, extent: Extent) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for kind in Degeneracy::ALL {
        for k in (0..=MOST).step_by(extent.step.max(1) as usize) {
            let cases = degenerate(extent.seed, kind, k, 20 * extent.cases);
            let input = Input::built(kind.name(), cases)?;
            for choice in choices() {
                let row = input.row(device, choice, Stored::F64, 0)?;
                rows.push(Row { at: Some(f64::from(k)), ..row });
            }
        }
    }
    Ok(rows)
}
