//! Rows of an answer in their final form, as the caller reads them: with bodies, and indices in
//! these.

use bytemuck::{Pod, Zeroable};

/// Numbers of a row's choices.
pub mod code {
    /// A vertex and a face.
    pub const VERTEX_FACE: u8 = 0;
    /// Two edges.
    pub const EDGE_EDGE: u8 = 1;
    /// An edge of no face, and a vertex.
    pub const EDGE_VERTEX: u8 = 2;
    /// Two vertices, one of them a point.
    pub const VERTEX_VERTEX: u8 = 3;
    /// A contact of a solver that can be wrong.
    pub const UNVERIFIED: u8 = 0;
    /// A proven contact.
    pub const CERTIFIED: u8 = 1;
    /// Neither contact nor separation is proven.
    pub const UNDECIDED: u8 = 2;
    /// Nearest: a vertex and the interior of a face.
    pub const NEAR_FACE: u8 = 0;
    /// Nearest: a vertex and the interior of an edge.
    pub const NEAR_EDGE: u8 = 1;
    /// Nearest: two vertices.
    pub const NEAR_VERTEX: u8 = 2;
    /// Nearest: the interiors of two edges.
    pub const NEAR_EDGES: u8 = 3;
}

/// Two triangles that share a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct PairRow {
    /// Bodies of the triangles.
    pub bodies: [u32; 2],
    /// Indices in their bodies.
    pub triangles: [u32; 2],
}
const _: () = assert!(size_of::<PairRow>() == 16);

/// Two features that meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct ContactRow {
    /// Bodies of the features.
    pub bodies: [u32; 2],
    /// Indices in their bodies.
    pub features: [u32; 2],
    /// No contact before.
    pub toi: f64,
    /// The first contact is not after.
    pub toi_upper: f64,
    /// [`code::VERTEX_FACE`] to [`code::VERTEX_VERTEX`].
    pub kind: u8,
    /// [`code::UNVERIFIED`], [`code::CERTIFIED`] or [`code::UNDECIDED`].
    pub status: u8,
    /// Zeros.
    pub pad: [u8; 6],
}
const _: () = assert!(size_of::<ContactRow>() == 40);

/// Two features within a distance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct NearRow {
    /// Bodies of the features.
    pub bodies: [u32; 2],
    /// Indices in their bodies.
    pub features: [u32; 2],
    /// Their squared distance.
    pub squared_distance: f64,
    /// The nearest points, see [`crate::prim::near::Near::at`].
    pub at: [f64; 2],
    /// [`code::VERTEX_FACE`] to [`code::VERTEX_VERTEX`].
    pub kind: u8,
    /// The nearest parts: [`code::NEAR_FACE`] to [`code::NEAR_EDGES`].
    pub closest: u8,
    /// Zeros.
    pub pad: [u8; 6],
}
const _: () = assert!(size_of::<NearRow>() == 48);
