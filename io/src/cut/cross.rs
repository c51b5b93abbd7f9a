//! Projections on a line: crossing edges, and the order in which corners are tested.

use super::{Point, turn};

/// A line on which the projections of edges are short, so that few overlap. If two edges overlap in
/// the plane, so do their projections, lengthened by `slack`.
#[derive(Clone, Copy)]
pub struct Line {
    from: Point,
    along: Point,
    /// More than twice the error of two places: three roundings each, of at most the sum of both
    /// magnitudes.
    pub slack: f64,
}

impl Line {
    /// The best of three lines: both axes, and the one across most of the edges' length. On it the
    /// polygon's edges cover the smallest multiple of the whole. `corners` are in turn.
    pub fn across(at: &[Point], corners: &[u32]) -> Line {
        let from = at[corners[0] as usize];
        let size =
            |k: usize| corners.iter().fold(0.0f64, |most, &c| most.max((at[c as usize][k] - from[k]).abs()));
        let size = [size(0), size(1)];
        let line = |along: Point| {
            let slack = 16.0 * f64::EPSILON * (along[0].abs() * size[0] + along[1].abs() * size[1]);
            Line { from, along, slack: slack + f64::MIN_POSITIVE }
        };
        let lines = [line([1.0, 0.0]), line([0.0, 1.0]), line(shortest(at, corners, size[0].max(size[1])))];
        let least = lines
            .map(|line| (line, line.part(at, corners)))
            .into_iter()
            .reduce(|a, b| if b.1 < a.1 { b } else { a });
        least.map_or(lines[0], |(line, _)| line)
    }

    /// The coordinate of a point along the line.
    pub fn place(&self, p: Point) -> f64 {
        self.along[0] * (p[0] - self.from[0]) + self.along[1] * (p[1] - self.from[1])
    }

    /// The sum of the edges' lengths, relative to the whole.
    fn part(&self, at: &[Point], corners: &[u32]) -> f64 {
        let (mut low, mut high, mut sum) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        let mut before = self.place(at[corners[corners.len() - 1] as usize]);
        for &corner in corners {
            let place = self.place(at[corner as usize]);
            sum += (place - before).abs();
            (low, high, before) = (low.min(place), high.max(place), place);
        }
        if high > low { sum / (high - low) } else { f64::INFINITY }
    }
}

/// The direction with the least sum of squares of the edges' lengths: at a right angle to the
/// longer axis of their second moments.
fn shortest(at: &[Point], corners: &[u32], size: f64) -> Point {
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    let mut before = at[corners[corners.len() - 1] as usize];
    for &corner in corners {
        let p = at[corner as usize];
        let [x, y] = [0, 1].map(|k| (p[k] - before[k]) / size.max(f64::MIN_POSITIVE));
        (xx, xy, yy, before) = (xx + x * x, xy + x * y, yy + y * y, p);
    }
    let half = (xx - yy) / 2.0;
    let root = (half * half + xy * xy).sqrt();
    let [x, y] = if half >= 0.0 { [half + root, xy] } else { [xy, root - half] };
    let longest = x.abs().max(y.abs());
    if longest > 0.0 { [-y / longest, x / longest] } else { [1.0, 0.0] }
}

/// The first two edges found that cross in their interiors; ends that touch do not cross.
pub fn crossing(at: &[Point], corners: &[u32]) -> Option<[[u32; 2]; 2]> {
    let line = Line::across(at, corners);
    let next = corners.iter().cycle().skip(1);
    let mut edges: Vec<_> = corners
        .iter()
        .zip(next)
        .map(|(&a, &b)| {
            let (p, q) = (line.place(at[a as usize]), line.place(at[b as usize]));
            (p.min(q), p.max(q), [a, b])
        })
        .collect();
    edges.sort_by(|a, b| a.0.total_cmp(&b.0));
    edges.iter().enumerate().find_map(|(k, &(_, high, e))| {
        let near = edges[k + 1..].iter().take_while(|other| other.0 <= high + line.slack);
        near.map(|other| other.2).find(|&f| cross(at, e, f)).map(|f| [e.min(f), e.max(f)])
    })
}

fn cross(at: &[Point], e: [u32; 2], f: [u32; 2]) -> bool {
    let ([a, b], [c, d]) = (e.map(|i| at[i as usize]), f.map(|i| at[i as usize]));
    let apart = |k: usize| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k]);
    !apart(0) && !apart(1) && turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0
}
