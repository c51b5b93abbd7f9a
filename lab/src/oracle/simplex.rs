//! Linear programs over the rationals: two phases and Bland's rule, so it ends on every input.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

/// Outcome of a linear program.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// No point satisfies the system.
    Infeasible,
    /// The objective is unbounded.
    Unbounded,
    /// The largest value of the objective.
    Most(BigRational),
}

/// Returns the largest `c . x` over `x >= 0` with `a x = b`. Exact.
pub fn maximize(a: &[Vec<BigRational>], b: &[BigRational], c: &[BigRational]) -> Outcome {
    let (rows, columns) = (a.len(), c.len());
    // One artificial variable per row makes a first basis; its own program drives them to zero.
    let mut table: Vec<Vec<BigRational>> = Vec::new();
    for (i, (row, right)) in a.iter().zip(b).enumerate() {
        let mut r = row.clone();
        r.resize(columns + rows, BigRational::zero());
        r.push(right.clone());
        if right.is_negative() {
            r.iter_mut().for_each(|x| *x = -x.clone());
        }
        r[columns + i] = BigRational::one();
        table.push(r);
    }
    let mut t = Tableau { basis: (columns..columns + rows).collect(), table, gain: Vec::new() };
    let mut phase_one = vec![BigRational::zero(); columns];
    phase_one.resize(columns + rows, -BigRational::one());
    t.price(&phase_one);
    t.climb(columns + rows);
    if !t.value().is_zero() {
        return Outcome::Infeasible;
    }
    // Artificial variables left in the basis are zero: swap them out, or their row is redundant.
    for i in 0..rows {
        if t.basis[i] >= columns
            && let Some(j) = (0..columns).find(|&j| !t.table[i][j].is_zero())
        {
            t.pivot(i, j);
        }
    }
    let mut objective = c.to_vec();
    objective.resize(columns + rows, BigRational::zero());
    t.price(&objective);
    if t.climb(columns) { Outcome::Most(t.value()) } else { Outcome::Unbounded }
}

/// Rows in terms of the basis; the last column is the right side. `gain` is the reduced objective,
/// same columns.
struct Tableau {
    basis: Vec<usize>,
    table: Vec<Vec<BigRational>>,
    gain: Vec<BigRational>,
}

impl Tableau {
    /// Sets the reduced objective of `c` for the current basis.
    fn price(&mut self, c: &[BigRational]) {
        self.gain = c.to_vec();
        self.gain.push(BigRational::zero());
        for (row, &j) in self.table.iter().zip(&self.basis) {
            subtract(&mut self.gain, row, &c[j]);
        }
    }

    fn value(&self) -> BigRational {
        self.gain.last().map_or_else(BigRational::zero, |x| -x)
    }

    /// Pivots while a variable below `limit` gains. Returns false if the objective is unbounded.
    fn climb(&mut self, limit: usize) -> bool {
        while let Some(j) = (0..limit).find(|&j| self.gain[j].is_positive()) {
            let ratio = |i: usize| self.table[i].last().map(|right| right / &self.table[i][j]);
            let bounding = (0..self.basis.len()).filter(|&i| self.table[i][j].is_positive());
            match bounding.min_by_key(|&i| (ratio(i), self.basis[i])) {
                Some(i) => self.pivot(i, j),
                None => return false,
            }
        }
        true
    }

    fn pivot(&mut self, i: usize, j: usize) {
        let by = self.table[i][j].clone();
        self.table[i].iter_mut().filter(|x| !x.is_zero()).for_each(|x| *x = &*x / &by);
        let row = self.table[i].clone();
        for (k, other) in self.table.iter_mut().enumerate() {
            if k != i {
                let times = other[j].clone();
                subtract(other, &row, &times);
            }
        }
        let times = self.gain[j].clone();
        subtract(&mut self.gain, &row, &times);
        self.basis[i] = j;
    }
}

/// Computes `to -= from * times`.
fn subtract(to: &mut [BigRational], from: &[BigRational], times: &BigRational) {
    if times.is_zero() {
        return;
    }
    for (x, y) in to.iter_mut().zip(from).filter(|(_, y)| !y.is_zero()) {
        *x -= y * times;
    }
}
