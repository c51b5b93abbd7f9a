//! # Certify: vertex/face and edge/edge candidates → contacts, proven, with bounds of their first time
//! Paper    none: beyond it.
//! Launch   `vf` and `ee`, a lane a candidate; a grid of any size strides. In f32 over what may meet; in f64 over the same,
//!          or over what f32 escalated.
//! Reads    candidates, faces or edges, positions of both frames (four vertices).
//! Writes   contacts and unresolved pairs with toi and toi_hi; or, when only the earliest is asked for, one number.
//!          With [`ESCALATE`] the pairs, in their own list, of which more precision may tell more.
//! Before   candidates are complete.
//! After    every pair that meets is listed, none of them late; see [`crate::prim::inclusion`]. A pair whose budget ends is
//!          listed as unresolved. The earliest is the least toi of all pairs, each asked over the whole step: what others
//!          found does not enter, so it is the same in any order.
//! Room     hits, escalated: counted past the end, grown, run again.
//! Cost     8 B candidate, 12 B indices, 128 B positions (gathered); 1,200 operations a box, mostly one to twenty boxes.
//!          Boxes wait in a stack in local memory: 1.5 KB a lane in f32, 3 KB in f64.

use super::{listed, moving};
use crate::abi::{CertifyArgs, ESCALATE, Hit, Pair, counter};
use crate::exec::{Block, Lane, Slot};
use crate::math::Real;
use crate::prim::inclusion::{Grid, Verdict, ee_settled, vf_settled};

/// Vertex/face, positions in R, boxes in S.
pub fn vf<R: Real, S: Grid, B: Block>(b: &mut B, a: &CertifyArgs<R>) {
    certify(b, a, |l, pair| {
        let face = l.read(a.faces, pair.b).map(|v| moving(l, &a.frames, v));
        vf_settled::<R, S>(moving(l, &a.frames, pair.a), face, &a.params)
    });
}

/// Edge/edge, positions in R, boxes in S.
pub fn ee<R: Real, S: Grid, B: Block>(b: &mut B, a: &CertifyArgs<R>) {
    certify(b, a, |l, pair| {
        let ends = |e: u32| l.read(a.edges, e).map(|v| moving(l, &a.frames, v));
        ee_settled::<R, S>(ends(pair.a), ends(pair.b), &a.params)
    });
}

/// Where a pair goes.
#[derive(Clone, Copy, PartialEq)]
enum To {
    Nowhere,
    Hits,
    Escalated,
}

/// Asks each candidate, and puts it where it belongs.
fn certify<R: Real, B: Block>(
    b: &mut B,
    a: &CertifyArgs<R>,
    ask: impl Fn(&B::Lane, Pair) -> (Verdict, bool),
) {
    let count = listed(b, a.pairs, a.counters, a.pairs_at);
    let lanes = b.lanes();
    let mut hits = b.slot(Hit::default());
    let mut goes = b.slot(To::Nowhere);
    let mut places = b.slot(0u32);
    let mut base = b.block() * lanes;
    while base < count {
        b.phase(|l| {
            let i = base + l.lane();
            *goes.of(l) = To::Nowhere;
            if i < count {
                let pair = l.read(a.pairs, i);
                let (verdict, settled) = ask(l, pair);
                *hits.of(l) = Hit { a: pair.a, b: pair.b, verdict };
                *goes.of(l) = if a.flags & ESCALATE != 0 && !settled {
                    To::Escalated
                } else if verdict.is_separated() {
                    To::Nowhere
                } else {
                    note(l, a, &verdict);
                    To::Hits
                };
            }
        });
        if a.earliest.is_empty() {
            b.phase(|l| *places.of(l) = (*goes.of(l) == To::Hits) as u32);
            let start = b.append(&mut places, a.counters, a.hits_at);
            b.phase(|l| {
                let place = start + *places.of(l) as u64;
                if *goes.of(l) == To::Hits && place < a.hits.len {
                    l.write(a.hits, place as u32, *hits.of(l));
                }
            });
        }
        if a.flags & ESCALATE != 0 {
            b.phase(|l| *places.of(l) = (*goes.of(l) == To::Escalated) as u32);
            let start = b.append(&mut places, a.counters, a.escalated_at);
            b.phase(|l| {
                let (place, Hit { a: one, b: other, .. }) = (start + *places.of(l) as u64, *hits.of(l));
                if *goes.of(l) == To::Escalated && place < a.escalated.len {
                    l.write(a.escalated, place as u32, Pair { a: one, b: other });
                }
            });
        }
        base += b.blocks() * lanes;
    }
}

/// Counts what is not certain; keeps the smallest time, where only that is asked for.
fn note<R: Real, L: Lane>(l: &L, a: &CertifyArgs<R>, verdict: &Verdict) {
    if !verdict.is_contact() {
        l.fetch_add(a.counters, counter::UNRESOLVED, 1);
    }
    if !a.earliest.is_empty() {
        // Times are in [0, 1]: their bits are ordered as they are.
        l.fetch_min(a.earliest, 0, verdict.toi.to_bits());
    }
}
