//! Styles of series: a solver has the same style in every picture. No two look alike, even in grey:
//! their marks differ too.

use crate::tables::picture::{FAINT, INK, Mark};
use nearmiss::research::Solver;
use plotters::style::RGBColor;

/// A colour, a mark at each point, and whether the line is dashed and the mark hollow, for solvers
/// that can miss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Colour of line and mark.
    pub colour: RGBColor,
    /// Shape of the mark.
    pub mark: Mark,
    /// Whether the line is dashed and the mark hollow.
    pub dashed: bool,
}

/// Returns a solver's style. Colours are those of Okabe and Ito, which remain distinct to
/// colour-blind readers.
pub fn of(solver: Solver) -> Style {
    let (colour, mark) = match solver {
        Solver::Certified => (RGBColor(0, 114, 178), Mark::Disc),
        Solver::CertifiedF32 => (RGBColor(86, 180, 233), Mark::Square),
        Solver::CertifiedF64 => (RGBColor(0, 158, 115), Mark::Diamond),
        Solver::CubicF64 => (RGBColor(213, 94, 0), Mark::Up),
        Solver::CubicF32 => (RGBColor(230, 159, 0), Mark::Down),
        Solver::Exact => (RGBColor(204, 121, 167), Mark::Disc),
        Solver::Moller => (RGBColor(120, 110, 40), Mark::Square),
        Solver::Bounded => (RGBColor(120, 60, 160), Mark::Diamond),
        // A new solver: give it a style of its own.
        _ => (INK, Mark::Disc),
    };
    Style { colour, mark, dashed: !solver.is_certain() }
}

/// Returns the styles of two series that are no solvers.
pub fn plain(second: bool) -> Style {
    if second {
        Style { colour: FAINT, mark: Mark::Square, dashed: true }
    } else {
        Style { colour: INK, mark: Mark::Disc, dashed: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns pairs of series with nearly the same colour.
    fn alike(series: &[(&'static str, Style)]) -> Vec<[&'static str; 2]> {
        let mut found = Vec::new();
        for (at, (name, one)) in series.iter().enumerate() {
            for (other_name, other) in &series[at + 1..] {
                let parts = |c: RGBColor| [c.0, c.1, c.2].map(i32::from);
                let (a, b) = (parts(one.colour), parts(other.colour));
                if (0..3).map(|k| (a[k] - b[k]).abs()).sum::<i32>() < 60 {
                    found.push([*name, *other_name]);
                }
            }
        }
        found
    }

    #[test]
    fn no_two_solvers_look_alike() {
        let all = Solver::ALL.map(|solver| (solver.name(), of(solver)));
        assert_eq!(alike(&all), Vec::<[&str; 2]>::new());
        // Solvers in one picture differ by their marks as well.
        let moving = Solver::ALL.into_iter().filter(|of| of.answers(nearmiss::query::QueryKind::Continuous));
        let marks: Vec<Mark> = moving.map(|solver| of(solver).mark).collect();
        assert!(
            marks.len() > 4 && marks.iter().enumerate().all(|(at, mark)| !marks[at + 1..].contains(mark))
        );
        assert!(of(Solver::CubicF32).dashed && !of(Solver::Certified).dashed);
        // The checker must notice two equal colours.
        let mut bad = all;
        bad[1].1.colour = bad[4].1.colour;
        assert_eq!(alike(&bad), [[bad[1].0, bad[4].0]]);
        assert_ne!(plain(false), plain(true));
    }
}
