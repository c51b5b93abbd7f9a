//! Stacked bars: shares of a whole.

use super::{At, Drawn, FAINT, GRID, INK, LEFT, RIGHT, Sheet, head_height, sheet};
use crate::tables::text::digits;
use nearmiss::error::Error;
use plotters::style::RGBColor;

/// One bar: shares in percent, in the order of [`NAMES`], and the whole in milliseconds.
pub struct Stack {
    /// The scene; bars of one scene are adjacent.
    pub panel: String,
    /// Name of the timed work.
    pub label: String,
    /// Percent.
    pub shares: [f64; 4],
    /// Milliseconds.
    pub ms: f64,
}

/// Names of the parts, then the colour of each and of a text on it.
const NAMES: [&str; 4] = ["refit", "traverse", "balance", "triangle tests"];
const WHITE: RGBColor = RGBColor(255, 255, 255);
const COLOURS: [(RGBColor, RGBColor); 4] = [
    (RGBColor(86, 180, 233), INK),
    (RGBColor(0, 114, 178), WHITE),
    (RGBColor(230, 159, 0), INK),
    (RGBColor(240, 228, 66), INK),
];

/// Height of a bar, of a bar with its gap, and of the rest of a panel.
const BAR: i32 = 20;
const ROW: i32 = 27;
const PANEL: i32 = 62;

/// Most pixels of a letter, at size 12.
const LETTER: i32 = 7;

/// Draws the picture.
///
/// # Errors
/// [`Error::Bug`] if it cannot be drawn.
pub fn stacks(title: &str, device: &str, all: &[Stack]) -> Result<String, Error> {
    let panels: Vec<&[Stack]> = all.chunk_by(|a, b| a.panel == b.panel).collect();
    let height = |panel: &[Stack]| PANEL + ROW * panel.len() as i32;
    let whole = head_height(2) + panels.iter().map(|p| height(p)).sum::<i32>();
    sheet(whole, |sheet| {
        let notes = [(format!("nearmiss on {device}"), INK), (String::new(), INK)];
        let mut y = sheet.head(title, &notes)?;
        let mut x = 20;
        for (name, (colour, _)) in NAMES.iter().zip(COLOURS) {
            sheet.rectangle([(x, y - 28), (x + 14, y - 16)], colour)?;
            sheet.text(name, (x + 20, y - 21), 13, At::Left, INK)?;
            x += 50 + 8 * name.len() as i32;
        }
        for panel in panels {
            self::panel(sheet, panel, y)?;
            y += height(panel);
        }
        Ok(())
    })
}

fn panel(sheet: &Sheet, panel: &[Stack], top: i32) -> Drawn {
    let x =
        |percent: f64| LEFT + (percent.clamp(0.0, 100.0) / 100.0 * f64::from(RIGHT - LEFT)).round() as i32;
    sheet.bold(panel.first().map_or("", |stack| &stack.panel), (20, top + 12), 14)?;
    sheet.text("a frame, ms", (880, top + 12), 12, At::Right, FAINT)?;
    let (first, last) = (top + 26, top + 26 + ROW * panel.len() as i32);
    for percent in [0, 20, 40, 60, 80, 100] {
        let at = x(f64::from(percent));
        sheet.line(vec![(at, first - 4), (at, last)], GRID, 1)?;
        sheet.text(&format!("{percent} %"), (at, last + 10), 12, At::Middle, FAINT)?;
    }
    for (row, stack) in panel.iter().enumerate() {
        let y = first + ROW * row as i32;
        sheet.text(&stack.label, (LEFT - 10, y + BAR / 2), 13, At::Right, INK)?;
        let mut from = 0.0;
        for ((share, name), (colour, ink)) in stack.shares.iter().zip(NAMES).zip(COLOURS) {
            let (left, right) = (x(from), x(from + share));
            from += share;
            if right <= left {
                continue;
            }
            sheet.rectangle([(left, y), (right, y + BAR)], colour)?;
            sheet.line(vec![(right, y), (right, y + BAR)], WHITE, 1)?;
            let (long, short) = (format!("{name} {share:.0}"), format!("{share:.0}"));
            let fits = |text: &&String| LETTER * text.len() as i32 + 4 < right - left;
            if let Some(text) = [&long, &short].into_iter().find(fits) {
                sheet.text(text, ((left + right) / 2, y + BAR / 2), 12, At::Middle, ink)?;
            }
        }
        sheet.text(&digits(stack.ms), (880, y + BAR / 2), 13, At::Right, INK)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_is_labelled_where_it_fits() {
        let stack = |shares| Stack { panel: "cloth".into(), label: "discrete AABB".into(), shares, ms: 0.5 };
        let svg = stacks("a title", "a GPU", &[stack([30.0, 68.0, 0.0, 2.0])]).expect("a picture");
        for text in ["a title", "a GPU", "cloth", "discrete AABB", "refit 30", "traverse 68", "0.500"] {
            assert!(svg.contains(text), "{text}: {svg}");
        }
        assert!(!svg.contains("balance 0") && !svg.contains("triangle tests 2"), "{svg}");
        assert_eq!(crate::tables::picture::check::faults(&svg), Vec::<String>::new());
    }
}
