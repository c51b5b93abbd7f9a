//! Test cases with known answers, and the choices to test them with.

use super::judge::{Judge, Truth};
use super::row::Row;
use crate::case::{Case, Features};
use crate::oracle::first_contact;
use crate::pairs::built::{Built, built};
use crate::pairs::{Options, Stored, ask, mean_edge};
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::query::{Query, QueryKind};
use nearmiss::research::QueryExt;
use rayon::prelude::*;

/// Cases whose answers are known.
pub struct Input {
    /// Name of the cases.
    pub name: String,
    /// Source of the answers.
    pub reference: &'static str,
    /// The cases.
    pub cases: Vec<Case>,
    /// Their answers.
    pub truths: Vec<Truth>,
    /// Their mean edge length.
    pub edge: f64,
}

/// A query and its tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// The query, with its solver; each input sets the tolerance.
    pub asked: Query,
    /// Tolerance in mean edges; `None` if the solver has none.
    pub tolerance: Option<f64>,
}

impl Choice {
    /// Returns every solver of a kind of query, with every tolerance if it has one.
    pub fn every(kind: QueryKind, tolerances: &[f64]) -> Vec<Choice> {
        let of = |asked: Query| -> Vec<Choice> {
            match asked.certified() {
                Some(_) => tolerances.iter().map(|&t| Choice { asked, tolerance: Some(t) }).collect(),
                None => vec![Choice { asked, tolerance: None }],
            }
        };
        Query::every().filter(|query| query.kind() == kind).flat_map(of).collect()
    }

    /// Returns the query for bodies or cases with this mean edge.
    pub fn query(&self, edge: f64) -> Query {
        let mut query = self.asked;
        if let Some(certified) = query.certified_mut() {
            certified.tolerance = self.tolerance.map(|edges| edges * edge);
        }
        query
    }
}

impl std::fmt::Display for Choice {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(self.asked.solver().name())?;
        self.tolerance.map_or(Ok(()), |edges| write!(f, " at {edges:.0e}"))
    }
}

impl Input {
    /// Finds the first contact of each case by the oracle: exact rational arithmetic, about a
    /// millisecond a case. `meet` is the known upper bound of each first contact; the oracle must
    /// not contradict it.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a case whose known answer is wrong.
    pub fn new(name: &str, cases: Vec<Case>, meet: &[Option<f64>]) -> Result<Input, Error> {
        let truths: Vec<Truth> = cases.par_iter().map(truth).collect();
        let differs = |(truth, meet): (&Truth, &Option<f64>)| match (truth, meet) {
            (Truth::Meet { by, .. }, Some(known)) => by > known,
            (Truth::Apart, None) => false,
            _ => true,
        };
        if let Some(at) = truths.iter().zip(meet).position(differs) {
            return Err(Error::InvalidArgument {
                what: format!(
                    "{name}: query {} has the wrong answer, got {:?}, exactly {:?}",
                    at + 1,
                    meet[at],
                    truths[at]
                ),
                advice: "correct the column with the answers".into(),
            });
        }
        let edge = mean_edge(&cases);
        Ok(Input { name: name.into(), reference: "exact", cases, truths, edge })
    }

    /// Returns the cases of the built-in generators.
    ///
    /// # Errors
    /// As for [`Input::new`]: a fault of the generator.
    pub fn built(name: &str, all: Vec<Built>) -> Result<Input, Error> {
        let meet: Vec<Option<f64>> = all.iter().map(|b| b.toi).collect();
        let cases = all.into_iter().map(|b| b.case).collect();
        Input::new(name, cases, &meet)
    }

    /// Returns the same cases with `of` applied to every coordinate, which must not change the
    /// answers.
    pub fn with(&self, name: String, of: impl Fn(f64) -> f64 + Sync) -> Input {
        let moved = |points: &[[f64; 3]; 4]| points.map(|p| p.map(&of));
        let case = |case: &Case| Case {
            features: case.features,
            positions_t0: moved(&case.positions_t0),
            positions_t1: moved(&case.positions_t1),
        };
        let cases: Vec<Case> = self.cases.par_iter().map(case).collect();
        let edge = mean_edge(&cases);
        Input { name, reference: self.reference, cases, truths: self.truths.clone(), edge }
    }

    /// Tests one choice on the cases; returns its row.
    ///
    /// # Errors
    /// Errors of [`ask`].
    pub fn row(&self, device: &Device, choice: Choice, stored: Stored, repeats: u32) -> Result<Row, Error> {
        let query = choice.query(self.edge);
        let answers = ask(device, &self.cases, &query, Options { filters: true, stored, repeats })?;
        let tolerance = query.certified().and_then(|certified| certified.tolerance);
        let mut judge = Judge::new(query.solver(), tolerance.unwrap_or(0.0), self.edge);
        for ((case, truth), met) in self.cases.iter().zip(&self.truths).zip(&answers.verdicts) {
            judge.note(case, *truth, *met);
        }
        let row = Row {
            input: self.name.clone(),
            reference: self.reference,
            tolerance_edges: choice.tolerance,
            tolerance,
            precision: if stored == Stored::F32 { "f32" } else { "f64" },
            escalated: answers.escalated.iter().sum(),
            ns: Some(answers.ns()),
            bytes: answers.bytes,
            ..Row::default()
        };
        Ok(row.judged(query.solver(), &judge.judged()))
    }
}

/// Returns the oracle's answer.
pub fn truth(case: &Case) -> Truth {
    match first_contact(case) {
        None => Truth::Apart,
        Some(toi) => {
            // A time is late if it exceeds the largest f64 up to the first contact. A certificate
            // is false if it ends before the smallest f64 from the first contact on.
            let (low, high) = toi.bracket();
            Truth::Meet { not_before: high, by: low }
        }
    }
}

/// Returns contacts and near misses of the built-in generator, of small, medium and wide integers.
/// The medium ones are the widest that f32 holds.
///
/// # Errors
/// As for [`Input::new`].
pub fn built_in(n: usize, seed: u64) -> Result<Vec<Input>, Error> {
    use crate::pairs::built::{REACH_F32, REACH_F64};
    [("built, small", 8), ("built, to 2^24", REACH_F32), ("built, to 2^52", REACH_F64 / 32)]
        .into_iter()
        .map(|(name, reach)| Input::built(name, built(seed, n, reach)))
        .collect()
}

/// Returns the cases of query files: all vertex/face queries together, and all edge/edge queries.
///
/// # Errors
/// Errors of reading, and of [`Input::new`].
pub fn query_files(root: &std::path::Path) -> Result<Vec<Input>, Error> {
    let all = super::queries::queries(root)?;
    let mut inputs = Vec::new();
    for (name, features) in
        [("queries, vertex/face", Features::VertexFace), ("queries, edge/edge", Features::EdgeEdge)]
    {
        let (mut cases, mut meet) = (Vec::new(), Vec::new());
        for folder in &all {
            for (case, &meets) in folder.cases.iter().zip(&folder.meets) {
                if case.features == features {
                    cases.push(*case);
                    meet.push(meets.then_some(1.0));
                }
            }
        }
        if !cases.is_empty() {
            inputs.push(Input::new(name, cases, &meet)?);
        }
    }
    Ok(inputs)
}
