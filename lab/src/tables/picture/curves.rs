//! Curves over the fraction of a step: the savings of a front.

use super::labels::{self, End};
use super::{At, Drawn, FAINT, GRID, INK, Mark, OURS, Sheet, THEIRS, head_height, sheet};
use nearmiss::error::Error;

/// One curve.
pub struct Curve {
    /// Name of the curve.
    pub label: String,
    /// Fraction of the step, 0 to 1, and percent.
    pub points: Vec<(f64, f64)>,
    /// Whether the curve shows time, in another style; the others show node tests.
    pub is_time: bool,
}

/// Curves that share a frame.
pub struct Chart {
    /// The scene, and the way that it ran.
    pub title: String,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// Height of a chart's frame, and of the rest of a chart.
const FRAME: i32 = 170;
const CHART: i32 = 75;
/// Left and right sides of frames; names are to the right.
const LEFT: i32 = 80;
const RIGHT: i32 = 660;

/// Draws the picture: percent of the cost of the same frame without a front, and `bound` as a line.
///
/// # Errors
/// [`Error::Bug`] if it cannot be drawn.
pub fn curves(
    title: &str,
    device: &str,
    (bound, bound_label): (f64, &str),
    charts: &[Chart],
) -> Result<String, Error> {
    let whole = head_height(1) + (FRAME + CHART) * charts.len() as i32;
    sheet(whole, |sheet| {
        let mut y = sheet.head(title, &[(format!("nearmiss on {device}"), INK)])?;
        for chart in charts {
            self::chart(sheet, chart, y, (bound, bound_label))?;
            y += FRAME + CHART;
        }
        Ok(())
    })
}

fn chart(sheet: &Sheet, chart: &Chart, top: i32, (bound, bound_label): (f64, &str)) -> Drawn {
    let most = chart.curves.iter().flat_map(|c| &c.points).map(|p| p.1).fold(100.0f64, f64::max);
    let most = (most / 50.0).ceil() * 50.0;
    let (first, last) = (top + 30, top + 30 + FRAME);
    let x = |part: f64| LEFT + (part * f64::from(RIGHT - LEFT)).round() as i32;
    let y = |percent: f64| last - (percent / most * f64::from(FRAME)).round() as i32;
    sheet.bold(&chart.title, (20, top + 12), 14)?;
    for part in [0.0, 0.2, 0.4, 0.6, 0.8, 1.0] {
        sheet.line(vec![(x(part), first), (x(part), last)], GRID, 1)?;
        sheet.text(&format!("{part}"), (x(part), last + 12), 12, At::Middle, FAINT)?;
    }
    sheet.text("part of the step", ((LEFT + RIGHT) / 2, last + 30), 12, At::Middle, FAINT)?;
    let step = if most > 200.0 { 100.0 } else { 50.0 };
    let mut percent = 0.0;
    while percent <= most {
        sheet.line(vec![(LEFT, y(percent)), (RIGHT, y(percent))], GRID, 1)?;
        sheet.text(&format!("{percent} %"), (LEFT - 8, y(percent)), 12, At::Right, FAINT)?;
        percent += step;
    }
    sheet.line(vec![(LEFT, y(bound)), (RIGHT, y(bound))], FAINT, 1)?;
    let mut ends = vec![End { at: (RIGHT, y(bound)), colour: FAINT, label: bound_label }];
    for curve in &chart.curves {
        let line: Vec<(i32, i32)> =
            curve.points.iter().map(|&(part, percent)| (x(part), y(percent))).collect();
        let Some(&end) = line.last() else { continue };
        let (colour, mark) = if curve.is_time { (THEIRS, Mark::Square) } else { (OURS, Mark::Disc) };
        sheet.line(line.clone(), colour, 2)?;
        for point in line {
            sheet.mark(mark, point, 2, colour, true)?;
        }
        ends.push(End { at: end, colour, label: &curve.label });
    }
    labels::draw(sheet, ends, RIGHT + 34, last + 8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables::picture::check::faults;

    #[test]
    fn a_curve_is_labelled_at_its_end() {
        let curve = |label: &str, is_time| Curve {
            label: label.into(),
            points: vec![(0.0, 52.0), (1.0, 51.0)],
            is_time,
        };
        let chart =
            Chart { title: "cloth".into(), curves: vec![curve("node tests", false), curve("time", true)] };
        let svg = curves("a title", "a GPU", (50.0, "the bound"), &[chart]).expect("a picture");
        for text in
            ["a title", "a GPU", "cloth", "node tests", "time", "the bound", "part of the step", "50 %"]
        {
            assert!(svg.contains(text), "{text}: {svg}");
        }
        assert_eq!(faults(&svg), Vec::<String>::new());
    }
}
