//! # Reject: candidates → candidates that may meet
//! Paper    none: the paper solves the cubic for every candidate.
//! Launch   a lane a candidate, both kinds in one launch; a grid of any size strides.
//! Reads    candidates, faces or edges, positions of both frames (four vertices).
//! Writes   the candidates that may meet.
//! Before   candidates are complete.
//! After    no contact is left out: a candidate goes only when the boxes around its features, moving with them, share a point
//!          at no time, or its four points never share a plane in the time that they do; both beyond all rounding. f32
//!          throughout, after a subtraction in the precision of the positions. See [`crate::prim::isolate`].
//! Room     survivors: counted past the end, grown, run again.
//! Cost     8 B candidate, 12 B indices, 128 B positions (gathered); about 100 operations for half of the candidates of real
//!          cloth, 300 for the others. A tenth survives.

use super::{append_each, edge_edge, listed, vertex_face};
use crate::abi::{RejectArgs, counter};
use crate::exec::{Block, Lane};
use crate::math::Real;
use crate::prim::isolate::ladder::rejected;
use crate::prim::isolate::{Edges, Face};

/// Both kinds.
pub fn reject<R: Real, B: Block>(b: &mut B, a: &RejectArgs<R>) {
    let count = listed(b, a.vf, a.counters, counter::VF);
    append_each(b, count, (a.may_vf, a.counters, counter::VF_SURVIVORS), |l, i| {
        let pair = l.read(a.vf, i);
        let (v, f) = vertex_face(l, (&a.frames, a.faces), pair);
        (!rejected(&Face::new(v, f, &a.params))).then_some(pair)
    });
    let count = listed(b, a.ee, a.counters, counter::EE);
    append_each(b, count, (a.may_ee, a.counters, counter::EE_SURVIVORS), |l, i| {
        let pair = l.read(a.ee, i);
        let [x, y] = edge_edge(l, (&a.frames, a.edges), pair);
        (!rejected(&Edges::new(x, y, &a.params))).then_some(pair)
    });
}
