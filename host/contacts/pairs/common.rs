//! The common points of two triangles, by exact signs: their kind, and the ends of a segment.

use super::{PairKind, Part};
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::crossing::{Chord, order};
use nearmiss_kernels::prim::tri_tri::{Certain, Signs};

/// Corners of a triangle.
pub type Corners = [Vec3<f64>; 3];

/// An end of the common segment, as an exact point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    pub at: Exactly,
    /// Part of each triangle that holds it.
    pub parts: [Part; 2],
}

/// A point that two triangles determine. Triangles and corners are numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exactly {
    /// A corner of a triangle.
    Corner { of: usize, corner: usize },
    /// The point of an edge of a triangle on the plane of the other. The ends of the edge are
    /// strictly on both sides.
    Pierced { of: usize, edge: [usize; 2] },
    /// The common point of the insides of two edges in one plane. Both are seen along `axis`.
    Crossed { edges: [[usize; 2]; 2], axis: usize },
}

impl Exactly {
    /// The same point by a corner, if one of both is one.
    fn or(self, equal: Exactly) -> Exactly {
        if let Exactly::Corner { .. } = self { self } else { equal }
    }
}

/// The common points of two triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Common {
    pub kind: PairKind,
    /// Equal for a point, `None` for an area.
    pub ends: Option<[End; 2]>,
}

/// Returns the common points of two closed triangles; `None` if there are none.
pub fn common(t: [&Corners; 2]) -> Option<Common> {
    let sides = [sides(t[1], t[0]), sides(t[0], t[1])];
    let is_apart = |side: &[i32; 3]| *side == [1; 3] || *side == [-1; 3];
    if sides.iter().any(is_apart) {
        return None;
    }
    match [0, 1].map(|of| Chord::of(sides[of]).map(|chord| Cut { of, side: sides[of], chord })) {
        [Some(p), Some(q)] => chords(t, [p, q]),
        [Some(cut), None] | [None, Some(cut)] => stab(t, &cut),
        [None, None] => super::flat::common(t),
    }
}

/// Returns the common points with these ends.
pub fn between(is_crossing: bool, first: End, last: End, are_equal: bool) -> Common {
    let kind = match (is_crossing, are_equal) {
        (true, _) => PairKind::Crossing,
        (false, true) => PairKind::Point,
        (false, false) => PairKind::Segment,
    };
    Common { kind, ends: Some([first, last]) }
}

/// Sides of the corners of `x` about the plane of `t`.
fn sides(t: &Corners, x: &Corners) -> [i32; 3] {
    x.map(|x| orient(t[0], t[1], t[2], x))
}

/// The exact sign of det[a-d, b-d, c-d].
pub fn orient(a: Vec3<f64>, b: Vec3<f64>, c: Vec3<f64>, d: Vec3<f64>) -> i32 {
    // `Certain` always knows.
    <Certain as Signs<f64>>::orient3d(a, b, c, d).unwrap_or(0)
}

/// A triangle and the plane of the other, which does not hold it.
struct Cut {
    /// Number of the triangle.
    of: usize,
    side: [i32; 3],
    chord: Chord,
}

impl Cut {
    /// An end of its chord: the point, and the part of the triangle that holds it.
    fn end(&self, i: usize) -> (Exactly, Part) {
        let far = self.chord.far[i];
        if self.side[far] == 0 {
            (Exactly::Corner { of: self.of, corner: far }, Part::Corner(far as u8))
        } else {
            let edge = [self.chord.lone, far];
            (Exactly::Pierced { of: self.of, edge }, Part::edge(edge))
        }
    }

    /// The part of the triangle that holds the chord without its ends.
    fn inside(&self) -> Part {
        let [x, y] = self.chord.far;
        match self.side[x] == 0 && self.side[y] == 0 && x != y {
            true => Part::edge([x, y]),
            false => Part::Inside,
        }
    }

    /// Whether end 1 is after end 0 along the product of the normals of this triangle and the
    /// other.
    ///
    /// The ends follow the lone corner in the order of the corners. If that corner is above the
    /// other plane (`side` 1, against its normal), the way from one to the other has the direction
    /// of the product.
    fn is_ascending(&self) -> bool {
        self.side[self.chord.lone] > 0
    }
}

/// Both have area, in two planes: the chords are on one line.
fn chords(t: [&Corners; 2], cuts: [Cut; 2]) -> Option<Common> {
    let [p, q] = &cuts;
    // i after j along the product of the normals of the first and the second.
    let along = p.side[p.chord.lone] * q.side[q.chord.lone];
    let signs = [0, 1].map(|i| {
        [0, 1].map(|j| along * order::<f64, Certain>((t[0], p.chord), (t[1], q.chord), i, j).unwrap_or(0))
    });
    // The same product, as the second sees it, has the other direction.
    let (p_last, q_last) = (usize::from(p.is_ascending()), usize::from(!q.is_ascending()));
    let (p_first, q_first) = (1 - p_last, 1 - q_last);
    if signs[p_first][q_last] > 0 || signs[p_last][q_first] < 0 {
        return None;
    }
    let of_p = |i: usize| {
        let equal = (0..2).find(|&j| signs[i][j] == 0).map(|j| q.end(j));
        let (at, own) = p.end(i);
        End {
            at: equal.map_or(at, |(other, _)| at.or(other)),
            parts: [own, equal.map_or(q.inside(), |q| q.1)],
        }
    };
    let of_q = |j: usize| {
        let equal = (0..2).find(|&i| signs[i][j] == 0).map(|i| p.end(i));
        let (at, own) = q.end(j);
        End {
            at: equal.map_or(at, |(other, _)| at.or(other)),
            parts: [equal.map_or(p.inside(), |p| p.1), own],
        }
    };
    // The later of both first ends, the earlier of both last ends.
    let first = if signs[p_first][q_first] >= 0 { of_p(p_first) } else { of_q(q_first) };
    let last = if signs[p_last][q_last] <= 0 { of_p(p_last) } else { of_q(q_last) };
    let is_point = |cut: &Cut| cut.chord.far[0] == cut.chord.far[1];
    let are_equal = is_point(p) || is_point(q) || signs[p_first][q_last] == 0 || signs[p_last][q_first] == 0;
    let is_crossing = !are_equal && p.chord.is_through && q.chord.is_through;
    let last = if are_equal { first } else { last };
    Some(between(is_crossing, first, last, are_equal))
}

/// One is a segment or a point outside of the plane of the other, which has area.
fn stab(t: [&Corners; 2], cut: &Cut) -> Option<Common> {
    let Cut { of, side, chord } = cut;
    let (segment, other) = (t[*of], t[1 - of]);
    // A corner on the plane is the point, if there is one.
    let i = usize::from(side[chord.far[0]] != 0);
    let (at, own) = cut.end(i);
    let (from, to) = (segment[chord.lone], segment[chord.far[i]]);
    let passes = [0, 1, 2].map(|k| orient(from, to, other[k], other[(k + 1) % 3]));
    if passes.contains(&1) && passes.contains(&-1) {
        return None;
    }
    let part = match passes.map(|sign| sign == 0) {
        [false, false, false] => Part::Inside,
        [true, false, false] => Part::Edge(0),
        [false, true, false] => Part::Edge(1),
        [false, false, true] => Part::Edge(2),
        [true, true, _] => Part::Corner(1),
        [_, true, true] => Part::Corner(2),
        [true, _, true] => Part::Corner(0),
    };
    let at = match part {
        Part::Corner(k) => at.or(Exactly::Corner { of: 1 - of, corner: k.into() }),
        Part::Inside | Part::Edge(_) => at,
    };
    let parts = if *of == 0 { [own, part] } else { [part, own] };
    let end = End { at, parts };
    Some(between(chord.is_through && part == Part::Inside, end, end, true))
}
