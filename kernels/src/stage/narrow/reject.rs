//! # Reject: candidates → candidates that may meet
//! Paper    none: the paper solves the cubic for every candidate.
//! Launch   `vf` and `ee`, or with a separation `near_vf` and `near_ee`; a lane a candidate; a grid of any size strides.
//! Reads    candidates, faces or edges, positions of both frames (four vertices).
//! Writes   the candidates that may meet.
//! Before   candidates are complete.
//! After    no contact is left out: a candidate goes only when its relative motion stays on one side of a coordinate
//!          plane, or its four points never share a plane, both beyond all rounding. f32 throughout, after a
//!          subtraction in the precision of the positions. With a separation: only when its relative motion stays on the
//!          far side of a plane, see [`crate::prim::inclusion::filter`].
//! Room     survivors: counted past the end, grown, run again.
//! Cost     8 B candidate, 12 B indices, 128 B positions (gathered); about 60 operations for three quarters of the
//!          candidates of real cloth, 200 for the others. A tenth survives.

use super::{append_each, listed, moving};
use crate::abi::{RejectArgs, counter};
use crate::exec::{Block, Lane};
use crate::math::Real;
use crate::prim::cubic::{ee_apart, vf_apart};
use crate::prim::inclusion::{Edges, Face, Local, Params};

/// Vertex/face.
pub fn vf<R: Real, B: Block>(b: &mut B, a: &RejectArgs<R>) {
    let count = listed(b, a.candidates, a.counters, counter::VF);
    append_each(b, count, (a.survivors, a.counters, counter::VF_SURVIVORS), |l, i| {
        let pair = l.read(a.candidates, i);
        let face = l.read(a.faces, pair.b).map(|v| moving(l, &a.frames, v));
        (!vf_apart::<R, f32>(moving(l, &a.frames, pair.a), face)).then_some(pair)
    });
}

/// Edge/edge.
pub fn ee<R: Real, B: Block>(b: &mut B, a: &RejectArgs<R>) {
    let count = listed(b, a.candidates, a.counters, counter::EE);
    append_each(b, count, (a.survivors, a.counters, counter::EE_SURVIVORS), |l, i| {
        let pair = l.read(a.candidates, i);
        let ends = |e: u32| l.read(a.edges, e).map(|v| moving(l, &a.frames, v));
        (!ee_apart::<R, f32>(ends(pair.a), ends(pair.b))).then_some(pair)
    });
}

/// Vertex/face, with a separation.
pub fn near_vf<R: Real, B: Block>(b: &mut B, a: &RejectArgs<R>) {
    let count = listed(b, a.candidates, a.counters, counter::VF);
    append_each(b, count, (a.survivors, a.counters, counter::VF_SURVIVORS), |l, i| {
        let pair = l.read(a.candidates, i);
        let face = l.read(a.faces, pair.b).map(|v| moving(l, &a.frames, v));
        let m = Face::<f32>::new(moving(l, &a.frames, pair.a), face, &within(a.separation));
        (!apart(&m)).then_some(pair)
    });
}

/// Edge/edge, with a separation.
pub fn near_ee<R: Real, B: Block>(b: &mut B, a: &RejectArgs<R>) {
    let count = listed(b, a.candidates, a.counters, counter::EE);
    append_each(b, count, (a.survivors, a.counters, counter::EE_SURVIVORS), |l, i| {
        let pair = l.read(a.candidates, i);
        let ends = |e: u32| l.read(a.edges, e).map(|v| moving(l, &a.frames, v));
        let m = Edges::<f32>::new(ends(pair.a), ends(pair.b), &within(a.separation));
        (!apart(&m)).then_some(pair)
    });
}

/// The filters ask for no more than the separation.
fn within(separation: f64) -> Params {
    Params { separation, ..Params::new(0.0) }
}

/// Whether the pair certainly stays farther apart than the separation.
fn apart<const N: usize>(m: &Local<f32, N>) -> bool {
    m.apart_by_axes() || m.apart_by_planes()
}
