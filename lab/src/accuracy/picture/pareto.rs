//! Time against accuracy, one mark per choice. Choices that can give wrong answers are hollow, with
//! the counts of those answers. A line joins the Pareto front of the other choices, which are
//! named.

use super::Quantity;
use super::axis::Axis;
use super::chart::frame;
use super::place::{Area, SIZE, places};
use super::style;
use crate::accuracy::row::Row;
use crate::tables::picture::{At, Drawn, FAINT, INK, Sheet, head_height, wide_sheet};
use nearmiss::error::Error;
use nearmiss::research::Solver;
use plotters::style::{RGBColor, WHITE};

/// Height of a frame, and of the rest of a panel.
const FRAME: i32 = 220;
const PANEL: i32 = 88;
/// Width of a panel, and the left and right sides of its frame.
const CELL: i32 = 800;
const BEGIN: i32 = 64;
const END: i32 = 765;

/// The line along the Pareto front.
const STEPS: RGBColor = RGBColor(178, 190, 200);

/// One mark.
struct Event<'a> {
    row: &'a Row,
    x: f64,
    y: f64,
}

/// The quantities; lower is better.
const QUANTITIES: [Quantity; 2] = [
    ("false alarms, per million pairs", |row| row.false_alarms as f64 * 1e6 / row.cases.max(1) as f64),
    ("99 % of times early by at most, in mean edges", |row| row.early_edges_p99),
];

/// Draws the picture, a row per input, a column per quantity. Time is milliseconds per frame for
/// whole scenes, and nanoseconds per pair for single cases.
///
/// # Errors
/// [`Error::Bug`] if it cannot be drawn.
pub fn pareto(device: &str, rows: &[Row]) -> Result<String, Error> {
    // A panel of zeros is left out.
    let has_values = |rows: &[Row], (_, of): &Quantity| rows.iter().any(|row| of(row) > 0.0);
    let is_drawn = |rows: &&[Row]| rows.len() > 2 && QUANTITIES.iter().any(|of| has_values(rows, of));
    let inputs: Vec<&[Row]> = rows.chunk_by(|a, b| a.input == b.input).filter(is_drawn).collect();
    let size = [CELL * QUANTITIES.len() as i32, head_height(3) + (FRAME + PANEL) * inputs.len() as i32];
    wide_sheet(size, |sheet| {
        let hollow = "hollow: can miss and be late, and how many missed + late; on the line: cannot, and none better in both";
        let notes = [(format!("nearmiss on {device}"), INK), (hollow.into(), FAINT), (String::new(), INK)];
        let mut y = sheet.head("Choices: left is faster, lower is better", &notes)?;
        legend(sheet, &inputs, y - 18)?;
        for rows in inputs {
            for (column, quantity) in
                QUANTITIES.into_iter().enumerate().filter(|(_, of)| has_values(rows, of))
            {
                panel(&sheet.part((CELL * column as i32, y), (CELL, FRAME + PANEL)), rows, quantity)?;
            }
            y += FRAME + PANEL;
        }
        Ok(())
    })
}

/// Returns the rows to draw. The storage of single cases changes no answer, and such a mark would
/// hide another.
fn drawn(rows: &[Row]) -> impl Iterator<Item = &Row> {
    rows.iter().filter(|row| row.bv.is_some() || row.precision == "f64")
}

/// Draws the solvers' colours, in a line.
fn legend(sheet: &Sheet, inputs: &[&[Row]], y: i32) -> Drawn {
    let mut x = 24;
    let is_drawn = |of: &Solver| inputs.iter().any(|rows| drawn(rows).any(|row| row.solver == *of));
    for solver in Solver::ALL.into_iter().filter(is_drawn) {
        let name = solver.name();
        let style = style::of(solver);
        sheet.mark(style.mark, (x, y), 5, style.colour, !style.dashed)?;
        sheet.text(name, (x + 10, y), 12, At::Left, INK)?;
        x += 34 + 7 * name.len() as i32;
    }
    Ok(())
}

/// Returns whether answers are reliable: the solver has a proof, and the counts show no wrong
/// answer.
fn is_sure(row: &Row) -> bool {
    row.solver.is_certain() && !row.is_wrong()
}

/// Returns the reliable choices that no other reliable one beats in both quantities.
fn best<'a>(marks: &'a [Event]) -> impl Iterator<Item = &'a Event<'a>> {
    let right = |mark: &&Event| is_sure(mark.row);
    let beaten = move |mark: &Event| {
        let others = marks.iter().filter(right);
        others.into_iter().any(|o| o.x <= mark.x && o.y <= mark.y && (o.x < mark.x || o.y < mark.y))
    };
    marks.iter().filter(right).filter(move |mark| !beaten(mark))
}

fn panel(sheet: &Sheet, rows: &[Row], (what, of): Quantity) -> Drawn {
    let frames = rows.iter().any(|row| row.ms.is_some());
    let time = |row: &Row| if frames { row.ms } else { row.ns };
    let marks: Vec<Event> =
        drawn(rows).filter_map(|row| Some(Event { row, x: time(row)?, y: of(row) })).collect();
    let (xs, ys): (Vec<f64>, Vec<f64>) = marks.iter().map(|m| (m.x, m.y)).unzip();
    let (xs, ys) = (Axis::of(xs.into_iter()), Axis::of(ys.into_iter()));
    sheet.bold(&ys.named(&format!("{}: {what}", rows[0].input)), (20, 12), 14)?;
    let (first, last) = (30, 30 + FRAME);
    let at = frame(sheet, (&xs, &ys), [(BEGIN, first), (END, last)])?;
    let unit = xs.named(if frames { "ms a frame" } else { "ns a pair" });
    sheet.text(&unit, ((BEGIN + END) / 2, last + 32), 12, At::Middle, FAINT)?;
    let place = |mark: &Event| <[i32; 2]>::from(at((mark.x, mark.y)));
    let unsure = marks.iter().filter(|mark| !is_sure(mark.row)).map(|mark| {
        let Row { missed, late, .. } = mark.row;
        (mark, format!("{}: {missed} + {late}", mark.row.choice()))
    });
    let mut best: Vec<&Event> = best(&marks).collect();
    best.sort_by(|a, b| a.x.total_cmp(&b.x).then(b.y.total_cmp(&a.y)));
    let steps = best.windows(2).flat_map(|two| [(two[0].x, two[0].y), (two[1].x, two[0].y)]);
    let steps = steps.chain(best.last().map(|last| (last.x, last.y)));
    sheet.line(steps.map(&at).collect(), STEPS, 2)?;
    let named: Vec<(&Event, String)> =
        unsure.chain(best.into_iter().map(|mark| (mark, mark.row.choice()))).collect();
    let areas: Vec<Area> = marks.iter().map(|mark| Area::around(place(mark), 7)).collect();
    let names: Vec<([i32; 2], String)> =
        named.iter().map(|(mark, name)| (place(mark), name.clone())).collect();
    let inside = Area { low: [BEGIN + 2, first + 1], high: [END + 25, last - 1] };
    let found = places(&names, &areas, &inside);
    for ((mark, name), found) in named.iter().zip(found) {
        // A name without a free place is left out: the CSV file has the rows.
        let Some(found) = found else { continue };
        let colour = style::of(mark.row.solver).colour;
        let [[left, top], [right, bottom]] = [found.area.low, found.area.high];
        sheet.rectangle([(left, top), (right, bottom)], WHITE)?;
        if let Some(line) = found.line {
            sheet.line(line.map(Into::into).to_vec(), colour, 1)?;
        }
        let ink = if is_sure(mark.row) { INK } else { FAINT };
        let y = (top + bottom) / 2;
        // Aligned towards its mark.
        let (x, at) = if right < place(mark)[0] { (right - 1, At::Right) } else { (left + 1, At::Left) };
        sheet.text(name, (x, y), SIZE, at, ink)?;
    }
    for mark in &marks {
        let (sure, style) = (is_sure(mark.row), style::of(mark.row.solver));
        sheet.mark(style.mark, place(mark).into(), if sure { 4 } else { 5 }, style.colour, sure)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(solver: Solver, ms: f64, early: f64, missed: u64) -> Row {
        Row {
            input: "a scene".into(),
            solver,
            tolerance_edges: (missed == 0).then_some(early),
            early_edges_p99: early,
            precision: "f64",
            missed,
            cases: 100,
            ms: Some(ms),
            ..Row::default()
        }
    }

    #[test]
    fn what_misses_is_hollow_and_what_is_best_is_named() {
        let rows = [
            row(Solver::Certified, 2.0, 1e-4, 0),
            row(Solver::CertifiedF64, 3.0, 1e-2, 0),
            row(Solver::CertifiedF32, 1.0, 1e-3, 0),
            row(Solver::CubicF32, 0.5, 1e-6, 7),
        ];
        let svg = pareto("a GPU", &rows).expect("a picture");
        for text in
            ["cubic-f32: 7 + 0", "certified 1e-4", "certified-f32 1e-3", "ms a frame", "a scene: 99 %"]
        {
            assert!(svg.contains(text), "{text}: {svg}");
        }
        assert!(!svg.contains("false alarms"), "there are none");
        assert_eq!(crate::tables::picture::check::faults(&svg), Vec::<String>::new());
        let marks: Vec<Event> =
            rows.iter().map(|row| Event { row, x: row.ms.expect("ms"), y: row.early_edges_p99 }).collect();
        let names: Vec<Solver> = best(&marks).map(|mark| mark.row.solver).collect();
        assert_eq!(names, [Solver::Certified, Solver::CertifiedF32]);
    }
}
