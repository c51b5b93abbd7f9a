//! Circles and waves by `+ - * /` alone, the same on every machine; and cloth around an axis.

use super::known::at_least_one;
use super::square_root;

/// Returns cosine and sine of a number of turns: the Taylor series of an eighth of the angle,
/// doubled three times. The error is below 1e-14.
pub(super) fn circle(turns: f64) -> [f64; 2] {
    let x = (turns - (turns + 0.5).floor()) * (std::f64::consts::TAU / 8.0);
    let square = x * x;
    // 1 - x^2/(1 2) (1 - x^2/(3 4) (...)) and x (1 - x^2/(2 3) (1 - ...)): |x| <= 0.4, and the
    // first omitted term is 1e-17.
    let series = |first: f64| {
        (0..6).rev().fold(1.0, |sum, k| {
            let n = first + 2.0 * f64::from(k);
            1.0 - square / (n * (n + 1.0)) * sum
        })
    };
    let (mut c, mut s) = (series(1.0), x * series(2.0));
    for _ in 0..3 {
        (c, s) = (c * c - s * s, 2.0 * c * s);
    }
    [c, s]
}

/// Returns a wave of period 1 and height 1 made of two parabolas: nearly a sine, the same on every
/// machine.
pub(super) fn wave(x: f64) -> f64 {
    let t = x - (x + 0.5).floor();
    8.0 * t * (1.0 - 2.0 * t.abs())
}

/// Returns the rows and columns of a cloth around an axis with about `cells` cells. Cells are about
/// square at half the width of the hem.
pub(super) fn around(cells: f64) -> [u32; 2] {
    let rows = square_root(cells.max(1.0) / 2.5);
    [rows, at_least_one(cells / f64::from(rows)).max(3)]
}

/// Makes a cloth around the vertical axis, row by row. `place` takes a fraction of the way down and
/// a direction around. It returns radius and height there, and the random shift of the vertex.
pub(super) fn ring(
    [rows, columns]: [u32; 2],
    mut place: impl FnMut(f64, f64) -> ([f64; 2], [f64; 3]),
) -> Vec<Vec<[f64; 3]>> {
    let row = |row| {
        let down = f64::from(row) / f64::from(rows);
        let vertex = |column| {
            let turns = f64::from(column) / f64::from(columns);
            let [c, s] = circle(turns);
            let ([radius, height], off) = place(down, turns);
            [radius * c + off[0], radius * s + off[1], height + off[2]]
        };
        (0..columns).map(vertex).collect()
    };
    (0..=rows).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_a_circle() {
        for k in -40..=40 {
            let turns = f64::from(k) / 16.0;
            let ([c, s], x) = (circle(turns), turns * std::f64::consts::TAU);
            assert!((c - x.cos()).abs() < 1e-14 && (s - x.sin()).abs() < 1e-14, "{turns}: {c} {s}");
            assert!((wave(turns) - s).abs() < 0.06, "{turns}");
        }
    }
}
