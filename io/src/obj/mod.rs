//! OBJ files to positions, faces, edges and points: the keywords `v`, `f`, `l` and `p`. All others
//! are counted, or known to hold no geometry.

mod word;

use crate::loose::Loose;
use crate::mesh_file::Parsed;
use crate::note::{Notes, Treated};
use crate::polygons::Fans;
use crate::problems::Problems;
use crate::shown::shown;
use crate::welded::positions;
use nearmiss::mesh::{ObjProblem, Problem};
use word::Word;

/// Reads the whole file. Lines end in LF, CR LF or CR. Coordinates are parsed as doubles and kept
/// as floats only if each is one exactly.
pub(crate) fn read(bytes: &[u8], problems: &mut Problems) -> Result<Parsed, Problem> {
    let mut obj = Obj::default();
    whole_lines(bytes, |line| match line {
        Line::Whole { line, text } => obj.line(line, text).or_else(|problem| problems.add(problem)),
        Line::Joined { line, word } => problems.add(ObjProblem::Joined { line, found: shown(word) }),
    })?;
    let vertices = obj.points.len();
    if obj.ahead > vertices as i64 {
        // Seldom: the first reference need not be that to the last vertex.
        whole_lines(bytes, |line| match line {
            Line::Whole { line, text } => missing(line, text, vertices, problems),
            Line::Joined { .. } => Ok(()),
        })?;
        problems.sort_by_line();
    }
    Ok(Parsed { positions: positions(obj.points), fans: obj.faces, loose: obj.loose, notes: obj.notes })
}

/// A line of a file, counted from 1.
enum Line<'a> {
    /// Whole: of several that a backslash joins, with the number of the first.
    Whole { line: usize, text: &'a [u8] },
    /// Joined to another, and it begins with a vertex or a face, which would be lost.
    Joined { line: usize, word: &'a [u8] },
}

/// Passes all lines on.
fn whole_lines(bytes: &[u8], mut each: impl FnMut(Line<'_>) -> Result<(), Problem>) -> Result<(), Problem> {
    let mut joined = Vec::new();
    let mut first = 0;
    for (i, line) in lines(bytes).enumerate() {
        let line = line.trim_ascii_end();
        if joined.is_empty() {
            first = i + 1;
        } else if let Some(word @ (b"v" | b"f")) = words(line).next() {
            // No argument has that form.
            each(Line::Joined { line: i, word })?;
        }
        // A comment that ends in a backslash, such as a path, does not continue on the next line.
        if let Some(part) = line.strip_suffix(b"\\").filter(|part| !part.contains(&b'#')) {
            joined.extend_from_slice(part);
            joined.push(b' ');
        } else if joined.is_empty() {
            each(Line::Whole { line: first, text: line })?;
        } else {
            joined.extend_from_slice(line);
            each(Line::Whole { line: first, text: &joined })?;
            joined.clear();
        }
    }
    if joined.is_empty() { Ok(()) } else { each(Line::Whole { line: first, text: &joined }) }
}

/// Adds the references of a line to vertices that the file does not have. Problems of their form are
/// known.
fn missing(line: usize, text: &[u8], vertices: usize, problems: &mut Problems) -> Result<(), Problem> {
    let mut words = words(statement(text));
    if !words.next().is_some_and(|word| matches!(Word::of(word), Word::Face | Word::Line | Word::Point)) {
        return Ok(());
    }
    let index = |word: &[u8]| word.split(|&b| b == b'/').next().and_then(parse::<i64>);
    let mut far = words.filter_map(index).filter(|index| *index > vertices as i64);
    far.try_for_each(|index| problems.add(ObjProblem::Index { line, index, vertices }))
}

/// A line without its comment.
fn statement(text: &[u8]) -> &[u8] {
    &text[..text.iter().position(|&b| b == b'#').unwrap_or(text.len())]
}

/// Lines without their ends.
fn lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = Some(bytes);
    std::iter::from_fn(move || {
        let now = rest?;
        let Some(end) = now.iter().position(|b| matches!(b, b'\n' | b'\r')) else {
            rest = None;
            return Some(now);
        };
        let length = if now[end..].starts_with(b"\r\n") { 2 } else { 1 };
        rest = Some(&now[end + length..]);
        Some(&now[..end])
    })
}

fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

#[derive(Default)]
struct Obj {
    points: Vec<[f64; 3]>,
    faces: Fans,
    loose: Loose,
    notes: Notes,
    /// The largest reference to a vertex that was not defined yet.
    ahead: i64,
}

impl Obj {
    fn line(&mut self, line: usize, text: &[u8]) -> Result<(), ObjProblem> {
        let text = statement(text);
        let mut words = words(text);
        let Some(word) = words.next() else { return Ok(()) };
        if text.contains(&0) {
            return Err(ObjProblem::Nul { line });
        }
        match Word::of(word) {
            Word::Vertex => self.vertex(line, words)?,
            Word::Face => self.face(line, words)?,
            Word::Line => self.segments(line, words)?,
            Word::Point => {
                words.try_for_each(|word| self.corner(line, word).map(|vertex| self.loose.point(vertex)))?
            }
            Word::Quiet => {}
            Word::Element => {
                self.notes.add(Treated::NotRead, || ObjProblem::Element { line, found: shown(word) }.into())
            }
            Word::Misspelt => return Err(ObjProblem::Misspelt { line, found: shown(word) }),
            Word::Unknown => {
                self.notes.add(Treated::Unknown, || ObjProblem::Word { line, found: shown(word) }.into());
            }
        }
        Ok(())
    }

    fn vertex<'a>(
        &mut self,
        line: usize,
        mut words: impl Iterator<Item = &'a [u8]>,
    ) -> Result<(), ObjProblem> {
        let vertex = self.points.len();
        // Even if it is wrong: other problems keep their numbers.
        self.points.push([0.0; 3]);
        let mut point = [0.0; 3];
        for (found, (x, axis)) in point.iter_mut().zip(['x', 'y', 'z']).enumerate() {
            let word = words.next().ok_or(ObjProblem::ShortVertex { line, found })?;
            *x = parse(word).ok_or_else(|| ObjProblem::Number { line, vertex, axis, found: shown(word) })?;
        }
        for (at, word) in words.enumerate() {
            if at >= MOST_AFTER || parse::<f64>(word).is_none() {
                return Err(ObjProblem::LongVertex { line, vertex, found: shown(word) });
            }
        }
        self.points[vertex] = point;
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
            self.faces.leave_out(corners as u64);
            self.notes.add(Treated::LeftOut, || ObjProblem::ShortFace { line, corners }.into());
        }
        Ok(())
    }

    /// The segments of a line, from each corner to the next.
    fn segments<'a>(&mut self, line: usize, words: impl Iterator<Item = &'a [u8]>) -> Result<(), ObjProblem> {
        let corners: Vec<u32> = words.map(|word| self.corner(line, word)).collect::<Result<_, _>>()?;
        corners.windows(2).for_each(|ends| self.loose.segment([ends[0], ends[1]]));
        if corners.len() < 2 {
            let corners = corners.len();
            self.notes.add(Treated::LeftOut, || ObjProblem::ShortLine { line, corners }.into());
        }
        Ok(())
    }

    /// The vertex of a corner, counted from 0.
    fn corner(&mut self, line: usize, word: &[u8]) -> Result<u32, ObjProblem> {
        let wrong = || ObjProblem::Corner { line, found: shown(word) };
        let mut parts = word.split(|&b| b == b'/');
        let index: i64 = parts.next().and_then(parse).ok_or_else(wrong)?;
        // Texture and normal are not used, but must be valid.
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
        if from_0 >= vertices as i64 {
            self.ahead = self.ahead.max(index);
        }
        Ok(index_u32)
    }
}

/// Maximum count of numbers after the three of a vertex: a weight, and a colour of three.
const MOST_AFTER: usize = 4;

fn parse<T: std::str::FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}
