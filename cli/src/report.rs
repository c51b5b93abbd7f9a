//! Results as files: CSV and JSON.

use crate::output::Target;
use nearmiss::contacts::{Answer, Contact, Contacts, Kind, NearPair, Status, Summary, TrianglePair};
use nearmiss::error::Error;
use nearmiss::mesh::Body;
use nearmiss::scene::BodyId;
use serde::Serialize;
use std::io::Write;
use std::path::Path;

/// What is said of an answer.
#[derive(Serialize)]
pub struct Report {
    /// Its figures.
    #[serde(flatten)]
    pub summary: Summary,
    /// Of an earliest query, the triangle pairs that meet at the start of the step already.
    pub pairs_at_start: Option<usize>,
    /// What else a user should know.
    pub notes: Vec<String>,
}

/// Of each triangle the face of the file that it was cut from, of one body or two.
pub struct FileFaces(Vec<Vec<u32>>);

impl FileFaces {
    /// Of these bodies.
    pub fn of(bodies: &[Body]) -> FileFaces {
        let all = |body: &Body| (0..body.face_count() as u32).map(|i| body.file_face(i)).collect();
        FileFaces(bodies.iter().map(all).collect())
    }

    fn face(&self, body: BodyId, triangle: u32) -> u32 {
        self.0[body.index()][triangle as usize]
    }

    /// The same answer in faces, ascending and each once: pairs of triangles of the same two faces become one, of contacts of a vertex with triangles
    /// of one face the earliest stays.
    fn name(&self, answer: &Answer) -> Answer {
        match answer {
            Answer::Pairs(pairs) => {
                let faces = |pair: &TrianglePair| {
                    let [a, b] = [0, 1].map(|k| self.face(pair.bodies[k], pair.triangles[k]));
                    let within = pair.bodies[0] == pair.bodies[1];
                    TrianglePair { triangles: if within { [a.min(b), a.max(b)] } else { [a, b] }, ..*pair }
                };
                let mut pairs: Vec<_> = pairs.iter().map(faces).collect();
                pairs.sort_unstable();
                pairs.dedup();
                Answer::Pairs(pairs)
            }
            Answer::Contacts(all) => {
                let faces = |c: &Contact| match c.kind {
                    Kind::Vf => Contact { b: self.face(c.bodies[1], c.b), ..*c },
                    Kind::Fv => Contact { a: self.face(c.bodies[0], c.a), ..*c },
                    Kind::Ee => *c,
                };
                let mut all: Vec<_> = all.iter().map(faces).collect();
                let key = |c: &Contact| (c.kind, c.bodies, c.a, c.b);
                all.sort_by(|c, d| key(c).cmp(&key(d)).then(c.toi.total_cmp(&d.toi)));
                all.dedup_by_key(|c| key(c));
                Answer::Contacts(all)
            }
            Answer::Earliest(toi) => Answer::Earliest(*toi),
            // Weights are those of a triangle's corners: `args` asks for no other names.
            Answer::Near(near) => Answer::Near(near.clone()),
        }
    }
}

/// Formats that contacts can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// `tri_a,tri_b` (`face_a,face_b`), or `kind,a,b,toi,toi_hi,status`, or
    /// `kind,a,b,squared_distance,w0,w1,w2,closest`.
    Csv,
    /// One object: the summary, and the rows under `contacts`.
    Json,
}

impl Format {
    /// The format that a file's name asks for.
    ///
    /// # Errors
    /// [`Error::Choice`] with the known ones.
    pub fn of(path: &Path) -> Result<Format, Error> {
        match path.extension().and_then(|e| e.to_str()) {
            Some("csv") => Ok(Format::Csv),
            Some("json") => Ok(Format::Json),
            _ => Err(Error::Choice {
                what: format!("{}: contacts cannot be written in that format", path.display()),
                advice: "give --out a name that ends in one of: .csv, .json".into(),
            }),
        }
    }
}

/// Writes contacts in canonical order, in triangles or in the files' own faces; times read back to the same bits.
///
/// # Errors
/// [`Error::Output`] when the file cannot be written.
pub fn write(
    target: Target,
    format: Format,
    contacts: &Contacts,
    (told, faces): (&Report, Option<&FileFaces>),
) -> Result<(), Error> {
    let named = faces.map(|faces| faces.name(&contacts.answer));
    let answer = named.as_ref().unwrap_or(&contacts.answer);
    let heads = if faces.is_some() { ["face_a", "face_b"] } else { ["tri_a", "tri_b"] };
    target.write(|out| match format {
        Format::Csv => csv(out, answer, heads),
        Format::Json => json(out, answer, told),
    })
}

/// Contacts as CSV. A number is printed as the shortest decimal that reads back to the same bits.
fn csv(out: impl Write, answer: &Answer, heads: [&str; 2]) -> Result<(), String> {
    let mut csv = csv::Writer::from_writer(out);
    let wrote = match answer {
        Answer::Pairs(pairs) => csv
            .write_record(heads)
            .and_then(|()| pairs.iter().try_for_each(|pair| csv.serialize(pair.triangles))),
        Answer::Contacts(all) => csv
            .write_record(["kind", "a", "b", "toi", "toi_hi", "status"])
            .and_then(|()| all.iter().try_for_each(|c| csv.write_record(row(c)))),
        Answer::Earliest(toi) => csv
            .write_record(["earliest_toi"])
            .and_then(|()| toi.iter().try_for_each(|toi| csv.write_record([toi.to_string()]))),
        Answer::Near(near) => csv
            .write_record(["kind", "a", "b", "squared_distance", "w0", "w1", "w2", "closest"])
            .and_then(|()| near.iter().try_for_each(|pair| csv.write_record(near_row(pair)))),
    };
    wrote.map_err(|e| e.to_string())?;
    csv.flush().map_err(|e| e.to_string())
}

fn kind(kind: Kind) -> String {
    match kind {
        Kind::Vf => "vf".into(),
        Kind::Fv => "fv".into(),
        Kind::Ee => "ee".into(),
    }
}

fn near_row(pair: &NearPair) -> [String; 8] {
    let [a, b] = [pair.a, pair.b].map(|i| i.to_string());
    let [x, y, z] = pair.weights.map(|weight| weight.to_string());
    [kind(pair.kind), a, b, pair.squared_distance.to_string(), x, y, z, pair.closest.name().into()]
}

fn row(c: &Contact) -> [String; 6] {
    let status = match c.status {
        Status::Contact => "contact",
        Status::Certified => "certified",
        Status::Unresolved => "unresolved",
    };
    let [a, b] = [c.a, c.b].map(|i| i.to_string());
    [kind(c.kind), a, b, c.toi.to_string(), c.toi_hi.to_string(), status.into()]
}

/// The summary and the contacts as one JSON object.
fn json(out: impl Write, answer: &Answer, summary: &Report) -> Result<(), String> {
    #[derive(Serialize)]
    struct Whole<'a> {
        summary: &'a Report,
        contacts: Rows<'a>,
    }
    #[derive(Serialize)]
    #[serde(untagged)]
    enum Rows<'a> {
        Pairs(Vec<[u32; 2]>),
        Contacts(&'a [Contact]),
        Earliest(Option<f64>),
        Near(&'a [NearPair]),
    }
    let rows = match answer {
        Answer::Pairs(pairs) => Rows::Pairs(pairs.iter().map(|pair| pair.triangles).collect()),
        Answer::Contacts(all) => Rows::Contacts(all),
        Answer::Earliest(toi) => Rows::Earliest(*toi),
        Answer::Near(near) => Rows::Near(near),
    };
    serde_json::to_writer(out, &Whole { summary, contacts: rows }).map_err(|e| e.to_string())
}
