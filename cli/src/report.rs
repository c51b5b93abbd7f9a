//! Results as files: CSV and JSON.

use crate::output::Target;
use nearmiss::contacts::{Answer, Contacts, Kind, Status, Summary};
use nearmiss::error::Error;
use serde::Serialize;
use std::io::Write;
use std::path::Path;

/// What is said of an answer.
#[derive(Serialize)]
pub struct Told {
    /// Its figures.
    #[serde(flatten)]
    pub summary: Summary,
    /// Of an earliest query, the triangle pairs that meet at the start of the step already.
    pub pairs_at_start: Option<usize>,
    /// What else a user should know.
    pub notes: Vec<String>,
}

/// Formats that contacts can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// `tri_a,tri_b`, or `kind,a,b,toi,toi_hi,status`.
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

/// Writes contacts in canonical order; times read back to the same bits.
///
/// # Errors
/// [`Error::Output`] when the file cannot be written.
pub fn write(target: Target, format: Format, contacts: &Contacts, told: &Told) -> Result<(), Error> {
    target.write(|out| match format {
        Format::Csv => csv(out, contacts),
        Format::Json => json(out, contacts, told),
    })
}

/// Contacts as CSV. A time is printed as the shortest decimal that reads back to the same bits.
fn csv(out: impl Write, contacts: &Contacts) -> Result<(), String> {
    let mut csv = csv::Writer::from_writer(out);
    let wrote = match &contacts.answer {
        Answer::Pairs(pairs) => csv
            .write_record(["tri_a", "tri_b"])
            .and_then(|()| pairs.iter().try_for_each(|pair| csv.serialize(pair))),
        Answer::Contacts(all) => csv
            .write_record(["kind", "a", "b", "toi", "toi_hi", "status"])
            .and_then(|()| all.iter().try_for_each(|c| csv.write_record(row(c)))),
        Answer::Earliest(toi) => csv
            .write_record(["earliest_toi"])
            .and_then(|()| toi.iter().try_for_each(|toi| csv.write_record([toi.to_string()]))),
    };
    wrote.map_err(|e| e.to_string())?;
    csv.flush().map_err(|e| e.to_string())
}

fn row(c: &nearmiss::contacts::Contact) -> [String; 6] {
    let kind = match c.kind {
        Kind::Vf => "vf",
        Kind::Fv => "fv",
        Kind::Ee => "ee",
    };
    let status = match c.status {
        Status::Contact => "contact",
        Status::Certified => "certified",
        Status::Unresolved => "unresolved",
    };
    let [a, b] = [c.a, c.b].map(|i| i.to_string());
    [kind.into(), a, b, c.toi.to_string(), c.toi_hi.to_string(), status.into()]
}

/// The summary and the contacts as one JSON object.
fn json(out: impl Write, contacts: &Contacts, summary: &Told) -> Result<(), String> {
    #[derive(Serialize)]
    struct Whole<'a> {
        summary: &'a Told,
        contacts: Rows<'a>,
    }
    #[derive(Serialize)]
    #[serde(untagged)]
    enum Rows<'a> {
        Pairs(&'a [[u32; 2]]),
        Contacts(&'a [nearmiss::contacts::Contact]),
        Earliest(Option<f64>),
    }
    let rows = match &contacts.answer {
        Answer::Pairs(pairs) => Rows::Pairs(pairs),
        Answer::Contacts(all) => Rows::Contacts(all),
        Answer::Earliest(toi) => Rows::Earliest(*toi),
    };
    serde_json::to_writer(out, &Whole { summary, contacts: rows }).map_err(|e| e.to_string())
}
