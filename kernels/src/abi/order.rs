//! Contacts into canonical order: their names, their rows, and the argument blocks.

use super::rows::{ContactRow, NearRow, PairRow, code};
use super::{Counters, Element, Hit, NearHit, Output, Pair, Span};
use crate::math::Real;
use crate::prim::near::corner_weights;
use bytemuck::{Pod, Zeroable};

/// Which starts of a body count a feature: vertices, triangles or edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Feature(u32);

impl Feature {
    /// Vertices.
    pub const VERTEX: Feature = Feature(0);
    /// Triangles.
    pub const TRIANGLE: Feature = Feature(1);
    /// Edges.
    pub const EDGE: Feature = Feature(2);
    /// How many there are.
    pub const COUNT: u32 = 3;

    /// Its place among the starts of a body.
    #[inline(always)]
    pub const fn place(self) -> u32 {
        self.0
    }
}

/// The name of a contact in its row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Name {
    /// A number of rows of features; 0 for triangle pairs.
    pub kind: u8,
    /// The lists that number its features.
    pub of: [Feature; 2],
    /// Both features, numbered through all bodies.
    pub features: [u32; 2],
}

impl Name {
    /// The name of two triangles.
    #[inline(always)]
    pub fn of_triangles(features: [u32; 2]) -> Name {
        Name { kind: 0, of: [Feature::TRIANGLE; 2], features }
    }

    /// The name of two edges.
    #[inline(always)]
    pub fn of_edges(features: [u32; 2]) -> Name {
        Name { kind: code::EDGE_EDGE, of: [Feature::EDGE; 2], features }
    }

    /// The name of a vertex and a triangle that stands for this element.
    #[inline(always)]
    pub fn of_element(vertex: u32, Element { kind, number }: Element) -> Name {
        let kind = kind as u8;
        let (of, features) = match kind {
            code::EDGE_VERTEX => ([Feature::EDGE, Feature::VERTEX], [number, vertex]),
            code::VERTEX_VERTEX => ([Feature::VERTEX; 2], [vertex.min(number), vertex.max(number)]),
            _ => ([Feature::VERTEX, Feature::TRIANGLE], [vertex, number]),
        };
        Name { kind, of, features }
    }
}

/// The place of a contact: its bodies, and the indices of its features in these.
#[derive(Clone, Copy, Debug)]
pub struct Located {
    /// Both bodies.
    pub bodies: [u32; 2],
    /// Both indices.
    pub features: [u32; 2],
    /// Its kind; a number of rows of features. 0 for triangle pairs.
    pub kind: u8,
    /// Status of a contact that is no undecided one.
    pub decided: u32,
}

/// The nearest points of a row of a kind, from those of a vertex and a triangle or of two edges: the
/// triangle of an edge has its second end twice.
#[inline(always)]
pub fn nearest_of(kind: u8, at: [f64; 2]) -> [f64; 2] {
    match kind {
        code::EDGE_VERTEX => [(at[0] + at[1]).lesser(1.0), 0.0],
        code::VERTEX_VERTEX => [0.0; 2],
        _ => at,
    }
}

/// The weights of the four vertices of a row of a kind in its nearest points.
#[inline(always)]
pub fn weights_of(kind: u8, at: [f64; 2]) -> [f64; 4] {
    match kind {
        code::VERTEX_FACE => {
            let [x, y, z] = corner_weights(at);
            [1.0, x, y, z]
        }
        code::EDGE_EDGE => [1.0 - at[0], at[0], 1.0 - at[1], at[1]],
        code::EDGE_VERTEX => [1.0 - at[0], at[0], 1.0, 0.0],
        _ => [1.0, 1.0, 0.0, 0.0],
    }
}

/// A contact that can be put into order.
pub trait Named: Pod {
    /// Its row in the answer.
    type Row: Pod;
    /// Whether lists are of vertices and faces, and of edges. If not, there is one list, of triangle
    /// pairs.
    const OF_FEATURES: bool;
    /// The two features, numbered through all bodies.
    fn name(&self) -> [u32; 2];
    /// Its row.
    fn row(&self, at: &Located) -> Self::Row;
}

impl Named for Pair {
    type Row = PairRow;
    const OF_FEATURES: bool = false;
    #[inline(always)]
    fn name(&self) -> [u32; 2] {
        [self.a, self.b]
    }
    #[inline(always)]
    fn row(&self, at: &Located) -> PairRow {
        PairRow { bodies: at.bodies, triangles: at.features }
    }
}

impl Named for Hit {
    type Row = ContactRow;
    const OF_FEATURES: bool = true;
    #[inline(always)]
    fn name(&self) -> [u32; 2] {
        [self.a, self.b]
    }
    #[inline(always)]
    fn row(&self, at: &Located) -> ContactRow {
        ContactRow {
            bodies: at.bodies,
            features: at.features,
            toi: self.verdict.toi,
            toi_upper: self.verdict.toi_upper,
            kind: at.kind,
            status: match (self.verdict.is_contact(), at.decided) {
                (false, _) => code::UNDECIDED,
                (true, 0) => code::UNVERIFIED,
                (true, _) => code::CERTIFIED,
            },
            pad: [0; 6],
        }
    }
}

impl Named for NearHit {
    type Row = NearRow;
    const OF_FEATURES: bool = true;
    #[inline(always)]
    fn name(&self) -> [u32; 2] {
        [self.a, self.b]
    }
    #[inline(always)]
    fn row(&self, at: &Located) -> NearRow {
        let nearest = nearest_of(at.kind, self.at);
        // Corners or ends with a weight. The vertex of a face, and a point, have one.
        let mut parts = 0;
        for weight in weights_of(at.kind, nearest) {
            parts += (weight > 0.0) as u32;
        }
        let closest = match (at.kind, parts) {
            (code::EDGE_EDGE, 4) => code::NEAR_EDGES,
            (code::VERTEX_FACE, 4) => code::NEAR_FACE,
            (_, 3) => code::NEAR_EDGE,
            _ => code::NEAR_VERTEX,
        };
        NearRow {
            bodies: at.bodies,
            features: at.features,
            squared_distance: self.squared,
            at: nearest,
            kind: at.kind,
            closest,
            pad: [0; 6],
        }
    }
}

impl Bins {
    /// How many contacts are in the bins before each one: `order_starts` writes them over the counts.
    #[inline(always)]
    pub const fn starts(&self) -> Span<u32> {
        self.counts.halves()
    }
}

arguments! {
    /// `order_sums`, `order_starts`: contacts by their first feature, a bin a feature. Also part of
    /// [`OrderArgs`].
    Bins {
        /// How many contacts each bin has; two bins a word, the lower half first. One more than
        /// there are features, at least. Out of `order_starts`: [`Bins::starts`].
        counts: Span<u64>,
        /// Out: how many contacts each tile of bins has.
        sums: Span<u32>,
        /// Counters: the most contacts of a bin.
        counters: Counters,
        /// How many words a tile has.
        words: u32,
        /// Nothing.
        pad: u32,
    }
    /// `order_count`, `order_place`, `order_merge`, `order_rank`: contacts into canonical order.
    OrderArgs<T: Named> {
        /// Contacts: triangle pairs, or vertices and faces.
        first: Output<T>,
        /// Contacts of edges; or none.
        second: Output<T>,
        /// Out: the rows of all, in order.
        rows: Output<T::Row>,
        /// Out: all contacts in the same order; or none.
        contacts: Output<T>,
        /// Contacts of each first feature.
        bins: Bins,
        /// The place of each contact in its bin.
        slots: Span<u32>,
        /// A key of each contact, in the order of bins: its second feature above its number.
        keys: Span<u64>,
        /// Out of `order_merge`: keys in longer runs.
        merged: Span<u64>,
        /// First vertex, triangle and edge of each body, and the totals; not read for one body.
        bodies: Span<u32>,
        /// The meaning of each triangle; empty if all are faces.
        elements: Span<Element>,
        /// Number of vertices, or of triangles: the bin of the first edge.
        vertices: u32,
        /// Number of edges.
        edges: u32,
        /// Keys of a bin that are in order already, from the first of the bin on: log2 of their
        /// number.
        run: u32,
        /// How many such runs become one: log2 of their number.
        ways: u32,
        /// Status of a contact that is no undecided one.
        decided: u32,
        /// Zero.
        pad: u32,
    }
}
