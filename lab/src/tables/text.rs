//! The figures as text, for a terminal.

use super::figures::{Figure612, Figure613, Figure614};
use super::front::FrontRow;
use super::paper_reference::PAPER_GPU;
use std::fmt::Write;

/// A figure with a caption.
pub trait Printed: Sized {
    /// The caption.
    const CAPTION: &'static str;
    /// Headings of the columns.
    const HEADS: &'static [&'static str];
    /// Returns a row, as many texts as there are headings.
    fn row(&self) -> Vec<String>;
}

/// Returns the caption, the headings and the rows, in columns; an empty text for no rows.
pub fn text<T: Printed>(rows: &[T]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let heads = T::HEADS.iter().map(|&head| head.to_owned()).collect();
    let all: Vec<Vec<String>> = std::iter::once(heads).chain(rows.iter().map(T::row)).collect();
    format!("{}\n{}\n", T::CAPTION.replace("PAPER_GPU", PAPER_GPU), aligned(&all))
}

/// Returns texts in columns: the first column to the left, the others to the right.
pub fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |at: usize| rows.iter().filter_map(|row| row.get(at)).map(|t| t.chars().count()).max();
    let widths: Vec<usize> = (0..columns).map(|at| width(at).unwrap_or(0)).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (at, (cell, &width)) in row.iter().zip(&widths).enumerate() {
            // Writing to a String cannot fail.
            let _ = if at == 0 { write!(line, "  {cell:<width$}") } else { write!(line, "  {cell:>width$}") };
        }
        text += line.trim_end();
        text.push('\n');
    }
    text
}

/// Returns milliseconds and ratios with three significant digits.
pub fn digits(x: f64) -> String {
    let decimals = if x >= 100.0 || x == 0.0 { 0 } else { (2 - x.abs().log10().floor() as i32).clamp(0, 6) };
    format!("{x:.*}", decimals as usize)
}

/// Returns a count with a comma after each three digits.
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let comma = |at: usize| if at > 0 && (digits.len() - at).is_multiple_of(3) { "," } else { "" };
    digits.char_indices().map(|(at, digit)| format!("{}{digit}", comma(at))).collect()
}

fn maybe(x: Option<f64>) -> String {
    x.map_or("-".into(), digits)
}

fn yes(front: bool) -> String {
    if front { "yes" } else { "no" }.into()
}

impl Printed for Figure612 {
    const CAPTION: &'static str = "Figure 6.12: construction and refit, ms; theirs on a PAPER_GPU";
    const HEADS: &'static [&'static str] =
        &["scene", "triangles", "stage", "volume", "ours", "theirs", "ours/theirs"];
    fn row(&self) -> Vec<String> {
        vec![
            self.scene.clone(),
            self.triangles.to_string(),
            self.stage.into(),
            self.bv.into(),
            digits(self.ours_ms),
            maybe(self.theirs_ms),
            maybe(self.ratio),
        ]
    }
}

impl Printed for Figure613 {
    const CAPTION: &'static str = "Figure 6.13: a frame (refit, traversal, triangle tests), ms, mean over the animation; \
                                   theirs on a PAPER_GPU";
    const HEADS: &'static [&'static str] = &[
        "scene",
        "motion",
        "volume",
        "front",
        "ours",
        "theirs",
        "ours/theirs",
        "contacts/frame",
        "hash of all frames",
        "frames",
        "differ",
    ];
    fn row(&self) -> Vec<String> {
        vec![
            self.scene.clone(),
            self.motion.into(),
            self.bv.into(),
            yes(self.front),
            digits(self.ours_ms),
            maybe(self.theirs_ms),
            maybe(self.ratio),
            format!("{:.1}", self.contacts_a_frame),
            self.hash.clone(),
            self.frames.to_string(),
            self.differing.to_string(),
        ]
    }
}

impl Printed for Figure614 {
    const CAPTION: &'static str =
        "Figure 6.14: shares of a frame's time, percent; Lauterbach 2010 has only a picture";
    const HEADS: &'static [&'static str] =
        &["scene", "motion", "volume", "front", "refit", "traverse", "balance", "triangle tests", "of ms"];
    fn row(&self) -> Vec<String> {
        let percent = |x: f64| format!("{x:.1}");
        vec![
            self.scene.clone(),
            self.motion.into(),
            self.bv.into(),
            yes(self.front),
            percent(self.refit),
            percent(self.traverse),
            percent(self.balance),
            percent(self.triangle_tests),
            digits(self.ms),
        ]
    }
}

impl Printed for FrontRow {
    const CAPTION: &'static str =
        "A front, by the moved part of a step; the bound of Lauterbach 2010 is half of the node tests";
    const HEADS: &'static [&'static str] = &[
        "scene",
        "motion",
        "volume",
        "front",
        "part of a step",
        "node tests",
        "of those without",
        "traverse ms",
        "of that without",
    ];
    fn row(&self) -> Vec<String> {
        vec![
            self.scene.clone(),
            self.motion.into(),
            self.bv.into(),
            yes(self.front),
            format!("{:.4}", self.part),
            self.node_tests.to_string(),
            digits(self.tests_ratio),
            digits(self.traverse_ms),
            digits(self.time_ratio),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_stand_after_three_digits() {
        let cases = [0, 999, 1000, 123_456, 1_234_567].map(grouped);
        assert_eq!(cases, ["0", "999", "1,000", "123,456", "1,234,567"]);
    }

    #[test]
    fn three_digits_count() {
        let cases = [(0.0, "0"), (0.01234, "0.0123"), (1.234, "1.23"), (12.34, "12.3"), (412.6, "413")];
        for (x, want) in cases {
            assert_eq!(digits(x), want);
        }
    }

    #[test]
    fn columns_stand_in_line() {
        let rows = [vec!["a".into(), "1".into()], vec!["long".into(), "123".into()]];
        assert_eq!(aligned(&rows), "  a       1\n  long  123\n");
    }
}
