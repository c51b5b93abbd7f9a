//! Results as files: CSV, JSON and VTP.

use crate::detect::Places;
use crate::output::{Target, is_stdout, unpacked};
use crate::rows::{Columns, JsonRows};
use crate::sequence::Moment;
use crate::vtp::Vtp;
use nearmiss::contacts::{Contact, Contacts, Kind, Rows, TrianglePair};
use nearmiss::error::Error;
use nearmiss::mesh::Body;
use nearmiss::research::Summary;
use nearmiss::scene::BodyId;
use nearmiss_io::Polygons;
use serde::Serialize;
use std::io::Write;
use std::path::Path;

/// The summary of an answer.
#[derive(Serialize)]
pub struct Report {
    /// The step or frame of a sequence.
    #[serde(flatten)]
    pub moment: Option<Moment>,
    /// Triangle pairs that share a point, for queries at rest whose rows do not show it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crossing: Option<u64>,
    /// Its figures.
    #[serde(flatten)]
    pub summary: Summary,
}

/// The face of the file from which each triangle was cut, body by body. Edges and points of no face
/// come behind all faces.
pub struct FileFaces(Vec<Vec<u32>>);

impl FileFaces {
    /// The faces of these bodies.
    pub fn of(bodies: &[Body], polygons: &[Polygons]) -> FileFaces {
        let all = |(body, polygons): (&Body, &Polygons)| {
            let all = 0..body.element_count() as u32;
            all.map(|element| polygons.file_element(element, body.face_count())).collect()
        };
        FileFaces(bodies.iter().zip(polygons).map(all).collect())
    }

    fn face(&self, body: BodyId, triangle: u32) -> u32 {
        self.0[body.index()][triangle as usize]
    }

    /// The same answer in faces, ascending and each once. Pairs of triangles of the same two faces become
    /// one. If a vertex has contacts with several triangles of a face, the earliest stays.
    pub fn name(&self, answer: &Rows) -> Rows {
        match answer {
            Rows::Pairs(pairs) => {
                let faces = |pair: &TrianglePair| {
                    let [a, b] = [0, 1].map(|k| self.face(pair.bodies[k], pair.triangles[k]));
                    let within = pair.bodies[0] == pair.bodies[1];
                    TrianglePair { triangles: if within { [a.min(b), a.max(b)] } else { [a, b] }, ..*pair }
                };
                let mut pairs: Vec<_> = pairs.iter().map(faces).collect();
                pairs.sort_unstable_by_key(|pair| [0, 1].map(|k| (pair.bodies[k], pair.triangles[k])));
                pairs.dedup();
                Rows::Pairs(pairs.into())
            }
            Rows::Contacts(all) => {
                let faces = |c: &Contact| match c.kind {
                    Kind::Vf => Contact { feature_b: self.face(c.bodies[1], c.feature_b), ..*c },
                    Kind::Ee | Kind::Ev | Kind::Vv => *c,
                };
                let mut all: Vec<_> = all.iter().map(faces).collect();
                let key = |c: &Contact| (c.kind, (c.bodies[0], c.feature_a), (c.bodies[1], c.feature_b));
                all.sort_by(|c, d| key(c).cmp(&key(d)).then(c.toi.total_cmp(&d.toi)));
                all.dedup_by_key(|c| key(c));
                Rows::Contacts(all.into())
            }
            Rows::Earliest(toi) => Rows::Earliest(*toi),
            // Weights are those of a triangle's corners: `args` allows no other names.
            Rows::Near(near) => Rows::Near(near.clone()),
            Rows::Distance(nearest) => Rows::Distance(*nearest),
            Rows::BodyPairs(pairs) => Rows::BodyPairs(pairs.clone()),
            Rows::BodyDistances(all) => Rows::BodyDistances(all.clone()),
        }
    }
}

/// Formats that contacts can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Columns of the query, see [`crate::rows`]; before these the step and the bodies, if there
    /// are several.
    Csv,
    /// One object: the summary, and the rows under `contacts`.
    Json,
    /// Points, lines and what is known of them: see [`Vtp`].
    Vtp,
}

impl Format {
    /// The format of a file's name.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] with the known ones.
    pub fn of(path: &Path) -> Result<Format, Error> {
        match unpacked(path).extension().and_then(|e| e.to_str()) {
            _ if is_stdout(path) => Ok(Format::Csv),
            Some("csv") => Ok(Format::Csv),
            Some("json") => Ok(Format::Json),
            Some("vtp") => Ok(Format::Vtp),
            _ => Err(Error::InvalidArgument {
                what: format!(
                    "--out must end in .csv, .json or .vtp, each also with .gz, got {}",
                    path.display()
                ),
                advice: "rename the file".into(),
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
    told: &Report,
    (faces, names): (Option<&FileFaces>, Option<&[String]>),
    places: Option<&Places>,
) -> Result<(), Error> {
    let named = faces.map(|faces| faces.name(&contacts.rows));
    let answer = named.as_ref().unwrap_or(&contacts.rows);
    let geometry = places.map(|places| &places.geometry);
    let columns = Columns { moment: None, has_reason: false, names, faces: faces.is_some(), geometry };
    target.write(|out| match format {
        Format::Csv => {
            let mut csv = csv::Writer::from_writer(out);
            columns.head(&mut csv, answer)?;
            columns.rows(&mut csv, answer)?;
            csv.flush().map_err(|e| e.to_string())
        }
        Format::Json => json(out, told, JsonRows { answer, names, geometry }),
        Format::Vtp => {
            let mut vtp = Vtp::default();
            places.into_iter().for_each(|places| vtp.add(None, answer, places));
            vtp.write(out).map_err(|e| e.to_string())
        }
    })
}

/// The summary and the contacts as one JSON object.
fn json(out: impl Write, summary: &Report, contacts: JsonRows) -> Result<(), String> {
    #[derive(Serialize)]
    struct Whole<'a> {
        summary: &'a Report,
        contacts: JsonRows<'a>,
    }
    serde_json::to_writer(out, &Whole { summary, contacts }).map_err(|e| e.to_string())
}
