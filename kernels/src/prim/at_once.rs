//! Whether two triangles meet, by all fifteen signs at once, without branches: for lanes that step
//! together, and for vectors. Some 600 operations.

use super::orient::Plane;
use crate::math::{Real, Vec3};

/// Three signs, a bit each: those that are certainly above 0, and certainly below.
#[derive(Clone, Copy)]
struct Signs {
    above: u32,
    below: u32,
}

/// All three bits.
const ALL: u32 = 7;

impl Signs {
    /// Those of three determinants, of which each has a value and an error bound.
    #[inline(always)]
    fn of<R: Real>([x, y, z]: [(R, R); 3]) -> Self {
        let above = |(value, bound): (R, R)| (value > bound) as u32;
        let below = |(value, bound): (R, R)| (value < -bound) as u32;
        Signs {
            above: above(x) | above(y) << 1 | above(z) << 2,
            below: below(x) | below(y) << 1 | below(z) << 2,
        }
    }
    /// The three corners of a triangle about a plane.
    #[inline(always)]
    fn of_corners<R: Real>([a, b, c]: [Vec3<R>; 3], [x, y, z]: [Vec3<R>; 3]) -> Self {
        let plane = Plane::through(a, b, c);
        Signs::of([plane.measured(x), plane.measured(y), plane.measured(z)])
    }
    /// An edge about the three of a triangle.
    #[inline(always)]
    fn of_edge<R: Real>(a: Vec3<R>, b: Vec3<R>, [x, y, z]: [Vec3<R>; 3]) -> Self {
        let about = |from, to| Plane::through(a, b, from).measured(to);
        Signs::of([about(x, y), about(y, z), about(z, x)])
    }
    /// Bit i: corners i and i + 1 are certainly on one side.
    #[inline(always)]
    fn same(self) -> u32 {
        (self.above & turned(self.above)) | (self.below & turned(self.below))
    }
    /// Bit i: corners i and i + 1 are certainly on different sides.
    #[inline(always)]
    fn across(self) -> u32 {
        (self.above & turned(self.below)) | (self.below & turned(self.above))
    }
    /// Whether all three are certain and alike.
    #[inline(always)]
    fn are_alike(self) -> u32 {
        ((self.above == ALL) | (self.below == ALL)) as u32
    }
    /// Whether two certainly differ.
    #[inline(always)]
    fn differ(self) -> u32 {
        ((self.above != 0) & (self.below != 0)) as u32
    }
}

/// Bit i is bit i + 1, the last one the first.
#[inline(always)]
fn turned(bits: u32) -> u32 {
    (bits >> 1 | bits << 2) & ALL
}

/// Whether the closed triangles share a point; `None` if a sign that matters is 0 or uncertain.
///
/// An edge that crosses the other's plane and passes the other's three edges on one side pierces
/// it. An edge whose ends are on one side of that plane, or that passes two of those edges on
/// different sides, does not meet it. Triangles of which no edge meets the other are apart. An edge
/// about another is the other about it: two exchanges of corners.
#[inline(always)]
pub fn meets_at_once<R: Real>(p: [Vec3<R>; 3], q: [Vec3<R>; 3]) -> Option<bool> {
    let (of_p, of_q) = (Signs::of_corners(q, p), Signs::of_corners(p, q));
    let edges = [Signs::of_edge(p[0], p[1], q), Signs::of_edge(p[1], p[2], q), Signs::of_edge(p[2], p[0], q)];
    // A bit an edge of p: what is said of it by the three of q.
    let [a, b, c] = edges;
    let pierces_q = a.are_alike() | b.are_alike() << 1 | c.are_alike() << 2;
    let passes_q = a.differ() | b.differ() << 1 | c.differ() << 2;
    // A bit an edge of q.
    let pierces_p = (a.above & b.above & c.above) | (a.below & b.below & c.below);
    let passes_p = (a.above | b.above | c.above) & (a.below | b.below | c.below);
    let meet = (of_p.across() & pierces_q) | (of_q.across() & pierces_p) != 0;
    let apart = (of_p.same() | passes_q) & (of_q.same() | passes_p) == ALL;
    if meet {
        Some(true)
    } else if apart {
        Some(false)
    } else {
        None
    }
}
