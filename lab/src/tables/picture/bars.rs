//! Bars on a logarithmic scale: ours and theirs, in pairs.

use super::{At, Drawn, FAINT, GRID, INK, LEFT, OURS, RIGHT, Sheet, THEIRS, head_height, sheet};
use crate::tables::paper_reference::PAPER_GPU;
use crate::tables::text::digits;
use nearmiss::error::Error;

/// One pair of bars, in milliseconds.
pub struct Bar {
    /// Name of the timed work.
    pub label: String,
    /// Our milliseconds.
    pub ours: f64,
    /// The thesis's milliseconds.
    pub theirs: Option<f64>,
}

/// A scene's bars.
pub struct Panel {
    /// The scene.
    pub title: String,
    /// The bars.
    pub bars: Vec<Bar>,
}

/// Height of a bar, of a pair with its gap, and of the rest of a panel.
const BAR: i32 = 11;
const PAIR: i32 = 30;
const PANEL: i32 = 66;

/// Returns powers of ten around all values, at least one apart.
fn decades(values: impl Iterator<Item = f64>) -> (i32, i32) {
    let (low, high) = values
        .filter(|x| x.is_finite() && *x > 0.0)
        .fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
    if high == 0.0 {
        return (-1, 0);
    }
    let from = low.log10().floor() as i32;
    // A bar of the smallest value must be visible.
    let from = if low.log10() - f64::from(from) < 0.1 { from - 1 } else { from };
    (from, (high.log10().ceil() as i32).max(from + 1))
}

/// Draws the picture. All panels share one scale.
///
/// # Errors
/// [`Error::Bug`] if it cannot be drawn.
pub fn bars(title: &str, device: &str, panels: &[Panel]) -> Result<String, Error> {
    let all = panels.iter().flat_map(|p| &p.bars);
    let (from, to) = decades(all.flat_map(|b| [b.ours, b.theirs.unwrap_or(b.ours)]));
    let height = |p: &Panel| PANEL + PAIR * p.bars.len() as i32;
    let whole = head_height(2) + panels.iter().map(height).sum::<i32>();
    sheet(whole, |sheet| {
        let notes =
            [(format!("nearmiss on {device}"), OURS), (format!("Lauterbach 2010 on a {PAPER_GPU}"), DARK)];
        let mut y = sheet.head(title, &notes)?;
        for panel in panels {
            self::panel(sheet, panel, y, (from, to))?;
            y += height(panel);
        }
        Ok(())
    })
}

/// The colour of the thesis's bars, darkened so that it is legible as text.
const DARK: plotters::style::RGBColor = plotters::style::RGBColor(160, 105, 0);

fn panel(sheet: &Sheet, panel: &Panel, top: i32, (from, to): (i32, i32)) -> Drawn {
    let x = |ms: f64| {
        let share = (ms.log10() - f64::from(from)) / f64::from(to - from);
        LEFT + (share.clamp(0.0, 1.0) * f64::from(RIGHT - LEFT)).round() as i32
    };
    sheet.bold(&panel.title, (20, top + 12), 14)?;
    sheet.text("ours / theirs", (880, top + 12), 12, At::Right, FAINT)?;
    let (first, last) = (top + 26, top + 26 + PAIR * panel.bars.len() as i32);
    for decade in from..=to {
        let at = x(10f64.powi(decade));
        sheet.line(vec![(at, first - 4), (at, last)], GRID, 1)?;
        let unit = if decade == to { " ms (log)" } else { "" };
        let label = format!("{}{unit}", 10f64.powi(decade));
        sheet.text(&label, (at, last + 11), 12, At::Middle, FAINT)?;
    }
    for (row, bar) in panel.bars.iter().enumerate() {
        let y = first + PAIR * row as i32;
        sheet.text(&bar.label, (LEFT - 10, y + BAR), 13, At::Right, INK)?;
        let pair = [(Some(bar.ours), OURS, OURS), (bar.theirs, THEIRS, DARK)];
        for (at, (ms, colour, dark)) in pair.into_iter().enumerate() {
            let Some(ms) = ms.filter(|ms| *ms > 0.0) else { continue };
            let y = y + BAR * at as i32;
            sheet.rectangle([(LEFT, y), (x(ms), y + BAR - 1)], colour)?;
            sheet.text(&digits(ms), (x(ms) + 5, y + BAR / 2), 11, At::Left, dark)?;
        }
        let ratio = bar.theirs.map_or("-".into(), |theirs| digits(bar.ours / theirs));
        sheet.text(&ratio, (880, y + BAR), 13, At::Right, INK)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scale_holds_its_values() {
        assert_eq!(decades([0.3, 40.0].into_iter()), (-1, 2));
        assert_eq!(decades([0.1, 100.0].into_iter()), (-2, 2));
        assert_eq!(decades([5.0].into_iter()), (0, 1));
        assert_eq!(decades([0.0].into_iter()), (-1, 0));
    }

    #[test]
    fn a_bar_is_labelled() {
        let bar = Bar { label: "discrete AABB".into(), ours: 0.5, theirs: Some(50.0) };
        let svg = bars("a title", "a GPU", &[Panel { title: "a <scene>".into(), bars: vec![bar] }])
            .expect("a picture");
        for text in
            ["a title", "a GPU", "a &lt;scene&gt;", "discrete AABB", "0.500", "50.0", "0.0100", "ms (log)"]
        {
            assert!(svg.contains(text), "{text}: {svg}");
        }
        assert_eq!(crate::tables::picture::check::faults(&svg), Vec::<String>::new());
    }
}
