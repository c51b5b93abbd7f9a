//! Pairs of features that a scene excludes: their tables, and arguments of kernels.

use super::{BodyRecord, NearArgs, Output, Pair, Span};
use crate::math::{Real, Vec3};
use bytemuck::{Pod, Zeroable};

/// A vertex in the rest shape of its body, in one access of 32 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub struct RestPoint {
    /// Its place.
    pub at: Vec3<f64>,
    /// Features of this body that are nearer at rest are excluded, a length; 0 for a body without
    /// a rest shape.
    pub within: f64,
}
const _: () = assert!(size_of::<RestPoint>() == 32);

// SAFETY: four f64, which may be zeros.
unsafe impl Zeroable for RestPoint {}
// SAFETY: four f64 without padding, asserted above.
unsafe impl Pod for RestPoint {}

impl ExclusionTables {
    /// Nothing is excluded.
    pub const NONE: Self =
        ExclusionTables { partners: Span::EMPTY, rest: Span::EMPTY, bodies: Span::EMPTY, faces: Span::EMPTY };
    /// Whether nothing is excluded.
    #[inline(always)]
    pub const fn is_empty(&self) -> bool {
        self.partners.is_empty() && self.rest.is_empty() && self.faces.is_empty()
    }
}

arguments! {
    /// What a scene excludes. A table that excludes nothing is empty.
    ExclusionTables {
        /// Pairs of vertices. Word `v` and the next are the range of words that hold the partners
        /// of vertex `v`, ascending. A partner of another has that one as a partner.
        partners: Span<u32>,
        /// All vertices in rest shapes.
        rest: Span<RestPoint>,
        /// The bodies, by first vertices; empty if there is only one.
        bodies: Span<BodyRecord>,
        /// A bit for each triangle: whether it takes no part.
        faces: Span<u32>,
    }
    /// `narrow_exclude`: pairs of features that are not excluded.
    ExcludeArgs {
        /// What is excluded.
        tables: ExclusionTables,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// End points of every edge.
        edges: Span<[u32; 2]>,
        /// Vertex/face pairs.
        vf: Output<Pair>,
        /// Edge/edge pairs.
        ee: Output<Pair>,
        /// Out: vertex/face pairs that are not excluded.
        kept_vf: Output<Pair>,
        /// Out: edge/edge pairs that are not excluded.
        kept_ee: Output<Pair>,
    }
    /// `narrow_exclude_triangles`: pairs of triangles that are not excluded.
    ExcludeTrianglesArgs {
        /// What is excluded.
        tables: ExclusionTables,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// Triangle pairs.
        pairs: Output<Pair>,
        /// Out: those that are not excluded.
        kept: Output<Pair>,
    }
    /// `narrow_near_excluding`: as `narrow_near`, without pairs that are excluded.
    NearExcludingArgs<R: Real> {
        /// The query.
        near: NearArgs<R>,
        /// What is excluded.
        tables: ExclusionTables,
    }
}
