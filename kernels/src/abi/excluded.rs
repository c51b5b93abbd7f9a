//! Pairs of features that a scene excludes: their tables, and arguments of kernels.

use super::{BodyRecord, NearArgs, Output, Pair, Span};
use crate::math::round::up;
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

/// The key of a vertex among partners. Each number has a key of its own, so keys stand for numbers:
/// shifts that are added, and products with odd numbers, can be undone. The highest 7 bits are the
/// hash (lowbias32 of Wellons, without its last step).
#[inline(always)]
pub const fn partner_key(vertex: u32) -> u32 {
    let x = (vertex ^ vertex >> 16).wrapping_mul(0x7feb_352d);
    (x ^ x >> 15).wrapping_mul(0x846c_a68b)
}

/// A bit for the hash of each partner of a vertex: a vertex whose bit is clear is no partner. One
/// access of 16 bytes decides most pairs.
///
/// With 20 partners, 15 in 100 other vertices have a bit that is set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct PartnerBits([u64; 2]);
const _: () = assert!(size_of::<PartnerBits>() == 16);

impl PartnerBits {
    /// The word of a key's bit, and its place there.
    #[inline(always)]
    const fn bit(self, key: u32) -> (u64, u32) {
        let bit = key >> 25;
        (if bit < 64 { self.0[0] } else { self.0[1] }, bit % 64)
    }
    /// The same with the bit of another partner's key.
    pub const fn with(mut self, key: u32) -> Self {
        let bit = key >> 25;
        self.0[bit as usize / 64] |= 1 << (bit % 64);
        self
    }
    /// Whether the bit of a key is set.
    #[inline(always)]
    pub const fn has(self, key: u32) -> bool {
        let (word, bit) = self.bit(key);
        word >> bit & 1 != 0
    }
    /// How many bits below that of a key are set.
    #[inline(always)]
    pub const fn before(self, key: u32) -> u32 {
        let (word, bit) = self.bit(key);
        let lower = if key >> 25 < 64 { 0 } else { self.0[0].count_ones() };
        lower + (word & ((1 << bit) - 1)).count_ones()
    }
    /// How many bits are set.
    #[inline(always)]
    pub const fn count(self) -> u32 {
        self.0[0].count_ones() + self.0[1].count_ones()
    }
}

/// A box around all features of a vertex in its rest shape, and half of the distance within which
/// features are excluded. One access of 16 bytes: boxes without a common point decide most pairs.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct RestReach {
    /// Its middle.
    at: [f32; 3],
    /// Half of a side.
    reach: f32,
}
const _: () = assert!(size_of::<RestReach>() == 16);

/// By how much a reach is longer than its parts. It exceeds the roundings of its sums, and twice
/// [`DISTANCE_LISTED`](crate::math::tolerance::DISTANCE_LISTED). Ratio.
const LONGER: f64 = 1.0 / (1u32 << 20) as f64;

impl RestReach {
    /// That of a vertex without a rest shape: apart from all.
    pub const NONE: Self = RestReach { at: [0.0; 3], reach: f32::NEG_INFINITY };

    /// The box of a place, without features.
    pub fn around(at: [f64; 3]) -> Self {
        let rounded = at.map(|x| x as f32);
        let is_finite = rounded.iter().all(|x| x.is_finite());
        // Beyond the range of f32 it has all places.
        if is_finite {
            RestReach { at: rounded, reach: 0.0 }
        } else {
            RestReach { at: [0.0; 3], reach: f32::INFINITY }
        }
    }
    /// The half side that has a place, at least.
    pub fn extent(&self, place: [f64; 3]) -> f64 {
        let mut most = self.reach as f64;
        for (axis, x) in place.into_iter().enumerate() {
            most = most.greater((x - self.at[axis] as f64).abs());
        }
        most
    }
    /// The same with features up to an extent, where those within a distance are excluded.
    pub fn reaching(self, extent: f64, within: f64) -> Self {
        RestReach { reach: up((extent + 0.5 * within) * (1.0 + LONGER)), ..self }
    }
    /// Whether the distance at rest excludes no pair of features of these two vertices.
    ///
    /// Rounding is monotone: a computed difference exceeds the computed sum only if the exact one
    /// does. Then the features are farther apart on some axis than `within` and `LONGER` of all
    /// lengths. So no computed distance is less than `within` ([`crate::prim::near`]).
    #[inline(always)]
    pub fn is_apart(&self, other: &Self) -> bool {
        let reach = self.reach + other.reach;
        let [x, y, z] = [0, 1, 2].map(|axis: usize| (self.at[axis] - other.at[axis]).abs() > reach);
        x | y | z
    }
}

impl ExclusionTables {
    /// Nothing is excluded.
    pub const NONE: Self = ExclusionTables {
        partners: Span::EMPTY,
        bits: Span::EMPTY,
        rest: Span::EMPTY,
        reaches: Span::EMPTY,
        bodies: Span::EMPTY,
        faces: Span::EMPTY,
    };
    /// Whether nothing is excluded.
    #[inline(always)]
    pub const fn is_empty(&self) -> bool {
        self.partners.is_empty() && self.rest.is_empty() && self.faces.is_empty()
    }
}

arguments! {
    /// What a scene excludes. A table that excludes nothing is empty.
    ExclusionTables {
        /// Pairs of vertices. Word `v` and the next are the range of words that hold the
        /// [keys](partner_key) of the partners of vertex `v`, ascending. A partner of another has
        /// that one as a partner.
        partners: Span<u32>,
        /// The bits of the partners of each vertex; empty if there are none.
        bits: Span<PartnerBits>,
        /// All vertices in rest shapes.
        rest: Span<RestPoint>,
        /// The reach of each vertex there.
        reaches: Span<RestReach>,
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
