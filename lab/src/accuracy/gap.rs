//! The distance of two features at a time: for false alarms, in floats, from differences.

use crate::case::{Case, Features};

type V = [f64; 3];

fn less(a: V, b: V) -> V {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns the computed distance of the features at `t`. Its error is a few roundings of the
/// features' extent.
pub fn gap(case: &Case, t: f64) -> f64 {
    let origin = case.positions_t0[0];
    let at = |i: usize| -> V {
        let p = less(case.positions_t0[i], origin);
        let d = less(case.positions_t1[i], case.positions_t0[i]);
        [0, 1, 2].map(|k| p[k] + t * d[k])
    };
    let [p, q, r, s] = [at(0), at(1), at(2), at(3)];
    match case.features {
        Features::VertexFace => vertex_face(p, [q, r, s]),
        Features::EdgeEdge => edge_edge([p, q], [r, s]),
    }
}

/// Returns the vector from a point to a segment.
fn to_edge(p: V, [a, b]: [V; 2]) -> f64 {
    let (along, from) = (less(b, a), less(p, a));
    let length = dot(along, along);
    let u = if length > 0.0 { (dot(from, along) / length).clamp(0.0, 1.0) } else { 0.0 };
    let off = less(from, along.map(|x| x * u));
    dot(off, off).sqrt()
}

fn vertex_face(p: V, [a, b, c]: [V; 3]) -> f64 {
    let n = cross(less(b, a), less(c, a));
    let square = dot(n, n);
    let inside = |a: V, b: V| dot(cross(less(b, a), less(p, a)), n) >= 0.0;
    let rim = to_edge(p, [a, b]).min(to_edge(p, [b, c])).min(to_edge(p, [c, a]));
    if square > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
        return rim.min(dot(less(p, a), n).abs() / square.sqrt());
    }
    rim
}

fn edge_edge(one: [V; 2], other: [V; 2]) -> f64 {
    let ends = to_edge(one[0], other)
        .min(to_edge(one[1], other))
        .min(to_edge(other[0], one))
        .min(to_edge(other[1], one));
    let (d, e, from) = (less(one[1], one[0]), less(other[1], other[0]), less(other[0], one[0]));
    let n = cross(d, e);
    let square = dot(n, n);
    let within = |x: f64| (0.0..=square).contains(&x);
    if square > 0.0 && within(dot(cross(from, e), n)) && within(dot(cross(from, d), n)) {
        return ends.min(dot(from, n).abs() / square.sqrt());
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_school() {
        let face = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        assert_eq!(vertex_face([1.0, 1.0, 3.0], face), 3.0);
        assert_eq!(vertex_face([-3.0, 1.0, 4.0], face), 5.0);
        assert_eq!(vertex_face([1.0, 1.0, 0.0], face), 0.0);
        assert_eq!(vertex_face([3.0, 4.0, 0.0], [[0.0; 3]; 3]), 5.0);
        let edge = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
        assert_eq!(edge_edge(edge, [[0.0, -1.0, 2.0], [0.0, 1.0, 2.0]]), 2.0);
        assert_eq!(edge_edge(edge, [[4.0, -1.0, 4.0], [4.0, 1.0, 4.0]]), 5.0);
        assert_eq!(edge_edge(edge, [[-1.0, 7.0, 0.0], [3.0, 7.0, 0.0]]), 7.0);
    }
}
