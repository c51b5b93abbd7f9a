//! OBJ files to positions and faces: the keywords `v` and `f`; all others are skipped.

use super::polygons::Fans;
use super::problem::shown;
use super::{Positions, Problem};

/// What is wrong with an OBJ file. Lines count from 1; a continued line has the number of its first part.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "the message of each variant says what it and its fields are")]
pub enum ObjProblem {
    #[error("line {line}: a vertex with {found} coordinates; x, y and z are needed")]
    ShortVertex { line: usize, found: usize },
    #[error(
        "line {line}: the {axis} of vertex {vertex} (from 0) is {found:?}, which is not a number: correct it"
    )]
    Number { line: usize, vertex: usize, axis: char, found: String },
    #[error(
        "line {line}: a face with {corners} corners; at least 3 are needed: remove it or give its corners"
    )]
    ShortFace { line: usize, corners: usize },
    #[error(
        "line {line}: the corner {found:?} is not of the form i, i/j, i//k or i/j/k with whole numbers: correct it"
    )]
    Corner { line: usize, found: String },
    #[error("line {line}: vertex index 0; OBJ counts vertices from 1, or back from -1: correct it")]
    Zero { line: usize },
    #[error(
        "line {line}: vertex index {index} reaches before the first of the {vertices} vertices so far: correct it"
    )]
    Back { line: usize, index: i64, vertices: usize },
    #[error(
        "line {line}: vertex index {index}, but the file has {vertices} vertices, counted from 1: correct it"
    )]
    Index { line: usize, index: i64, vertices: usize },
}

/// Reads the whole file. Coordinates are parsed as doubles and kept as
/// floats only if each is one exactly.
pub(super) fn read(bytes: &[u8]) -> Result<(Positions, Fans), Problem> {
    let mut obj = Obj::default();
    let mut joined = Vec::new();
    let mut first = 0;
    for (i, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let line = line.trim_ascii_end();
        if joined.is_empty() {
            first = i + 1;
        }
        // A comment that ends in a backslash, say a path, must not swallow the next line.
        if let Some(part) = line.strip_suffix(b"\\").filter(|part| !part.contains(&b'#')) {
            joined.extend_from_slice(part);
            joined.push(b' ');
        } else if joined.is_empty() {
            obj.line(first, line)?;
        } else {
            joined.extend_from_slice(line);
            obj.line(first, &joined)?;
            joined.clear();
        }
    }
    if !joined.is_empty() {
        obj.line(first, &joined)?;
    }
    obj.finish()
}

#[derive(Default)]
struct Obj {
    points: Vec<[f64; 3]>,
    faces: Fans,
    /// The line and the index of the largest reference to a vertex that had not come yet.
    ahead: Option<(usize, i64)>,
}

impl Obj {
    fn line(&mut self, line: usize, text: &[u8]) -> Result<(), ObjProblem> {
        let end = text.iter().position(|&b| b == b'#').unwrap_or(text.len());
        let mut words = text[..end].split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match words.next() {
            Some(b"v") => self.vertex(line, words),
            Some(b"f") => self.face(line, words),
            _ => Ok(()),
        }
    }

    fn vertex<'a>(
        &mut self,
        line: usize,
        mut words: impl Iterator<Item = &'a [u8]>,
    ) -> Result<(), ObjProblem> {
        let mut point = [0.0; 3];
        for (found, (x, axis)) in point.iter_mut().zip(['x', 'y', 'z']).enumerate() {
            let word = words.next().ok_or(ObjProblem::ShortVertex { line, found })?;
            *x = parse(word).ok_or_else(|| {
                let vertex = self.points.len();
                ObjProblem::Number { line, vertex, axis, found: shown(word) }
            })?;
        }
        self.points.push(point);
        Ok(())
    }

    fn face<'a>(&mut self, line: usize, words: impl Iterator<Item = &'a [u8]>) -> Result<(), ObjProblem> {
        let mut corners = 0;
        for word in words {
            let index = self.corner(line, word)?;
            self.faces.corner(corners as u64, index);
            corners += 1;
        }
        if corners < 3 {
            return Err(ObjProblem::ShortFace { line, corners });
        }
        Ok(())
    }

    /// The vertex of a corner, from 0.
    fn corner(&mut self, line: usize, word: &[u8]) -> Result<u32, ObjProblem> {
        let wrong = || ObjProblem::Corner { line, found: shown(word) };
        let mut parts = word.split(|&b| b == b'/');
        let index: i64 = parts.next().and_then(parse).ok_or_else(wrong)?;
        // Texture and normal are not used, but must be what they claim.
        let fine = |part: &[u8]| part.is_empty() || parse::<i64>(part).is_some();
        if !parts.by_ref().take(2).all(fine) || parts.next().is_some() {
            return Err(wrong());
        }
        let vertices = self.points.len();
        let from_0 = match index {
            0 => return Err(ObjProblem::Zero { line }),
            1.. => index - 1,
            _ => index.saturating_add(vertices as i64),
        };
        if from_0 < 0 {
            return Err(ObjProblem::Back { line, index, vertices });
        }
        let index_u32 = u32::try_from(from_0).map_err(|_| ObjProblem::Index { line, index, vertices })?;
        if from_0 >= vertices as i64 && self.ahead.is_none_or(|(_, largest)| largest < index) {
            self.ahead = Some((line, index));
        }
        Ok(index_u32)
    }

    fn finish(self) -> Result<(Positions, Fans), Problem> {
        let vertices = self.points.len();
        if let Some((line, index)) = self.ahead.filter(|&(_, index)| index > vertices as i64) {
            return Err(ObjProblem::Index { line, index, vertices }.into());
        }
        // NaN is a float too.
        let is_float = |x: &f64| x.is_nan() || f64::from(*x as f32).to_bits() == x.to_bits();
        let positions = if self.points.iter().flatten().all(is_float) {
            Positions::F32(self.points.iter().map(|p| p.map(|x| x as f32)).collect())
        } else {
            Positions::F64(self.points)
        };
        Ok((positions, self.faces))
    }
}

fn parse<T: std::str::FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}
