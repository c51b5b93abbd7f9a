//! Files of figures: CSV, a row a stage of a question of a case.

use super::measure::{Measured, STAGES, TOTAL, WALL, called};
use super::{Figures, Machine};
use crate::sequence::read_text;
use nearmiss::error::Error;
use nearmiss::mesh::Problem;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// The file's name in the folder of `--out`.
pub const NAME: &str = "bench.csv";

/// The columns, in their order.
const COLUMNS: [&str; 16] = [
    "machine",
    "threads",
    "version",
    "case",
    "triangles",
    "bodies",
    "question",
    "stage",
    "frames",
    "median_ms",
    "low_ms",
    "high_ms",
    "candidates",
    "contacts",
    "bytes",
    "hash",
];

/// A row, by its columns.
#[derive(Serialize, Deserialize)]
struct Row {
    machine: String,
    threads: Option<usize>,
    version: String,
    case: String,
    triangles: usize,
    bodies: usize,
    question: String,
    stage: String,
    frames: u32,
    median_ms: f64,
    low_ms: f64,
    high_ms: f64,
    candidates: u64,
    contacts: usize,
    bytes: u64,
    hash: String,
}

/// A question of a case in an earlier file.
pub struct EarlierCase {
    pub case: String,
    pub question: String,
    pub hash: String,
    /// Medians by stage, milliseconds.
    pub ms: BTreeMap<String, f64>,
}

/// An earlier file.
pub struct Earlier {
    pub file: String,
    pub machine: Machine,
    pub version: String,
    /// In the file's order.
    pub cases: Vec<EarlierCase>,
}

impl Earlier {
    /// A query of a case, if the file has it.
    pub fn of(&self, case: &str, question: &str) -> Option<&EarlierCase> {
        self.cases.iter().find(|of| of.case == case && of.question == question)
    }
}

/// The figures as CSV.
///
/// # Errors
/// The writer's text.
pub fn csv(all: &Figures) -> Result<Vec<u8>, Error> {
    let row = |of: &Measured, at: usize| {
        let times = &of.stages[at];
        Row {
            machine: all.machine.machine.clone(),
            threads: all.machine.threads,
            version: all.version.into(),
            case: of.case.clone(),
            triangles: of.triangles,
            bodies: of.bodies,
            question: of.question.into(),
            stage: times.stage.into(),
            frames: all.frames,
            median_ms: times.median_ms,
            low_ms: times.low_ms,
            high_ms: times.high_ms,
            candidates: of.candidates,
            contacts: of.contacts,
            bytes: of.bytes,
            hash: of.hash.clone(),
        }
    };
    let rows = |of| (0..STAGES.len()).map(move |at| row(of, at));
    nearmiss_lab::tables::csv(&all.cases.iter().flat_map(rows).collect::<Vec<_>>())
}

/// Reads an earlier file. Columns and stages that are not known are passed over.
///
/// # Errors
/// [`Error::Input`], naming the file, the line and the value.
pub fn read(path: &Path) -> Result<Earlier, Error> {
    let text = read_text(path)?;
    parse(&text)
        .map_err(|(what, advice)| Error::Input {
            file: path.display().to_string(),
            problem: Problem::Scene { what, advice },
        })
        .map(|earlier| Earlier { file: path.display().to_string(), ..earlier })
}

/// A fault, and its remedy.
type Wrong = (String, String);

/// The remedy for a file that was changed.
const ANEW: &str = "fix it, or measure again with nearmiss lab bench --out DIR";

fn parse(text: &str) -> Result<Earlier, Wrong> {
    let anew = |what: String| (what, ANEW.to_owned());
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let heads = reader.headers().map_err(|e| anew(e.to_string()))?.clone();
    if let Some(missing) = COLUMNS.iter().find(|column| !heads.iter().any(|head| head == **column)) {
        let advice =
            format!("give a file that nearmiss lab bench wrote, with the columns {}", COLUMNS.join(","));
        return Err((format!("line 1: has no column {missing}"), advice));
    }
    let mut found: Option<Earlier> = None;
    for record in reader.records() {
        let record = record.map_err(|e| anew(e.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        let row: Row = record.deserialize(Some(&heads)).map_err(|e| misread(line, (&heads, &record), &e))?;
        add(&mut found, row).map_err(|what| anew(format!("line {line}: {what}")))?;
    }
    let found = found.ok_or_else(|| anew("has no rows".into()))?;
    for of in &found.cases {
        if let Some(missing) = [TOTAL, WALL].into_iter().find(|stage| !of.ms.contains_key(*stage)) {
            let called = called(&of.case, &of.question);
            return Err(anew(format!("has no row of {called} for the stage {missing}")));
        }
    }
    Ok(found)
}

/// A value that is not what its column holds.
fn misread(
    line: u64,
    (heads, record): (&csv::StringRecord, &csv::StringRecord),
    error: &csv::Error,
) -> Wrong {
    let field = match error.kind() {
        csv::ErrorKind::Deserialize { err, .. } => err.field().and_then(|at| usize::try_from(at).ok()),
        _ => None,
    };
    let named = field.and_then(|at| Some((heads.get(at)?, record.get(at)?)));
    let what = match named {
        Some((column, value)) => format!("line {line}: {column} is {value:?}, and must be a number from 0"),
        None => format!("line {line}: {error}"),
    };
    (what, ANEW.into())
}

/// Adds a row to what the rows before it gave.
fn add(found: &mut Option<Earlier>, row: Row) -> Result<(), String> {
    for (column, ms) in [("median_ms", row.median_ms), ("low_ms", row.low_ms), ("high_ms", row.high_ms)] {
        if !(0.0..f64::INFINITY).contains(&ms) {
            return Err(format!("{column} is {ms}, and must be from 0"));
        }
    }
    if !(row.low_ms..=row.high_ms).contains(&row.median_ms) {
        return Err(format!(
            "median_ms is {}, and must be from low_ms, {}, to high_ms, {}",
            row.median_ms, row.low_ms, row.high_ms
        ));
    }
    if row.hash.len() != 16 || !row.hash.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return Err(format!("hash is {:?}, and must be sixteen hexadecimal digits", row.hash));
    }
    let machine = Machine { machine: row.machine, threads: row.threads };
    let all = found.get_or_insert_with(|| Earlier {
        file: String::new(),
        machine: machine.clone(),
        version: row.version.clone(),
        cases: Vec::new(),
    });
    if (&machine, &row.version) != (&all.machine, &all.version) {
        return Err(format!(
            "is of {machine}, version {}, the lines before of {}, version {}",
            row.version, all.machine, all.version
        ));
    }
    let at = all.cases.iter().position(|of| of.case == row.case && of.question == row.question);
    let at = at.unwrap_or_else(|| {
        let (case, question, hash) = (row.case.clone(), row.question.clone(), row.hash.clone());
        all.cases.push(EarlierCase { case, question, hash, ms: BTreeMap::new() });
        all.cases.len() - 1
    });
    let of = &mut all.cases[at];
    let called = called(&of.case, &of.question);
    if of.hash != row.hash {
        return Err(format!("hash of {called} is {}, in a line before {}", row.hash, of.hash));
    }
    match of.ms.insert(row.stage.clone(), row.median_ms) {
        None => Ok(()),
        Some(_) => Err(format!("the stage {} of {called} stands in a line before", row.stage)),
    }
}
