//! Tables as `benches/tables.toml` describes them.

use super::recorded::Recorded;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// A table: columns of figures, and rows that say which recorded rows they show.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    /// Heading of the first column.
    #[serde(default)]
    of: String,
    columns: Vec<Column>,
    rows: Vec<Row>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Column {
    heading: String,
    /// A column of the file; `a + b` for a sum, `a..b` for a range.
    #[serde(default)]
    figure: String,
    /// Which source of the row.
    #[serde(default)]
    source: usize,
    /// A text of the row instead of a figure.
    text: Option<usize>,
    /// Factor of the figure.
    #[serde(default = "one")]
    times: f64,
    /// Values of further columns that select the recorded row.
    #[serde(default)]
    with: BTreeMap<String, String>,
    /// The cell stays empty if no recorded row matches.
    #[serde(default)]
    is_optional: bool,
}

fn one() -> f64 {
    1.0
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    label: String,
    #[serde(default)]
    sources: Vec<Source>,
    #[serde(default)]
    texts: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Source {
    file: String,
    /// Values of columns that select the recorded row.
    #[serde(default)]
    with: BTreeMap<String, String>,
    /// The figure of this source, instead of the column's.
    figure: Option<String>,
    /// Its factor, instead of the column's.
    times: Option<f64>,
}

/// All tables, with the recorded files that they read.
pub struct Tables {
    tables: BTreeMap<String, Table>,
    recorded: Recorded,
}

impl Tables {
    /// The tables of a repository.
    ///
    /// # Errors
    /// A sentence that names the file.
    pub fn open(root: &Path) -> Result<Tables, String> {
        let path = root.join("benches/tables.toml");
        let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let tables = toml::from_str(&text).map_err(|e| format!("benches/tables.toml: {e}"))?;
        Ok(Tables { tables, recorded: Recorded::open(&root.join("benches/results"))? })
    }

    /// Names of all tables.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.tables.keys().map(String::as_str)
    }

    /// A table as Markdown, its sources below it. `up` leads from the page's folder to the root.
    ///
    /// # Errors
    /// A sentence if there is no such table, or a file lacks what it shows.
    pub fn markdown(&mut self, name: &str, up: &str) -> Result<String, String> {
        let table = self.tables.get(name).ok_or_else(|| format!("no table {name}"))?;
        let headings: Vec<&str> = table.columns.iter().map(|column| column.heading.as_str()).collect();
        let rules: Vec<&str> =
            table.columns.iter().map(|c| if c.text.is_some() { "---" } else { "---:" }).collect();
        let mut text = format!("| {} | {} |\n", table.of, headings.join(" | "));
        let _ = writeln!(text, "| --- | {} |", rules.join(" | "));
        let mut files: Vec<&str> = Vec::new();
        for row in &table.rows {
            let mut cells = vec![row.label.clone()];
            for column in &table.columns {
                cells.push(cell(&mut self.recorded, row, column).map_err(|e| format!("{name}: {e}"))?);
            }
            if cells[1..].iter().all(|cell| !cell.starts_with(|c: char| c.is_ascii_digit())) {
                return Err(format!("{name}: row {} has no figure", row.label));
            }
            let _ = writeln!(text, "| {} |", cells.join(" | "));
            for source in &row.sources {
                if !files.contains(&source.file.as_str()) {
                    files.push(&source.file);
                }
            }
        }
        text.push_str("\nMeasured:\n");
        for (at, file) in files.iter().enumerate() {
            let origin = self.recorded.origin(file)?;
            let (machine, measured) = (&origin.machine, &origin.measured);
            let end = if at + 1 == files.len() { '.' } else { ';' };
            let _ = writeln!(text, "{machine}, {measured},\n[{file}]({up}benches/results/{file}){end}");
        }
        Ok(text)
    }
}

/// A cell: a text of the row, or a figure. Empty if the row lacks the source or the value.
fn cell(recorded: &mut Recorded, row: &Row, column: &Column) -> Result<String, String> {
    if let Some(text) = column.text {
        return Ok(row.texts.get(text).cloned().unwrap_or_default());
    }
    let Some(source) = row.sources.get(column.source) else { return Ok(String::new()) };
    let matching: Vec<(String, String)> =
        source.with.iter().chain(&column.with).map(|(k, v)| (k.clone(), v.clone())).collect();
    if column.is_optional && !recorded.has(&source.file, &matching)? {
        return Ok(String::new());
    }
    let times = source.times.unwrap_or(column.times);
    let figures = source.figure.as_ref().unwrap_or(&column.figure);
    let mut figure = |name: &str| -> Result<Option<f64>, String> {
        Ok(recorded.median(&source.file, &matching, name.trim())?.map(|value| value * times))
    };
    if let Some((low, high)) = figures.split_once("..") {
        let ends = [figure(low)?, figure(high)?].map(|end| end.map(number).unwrap_or_default());
        let is_one = ends[0] == ends[1];
        return Ok(if is_one { ends[0].clone() } else { format!("{} to {}", ends[0], ends[1]) });
    }
    let mut sum = None;
    for part in figures.split('+') {
        sum = match (sum, figure(part)?) {
            (None, value) => value,
            (Some(sum), value) => value.map(|value| sum + value),
        };
    }
    Ok(sum.map(number).unwrap_or_default())
}

/// Three significant digits; whole numbers from 1,000 on keep all of theirs, in groups of three.
fn number(value: f64) -> String {
    if value.abs() >= 999.5 {
        let digits = format!("{value:.0}");
        let mut grouped = String::new();
        for (at, digit) in digits.chars().enumerate() {
            if at > 0 && (digits.len() - at) % 3 == 0 {
                grouped.push(',');
            }
            grouped.push(digit);
        }
        return grouped;
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let scientific = format!("{value:.2e}");
    if value.abs() < 1e-4 {
        return scientific;
    }
    scientific.parse::<f64>().map_or(scientific, |rounded| rounded.to_string())
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_have_three_digits() {
        let shown = [0.0587, 0.1384, 45.5, 79.96, 138.4, 1105.6, 162_543.0, 0.0, 7.49e-6].map(number);
        assert_eq!(shown, ["0.0587", "0.138", "45.5", "80", "138", "1,106", "162,543", "0", "7.49e-6"]);
    }
}
