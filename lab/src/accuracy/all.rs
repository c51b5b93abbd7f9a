//! Everything together: text, CSV files and pictures.

use super::funnel::FunnelRow;
use super::headline::headline;
use super::picture;
use super::refit::{RefitRow, advice};
use super::row::Row;
use crate::tables::{csv, failed, put, text};
use nearmiss::error::Error;
use serde::Serialize;
use std::path::Path;

/// What was measured; what was not has no rows.
#[derive(Debug, Serialize)]
pub struct Trade {
    /// The machine.
    pub device: String,
    /// A row a choice.
    pub choices: Vec<Row>,
    /// A row a choice and a point of a sweep.
    pub sweeps: Vec<Row>,
    /// A row a step.
    pub funnel: Vec<FunnelRow>,
    /// A row a frame.
    pub refit: Vec<RefitRow>,
    /// The summary of all.
    pub headline: String,
}

impl Trade {
    /// Nothing yet.
    pub fn new(device: String) -> Trade {
        let (choices, sweeps, funnel, refit, headline) = Default::default();
        Trade { device, choices, sweeps, funnel, refit, headline }
    }

    /// Sums up: to be called when all is measured.
    pub fn sum_up(&mut self) {
        let all: Vec<Row> = self.choices.iter().chain(&self.sweeps).cloned().collect();
        self.headline = headline(&all);
    }

    /// For people.
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

    /// Writes `trade.csv`, `trade-sweeps.csv` and so on, and a picture of each, into a folder, which is made where there is
    /// none; the files' names.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn write(&self, folder: &Path) -> Result<Vec<String>, Error> {
        std::fs::create_dir_all(folder).map_err(|e| failed(folder, &e))?;
        let mut names = Vec::new();
        let mut write = |name: &str, bytes: Result<Vec<u8>, String>| {
            let path = folder.join(name);
            put(&path, &bytes.map_err(|e| failed(&path, &e))?)?;
            names.push(name.to_owned());
            Ok::<_, Error>(())
        };
        if !self.choices.is_empty() {
            write("trade.csv", csv(&self.choices))?;
            write("trade-pareto.svg", Ok(picture::pareto(&self.device, &self.choices)?.into_bytes()))?;
        }
        if self.choices.iter().any(|row| row.tolerance_edges.is_some()) {
            write("trade-tolerance.svg", Ok(picture::tolerance(&self.device, &self.choices)?.into_bytes()))?;
        }
        if !self.sweeps.is_empty() {
            write("trade-sweeps.csv", csv(&self.sweeps))?;
            write("trade-sweeps.svg", Ok(picture::sweeps(&self.device, &self.sweeps)?.into_bytes()))?;
        }
        if !self.funnel.is_empty() {
            write("trade-funnel.csv", csv(&self.funnel))?;
            write("trade-funnel.svg", Ok(picture::funnel(&self.device, &self.funnel)?.into_bytes()))?;
        }
        if !self.refit.is_empty() {
            write("trade-refit.csv", csv(&self.refit))?;
            write("trade-refit.svg", Ok(picture::refit(&self.device, &self.refit)?.into_bytes()))?;
        }
        Ok(names)
    }
}
