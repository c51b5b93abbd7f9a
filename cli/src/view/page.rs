//! The page: a template that is made from `cli/view`, and the data that it reads.

use super::columns::{Arrays, Columns, Names};
use super::motion::{Places, Turn};
use crate::sequence::Moment;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::GzDecoder;
use nearmiss::mesh::Body;
use serde::Serialize;
use std::io::{Read, Write};

/// The page without data, packed; `cli/view/build.sh` makes it.
const TEMPLATE: &[u8] = include_bytes!("../../view/page.html.gz");
/// The place of the data.
const DATA: &str = "<!--data-->";
/// The number of this format of the data; `cli/view/src/data.js` reads it.
const FORMAT: u32 = 1;

/// The part that all frames share.
pub struct About {
    pub title: String,
    /// The middle of the bodies in all frames, and their longest side.
    pub middle: [f64; 3],
    pub side: f64,
    pub at_rest: bool,
    /// The direction to the eye, and the one upwards.
    pub direction: [[f64; 3]; 2],
    pub columns: Columns,
    /// The names of the bodies.
    pub names: Vec<String>,
}

impl About {
    /// A point from the middle of the bodies, in units of their longest side: within the cube of side
    /// 1 that the page shows.
    pub fn near_origin(&self, point: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| (point[k] - self.middle[k]) / self.side)
    }
}

/// The head of the data.
#[derive(Serialize)]
struct Head<'a> {
    format: u32,
    version: &'static str,
    title: &'a str,
    at_rest: bool,
    middle: [f64; 3],
    side: f64,
    view: [f64; 3],
    up: [f64; 3],
    columns: &'a Columns,
    names: Names,
    bodies: Vec<Named<'a>>,
    moments: &'a [Told],
}

#[derive(Serialize)]
struct Named<'a> {
    name: &'a str,
    vertices: usize,
    faces: usize,
}

/// A step or frame in the head.
#[derive(Serialize)]
struct Told {
    #[serde(flatten)]
    moment: Moment,
    #[serde(flatten)]
    outcome: Outcome,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Outcome {
    Tested(Tested),
    Untested { reason: String },
}

/// A step or frame in the head that was tested.
#[derive(Serialize)]
pub struct Tested {
    pub rows: usize,
    /// The result, notes and caveats.
    pub remarks: Vec<String>,
    /// Numbers of the places of each body, at the start and at the end.
    pub starts: Vec<usize>,
    pub ends: Vec<usize>,
    pub turns: Vec<Turn>,
}

/// A step or frame that was tested.
pub struct Frame {
    pub moment: Moment,
    pub tested: Tested,
    /// Coloured triangles, each followed by its colour.
    pub met: Vec<u32>,
    pub rows: Arrays,
}

/// The size of a page that is written.
pub struct Written {
    pub rows: u64,
    pub bytes: u64,
}

/// A page that is being written.
pub struct Page<'a> {
    pub about: About,
    out: Counted<'a>,
    sizes: Vec<[usize; 2]>,
    told: Vec<Told>,
    /// The template after the data.
    tail: String,
}

impl<'a> Page<'a> {
    /// Writes the template up to the data, the triangles, and a colour for each.
    pub fn begin(
        out: &'a mut dyn Write,
        about: About,
        bodies: &[Body],
        (faces, colours): (&[[u32; 3]], &[[u8; 3]]),
    ) -> Result<Page<'a>, String> {
        let mut template = String::new();
        GzDecoder::new(TEMPLATE).read_to_string(&mut template).map_err(|e| e.to_string())?;
        let (head, tail) = template.split_once(DATA).ok_or("the template has no place for data")?;
        let sizes = bodies.iter().map(|body| [body.vertex_count(), body.element_count()]).collect();
        let out = Counted { out, bytes: 0 };
        let mut page = Page { about, out, sizes, told: Vec::new(), tail: tail.to_owned() };
        page.put(head)?;
        page.blob("faces", &bytes(faces.as_flattened(), |x| x.to_le_bytes()))?;
        page.blob("colours", colours.as_flattened())?;
        Ok(page)
    }

    /// Writes places, each under its number.
    pub fn places(&mut self, stored: &[(usize, Places)]) -> Result<(), String> {
        stored.iter().try_for_each(|(number, places)| {
            self.blob(&format!("places-{number}"), &bytes(places, |x| x.to_le_bytes()))
        })
    }

    /// Writes the rows and the coloured triangles of a step or frame.
    pub fn frame(&mut self, frame: Frame) -> Result<(), String> {
        let at = self.told.len();
        self.blob(&format!("words-{at}"), &bytes(&frame.rows.words, |x| x.to_le_bytes()))?;
        self.blob(&format!("numbers-{at}"), &bytes(&frame.rows.numbers, |x| x.to_le_bytes()))?;
        self.blob(&format!("met-{at}"), &bytes(&frame.met, |x| x.to_le_bytes()))?;
        self.told.push(Told { moment: frame.moment, outcome: Outcome::Tested(frame.tested) });
        Ok(())
    }

    /// Notes a step or frame that was not tested.
    pub fn pass(&mut self, moment: Moment, reason: &str) {
        self.told.push(Told { moment, outcome: Outcome::Untested { reason: reason.into() } });
    }

    /// Writes the head of the data and the rest of the template.
    pub fn end(mut self) -> Result<Written, String> {
        let About { title, middle, side, at_rest, direction: [view, up], columns, names } = &self.about;
        let named = names.iter().zip(&self.sizes);
        let head = Head {
            format: FORMAT,
            version: env!("CARGO_PKG_VERSION"),
            title,
            at_rest: *at_rest,
            middle: *middle,
            side: *side,
            view: *view,
            up: *up,
            columns,
            names: columns.names,
            bodies: named
                .map(|(name, [vertices, faces])| Named { name, vertices: *vertices, faces: *faces })
                .collect(),
            moments: &self.told,
        };
        let head = serde_json::to_string(&head).map_err(|e| e.to_string())?;
        // No text of a file ends the script.
        let head = head.replace('<', "\\u003c");
        self.put(&format!("<script type=\"application/json\" id=\"scene\">{head}</script>\n"))?;
        let tail = std::mem::take(&mut self.tail);
        self.put(&tail)?;
        let rows = |told: &Told| match &told.outcome {
            Outcome::Tested(tested) => tested.rows as u64,
            Outcome::Untested { .. } => 0,
        };
        Ok(Written { rows: self.told.iter().map(rows).sum(), bytes: self.out.bytes })
    }

    /// Writes an array under a name.
    fn blob(&mut self, name: &str, bytes: &[u8]) -> Result<(), String> {
        self.put(&format!("<script type=\"text/plain\" id=\"{name}\">{}</script>\n", STANDARD.encode(bytes)))
    }

    fn put(&mut self, text: &str) -> Result<(), String> {
        self.out.out.write_all(text.as_bytes()).map_err(|e| e.to_string())?;
        self.out.bytes += text.len() as u64;
        Ok(())
    }
}

/// A file, and the bytes that it has got.
struct Counted<'a> {
    out: &'a mut dyn Write,
    bytes: u64,
}

/// Numbers as bytes.
fn bytes<T: Copy, const N: usize>(numbers: &[T], of: impl Fn(T) -> [u8; N]) -> Vec<u8> {
    numbers.iter().flat_map(|number| of(*number)).collect()
}
