//! Query files: rows of numerators and denominators, eight rows a query, and whether it meets. The layout of the public
//! Sample-Queries.

use crate::case::{Case, Features};
use crate::error::Error;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Queries of one folder, in the order of its files.
pub struct Queries {
    /// The folder, below the one that was given.
    pub name: String,
    /// The questions.
    pub cases: Vec<Case>,
    /// Whether each meets, by the file.
    pub meets: Vec<bool>,
}

/// Walks a folder: every `.csv` and `.csv.gz` in a folder called `vertex-face` or `edge-edge` is read, in order of names.
///
/// # Errors
/// [`Error::Choice`] for a folder without such a file, for a file that is not of that layout (which line, and why), and for
/// a number that f64 does not hold exactly: rounding it would ask another question.
pub fn queries(root: &Path) -> Result<Vec<Queries>, Error> {
    let mut files = Vec::new();
    walk(root, &mut files)?;
    files.sort();
    let mut all: Vec<Queries> = Vec::new();
    for file in files {
        let Some((folder, features)) = kind(&file) else { continue };
        let name = folder.strip_prefix(root).unwrap_or(folder).display().to_string();
        let (cases, meets) = read(&file, features)?;
        match all.last_mut().filter(|last| last.name == name) {
            Some(last) => {
                last.cases.extend(cases);
                last.meets.extend(meets);
            }
            None => all.push(Queries { name, cases, meets }),
        }
    }
    if all.is_empty() {
        return Err(bad(root, "no folder vertex-face or edge-edge with a .csv or .csv.gz file below it"));
    }
    Ok(all)
}

/// The folder of a query file, and which features it asks of.
fn kind(file: &Path) -> Option<(&Path, Features)> {
    let name = file.file_name()?.to_str()?;
    if !name.ends_with(".csv") && !name.ends_with(".csv.gz") {
        return None;
    }
    let folder = file.parent()?;
    match folder.file_name()?.to_str()? {
        "vertex-face" => Some((folder, Features::VertexFace)),
        "edge-edge" => Some((folder, Features::EdgeEdge)),
        _ => None,
    }
}

fn bad(file: &Path, what: impl std::fmt::Display) -> Error {
    Error::Choice {
        what: format!("{}: {what}", file.display()),
        advice: "give query files of eight rows a query: three numerators and denominators, and 0 or 1"
            .into(),
    }
}

fn walk(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Error> {
    for entry in std::fs::read_dir(folder).map_err(|e| bad(folder, e))? {
        let path = entry.map_err(|e| bad(folder, e))?.path();
        if path.is_dir() {
            walk(&path, files)?;
        } else {
            files.push(path);
        }
    }
    Ok(())
}

/// A file's text, unpacked where its name says so.
///
/// # Errors
/// [`Error::Choice`] with the system's text.
pub fn text(file: &Path) -> Result<String, Error> {
    let mut text = String::new();
    let open = std::fs::File::open(file).map_err(|e| bad(file, e))?;
    let read = if file.extension().is_some_and(|e| e == "gz") {
        flate2::read::MultiGzDecoder::new(open).read_to_string(&mut text)
    } else {
        std::io::BufReader::new(open).read_to_string(&mut text)
    };
    read.map(|_| text).map_err(|e| bad(file, e))
}

fn read(file: &Path, features: Features) -> Result<(Vec<Case>, Vec<bool>), Error> {
    let text = text(file)?;
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    if !lines.len().is_multiple_of(8) {
        return Err(bad(file, format!("{} rows, which is no multiple of 8", lines.len())));
    }
    let (mut cases, mut meets) = (Vec::new(), Vec::new());
    for (query, rows) in lines.chunks_exact(8).enumerate() {
        let mut points = [[0.0; 3]; 8];
        let mut truth = false;
        for (i, row) in rows.iter().enumerate() {
            (points[i], truth) =
                parse(row).map_err(|why| bad(file, format!("row {}: {why}", 8 * query + i + 1)))?;
        }
        let [a, b, c, d, e, f, g, h] = points;
        cases.push(Case { features, positions_t0: [a, b, c, d], positions_t1: [e, f, g, h] });
        meets.push(truth);
    }
    Ok((cases, meets))
}

/// A row: a point, and the truth.
fn parse(row: &str) -> Result<([f64; 3], bool), String> {
    let fields: Vec<&str> = row.split(',').map(str::trim).collect();
    let [x, p, y, q, z, r, truth] = fields[..] else {
        return Err(format!("{} columns, not 7", fields.len()));
    };
    let point = [number(x, p)?, number(y, q)?, number(z, r)?];
    match truth {
        "0" => Ok((point, false)),
        "1" => Ok((point, true)),
        _ => Err(format!("{truth} is neither 0 nor 1")),
    }
}

/// A quotient that f64 holds.
fn number(numerator: &str, denominator: &str) -> Result<f64, String> {
    let whole = |text: &str| text.parse::<BigInt>().map_err(|_| format!("{text} is no integer"));
    let (n, d) = (whole(numerator)?, whole(denominator)?);
    if d == BigInt::ZERO {
        return Err(format!("{numerator} over zero"));
    }
    let exact = BigRational::new(n, d);
    let double = exact.to_f64().filter(|x| x.is_finite());
    match double.filter(|&x| BigRational::from_float(x).as_ref() == Some(&exact)) {
        Some(x) => Ok(x),
        None => Err(format!("{numerator} / {denominator} is not exact in f64")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_a_point_and_the_truth() {
        assert_eq!(parse("1,2, -3,4,0,1,1"), Ok(([0.5, -0.75, 0.0], true)));
        for (row, why) in [
            ("1,2,3,4,0,1", "6 columns"),
            ("1,0,3,4,0,1,0", "over zero"),
            ("1,3,3,4,0,1,0", "not exact"),
            ("1,2,3,4,0,1,2", "neither"),
            ("x,2,3,4,0,1,1", "no integer"),
        ] {
            assert!(parse(row).expect_err("refused").contains(why), "{row}");
        }
    }
}
