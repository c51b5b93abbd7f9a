//! OFF files to positions and faces: a vertex a line, then a face a line.
//!
//! This is our own reader. The crate `off-rs` reads floats alone and no header but `OFF`.

use crate::loose::Loose;
use crate::mesh_file::Parsed;
use crate::note::{Notes, Treated};
use crate::polygons::Fans;
use crate::problems::{Problems, wrong};
use crate::shown::shown;
use crate::welded::positions;
use nearmiss::mesh::{MAX_FACES, MAX_VERTICES, Problem};

/// Reads the whole file. Colours, normals and texture coordinates are skipped. A face of two corners is
/// an edge, and one of one corner a point.
pub(crate) fn read(bytes: &[u8], problems: &mut Problems) -> Result<Parsed, Problem> {
    let mut lines = Lines { rest: bytes, line: 0 };
    let [vertices, faces] = counts(&mut lines)?;
    let mut points = Vec::new();
    for vertex in 0..vertices {
        let (line, text) = lines.next().ok_or_else(|| cut("vertices", vertices, vertex))?;
        points.push(match point(line, text) {
            Ok(point) => point,
            Err(problem) => problems.add(problem).map(|()| [0.0; 3])?,
        });
    }
    let (mut fans, mut loose, mut notes) = (Fans::default(), Loose::default(), Notes::default());
    for face in 0..faces {
        let (line, text) = lines.next().ok_or_else(|| cut("faces", faces, face))?;
        polygon((line, text), vertices, (&mut fans, &mut loose, &mut notes))
            .or_else(|problem| problems.add(problem))?;
    }
    match lines.next() {
        Some((line, text)) => Err(wrong(
            format!("line {line}: {:?} is after the last face", shown(text)),
            "correct the counts of the header, or remove it",
        )),
        None => Ok(Parsed { positions: positions(points), fans, loose, notes }),
    }
}

/// Lines that have anything besides a comment, with their numbers.
struct Lines<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<(usize, &'a [u8])> {
        while !self.rest.is_empty() {
            let end = self.rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(self.rest.len());
            let (text, rest) = self.rest.split_at(end);
            let length = if rest.starts_with(b"\r\n") { 2 } else { 1.min(rest.len()) };
            self.rest = &rest[length..];
            self.line += 1;
            let text = text.split(|b| *b == b'#').next().unwrap_or_default().trim_ascii();
            if !text.is_empty() {
                return Some((self.line, text));
            }
        }
        None
    }
}

fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

fn number<T: std::str::FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// The numbers of vertices and faces, behind the keyword or on the next line.
fn counts(lines: &mut Lines<'_>) -> Result<[u64; 2], Problem> {
    let (line, text) = lines.next().unwrap_or((1, b""));
    let mut all = words(text);
    let keyword = all.next().unwrap_or_default();
    if !matches!(
        keyword,
        b"OFF" | b"COFF" | b"NOFF" | b"CNOFF" | b"STOFF" | b"STCOFF" | b"STNOFF" | b"STCNOFF"
    ) {
        let what = format!("line {line}: begins with {:?}, and an OFF file with \"OFF\"", shown(keyword));
        return Err(wrong(what, "give an OFF file of three dimensions, in text"));
    }
    let own: Vec<&[u8]> = all.collect();
    if own.first() == Some(&&b"BINARY"[..]) {
        return Err(wrong(format!("line {line}: is a binary OFF file"), "give an OFF file in text"));
    }
    let (line, counts) = match own.is_empty() {
        true => lines.next().map_or((line, Vec::new()), |(line, text)| (line, words(text).collect())),
        false => (line, own),
    };
    let found: Option<Vec<u64>> = counts.iter().map(|word| number(word)).collect();
    match found.as_deref() {
        Some([vertices, faces] | [vertices, faces, _]) => {
            for (what, count, limit) in [("vertices", *vertices, MAX_VERTICES), ("faces", *faces, MAX_FACES)]
            {
                if count > limit as u64 {
                    return Err(Problem::TooMany { what, count, limit: limit as u64 });
                }
            }
            Ok([*vertices, *faces])
        }
        _ => {
            let found = counts.join(&b' ');
            let what = format!("line {line}: has {:?} for the numbers of vertices and faces", shown(&found));
            Err(wrong(what, "write two or three whole numbers, such as 8 6 12"))
        }
    }
}

fn cut(what: &str, count: u64, found: u64) -> Problem {
    wrong(format!("ends after {found} of {count} {what}"), "copy the file again, or correct its header")
}

fn point(line: usize, text: &[u8]) -> Result<[f64; 3], Problem> {
    let mut point = [0.0; 3];
    let mut all = words(text);
    for (x, axis) in point.iter_mut().zip(['x', 'y', 'z']) {
        let word = all.next().unwrap_or_default();
        *x = number(word).ok_or_else(|| {
            wrong(format!("line {line}: {axis} is {:?}, which is no number", shown(word)), "correct it")
        })?;
    }
    match all.find(|word| number::<f64>(word).is_none()) {
        Some(word) => {
            Err(wrong(format!("line {line}: {:?} behind a vertex is no number", shown(word)), "correct it"))
        }
        None => Ok(point),
    }
}

fn polygon(
    (line, text): (usize, &[u8]),
    vertices: u64,
    (fans, loose, notes): (&mut Fans, &mut Loose, &mut Notes),
) -> Result<(), Problem> {
    let mut all = words(text);
    let first = all.next().unwrap_or_default();
    let count: usize = number(first).ok_or_else(|| {
        wrong(format!("line {line}: {:?} is no number of corners", shown(first)), "correct it")
    })?;
    let mut corners = Vec::new();
    for word in all.by_ref().take(count) {
        let index: i64 = number(word).ok_or_else(|| {
            wrong(format!("line {line}: the corner {:?} is no whole number", shown(word)), "correct it")
        })?;
        let vertex = u32::try_from(index).ok().filter(|vertex| u64::from(*vertex) < vertices);
        corners.push(vertex.ok_or_else(|| {
            let what = format!("line {line}: names vertex {index}, but there are {vertices}, counted from 0");
            wrong(what, "correct the index or remove the face")
        })?);
    }
    if corners.len() < count {
        let what = format!("line {line}: has {} of {count} corners", corners.len());
        return Err(wrong(what, "correct the face or remove it"));
    }
    match corners[..] {
        [] => {
            fans.leave_out(0);
            notes.add(Treated::LeftOut, || {
                wrong(format!("line {line}: the face has no corners"), "remove it")
            });
        }
        [a] => {
            fans.leave_out(0);
            loose.point(a);
        }
        [a, b] => {
            fans.leave_out(0);
            loose.segment([a, b]);
        }
        _ => corners.iter().enumerate().for_each(|(at, vertex)| fans.corner(at as u64, *vertex)),
    }
    Ok(())
}
