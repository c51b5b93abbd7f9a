//! The fifteen elementary tests of two triangles, and the owners of vertices and edges.
//!
//! Edge `k` of a triangle runs from corner `k` to corner `(k + 1) % 3`. Vertices and edges belong
//! to several triangles, and one of these owns each. So each elementary pair is tested once: by the
//! triangles that own its parts.

/// How many elementary tests two triangles have: six of a vertex and a face, nine of two edges.
pub const TESTS: usize = 15;

/// The corners of edge `k`.
pub const EDGE: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// The vertex/face tests: (0 if the vertex is of the first triangle and the face is the second,
/// else 1; corner).
pub const VERTEX_FACE: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2)];

/// The edge/edge tests: (edge of the first triangle, edge of the second).
pub const EDGE_EDGE: [(usize, usize); 9] =
    [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2)];

/// The bit of an ownership mask for the vertex at corner `k` (bits 0 to 2).
#[inline]
pub const fn vertex_bit(k: usize) -> u32 {
    1 << k
}

/// The bit of an ownership mask for edge `k` (bits 3 to 5).
#[inline]
pub const fn edge_bit(k: usize) -> u32 {
    1 << (k + 3)
}
