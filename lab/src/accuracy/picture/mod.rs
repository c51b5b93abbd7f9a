//! Pictures of the choices and their costs.

mod axis;
mod chart;
mod pareto;
mod place;
mod style;

use super::funnel::FunnelRow;
use super::refit::RefitRow;
use super::row::Row;
use chart::{Chart, Curve, Group, charts};
use nearmiss::error::Error;
pub use pareto::pareto;

/// A quantity to draw: its name, and its value in a row.
type Quantity = (&'static str, fn(&Row) -> f64);

/// Draws earliness of times, and cost of an answer, over the tolerance: a chart per input and
/// quantity.
///
/// # Errors
/// [`Error::Bug`] if it cannot be drawn.
pub fn tolerance(device: &str, rows: &[Row]) -> Result<String, Error> {
    let with: Vec<&Row> =
        rows.iter().filter(|row| row.tolerance_edges.is_some_and(|t| t > 0.0) && is_plain(row)).collect();
    let quantities: [Quantity; 5] = [
        ("99 % of times early by at most, in mean edges", |row| row.early_edges_p99),
        ("false alarms", |row| row.false_alarms as f64),
        ("tested in f64 after f32", |row| row.escalated as f64),
        ("boxes of 99 % of the listed pairs", |row| row.boxes_p99),
        ("nanoseconds a pair", |row| row.ns.unwrap_or(0.0)),
    ];
    let group = |rows: &[&Row]| {
        let chart = |(what, of): Quantity| {
            let curves = curves(rows, |row| row.tolerance_edges.unwrap_or(0.0), of);
            Chart { title: what.into(), x: "tolerance / mean edge".into(), curves }
        };
        Group { title: rows[0].input.clone(), charts: quantities.map(chart).into() }
    };
    let all: Vec<Group> = with.chunk_by(|a, b| a.input == b.input).map(group).collect();
    charts("The tolerance: sharper times cost boxes", device, &all)
}

/// Returns whether a row has defaults for everything except solver and tolerance.
fn is_plain(row: &Row) -> bool {
    let default =
        nearmiss::research::BoundingVolume::default_for(nearmiss::query::QueryKind::Continuous).name();
    row.bv.is_none_or(|bv| bv == default) && (row.bv.is_some() || row.precision == "f64")
}

/// Draws wrong answers over the offset, the scale and the degeneracy, and boxes over the
/// degeneracy: a chart per sweep.
///
/// # Errors
/// [`Error::Bug`] if it cannot be drawn.
pub fn sweeps(device: &str, rows: &[Row]) -> Result<String, Error> {
    let mut sorted: Vec<&Row> = rows.iter().collect();
    // Each sweep's rows become adjacent; a sweep has one curve per choice.
    sorted.sort_by_key(|row| rows.iter().position(|other| other.input == row.input));
    let mut all = Vec::new();
    for rows in sorted.chunk_by(|a, b| a.input == b.input) {
        let wrong = |row: &Row| (row.missed + row.late) as f64 / row.contacts.max(1) as f64;
        let at = |row: &Row| row.at.unwrap_or(0.0);
        let x = rows[0].input.clone();
        let (cast, given): (Vec<&Row>, Vec<&Row>) = rows.iter().partition(|row| row.precision == "f32 cast");
        let chart = |title: &str, curves| Chart { title: title.into(), x: x.clone(), curves };
        let wrong_of = |rows: &[&Row]| curves(rows, at, wrong);
        let second = if x.contains("10^") {
            let certified: Vec<&Row> = rows.iter().filter(|row| row.boxes_max > 0.0).copied().collect();
            chart("boxes of 99 % of the listed pairs", curves(&certified, at, |row| row.boxes_p99))
        } else {
            chart("the same, positions cast to f32", wrong_of(&cast))
        };
        let charts = vec![chart("part of the contacts that is missed or late", wrong_of(&given)), second];
        all.push(Group { title: x.clone(), charts });
    }
    charts("Far away, large and small, degenerate", device, &all)
}

/// Draws the pairs that each step leaves.
///
/// # Errors
/// [`Error::Bug`] if it cannot be drawn.
pub fn funnel(device: &str, rows: &[FunnelRow]) -> Result<String, Error> {
    let panel = |rows: &[FunnelRow]| {
        let bar = |row: &FunnelRow| (row.step.to_owned(), row.pairs as f64, row.ms);
        (rows[0].input.clone(), rows.iter().map(bar).collect())
    };
    let panels: Vec<_> = rows.chunk_by(|a, b| a.input == b.input).map(panel).collect();
    chart::bars("The funnel: pairs that each step leaves, and its time", device, &panels)
}

/// Draws the tests of a refitted tree relative to those of a fresh one.
///
/// # Errors
/// [`Error::Bug`] if it cannot be drawn.
pub fn refit(device: &str, rows: &[RefitRow]) -> Result<String, Error> {
    let chart = |of: &[RefitRow]| {
        let quantity = |label: &str, of_row: fn(&RefitRow) -> f64| Curve {
            label: label.into(),
            style: style::plain(label == "triangle pairs"),
            points: of.iter().enumerate().map(|(at, row)| (at as f64, of_row(row))).collect(),
        };
        let curves = vec![
            quantity("overlap tests", |row| row.refitted_tests as f64 / row.fresh_tests.max(1) as f64),
            quantity("triangle pairs", |row| row.refitted_pairs as f64 / row.fresh_pairs.max(1) as f64),
        ];
        Chart { title: format!("{}: a refitted tree over a fresh one", of[0].bv), x: "frame".into(), curves }
    };
    let group = |of: &[RefitRow]| Group {
        title: of[0].input.clone(),
        charts: of.chunk_by(|a, b| a.bv == b.bv).map(chart).collect(),
    };
    let all: Vec<Group> = rows.chunk_by(|a, b| a.input == b.input).map(group).collect();
    charts("Refitting: what it costs in quality", device, &all)
}

/// Returns one curve per solver.
fn curves(rows: &[&Row], x: impl Fn(&Row) -> f64, y: impl Fn(&Row) -> f64) -> Vec<Curve> {
    let mut all: Vec<Curve> = Vec::new();
    for row in rows {
        let (label, point) = (row.solver.name(), (x(row), y(row)));
        match all.iter_mut().find(|curve| curve.label == label) {
            Some(curve) => curve.points.push(point),
            None => {
                all.push(Curve { label: label.into(), style: style::of(row.solver), points: vec![point] });
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables::picture::check::faults;
    use nearmiss::query::QueryKind;
    use nearmiss::research::KindExt;
    use nearmiss::research::Solver;

    #[test]
    fn a_solver_has_one_colour_in_every_picture() {
        let solvers = QueryKind::Continuous.solvers();
        let mut rows = Vec::new();
        for (place, &solver) in solvers.iter().enumerate() {
            for step in 0..4 {
                rows.push(Row {
                    input: "offset".into(),
                    solver,
                    precision: "f64",
                    tolerance_edges: Some(10f64.powi(-step)),
                    at: Some(f64::from(step)),
                    early_edges_p99: 10f64.powi(-step - place as i32),
                    ns: Some(100.0 * (place as f64 + 1.0)),
                    cases: 10,
                    missed: u64::from(!solver.is_certain()),
                    ..Row::default()
                });
            }
        }
        let pictures = [tolerance("a GPU", &rows), sweeps("a GPU", &rows), pareto("a GPU", &rows)];
        for svg in pictures.map(|svg| svg.expect("a picture")) {
            assert_eq!(faults(&svg), Vec::<String>::new());
            for &solver in &solvers {
                let colour = style::of(solver).colour;
                let hex = format!("#{:02X}{:02X}{:02X}", colour.0, colour.1, colour.2);
                assert!(
                    svg.contains(solver.name()) && svg.contains(&hex),
                    "{} in {hex}: {svg}",
                    solver.name()
                );
            }
        }
        // One solver has one colour, and no other solver has it.
        let one: Vec<&Row> = rows.iter().filter(|row| row.solver == Solver::CubicF32).collect();
        let drawn = curves(&one, |_| 0.0, |_| 0.0);
        assert!(drawn.len() == 1 && drawn[0].style == style::of(Solver::CubicF32));
    }
}
