//! Two triangles in one plane, and two without area.

use super::common::{Common, Corners, End, Exactly, between, orient};
use super::{PairKind, Part};
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::tri_tri::{Certain, Signs, point_on_triangle, segments_meet};

/// Returns the common points of two triangles in one plane, or of two without area.
///
/// They are the hull of the corners of each that the other holds, and of the points at which
/// insides of edges cross. All of these are corners of the hull, and no two of different kinds are
/// equal: a corner of a convex set is a corner of its part in another one. So one is a point, two
/// are a segment, and more have an area.
pub fn common(t: [&Corners; 2]) -> Option<Common> {
    let shapes = [0, 1].map(|of| Shape::of(t[of]));
    let mut ends: Vec<End> = Vec::new();
    for of in 0..2 {
        let other = 1 - of;
        for &corner in &shapes[of].corners {
            let x = t[of][corner];
            // The first triangle has named the corners that both have.
            let is_named = of == 1 && shapes[0].corners.iter().any(|&k| t[0][k] == x);
            if is_named || !is_on(x, t[other]) {
                continue;
            }
            let (own, part) = (Part::Corner(corner as u8), part_of(x, t[other]));
            let parts = if of == 0 { [own, part] } else { [part, own] };
            ends.push(End { at: Exactly::Corner { of, corner }, parts });
        }
    }
    for &p in &shapes[0].edges {
        for &q in &shapes[1].edges {
            if let Some(axis) = cross(p.map(|k| t[0][k]), q.map(|k| t[1][k])) {
                let at = Exactly::Crossed { edges: [p, q], axis };
                ends.push(End { at, parts: [Part::edge(p), Part::edge(q)] });
            }
        }
    }
    match *ends {
        [] => None,
        [end] => Some(between(false, end, end, true)),
        [first, last] => Some(between(false, first, last, false)),
        _ => Some(Common { kind: PairKind::Overlap, ends: None }),
    }
}

/// The corners and edges of a triangle, segment or point; equal corners once.
struct Shape {
    corners: Vec<usize>,
    edges: Vec<[usize; 2]>,
}

impl Shape {
    fn of(t: &Corners) -> Shape {
        if has_area(t) {
            return Shape { corners: vec![0, 1, 2], edges: vec![[0, 1], [1, 2], [2, 0]] };
        }
        // Coordinates are monotone along a line: the ends are first and last in this order.
        let before =
            |&a: &usize, &b: &usize| t[a].0.partial_cmp(&t[b].0).unwrap_or(std::cmp::Ordering::Equal);
        let (first, last) = ((0..3).min_by(before).unwrap_or(0), (0..3).max_by(before).unwrap_or(0));
        if t[first] == t[last] {
            return Shape { corners: vec![first], edges: Vec::new() };
        }
        Shape { corners: vec![first, last], edges: vec![[first, last]] }
    }
}

fn turn(a: Vec3<f64>, b: Vec3<f64>, c: Vec3<f64>, axis: usize) -> i32 {
    // `Certain` always knows.
    <Certain as Signs<f64>>::orient2d(a, b, c, axis).unwrap_or(0)
}

fn has_area(t: &Corners) -> bool {
    (0..3).any(|axis| turn(t[0], t[1], t[2], axis) != 0)
}

fn is_on(x: Vec3<f64>, t: &Corners) -> bool {
    point_on_triangle::<f64, Certain>(x, t) == Some(true)
}

/// The part of a triangle that holds a point of it.
fn part_of(x: Vec3<f64>, t: &Corners) -> Part {
    if let Some(corner) = t.iter().position(|corner| *corner == x) {
        return Part::Corner(corner as u8);
    }
    let holds = |k: &usize| segments_meet::<f64, Certain>([x, x], [t[*k], t[(k + 1) % 3]]) == Some(true);
    (0..3).find(holds).map_or(Part::Inside, |edge| Part::Edge(edge as u8))
}

/// An axis along which the insides of two segments are seen to cross; `None` if they do not.
fn cross([a, b]: [Vec3<f64>; 2], [c, d]: [Vec3<f64>; 2]) -> Option<usize> {
    if orient(a, b, c, d) != 0 {
        return None;
    }
    (0..3).find(|&axis| {
        turn(a, b, c, axis) * turn(a, b, d, axis) < 0 && turn(c, d, a, axis) * turn(c, d, b, axis) < 0
    })
}
