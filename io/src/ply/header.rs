//! The header of a PLY file: elements, their counts and their properties, borrowed from the bytes
//! of the file.

use super::source::Scalar;
use crate::shown::shown;
use nearmiss::mesh::PlyProblem;
use std::collections::HashSet;

/// Encoding of the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

/// A single number or a list of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    One(Scalar),
    List { length: Scalar, item: Scalar },
}

#[derive(Debug)]
pub(super) struct Property<'a> {
    pub name: &'a str,
    pub kind: Kind,
}

#[derive(Debug)]
pub(super) struct Element<'a> {
    pub name: &'a str,
    pub count: u64,
    pub properties: Vec<Property<'a>>,
}

#[derive(Debug)]
pub(super) struct Header<'a> {
    pub encoding: Encoding,
    pub elements: Vec<Element<'a>>,
    /// Offset of the body.
    pub size: usize,
}

impl<'a> Header<'a> {
    /// Reads up to and including the line `end_header`. Lines end in LF, CR LF, or CR if the first
    /// one does.
    pub fn read(bytes: &'a [u8]) -> Result<Header<'a>, PlyProblem> {
        let mut lines = Lines::new(bytes);
        let first = lines.next().unwrap_or(bytes);
        if first != b"ply" {
            return Err(PlyProblem::NotPly { found: shown(first) });
        }
        let mut encoding = None;
        let mut elements: Vec<Element<'a>> = Vec::new();
        let mut element_names = HashSet::new();
        let mut property_names = HashSet::new();
        while let Some(bytes) = lines.next() {
            let line = lines.read;
            let keyword = bytes.trim_ascii_start().split(u8::is_ascii_whitespace).next();
            if matches!(keyword, Some(b"comment" | b"obj_info")) {
                continue; // free text, in any encoding
            }
            let text = std::str::from_utf8(bytes)
                .map_err(|_| PlyProblem::HeaderText { line, found: shown(bytes) })?
                .trim_ascii();
            let mut words = text.split_ascii_whitespace();
            match words.next() {
                None => {}
                Some("end_header") => {
                    let encoding = encoding.ok_or(PlyProblem::NoFormat)?;
                    return Ok(Header { encoding, elements, size: lines.at });
                }
                Some("format") => {
                    let earlier = encoding.replace(self::encoding(line, text)?);
                    if earlier.is_some() {
                        return Err(PlyProblem::Twice { line, what: "the", name: "format".into() });
                    }
                }
                Some("element") => {
                    let element = element(line, text)?;
                    if !element_names.insert(element.name) {
                        return Err(twice(line, "element", element.name));
                    }
                    elements.push(element);
                    property_names.clear();
                }
                Some("property") => {
                    let property = property(line, text)?;
                    let element = elements.last_mut().ok_or(PlyProblem::Orphan { line })?;
                    if !property_names.insert(property.name) {
                        return Err(twice(line, "property", property.name));
                    }
                    element.properties.push(property);
                }
                Some(other) => return Err(PlyProblem::Keyword { line, found: shown(other.as_bytes()) }),
            }
        }
        Err(PlyProblem::HeaderCut { lines: lines.read })
    }
}

fn twice(line: usize, what: &'static str, name: &str) -> PlyProblem {
    PlyProblem::Twice { line, what, name: shown(name.as_bytes()) }
}

fn encoding(line: usize, text: &str) -> Result<Encoding, PlyProblem> {
    let mut words = text.split_ascii_whitespace().skip(1);
    match (words.next(), words.next(), words.next()) {
        (Some("ascii"), Some("1.0"), None) => Ok(Encoding::Ascii),
        (Some("binary_little_endian"), Some("1.0"), None) => Ok(Encoding::Little),
        (Some("binary_big_endian"), Some("1.0"), None) => Ok(Encoding::Big),
        _ => Err(PlyProblem::Format {
            line,
            found: shown(text.strip_prefix("format").unwrap_or(text).trim_ascii().as_bytes()),
        }),
    }
}

fn element(line: usize, text: &str) -> Result<Element<'_>, PlyProblem> {
    let mut words = text.split_ascii_whitespace().skip(1);
    let (Some(name), Some(count), None) = (words.next(), words.next(), words.next()) else {
        return Err(PlyProblem::Form { line, found: shown(text.as_bytes()), form: "element NAME COUNT" });
    };
    let count = count.parse().map_err(|_| PlyProblem::Count {
        line,
        element: shown(name.as_bytes()),
        found: shown(count.as_bytes()),
    })?;
    Ok(Element { name, count, properties: Vec::new() })
}

fn property(line: usize, text: &str) -> Result<Property<'_>, PlyProblem> {
    let scalar = |word: &str| {
        Scalar::named(word).ok_or_else(|| PlyProblem::TypeName { line, found: shown(word.as_bytes()) })
    };
    let mut words = text.split_ascii_whitespace().skip(1);
    let five = [words.next(), words.next(), words.next(), words.next(), words.next()];
    match five {
        [Some("list"), Some(length), Some(item), Some(name), None] => {
            let (length, item) = (scalar(length)?, scalar(item)?);
            if !length.is_integer() {
                let property = shown(name.as_bytes());
                return Err(PlyProblem::ListType { line, property, what: "length", found: length.name() });
            }
            if !item.is_integer() && is_corners(name) {
                let property = shown(name.as_bytes());
                return Err(PlyProblem::ListType { line, property, what: "indices", found: item.name() });
            }
            Ok(Property { name, kind: Kind::List { length, item } })
        }
        [Some(word), Some(name), None, ..] if word != "list" => {
            Ok(Property { name, kind: Kind::One(scalar(word)?) })
        }
        _ => Err(PlyProblem::Form {
            line,
            found: shown(text.as_bytes()),
            form: "property TYPE NAME\" or \"property list TYPE TYPE NAME",
        }),
    }
}

/// Whether `name` is one of the two names for the corners of a face.
pub(super) fn is_corners(name: &str) -> bool {
    matches!(name, "vertex_indices" | "vertex_index")
}

/// Header lines without their ends.
struct Lines<'a> {
    bytes: &'a [u8],
    end: u8,
    at: usize,
    read: usize,
}

impl<'a> Lines<'a> {
    fn new(bytes: &'a [u8]) -> Lines<'a> {
        let first = bytes.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(0);
        let lone_cr = bytes.get(first) == Some(&b'\r') && bytes.get(first + 1) != Some(&b'\n');
        Lines { bytes, end: if lone_cr { b'\r' } else { b'\n' }, at: 0, read: 0 }
    }

    /// The next line, trimmed at its end; `None` if no line end follows.
    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&b| b == self.end)?;
        self.at += length + 1;
        self.read += 1;
        Some(rest[..length].trim_ascii_end())
    }
}
