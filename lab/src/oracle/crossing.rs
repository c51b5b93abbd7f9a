//! How two triangles meet, by rational arithmetic.
//!
//! Insides share a point if weights above 0 of both triangles give one: a linear program finds the
//! largest least weight. The common points are the hull of points that are listed without thought:
//! all corners, all points of lines of edges on planes, all common points of lines of edges.
//! Another linear program keeps those that both triangles hold. Their rank is the dimension.

use super::simplex::{Outcome, maximize};
use super::{Triangle, exact};
use num_rational::BigRational;
use num_traits::{One, Zero};

/// A point with exact coordinates.
pub type Point = [BigRational; 3];

/// The common points of two triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Meeting {
    /// Whether the insides share a point and no plane holds all corners.
    pub is_crossing: bool,
    /// Dimension of the common points: 0, 1 or 2.
    pub dimension: usize,
    /// The two ends of a segment, twice the point, or neither of an area; the lesser first.
    pub ends: Option<[Point; 2]>,
}

/// Returns how two closed triangles meet; `None` if they share no point.
pub fn meeting(p: &Triangle, q: &Triangle) -> Option<Meeting> {
    let [p, q] = [p, q].map(|t| t.map(|corner| corner.map(exact)));
    let mut points: Vec<Point> = Vec::new();
    for x in candidates(&p, &q) {
        if !points.contains(&x) && holds(&p, &x) && holds(&q, &x) {
            points.push(x);
        }
    }
    points.sort();
    let (first, last) = (points.first()?.clone(), points.last()?.clone());
    let dimension = rank(points.iter().map(|x| minus(x, &first)).collect());
    let is_flat = rank(p.iter().chain(&q).map(|x| minus(x, &p[0])).collect()) < 3;
    let is_crossing = !is_flat && insides_meet(&p, &q);
    Some(Meeting { is_crossing, dimension, ends: (dimension < 2).then_some([first, last]) })
}

/// All points that may be corners of the common points, and more.
fn candidates(p: &[Point; 3], q: &[Point; 3]) -> Vec<Point> {
    let mut all: Vec<Point> = p.iter().chain(q).cloned().collect();
    let edges = |t: &[Point; 3]| [0, 1, 2].map(|k| [t[k].clone(), t[(k + 1) % 3].clone()]);
    for (t, other) in [(p, q), (q, p)] {
        let normal = cross(&minus(&other[1], &other[0]), &minus(&other[2], &other[0]));
        for [from, to] in edges(t) {
            let way = minus(&to, &from);
            let along = dot(&normal, &way);
            if !along.is_zero() {
                let part = dot(&normal, &minus(&other[0], &from)) / along;
                all.push(moved(&from, &way, &part));
            }
        }
    }
    for [from, to] in edges(p) {
        for [start, end] in edges(q) {
            let (way, other) = (minus(&to, &from), minus(&end, &start));
            let normal = cross(&way, &other);
            let size = dot(&normal, &normal);
            if !size.is_zero() {
                let part = dot(&cross(&minus(&start, &from), &other), &normal) / size;
                all.push(moved(&from, &way, &part));
            }
        }
    }
    all
}

/// Whether a point is a sum of the corners with weights of at least 0 that sum to 1.
fn holds(t: &[Point; 3], x: &Point) -> bool {
    let mut rows: Vec<Vec<_>> = (0..3).map(|k| t.iter().map(|corner| corner[k].clone()).collect()).collect();
    rows.push(vec![BigRational::one(); 3]);
    let right: Vec<_> = x.iter().cloned().chain([BigRational::one()]).collect();
    maximize(&rows, &right, &vec![BigRational::zero(); 3]) != Outcome::Infeasible
}

/// Whether weights above 0 of both give one point. The seventh variable is the least weight: the
/// others are what weights exceed it by.
fn insides_meet(p: &[Point; 3], q: &[Point; 3]) -> bool {
    let (zero, one) = (BigRational::zero, BigRational::one);
    let three = one() + one() + one();
    let mut rows: Vec<Vec<BigRational>> = Vec::new();
    for k in 0..3 {
        let mut row: Vec<_> = p.iter().map(|x| x[k].clone()).chain(q.iter().map(|x| -x[k].clone())).collect();
        row.push(row.iter().sum());
        rows.push(row);
    }
    let of = |first: bool| (0..6).map(move |i| if (i < 3) == first { one() } else { zero() });
    rows.push(of(true).chain([three.clone()]).collect());
    rows.push(of(false).chain([three]).collect());
    let right = [zero(), zero(), zero(), one(), one()];
    let mut gain = vec![zero(); 6];
    gain.push(one());
    matches!(maximize(&rows, &right, &gain), Outcome::Most(least) if least > zero())
}

/// Rank of vectors, by elimination.
fn rank(mut rows: Vec<Point>) -> usize {
    let mut rank = 0;
    for k in 0..3 {
        let Some(at) = (rank..rows.len()).find(|&at| !rows[at][k].is_zero()) else { continue };
        rows.swap(rank, at);
        let pivot = rows[rank].clone();
        for row in &mut rows[rank + 1..] {
            let part = -(&row[k] / &pivot[k]);
            *row = moved(row, &pivot, &part);
        }
        rank += 1;
    }
    rank
}

fn minus(a: &Point, b: &Point) -> Point {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

/// `a + part * way`.
fn moved(a: &Point, way: &Point, part: &BigRational) -> Point {
    [0, 1, 2].map(|k| &a[k] + &way[k] * part)
}

fn dot(a: &Point, b: &Point) -> BigRational {
    (0..3).map(|k| &a[k] * &b[k]).sum()
}

fn cross(a: &Point, b: &Point) -> Point {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}
