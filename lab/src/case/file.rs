//! Files of cases in the layout of the public Sample-Queries. A query has eight rows: the four
//! points at t = 0, then at t = 1. A row has numerator and denominator of x, y and z, and whether
//! the features meet.

use super::{Case, Features};
use nearmiss::error::Error;
use nearmiss::mesh::Problem;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};
use std::path::Path;

/// Rows per query.
const ROWS: usize = 8;
/// Most bytes of memory per byte of a file. A row of six one-digit numbers has 14 bytes; it takes
/// 24 as a point, and 32 as a line.
const MULTIPLE: u64 = 8;
/// Most digits of a numerator or a denominator. A double needs up to 324, and the division of
/// larger ones is slow.
const DIGITS: usize = 1000;

/// Returns the kind of features that the folders above a file name.
pub fn features(path: &Path) -> Option<Features> {
    path.parent()?.iter().rev().find_map(|part| match part.to_str()? {
        "vertex-face" => Some(Features::VertexFace),
        "edge-edge" => Some(Features::EdgeEdge),
        _ => None,
    })
}

/// Returns a file's text, decompressed if needed.
///
/// # Errors
/// [`Error::Input`] for a file that cannot be read; [`Error::OutOfMemory`].
pub fn text(path: &Path) -> Result<String, Error> {
    nearmiss_io::file::text(path, MULTIPLE)
}

/// Returns the cases of a file, each with the file's own answer.
///
/// # Errors
/// [`Error::Input`] with the line and the fault. A number that f64 does not hold is a fault: its
/// rounding would change the case.
pub fn queries(path: &Path, features: Features) -> Result<Vec<(Case, bool)>, Error> {
    let text = text(path)?;
    let lines: Vec<_> = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).collect();
    let wrong = |line: usize, token, why| input(path, Problem::QueryRow { line: line + 1, token, why });
    let (whole, rest) = lines.as_chunks::<ROWS>();
    if let Some((line, _)) = rest.last() {
        return Err(wrong(*line, String::new(), "ends the file in the middle of a query of eight rows"));
    }
    let query = |rows: &[(usize, &str); ROWS]| {
        let mut points = [[0.0; 3]; ROWS];
        let mut meets = false;
        for (point, (line, text)) in points.iter_mut().zip(rows) {
            (*point, meets) = row(text).map_err(|(token, why)| wrong(*line, token, why))?;
        }
        let [a, b, c, d, e, f, g, h] = points;
        Ok((Case { features, positions_t0: [a, b, c, d], positions_t1: [e, f, g, h] }, meets))
    };
    whole.iter().map(query).collect()
}

fn input(path: &Path, problem: Problem) -> Error {
    Error::Input { file: path.display().to_string(), problem }
}

/// Returns a point and the answer, or the wrong token and the reason.
fn row(line: &str) -> Result<([f64; 3], bool), (String, &'static str)> {
    let cells: Vec<&str> = line.split(',').map(str::trim).collect();
    let [x, p, y, q, z, r, truth] = cells[..] else {
        return Err((line.chars().take(40).collect(), "a row has 7 columns"));
    };
    let point = [number(x, p)?, number(y, q)?, number(z, r)?];
    match truth {
        "0" => Ok((point, false)),
        "1" => Ok((point, true)),
        other => Err((other.to_owned(), "is the answer, which must be 0 or 1")),
    }
}

/// Returns a quotient, if f64 holds it.
fn number(numerator: &str, denominator: &str) -> Result<f64, (String, &'static str)> {
    let whole = |cell: &str| {
        if cell.len() > DIGITS {
            return Err((cell.chars().take(40).collect(), "begins a number of more than 1,000 digits"));
        }
        cell.parse::<BigInt>().map_err(|_| (cell.to_owned(), "is no integer"))
    };
    let (numerator, denominator) = (whole(numerator)?, whole(denominator)?);
    if denominator.is_zero() {
        return Err((denominator.to_string(), "is a denominator, which must not be zero"));
    }
    let exact = BigRational::new(numerator, denominator);
    let double = exact.to_f64().filter(|x| BigRational::from_float(*x).as_ref() == Some(&exact));
    double.ok_or_else(|| (exact.to_string(), "is no double, and rounding would change the query"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_a_point_and_the_truth() {
        assert_eq!(row("1,2, -3,4,0,1,1"), Ok(([0.5, -0.75, 0.0], true)));
        for (text, why) in [
            ("1,2,3,4,0,1", "7 columns"),
            ("1,0,3,4,0,1,0", "not be zero"),
            ("1,3,3,4,0,1,0", "no double"),
            ("1,2,3,4,0,1,2", "0 or 1"),
            ("x,2,3,4,0,1,1", "no integer"),
            (&format!("{},2,3,4,0,1,1", "9".repeat(DIGITS + 1)), "more than 1,000 digits"),
        ] {
            assert!(row(text).expect_err("refused").1.contains(why), "{text}");
        }
    }
}
