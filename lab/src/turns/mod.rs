//! A hunt among hostile pairs of turning features: the kernels' test against the judge.

pub mod build;
pub mod families;
pub mod hunt;
#[cfg(test)]
mod tests;
pub mod triangles;

pub use families::FAMILIES;
pub use hunt::{Row, hunt, verdict};

use crate::tables::{Printed, csv, grouped, text};
use nearmiss::error::Error;
use serde::Serialize;

/// The figures of a hunt.
#[derive(Debug, Serialize)]
pub struct Turns {
    /// One row per family, then their sum.
    pub rows: Vec<Row>,
}

impl Turns {
    /// Adds the sum of all rows.
    pub fn sum_up(&mut self) {
        let mut all = Row { family: "all".into(), ..Row::default() };
        for row in &self.rows {
            all.pairs += row.pairs;
            all.separated += row.separated;
            all.contacts += row.contacts;
            all.undecided += row.undecided;
            all.missed += row.missed;
            all.late += row.late;
            all.falsely_certain += row.falsely_certain;
            all.far_undecided += row.far_undecided;
            all.exhausted += row.exhausted;
            all.open += row.open;
            all.unjudged += row.unjudged;
            all.slices += row.slices * row.pairs as f64;
            all.slices_p99 = all.slices_p99.max(row.slices_p99);
            all.slices_most = all.slices_most.max(row.slices_most);
            all.microseconds += row.microseconds * row.pairs as f64;
        }
        all.slices /= all.pairs.max(1) as f64;
        all.microseconds /= all.pairs.max(1) as f64;
        self.rows.push(all);
    }

    /// The number of wrong verdicts, of all rows but the sum.
    pub fn faults(&self) -> u64 {
        let faults = |row: &Row| row.missed + row.late + row.falsely_certain + row.far_undecided;
        self.rows.iter().filter(|row| row.family != "all").map(faults).sum()
    }

    /// The figures as text, for a terminal.
    pub fn text(&self) -> String {
        text(&self.rows)
    }

    /// `turns.csv`: its name and bytes.
    ///
    /// # Errors
    /// Errors of writing rows.
    pub fn files(&self) -> Result<Vec<(String, Vec<u8>)>, Error> {
        Ok(vec![("turns.csv".to_owned(), csv(&self.rows)?)])
    }
}

impl Printed for Row {
    const CAPTION: &'static str = "Turning features: verdicts, faults, and what stays open";
    const HEADS: &'static [&'static str] = &[
        "family",
        "pairs",
        "separated",
        "contact",
        "undecided",
        "missed",
        "late",
        "false",
        "far",
        "exhausted",
        "open",
        "unjudged",
        "slices",
        "p99",
        "most",
        "us",
    ];
    fn row(&self) -> Vec<String> {
        let counts = [
            self.pairs,
            self.separated,
            self.contacts,
            self.undecided,
            self.missed,
            self.late,
            self.falsely_certain,
            self.far_undecided,
            self.exhausted,
            self.open,
            self.unjudged,
        ];
        let mut all = vec![self.family.clone()];
        all.extend(counts.map(grouped));
        all.push(format!("{:.1}", self.slices));
        all.extend([self.slices_p99.to_string(), self.slices_most.to_string()]);
        all.push(format!("{:.1}", self.microseconds));
        all
    }
}
