//! The links of a cloth: lengths between two vertices.

use super::V;

/// A link between two vertices with rest length `rest`.
#[derive(Clone, Copy)]
pub(super) struct Link {
    a: u32,
    b: u32,
    rest: f64,
    /// Compliance of the link: 0 is rigid. In units of (frame)^2 per unit of mass.
    yields: f64,
}

/// Compliance of a cloth, in the units of [`Link`].
#[derive(Clone, Copy)]
pub(in super::super) struct Fabric {
    /// Compliance along its threads.
    pub stretch: f64,
    /// Compliance along the diagonals of its cells.
    pub shear: f64,
    /// Compliance between threads that are two apart.
    pub bend: f64,
}

/// Makes the links of a woven cloth with rows of equal length, at rest in `x`. In a `closed` cloth
/// the last vertex of a row is next to the first. Six links per vertex, row by row: they act in
/// that order.
pub(super) fn weave(rows: &[Vec<u32>], closed: bool, fabric: Fabric, x: &[V]) -> Vec<Link> {
    let columns = rows.first().map_or(0, Vec::len);
    let at = |row: usize, column: usize| {
        let column = if closed && column >= columns { column - columns } else { column };
        rows.get(row).and_then(|row| row.get(column)).copied()
    };
    let mut links = Vec::with_capacity(6 * rows.len() * columns);
    for row in 0..rows.len() {
        for column in 0..columns {
            let mut link = |from: Option<u32>, to: Option<u32>, yields: f64| {
                if let (Some(a), Some(b)) = (from, to)
                    && a != b
                {
                    let d = x[a as usize] - x[b as usize];
                    links.push(Link { a, b, rest: d.dot(d).sqrt(), yields });
                }
            };
            let here = at(row, column);
            link(here, at(row, column + 1), fabric.stretch);
            link(here, at(row + 1, column), fabric.stretch);
            link(here, at(row + 1, column + 1), fabric.shear);
            link(at(row, column + 1), at(row + 1, column), fabric.shear);
            link(here, at(row, column + 2), fabric.bend);
            link(here, at(row + 2, column), fabric.bend);
        }
    }
    links
}

impl Link {
    /// Moves both ends towards the rest length. This is one step of XPBD (Macklin, Mueller and
    /// Chentanez 2016) with a fresh multiplier, as small substeps allow (Macklin et al. 2019). `w`:
    /// inverse masses; `per_step`: 1 / h^2.
    #[inline]
    pub(super) fn pull(&self, x: &mut [V], w: &[f64], per_step: f64) {
        let (a, b) = (self.a as usize, self.b as usize);
        let d = x[a] - x[b];
        let length = d.dot(d).sqrt();
        let mobile = w[a] + w[b];
        if length == 0.0 || mobile == 0.0 {
            return;
        }
        let pull = d * ((self.rest - length) / (length * (mobile + self.yields * per_step)));
        x[a] = x[a] + pull * w[a];
        x[b] = x[b] - pull * w[b];
    }
}
