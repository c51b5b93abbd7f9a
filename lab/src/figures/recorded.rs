//! Rows of the recorded files.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Machine and date of a file's measurement.
#[derive(Clone, Debug, serde::Deserialize)]
pub struct Origin {
    file: String,
    /// The machine, by name.
    pub machine: String,
    /// A date, or the first and the last of several.
    pub measured: String,
}

/// Rows by column.
type Rows = Vec<HashMap<String, String>>;

/// The files below `benches/results`, read once each.
pub struct Recorded {
    folder: PathBuf,
    origins: Vec<Origin>,
    files: HashMap<String, Rows>,
}

impl Recorded {
    /// The files of a folder, which has an `origins.csv`.
    ///
    /// # Errors
    /// A sentence that names the file.
    pub fn open(folder: &Path) -> Result<Recorded, String> {
        let path = folder.join("origins.csv");
        let mut reader = csv::Reader::from_path(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let origins: Result<Vec<Origin>, _> = reader.deserialize().collect();
        let origins = origins.map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(Recorded { folder: folder.to_path_buf(), origins, files: HashMap::new() })
    }

    /// The machine and the date of a file.
    ///
    /// # Errors
    /// A sentence if `origins.csv` does not list the file.
    pub fn origin(&self, file: &str) -> Result<&Origin, String> {
        let known = self.origins.iter().find(|origin| origin.file == file);
        known.ok_or_else(|| format!("{file}: no row in benches/results/origins.csv; add one"))
    }

    fn rows(&mut self, file: &str) -> Result<&Rows, String> {
        if !self.files.contains_key(file) {
            let path = self.folder.join(file);
            let mut reader = csv::Reader::from_path(&path).map_err(|e| format!("{file}: {e}"))?;
            let rows: Result<Rows, _> = reader.deserialize().collect();
            self.files.insert(file.to_owned(), rows.map_err(|e| format!("{file}: {e}"))?);
        }
        Ok(&self.files[file])
    }

    /// Whether a row matches.
    ///
    /// # Errors
    /// A sentence if the file cannot be read.
    pub fn has(&mut self, file: &str, matching: &[(String, String)]) -> Result<bool, String> {
        let rows = self.rows(file)?;
        Ok(rows.iter().any(|row| matching.iter().all(|(key, value)| row.get(key) == Some(value))))
    }

    /// The median of a column over all rows that match; `None` if the column is empty there.
    ///
    /// # Errors
    /// A sentence if no row matches, the file lacks a column, or a value is no number.
    pub fn median(
        &mut self,
        file: &str,
        matching: &[(String, String)],
        column: &str,
    ) -> Result<Option<f64>, String> {
        let described = || {
            let matching: Vec<_> = matching.iter().map(|(k, v)| format!("{k} = {v}")).collect();
            format!("{file}, {column} of {}", matching.join(", "))
        };
        let mut values = Vec::new();
        let mut rows = 0;
        for row in self.rows(file)? {
            let mut is_match = true;
            for (key, value) in matching {
                let found = row.get(key).ok_or_else(|| format!("{file}: no column {key}"))?;
                is_match &= found == value;
            }
            if is_match {
                rows += 1;
                let text = row.get(column).ok_or_else(|| format!("{file}: no column {column}"))?;
                if !text.is_empty() {
                    let value = text.parse().map_err(|_| format!("{}: {text}", described()))?;
                    values.push(value);
                }
            }
        }
        if rows == 0 {
            return Err(format!("{}: no such row", described()));
        }
        values.sort_by(f64::total_cmp);
        let middle = values.len() / 2;
        Ok(match values.len() {
            0 => None,
            odd if odd % 2 == 1 => Some(values[middle]),
            _ => Some((values[middle - 1] + values[middle]) / 2.0),
        })
    }
}
