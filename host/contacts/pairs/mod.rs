//! Geometry of triangle pairs: how they meet, and the segment in which they do.

mod common;
mod flat;
mod place;
mod two;
mod whole;

pub use place::END_ERROR;

use super::TrianglePair;
use crate::scene::{Body, BodyId};
use common::Corners;
use nearmiss_kernels::math::Vec3;

/// How two triangles meet. Its number (`as u8`) is used in files and in other languages.
///
/// The *inside* of a triangle is the triangle without its edges, that of a segment is the segment
/// without its ends. Triangles without area are the segments or points that they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
#[repr(u8)]
pub enum PairKind {
    /// They cross: their insides share a point, and no plane holds both. Triangles with area have a
    /// segment in common. They still cross if all corners move a little.
    Crossing = 0,
    /// They touch in one point.
    Point = 1,
    /// They touch in a segment: an edge is on a face or along an edge.
    Segment = 2,
    /// They overlap in one plane, in an area.
    Overlap = 3,
}

/// Part of a triangle that holds a point. Its number ([`Part::number`]) is used in files and in
/// other languages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
pub enum Part {
    /// Its inside.
    Inside,
    /// The edge from this corner to the next, without its ends.
    Edge(u8),
    /// This corner.
    Corner(u8),
}

impl Part {
    /// Number of the part: 0 for the inside, 1 to 3 for edges, 4 to 6 for corners.
    pub const fn number(self) -> u8 {
        match self {
            Part::Inside => 0,
            Part::Edge(edge) => 1 + edge,
            Part::Corner(corner) => 4 + corner,
        }
    }

    /// The edge between two corners.
    fn edge([from, to]: [usize; 2]) -> Part {
        Part::Edge(if (from + 1) % 3 == to { from } else { to } as u8)
    }
}

/// Geometry of two triangles that share a point: see
/// [`Detector::geometry`](crate::Detector::geometry).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PairGeometry {
    /// How they meet, by exact signs.
    pub kind: PairKind,
    /// Bodies of the triangles, as in the row.
    pub bodies: [BodyId; 2],
    /// Indices of the triangles in their bodies, as in the row.
    pub triangles: [u32; 2],
    /// Ends of the common segment, in scene units: the exact points, each coordinate rounded to the
    /// nearest double. They are equal for a point, and `None` for an overlap.
    ///
    /// The segment of two planes is directed along the product of both normals, the first times the
    /// second.
    pub ends: Option<[[f64; 3]; 2]>,
    /// Upper bound of the error of each coordinate of the ends, in scene units. It is 0 if both
    /// ends are corners, else [`END_ERROR`] times the largest coordinate.
    pub error: f64,
    /// For each end, the part of each triangle that holds it. `None` for an overlap.
    pub parts: Option<[[Part; 2]; 2]>,
}

impl PairGeometry {
    /// Returns the geometry of two triangles by their corners, as triangles 0 of bodies 0 and 1.
    /// `None` if they share no point.
    ///
    /// ```
    /// use nearmiss::contacts::{PairGeometry, PairKind};
    ///
    /// let floor = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    /// let wall = [[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 1.0, 3.0]];
    /// let standing = PairGeometry::of_triangles([floor, wall]).expect("they touch");
    /// assert_eq!(standing.kind, PairKind::Segment);
    /// assert!(standing.ends.is_some_and(|ends| ends.contains(&[2.0, 1.0, 0.0])));
    /// ```
    ///
    /// Coordinates must be finite.
    pub fn of_triangles(triangles: [[[f64; 3]; 3]; 2]) -> Option<PairGeometry> {
        let [p, q] = triangles.map(|corners| corners.map(Vec3));
        let pair = TrianglePair { bodies: [BodyId(0), BodyId(1)], triangles: [0, 0] };
        PairGeometry::of(&pair, [&p, &q])
    }

    /// Computes the geometry of two triangles; `None` if they share no point.
    fn of(pair: &TrianglePair, corners: [&Corners; 2]) -> Option<PairGeometry> {
        let common = common::common(corners)?;
        let placed = common.ends.map(|ends| place::placed(&ends, corners));
        Some(PairGeometry {
            kind: common.kind,
            bodies: pair.bodies,
            triangles: pair.triangles,
            ends: placed.map(|(points, _)| points),
            error: placed.map_or(0.0, |(_, error)| error),
            parts: common.ends.map(|ends| ends.map(|end| end.parts)),
        })
    }

    /// Computes the geometry of two triangles of these bodies at the start of the step. `None` if
    /// they do not exist or share no point.
    pub(crate) fn of_bodies(pair: &TrianglePair, bodies: &[Body]) -> Option<PairGeometry> {
        let corners =
            |side: usize| bodies.get(pair.bodies[side].index())?.corners(pair.triangles[side] as usize);
        PairGeometry::of(pair, [&corners(0)?, &corners(1)?])
    }
}
