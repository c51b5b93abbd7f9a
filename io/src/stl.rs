//! STL files, binary and text, to positions and faces. The corners of their triangles are welded.
//!
//! This is our own reader. The crate `stl_io` takes a binary file that begins with `solid` for text,
//! rounds numbers of text to floats, and reads no solid but the first.

use crate::loose::Loose;
use crate::mesh_file::Parsed;
use crate::note::{Notes, Treated};
use crate::polygons::Fans;
use crate::problems::wrong;
use crate::shown::shown;
use crate::welded::{Welded, positions};
use nearmiss::mesh::Problem;

/// Bytes of a binary file before its triangles, and those of a triangle: twelve floats and two bytes.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;

/// Reads the whole file.
pub(crate) fn read(bytes: &[u8]) -> Result<Parsed, Problem> {
    let (mut welded, mut fans) = (Welded::default(), Fans::default());
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let is_text = text.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    if is_binary(bytes) {
        for triangle in bytes[HEAD..].chunks_exact(TRIANGLE) {
            let number = |at: usize| f64::from(f32::from_bits(le(&triangle[at..at + 4])));
            let corner = |at: usize| [number(at), number(at + 4), number(at + 8)];
            fans.single([12, 24, 36].map(|at| welded.corner(corner(at))));
        }
    } else if is_text {
        Text { rest: text, line: 1 }.solids(&mut welded, &mut fans)?;
    } else {
        return Err(match triangles(bytes) {
            Some(count) => {
                let held = bytes.len().saturating_sub(HEAD);
                let need = u128::from(count) * TRIANGLE as u128;
                let what = format!(
                    "has {count} triangles of 50 bytes by its header, {need} in all, and {held} follow it"
                );
                wrong(what, "copy the file again, or write it again")
            }
            None => wrong(
                "is neither text that begins with \"solid\" nor as long as a header",
                "give an STL file",
            ),
        });
    }
    let mut notes = Notes::default();
    if welded.corners > 0 {
        notes.add_many(Treated::Welded { vertices: welded.points.len() as u64 }, welded.corners, || {
            wrong("an STL file has no shared vertices", "give a PLY or OBJ file to keep seams open")
        });
    }
    Ok(Parsed { positions: positions(welded.points), fans, loose: Loose::default(), notes })
}

/// Number of triangles by the header of a binary file.
fn triangles(bytes: &[u8]) -> Option<u64> {
    bytes.get(HEAD - 4..HEAD).map(|four| u64::from(le(four)))
}

/// Whether a file is as long as a binary one with that number of triangles.
pub(crate) fn is_binary(bytes: &[u8]) -> bool {
    triangles(bytes).is_some_and(|n| bytes.len() as u64 == HEAD as u64 + n * TRIANGLE as u64)
}

fn le(four: &[u8]) -> u32 {
    four.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte))
}

/// The rest of a text, and the line at which it begins.
struct Text<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Text<'a> {
    /// The next word; `None` at the end.
    fn word(&mut self) -> Option<&'a [u8]> {
        let start = self.rest.iter().position(|b| !b.is_ascii_whitespace())?;
        self.line += self.rest[..start].iter().filter(|b| **b == b'\n').count();
        let rest = &self.rest[start..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let (word, rest) = rest.split_at(end);
        self.rest = rest;
        Some(word)
    }

    /// Skips the rest of a line: names are free text.
    fn skip_line(&mut self) {
        let end = self.rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(self.rest.len());
        self.rest = &self.rest[end..];
    }

    /// Takes these words, in either case.
    fn words(&mut self, all: &[&str]) -> Result<(), Problem> {
        all.iter().try_for_each(|expected| {
            let word = self.word().unwrap_or_default();
            if word.eq_ignore_ascii_case(expected.as_bytes()) {
                Ok(())
            } else {
                Err(self.wrong(word, expected))
            }
        })
    }

    fn wrong(&self, found: &[u8], expected: &str) -> Problem {
        let what = match found {
            [] => format!("ends where {expected:?} must follow"),
            found => format!("line {}: has {:?} where {expected:?} must be", self.line, shown(found)),
        };
        wrong(what, "copy the file again, or write it again")
    }

    fn numbers(&mut self) -> Result<[f64; 3], Problem> {
        let mut all = [0.0; 3];
        for x in &mut all {
            let word = self.word().unwrap_or_default();
            let number = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
            *x = number.ok_or_else(|| self.wrong(word, "a number"))?;
        }
        Ok(all)
    }

    /// All solids of the file; each ends with `endsolid`.
    fn solids(&mut self, welded: &mut Welded, fans: &mut Fans) -> Result<(), Problem> {
        while let Some(word) = self.word() {
            if !word.eq_ignore_ascii_case(b"solid") {
                return Err(self.wrong(word, "solid"));
            }
            self.skip_line();
            loop {
                match self.word().unwrap_or_default().to_ascii_lowercase().as_slice() {
                    b"facet" => self.facet(welded, fans)?,
                    b"endsolid" => break self.skip_line(),
                    other => return Err(self.wrong(other, "facet or endsolid")),
                }
            }
        }
        Ok(())
    }

    /// A facet behind its first word. Its normal is skipped; some writers have NaN there.
    fn facet(&mut self, welded: &mut Welded, fans: &mut Fans) -> Result<(), Problem> {
        self.words(&["normal"])?;
        self.numbers()?;
        self.words(&["outer", "loop"])?;
        let mut corner = || {
            self.words(&["vertex"])?;
            self.numbers().map(|point| welded.corner(point))
        };
        let face = [corner()?, corner()?, corner()?];
        self.words(&["endloop", "endfacet"])?;
        fans.single(face);
        Ok(())
    }
}
