//! Parts of an answer that the device makes on request: geometry of rows, rows by feature, least
//! numbers of vertices.

use super::{Element, Named, Output, Positions, Span, Tiles};
use crate::math::Real;
use bytemuck::{Pod, Zeroable};

/// Geometry of a row. Unused rows are zeros.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct RowGeometry {
    /// Distance of the nearest points.
    pub distance: f64,
    /// Unit vector from the second feature towards the first; zeros if no direction is defined.
    pub normal: [f64; 3],
    /// Weight of each vertex in the nearest point of its feature, negative for the second feature.
    pub signed_weights: [f64; 4],
    /// Nearest points of both features at the time of contact.
    pub points: [[f64; 3]; 2],
    /// The vertices, numbered through all bodies: a vertex and the face's corners, or the ends of two
    /// edges. With fewer, the last one is repeated.
    pub vertices: [u32; 4],
}
const _: () = assert!(size_of::<RowGeometry>() == 128);

/// Numbers of the choices of features by which rows are grouped.
pub mod by {
    /// The vertex of a vertex/face or edge/vertex row, both of two points.
    pub const VERTEX: u32 = 0;
    /// Both edges of an edge/edge row, the edge of an edge/vertex row.
    pub const EDGE: u32 = 1;
    /// The face of a vertex/face row, or both triangles of a row of two.
    pub const FACE: u32 = 2;
    /// All vertices of both features.
    pub const CORNER: u32 = 3;
}

arguments! {
    /// The rows of an answer, as they are on the device. Part of the other blocks.
    AnswerRows<T: Named> {
        /// Contacts: triangle pairs, or vertices and faces.
        first: Output<T>,
        /// Contacts of edges; or none.
        second: Output<T>,
        /// All contacts in order; empty if they are in no order.
        ordered: Span<T>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// End points of every edge.
        edges: Span<[u32; 2]>,
        /// The meaning of each triangle; empty if all are faces.
        elements: Span<Element>,
    }
    /// `answer_geometry`: weights, points and normal of each row.
    AnswerGeometryArgs<R: Real, T: Named> {
        /// The rows.
        rows: AnswerRows<T>,
        /// Positions.
        frames: Positions<R>,
        /// Out: the geometry of each row.
        geometry: Span<RowGeometry>,
    }
    /// `answer_infinite`: numbers before the least are found.
    AnswerInfiniteArgs {
        /// Out: the bits of infinity, for each vertex.
        least: Span<u64>,
    }
    /// `answer_least`: the least time or distance of each vertex.
    AnswerLeastArgs<T: Named> {
        /// The rows.
        rows: AnswerRows<T>,
        /// Out: the bits of a number of each vertex.
        least: Span<u64>,
    }
    /// `answer_keys`: a key of each feature of each row.
    AnswerKeysArgs<T: Named> {
        /// The rows.
        rows: AnswerRows<T>,
        /// Out: keys, so many a row: the feature above the row's number. Places that are not used
        /// have the feature behind the last.
        keys: Span<u64>,
        /// Out: counts of the lowest bytes of features. Zeroed before.
        tiles: Tiles,
        /// A number of [`by`].
        by: u32,
        /// Keys of a row.
        width: u32,
        /// How many features there are.
        features: u32,
        /// Zero.
        pad: u32,
    }
    /// `answer_groups`: sorted keys to rows by feature.
    AnswerGroupsArgs {
        /// Keys, ascending by feature, then by row.
        keys: Span<u64>,
        /// Out: the first row of each feature, and the end of the last.
        starts: Span<u32>,
        /// Out: the rows.
        rows: Span<u32>,
    }
}
