//! One query out of a file of the public Sample-Queries' layout.

use super::Between;
use crate::case::{Case, Features};
use crate::error::Error;
use crate::mesh::Problem;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};
use std::io::Read;
use std::path::Path;

/// Rows a query.
const ROWS: usize = 8;

/// What the folders above the file say it is about.
pub fn between(path: &Path) -> Option<Between> {
    path.iter().rev().find_map(|part| match part.to_str()? {
        "vertex-face" => Some(Between::Vf),
        "edge-edge" => Some(Between::Ee),
        _ => None,
    })
}

/// Query `n`, counted from 0, and the file's own answer.
///
/// # Errors
/// [`Error::Input`] with the line and what is wrong with it.
pub fn read(path: &Path, n: usize, features: Features) -> Result<(Case, bool), Error> {
    let failed = |problem| Error::Input { file: path.display().to_string(), problem };
    let unreadable = |e: std::io::Error| failed(Problem::Unreadable { reason: e.to_string() });
    let bytes = std::fs::read(path).map_err(unreadable)?;
    let mut text = String::new();
    if bytes.starts_with(&[0x1f, 0x8b]) {
        flate2::read::MultiGzDecoder::new(&bytes[..]).read_to_string(&mut text).map_err(unreadable)?;
    } else {
        (&bytes[..]).read_to_string(&mut text).map_err(unreadable)?;
    }
    let lines: Vec<&str> = text.lines().collect();
    let count = lines.len() / ROWS;
    if n >= count {
        return Err(failed(Problem::NoSuch { what: "query", index: n as u64, count: count as u64 }));
    }
    let mut points = [[0.0; 3]; ROWS];
    let mut meets = false;
    for (i, point) in points.iter_mut().enumerate() {
        let line = n * ROWS + i;
        let wrong = |(token, why)| failed(Problem::QueryRow { line: line + 1, token, why });
        (*point, meets) = row(lines[line]).map_err(wrong)?;
    }
    let at = |from: usize| [0, 1, 2, 3].map(|i| points[from + i]);
    Ok((Case { features, positions_t0: at(0), positions_t1: at(4) }, meets))
}

/// A point and the truth, or the token that is wrong and why.
fn row(line: &str) -> Result<([f64; 3], bool), (String, &'static str)> {
    let cells: Vec<&str> = line.split(',').map(str::trim).collect();
    if cells.len() != 7 {
        return Err((line.chars().take(40).collect(), "a row has 7 columns"));
    }
    let whole = |cell: &str| cell.parse::<BigInt>().map_err(|_| (cell.to_owned(), "is no integer"));
    let mut point = [0.0; 3];
    for (k, x) in point.iter_mut().enumerate() {
        let (numerator, denominator) = (whole(cells[2 * k])?, whole(cells[2 * k + 1])?);
        if denominator.is_zero() {
            return Err((cells[2 * k + 1].to_owned(), "is a denominator, which is not zero"));
        }
        let exact = BigRational::new(numerator, denominator);
        let double = exact.to_f64().filter(|x| BigRational::from_float(*x).as_ref() == Some(&exact));
        *x = double
            .ok_or_else(|| (exact.to_string(), "is no double, and rounding would ask another question"))?;
    }
    match cells[6] {
        "0" => Ok((point, false)),
        "1" => Ok((point, true)),
        other => Err((other.to_owned(), "is the truth, which is 0 or 1")),
    }
}
