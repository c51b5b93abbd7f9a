//! Curves, each with a name at its end; and bars.

use super::axis::Axis;
use super::style::Style;
use crate::tables::picture::labels::{self, End};
use crate::tables::picture::{
    At, Drawn, FAINT, GRID, INK, LEFT, OURS, RIGHT, Sheet, WIDTH, head_height, sheet, wide_sheet,
};
use crate::tables::{digits, grouped};
use nearmiss::error::Error;

/// A curve.
pub struct Curve {
    /// Name of the series.
    pub label: String,
    /// Line and mark style.
    pub style: Style,
    /// Points of the curve.
    pub points: Vec<(f64, f64)>,
}

/// Curves in one frame.
pub struct Chart {
    /// Title.
    pub title: String,
    /// Name of the x axis.
    pub x: String,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// Charts of one input, in a row.
pub struct Group {
    /// The input.
    pub title: String,
    /// One chart per quantity: the same in every group, in the same order.
    pub charts: Vec<Chart>,
}

/// Height of a frame, and of the rest of a chart.
const FRAME: i32 = 150;
const CHART: i32 = 68;
/// Height of a group's title.
const TITLE: i32 = 28;
/// Width of a chart, and the left and right sides of its frame; names are to its right.
const CELL: i32 = 460;
const BEGIN: i32 = 64;
const END: i32 = 310;

/// Draws the picture: a row per group, and a column per quantity that has values. Groups of few
/// charts share a row.
///
/// # Errors
/// [`Error::Bug`] if it cannot be drawn.
pub fn charts(title: &str, device: &str, all: &[Group]) -> Result<String, Error> {
    // A curve needs two places on its axis, and a chart of zeros is left out.
    let has_values = |chart: &Chart| {
        let mut points = chart.curves.iter().flat_map(|curve| &curve.points);
        let is_any = points.clone().any(|point| point.1 != 0.0);
        is_any && points.next().is_some_and(|first| points.any(|other| other.0 != first.0))
    };
    let drawn = |group: &Group| (0..group.charts.len()).filter(|at| has_values(&group.charts[*at])).collect();
    let drawn: Vec<(&Group, Vec<usize>)> = all.iter().map(|group| (group, drawn(group))).collect();
    let mut columns: Vec<usize> = drawn.iter().flat_map(|(_, charts)| charts).copied().collect();
    columns.sort_unstable();
    columns.dedup();
    let column = |chart: usize| columns.partition_point(|other| *other < chart) as i32;
    let widths: Vec<i32> =
        drawn.iter().map(|(_, charts)| charts.last().map_or(0, |last| column(*last) + 1)).collect();
    let places = side_by_side(&widths, columns.len() as i32);
    let rows = places.last().map_or(0, |place| place[1] + 1);
    let high = TITLE + FRAME + CHART;
    let size = [(CELL * columns.len() as i32).max(WIDTH), head_height(1) + high * rows];
    wide_sheet(size, |sheet| {
        let top = sheet.head(title, &[(format!("nearmiss on {device}"), INK)])?;
        for ((group, charts), [first, row]) in drawn.iter().zip(places).filter(|(of, _)| !of.1.is_empty()) {
            let (x, y) = (CELL * first, top + high * row);
            sheet.bold(&group.title, (x + 20, y + 12), 14)?;
            for &at in charts {
                let cell = sheet.part((x + CELL * column(at), y + TITLE), (CELL, high - TITLE));
                chart(&cell, &group.charts[at])?;
            }
        }
        Ok(())
    })
}

/// Returns the column and row of each group of these widths; a group is in the row of the one
/// before it if there is room.
fn side_by_side(widths: &[i32], columns: i32) -> Vec<[i32; 2]> {
    let mut next = [0, 0];
    let place = |wide: &i32| {
        if next[0] + wide > columns {
            next = [0, next[1] + 1];
        }
        let place = next;
        next[0] += wide;
        place
    };
    widths.iter().map(place).collect()
}

/// Draws a frame with its lines and their numbers. Returns the map from a point to pixels.
pub fn frame(
    sheet: &Sheet,
    (x, y): (&Axis, &Axis),
    [(left, top), (right, bottom)]: [(i32, i32); 2],
) -> Result<impl Fn((f64, f64)) -> (i32, i32) + use<>, String> {
    let (x, y) = (x.clone(), y.clone());
    let at = {
        let (x, y) = (x.clone(), y.clone());
        move |(a, b): (f64, f64)| {
            let part = |part: f64, length: i32| (part * f64::from(length)).round() as i32;
            (left + part(x.part(a), right - left), bottom - part(y.part(b), bottom - top))
        }
    };
    for (tick, label) in x.ticks() {
        let (px, _) = at((tick, 0.0));
        sheet.line(vec![(px, top), (px, bottom)], GRID, 1)?;
        sheet.text(&label, (px, bottom + 15), 11, At::Middle, FAINT)?;
    }
    for (tick, label) in y.ticks() {
        let (_, py) = at((0.0, tick));
        sheet.line(vec![(left, py), (right, py)], GRID, 1)?;
        sheet.text(&label, (left - 11, py), 11, At::Right, FAINT)?;
    }
    Ok(at)
}

fn chart(sheet: &Sheet, chart: &Chart) -> Drawn {
    let points = || chart.curves.iter().flat_map(|curve| curve.points.iter().copied());
    let (x, y) = (
        Axis::of(points().map(|p| p.0).collect::<Vec<_>>().into_iter()),
        Axis::of(points().map(|p| p.1).collect::<Vec<_>>().into_iter()),
    );
    sheet.text(&y.named(&chart.title), (20, 8), 12, At::Left, INK)?;
    let (first, last) = (24, 24 + FRAME);
    let at = frame(sheet, (&x, &y), [(BEGIN, first), (END, last)])?;
    sheet.text(&x.named(&chart.x), ((BEGIN + END) / 2, last + 31), 12, At::Middle, FAINT)?;
    let mut ends = Vec::new();
    for (place, curve) in chart.curves.iter().enumerate() {
        let mut sorted = curve.points.clone();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let line: Vec<(i32, i32)> = sorted.into_iter().map(&at).collect();
        let Some(&end) = line.last() else { continue };
        let Style { colour, mark, dashed } = curve.style;
        // Curves that coincide are drawn with decreasing width, later ones inside.
        let over = chart.curves.len() - 1 - place;
        let width = 2 + (3 * over / 2).min(8);
        let marks = line.clone();
        if dashed {
            sheet.dashes(line, colour, width as u32)?;
        } else {
            sheet.line(line, colour, width as u32)?;
        }
        for point in marks {
            sheet.mark(mark, point, 3 + over.min(3) as i32, colour, !dashed)?;
        }
        ends.push(End { at: end, colour, label: &curve.label });
    }
    if ends.len() > 2 && chart.curves.iter().all(|c| c.points == chart.curves[0].points) {
        ends.truncate(1);
        ends.iter_mut().for_each(|end| end.label = "all of them");
    }
    labels::draw(sheet, ends, END + 34, last + 8)
}

/// Draws bars on a logarithmic scale, each with its number and, if known, its milliseconds: a panel
/// per input.
///
/// # Errors
/// [`Error::Bug`] if it cannot be drawn.
#[allow(clippy::type_complexity, reason = "a panel is its title and its bars, here alone")]
pub fn bars(
    title: &str,
    device: &str,
    panels: &[(String, Vec<(String, f64, Option<f64>)>)],
) -> Result<String, Error> {
    const ROW: i32 = 24;
    const PANEL: i32 = 44;
    let rows: usize = panels.iter().map(|panel| panel.1.len()).sum();
    sheet(head_height(2) + PANEL * panels.len() as i32 + ROW * rows as i32, |sheet| {
        let notes = [(format!("nearmiss on {device}"), INK), ("bars on a log scale".into(), FAINT)];
        let mut y = sheet.head(title, &notes)?;
        for (title, bars) in panels {
            sheet.bold(title, (20, y + 12), 14)?;
            y += 30;
            let most = bars.iter().map(|bar| bar.1).fold(10.0, f64::max).log10();
            for (label, number, ms) in bars {
                let part = if *number >= 1.0 { (number.log10() + 0.3) / (most + 0.3) } else { 0.0 };
                let end = LEFT + 60 + (part * f64::from(RIGHT - LEFT - 160)) as i32;
                sheet.text(label, (LEFT + 52, y + 9), 12, At::Right, INK)?;
                sheet.rectangle([(LEFT + 60, y), (end, y + 17)], OURS)?;
                let time = ms.map_or_else(String::new, |ms| format!("  in {} ms", digits(ms)));
                sheet.text(
                    &format!("{}{time}", grouped(*number as u64)),
                    (end + 6, y + 9),
                    12,
                    At::Left,
                    INK,
                )?;
                y += ROW;
            }
            y += PANEL - 30;
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::picture::style;
    use crate::tables::picture::check::faults;

    #[test]
    fn curves_and_bars_are_labelled() {
        let curve = |label: &str, y| {
            let style = style::plain(label == "two");
            Curve { label: label.into(), style, points: vec![(1e-9, 0.0), (1e-1, y)] }
        };
        let point = || Curve { points: vec![(1.0, 1.0)], ..curve("a point", 0.0) };
        let still = || Chart { title: "no curve".into(), x: String::new(), curves: vec![point()] };
        let groups = |chart| [Group { title: "an input".into(), charts: vec![still(), chart] }];
        let chart = Chart {
            title: "a <chart>".into(),
            x: "a quantity".into(),
            curves: vec![curve("one", 5e3), curve("two", 5e3), curve("three", 40.0)],
        };
        let svg = charts("a title", "a GPU", &groups(chart)).expect("a picture");
        for text in
            ["a title", "a GPU", "an input", "a &lt;chart&gt;", "one", "two", "1e-9", "a quantity, log scale"]
        {
            assert!(svg.contains(text), "{text}: {svg}");
        }
        assert!(!svg.contains("no curve"), "{svg}");
        // There is no place for it either.
        assert!(svg.contains("width=\"900\""), "{svg}");
        assert_eq!(faults(&svg), Vec::<String>::new());
        let panel = (
            "a scene".to_owned(),
            vec![("left".to_owned(), 1234.0, Some(0.5)), ("none".to_owned(), 0.0, None)],
        );
        let svg = bars("a title", "a GPU", &[panel]).expect("a picture");
        for text in ["a scene", "left", "1,234  in 0.500 ms", "none", "log scale"] {
            assert!(svg.contains(text), "{text}: {svg}");
        }
        assert_eq!(faults(&svg), Vec::<String>::new());
    }

    #[test]
    fn groups_stand_side_by_side_where_there_is_room() {
        assert_eq!(side_by_side(&[2, 1, 1, 1], 2), [[0, 0], [0, 1], [1, 1], [0, 2]]);
        assert_eq!(side_by_side(&[5, 5], 5), [[0, 0], [0, 1]]);
        assert_eq!(side_by_side(&[0, 1], 1), [[0, 0], [0, 0]]);
    }
}
