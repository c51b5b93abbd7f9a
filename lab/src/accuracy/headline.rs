//! The result in one line.

use super::row::Row;
use crate::tables::digits;
use nearmiss::query::QueryKind;
use nearmiss::research::{BoundingVolume, Certified, Solver};

/// Returns whether a row is of the default choice, with the positions as given.
fn is_default(row: &Row) -> bool {
    let motion = if row.tolerance_edges.is_some() { QueryKind::Continuous } else { QueryKind::Discrete };
    row.solver == Solver::default_for(motion)
        && row.tolerance_edges.is_none_or(|edges| edges == Certified::TOLERANCE)
        && row.bv.is_none_or(|bv| bv == BoundingVolume::default_for(motion).name())
        && row.precision != "f32 cast"
}

/// Returns `0 missed, k late, x ppm undecided, y ms at tolerance = z edge lengths` for the default
/// choice. Missed and late count over all its rows. The undecided pairs and the milliseconds per
/// frame are those of the largest moving scene.
pub fn headline(rows: &[Row]) -> String {
    let of: Vec<&Row> = rows.iter().filter(|row| is_default(row)).collect();
    let sum = |count: fn(&Row) -> u64| of.iter().map(|row| count(row)).sum::<u64>();
    let counts = format!("of {} pairs tested, {} of them contacts", sum(|r| r.cases), sum(|r| r.contacts));
    let moving = of.iter().filter(|row| row.ms.is_some() && row.tolerance_edges.is_some());
    let frame = match moving.max_by_key(|row| row.cases) {
        Some(row) => format!(
            ", {} ppm undecided, {} ms at tolerance = {:.0e} edge lengths ({}, {}",
            digits(row.undecided as f64 * 1e6 / row.cases.max(1) as f64),
            row.ms.map_or_else(String::new, digits),
            Certified::TOLERANCE,
            row.solver.name(),
            row.input,
        ),
        None => " (".to_owned() + Solver::default_for(QueryKind::Continuous).name(),
    };
    format!("{} missed, {} late{frame}; {counts})", sum(|r| r.missed), sum(|r| r.late))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(solver: Solver, tolerance: Option<f64>) -> Row {
        Row {
            input: "a scene".into(),
            solver,
            tolerance_edges: tolerance,
            cases: 2_000_000,
            contacts: 50,
            ..Row::default()
        }
    }

    #[test]
    fn it_is_counted_not_claimed() {
        let default = row(Solver::Certified, Some(Certified::TOLERANCE));
        let frame = Row { ms: Some(12.5), bv: Some("linear"), undecided: 4, ..default.clone() };
        let planted = Row { missed: 3, late: 2, ..default.clone() };
        let cast = Row { missed: 9, precision: "f32 cast", ..default.clone() };
        let other = Row { missed: 70, ..row(Solver::CubicF32, None) };
        let line = headline(&[default, frame, planted, cast, other]);
        let want = "3 missed, 2 late, 2.00 ppm undecided, 12.5 ms at tolerance = 1e-4 edge lengths (certified, a scene; of \
                    6000000 pairs tested, 150 of them contacts)";
        assert_eq!(line, want);
        assert!(headline(&[]).starts_with("0 missed, 0 late (certified; of 0 pairs"));
    }
}
