//! Curves, each labelled at its end; and bars.

use super::axis::Axis;
use crate::tables::digits;
use crate::tables::picture::{At, Drawn, FAINT, GRID, INK, LEFT, OURS, RIGHT, Sheet, head_height, sheet};
use nearmiss::error::Error;
use plotters::style::RGBColor;

/// A curve.
pub struct Curve {
    /// What it is of.
    pub label: String,
    /// Where it runs.
    pub points: Vec<(f64, f64)>,
}

/// Curves that share a frame.
pub struct Chart {
    /// What they show.
    pub title: String,
    /// Over what.
    pub x: String,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// Height of a frame, and of what a chart has besides.
const FRAME: i32 = 150;
const CHART: i32 = 72;
/// Where frames end; labels stand to the right.
const END: i32 = 640;
/// Colours of Okabe and Ito, which people tell apart who see colours differently.
pub const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(86, 180, 233),
    RGBColor(0, 158, 115),
    RGBColor(213, 94, 0),
    RGBColor(230, 159, 0),
    RGBColor(204, 121, 167),
    RGBColor(90, 90, 90),
    RGBColor(0, 0, 0),
];

/// The picture.
///
/// # Errors
/// [`Error::Bug`] where it cannot be drawn.
pub fn charts(title: &str, device: &str, all: &[Chart]) -> Result<String, Error> {
    sheet(head_height(1) + (FRAME + CHART) * all.len() as i32, |sheet| {
        let mut y = sheet.head(title, &[(format!("nearmiss on {device}"), INK)])?;
        for chart in all {
            self::chart(sheet, chart, y)?;
            y += FRAME + CHART;
        }
        Ok(())
    })
}

/// A frame with its lines and the numbers at them; from a point to pixels.
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
        sheet.text(&label, (px, bottom + 11), 11, At::Middle, FAINT)?;
    }
    for (tick, label) in y.ticks() {
        let (_, py) = at((0.0, tick));
        sheet.line(vec![(left, py), (right, py)], GRID, 1)?;
        sheet.text(&label, (left - 8, py), 11, At::Right, FAINT)?;
    }
    Ok(at)
}

fn chart(sheet: &Sheet, chart: &Chart, top: i32) -> Drawn {
    let points = || chart.curves.iter().flat_map(|curve| curve.points.iter().copied());
    let (x, y) = (
        Axis::of(points().map(|p| p.0).collect::<Vec<_>>().into_iter()),
        Axis::of(points().map(|p| p.1).collect::<Vec<_>>().into_iter()),
    );
    sheet.bold(&chart.title, (20, top + 12), 14)?;
    let (first, last) = (top + 28, top + 28 + FRAME);
    let at = frame(sheet, (&x, &y), [(LEFT / 2, first), (END, last)])?;
    sheet.text(&chart.x, ((LEFT / 2 + END) / 2, last + 27), 12, At::Middle, FAINT)?;
    let mut ends = Vec::new();
    for (curve, colour) in chart.curves.iter().zip(COLOURS.iter().cycle()) {
        let mut sorted = curve.points.clone();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let line: Vec<(i32, i32)> = sorted.into_iter().map(&at).collect();
        let Some(&end) = line.last() else { continue };
        for &point in &line {
            sheet.dot(point, 3, *colour, true)?;
        }
        sheet.line(line, *colour, 2)?;
        ends.push((end.1, &curve.label, *colour));
    }
    let all_same = chart.curves.len() > 2 && chart.curves.iter().all(|c| c.points == chart.curves[0].points);
    if all_same {
        ends.truncate(1);
    }
    ends.sort_by_key(|end| end.0);
    let places = apart(ends.iter().map(|end| end.0).collect(), last + 8);
    for ((_, label, colour), y) in ends.into_iter().zip(places) {
        sheet.line(vec![(END + 6, y), (END + 20, y)], colour, 3)?;
        let label = if all_same { "all of them" } else { label };
        sheet.text(label, (END + 26, y), 12, At::Left, INK)?;
    }
    Ok(())
}

/// Heights, ascending, moved apart so that a line of text fits between any two, none below `bottom`.
fn apart(mut heights: Vec<i32>, bottom: i32) -> Vec<i32> {
    const LINE: i32 = 13;
    for i in 1..heights.len() {
        heights[i] = heights[i].max(heights[i - 1] + LINE);
    }
    let mut most = bottom;
    for height in heights.iter_mut().rev() {
        *height = (*height).min(most);
        most = *height - LINE;
    }
    heights
}

/// Bars on a logarithmic scale, each with its number and, where it has some, milliseconds: a panel an input.
///
/// # Errors
/// [`Error::Bug`] where it cannot be drawn.
#[allow(clippy::type_complexity, reason = "a panel is its title and its bars, here alone")]
pub fn bars(
    title: &str,
    device: &str,
    panels: &[(String, Vec<(String, f64, Option<f64>)>)],
) -> Result<String, Error> {
    const ROW: i32 = 24;
    const PANEL: i32 = 44;
    let rows: usize = panels.iter().map(|panel| panel.1.len()).sum();
    sheet(head_height(1) + PANEL * panels.len() as i32 + ROW * rows as i32, |sheet| {
        let mut y = sheet.head(title, &[(format!("nearmiss on {device}"), INK)])?;
        for (title, bars) in panels {
            sheet.bold(title, (20, y + 12), 14)?;
            y += 30;
            let most = bars.iter().map(|bar| bar.1).fold(10.0, f64::max).log10();
            for (label, number, ms) in bars {
                let part = if *number >= 1.0 { (number.log10() + 0.3) / (most + 0.3) } else { 0.0 };
                let end = LEFT + 60 + (part * f64::from(RIGHT - LEFT - 160)) as i32;
                sheet.text(label, (LEFT + 52, y + 9), 12, At::Right, INK)?;
                sheet.rectangle([(LEFT + 60, y), (end, y + 17)], OURS)?;
                let time = ms.map_or_else(String::new, |ms| format!(", in {} ms", digits(ms)));
                sheet.text(&format!("{number}{time}"), (end + 6, y + 9), 12, At::Left, INK)?;
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

    #[test]
    fn labels_stand_apart() {
        assert_eq!(apart(vec![10, 10, 50], 100), [10, 23, 50]);
        assert_eq!(apart(vec![95, 100, 100], 100), [74, 87, 100]);
    }

    #[test]
    fn curves_and_bars_are_labelled() {
        let curve = |label: &str, y| Curve { label: label.into(), points: vec![(1e-9, 0.0), (1e-1, y)] };
        let chart = Chart {
            title: "a <chart>".into(),
            x: "a quantity".into(),
            curves: vec![curve("one", 5e3), curve("two", 4e3)],
        };
        let svg = charts("a title", "a GPU", &[chart]).expect("a picture");
        for text in ["a title", "a GPU", "a &lt;chart&gt;", "one", "two", "1e-9", "a quantity"] {
            assert!(svg.contains(text), "{text}: {svg}");
        }
        let panel = (
            "a scene".to_owned(),
            vec![("left".to_owned(), 1234.0, Some(0.5)), ("none".to_owned(), 0.0, None)],
        );
        let svg = bars("a title", "a GPU", &[panel]).expect("a picture");
        for text in ["a scene", "left", "1234, in 0.500 ms", "none"] {
            assert!(svg.contains(text), "{text}: {svg}");
        }
    }
}
