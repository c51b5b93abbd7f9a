//! All results together: text, CSV files and pictures.

use super::funnel::FunnelRow;
use super::headline::headline;
use super::picture;
use super::refit::{RefitRow, advice};
use super::row::Row;
use crate::tables::{csv, text};
use nearmiss::error::Error;
use serde::Serialize;

/// Results of the measurements; those that were not made have no rows.
#[derive(Debug, Serialize)]
pub struct Trade {
    /// The machine.
    pub device: String,
    /// One row per choice.
    pub choices: Vec<Row>,
    /// One row per choice and point of a sweep.
    pub sweeps: Vec<Row>,
    /// One row per step.
    pub funnel: Vec<FunnelRow>,
    /// One row per frame.
    pub refit: Vec<RefitRow>,
    /// Summary of all rows.
    pub headline: String,
}

impl Trade {
    /// Returns empty results.
    pub fn new(device: String) -> Trade {
        let (choices, sweeps, funnel, refit, headline) = Default::default();
        Trade { device, choices, sweeps, funnel, refit, headline }
    }

    /// Writes the summary; call it after all measurements.
    pub fn sum_up(&mut self) {
        let all: Vec<Row> = self.choices.iter().chain(&self.sweeps).cloned().collect();
        self.headline = headline(&all);
    }

    /// Returns the results as text, for a terminal.
    pub fn text(&self) -> String {
        let mut all = format!("on {}\n\n", self.device);
        all += &text(&self.choices);
        all += &text(&self.sweeps);
        all += &text(&self.funnel);
        all += &text(&self.refit);
        for rows in self.refit.chunk_by(|a, b| (&a.input, a.bv) == (&b.input, b.bv)) {
            all += &format!("{}\n", advice(rows));
        }
        all += &format!("{}\n", self.headline);
        all
    }

    /// Returns `trade.csv`, `trade-sweeps.csv` and so on, and a picture of each: file names and
    /// bytes.
    ///
    /// # Errors
    /// Drawing errors.
    pub fn files(&self) -> Result<Vec<(String, Vec<u8>)>, Error> {
        let mut files = Vec::new();
        let mut add = |name: &str, bytes: Vec<u8>| files.push((name.to_owned(), bytes));
        if !self.choices.is_empty() {
            add("trade.csv", csv(&self.choices)?);
            add("trade-pareto.svg", picture::pareto(&self.device, &self.choices)?.into_bytes());
        }
        if self.choices.iter().any(|row| row.tolerance_edges.is_some()) {
            add("trade-tolerance.svg", picture::tolerance(&self.device, &self.choices)?.into_bytes());
        }
        if !self.sweeps.is_empty() {
            add("trade-sweeps.csv", csv(&self.sweeps)?);
            add("trade-sweeps.svg", picture::sweeps(&self.device, &self.sweeps)?.into_bytes());
        }
        if !self.funnel.is_empty() {
            add("trade-funnel.csv", csv(&self.funnel)?);
            add("trade-funnel.svg", picture::funnel(&self.device, &self.funnel)?.into_bytes());
        }
        if !self.refit.is_empty() {
            add("trade-refit.csv", csv(&self.refit)?);
            add("trade-refit.svg", picture::refit(&self.device, &self.refit)?.into_bytes());
        }
        Ok(files)
    }
}
