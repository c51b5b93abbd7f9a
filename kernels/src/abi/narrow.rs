//! Argument blocks of the last stage: from triangle pairs to contacts.

use super::{Frames, Hit, Pair, Point, Span};
use crate::math::Real;
use crate::prim::inclusion::Params;
use bytemuck::{Pod, Zeroable};

arguments! {
    /// `narrow_sift`: triangle pairs to vertex/face and edge/edge candidates.
    SiftArgs<R: Real> {
        /// Positions.
        frames: Frames<R>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// Edges of every triangle; edge k joins corners k and k + 1.
        face_edges: Span<[u32; 3]>,
        /// Which vertices (bits 0 to 2) and edges (bits 3 to 5) each triangle stands for.
        owners: Span<u32>,
        /// Candidate triangle pairs.
        pairs: Span<Pair>,
        /// Out: vertex, face.
        vf: Span<Pair>,
        /// Out: edge, edge.
        ee: Span<Pair>,
        /// Counters, see [`counter`](super::counter).
        counters: Span<u64>,
        /// Features this near are in contact, a length; 0 for touching.
        separation: f64,
    }
    /// `narrow_moller`, `narrow_filter`, `narrow_wide`, `narrow_exact`: triangle pairs that meet.
    DiscreteArgs<R: Real> {
        /// Positions.
        positions: Span<Point<R>>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// Pairs to test.
        pairs: Span<Pair>,
        /// Out: pairs that meet.
        contacts: Span<Pair>,
        /// Out: pairs that a filter leaves to what comes next; empty for the last one.
        undecided: Span<Pair>,
        /// Counters, see [`counter`](super::counter).
        counters: Span<u64>,
        /// Which counter tells how many pairs there are.
        pairs_at: u32,
        /// Which counter the undecided pairs add to.
        undecided_at: u32,
        /// Bits: [`KEEP_ADJACENT`](super::KEEP_ADJACENT).
        flags: u32,
        /// Zero.
        pad: u32,
    }
    /// `narrow_reject_vf`, `narrow_reject_ee`, and with a separation `narrow_reject_near_vf` and `_ee`: candidates that
    /// certainly stay apart, left out.
    RejectArgs<R: Real> {
        /// Positions.
        frames: Frames<R>,
        /// Vertex indices of every triangle (`narrow_reject_vf`).
        faces: Span<[u32; 3]>,
        /// End points of every edge (`narrow_reject_ee`).
        edges: Span<[u32; 2]>,
        /// Candidates.
        candidates: Span<Pair>,
        /// Out: those that may meet.
        survivors: Span<Pair>,
        /// Counters, see [`counter`](super::counter).
        counters: Span<u64>,
        /// Features this near are in contact, a length; only of the two kernels that heed it.
        separation: f64,
    }
    /// `narrow_vf`, `narrow_ee`, `narrow_additive_vf`, `narrow_additive_ee`: the first time of contact of two primitives in
    /// motion.
    SolveArgs<R: Real> {
        /// Positions.
        frames: Frames<R>,
        /// Vertex indices of every triangle (`narrow_vf`).
        faces: Span<[u32; 3]>,
        /// End points of every edge (`narrow_ee`).
        edges: Span<[u32; 2]>,
        /// Candidates that may meet.
        survivors: Span<Pair>,
        /// Out: contacts; empty when only the earliest is asked for.
        hits: Span<Hit>,
        /// Out: the smallest toi so far, as bits; or empty.
        earliest: Span<u64>,
        /// Counters, see [`counter`](super::counter).
        counters: Span<u64>,
    }
    /// Candidates of one kind for `narrow_certify`, and where they go.
    Listed {
        /// Candidates.
        pairs: Span<Pair>,
        /// Out: contacts and unresolved pairs; empty when only the earliest is asked for.
        hits: Span<Hit>,
        /// Out: pairs that need more precision; empty without [`ESCALATE`].
        escalated: Span<Pair>,
        /// Which counter tells how many pairs there are.
        pairs_at: u32,
        /// Which counter the hits add to.
        hits_at: u32,
        /// Which counter the escalated pairs add to.
        escalated_at: u32,
        /// Zero.
        pad: u32,
    }
    /// `narrow_certify`: what meets, and bounds of the first time, with proof.
    CertifyArgs<R: Real> {
        /// Positions.
        frames: Frames<R>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// End points of every edge.
        edges: Span<[u32; 2]>,
        /// Vertex/face candidates.
        vf: Listed,
        /// Edge/edge candidates.
        ee: Listed,
        /// Out: the smallest toi so far, as bits; or empty.
        earliest: Span<u64>,
        /// Counters, see [`counter`](super::counter).
        counters: Span<u64>,
        /// What is asked.
        params: Params,
        /// Bits: [`ESCALATE`].
        flags: u32,
        /// Zero.
        pad: u32,
    }
}

/// [`CertifyArgs::flags`]: pairs of which more precision may tell more go to their own list.
pub const ESCALATE: u32 = 1;
