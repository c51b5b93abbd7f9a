//! # Certify: vertex/face and edge/edge candidates → contacts, proven, with bounds of their first time
//! Paper    none: beyond it.
//! Launch   a grid of any size, both kinds of candidates in one. In f32 over what may meet; in f64 over the same, or over
//!          what f32 escalated. Searches are of very different lengths: a lane looks at one box, then at the next, and a
//!          lane whose search has ended draws the block's next candidate, so that few lanes wait. A block's candidates lie
//!          a grid apart, and the two kinds begin at opposite ends of the grid, so that short lists are spread over all
//!          blocks, and none waits for the other.
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
use crate::abi::{CertifyArgs, ESCALATE, Hit, Listed, Pair, counter};
use crate::exec::{Block, Lane, Shared};
use crate::math::Real;
use crate::prim::inclusion::{Edges, Face, Grid, Local, STACK, Search, Verdict};
use core::mem::MaybeUninit;

/// Bytes of shared memory of a block: the numbers of candidates drawn.
pub const SHARED: u32 = 8;

/// Positions in R, boxes in S.
pub fn certify<R: Real, S: Grid, B: Block>(b: &mut B, a: &CertifyArgs<R>) {
    let share = |b: &B, of: &Listed, first: u32, drawn: u32| Share {
        count: listed(b, of.pairs, a.counters, of.pairs_at) as u64,
        first: first as u64,
        stride: b.blocks() as u64,
        drawn,
    };
    let vf = share(b, &a.vf, b.block(), 0);
    let ee = share(b, &a.ee, b.blocks() - 1 - b.block(), 1);
    let drawn = b.shared::<u32>(2);
    b.phase(|l| {
        if l.lane() < 2 {
            l.put(drawn, l.lane(), 0);
        }
    });
    b.phase(|l| {
        search(l, a, &a.vf, (&vf, drawn), |pair| {
            let face = l.read(a.faces, pair.b).map(|v| moving(l, &a.frames, v));
            Face::<S>::new(moving(l, &a.frames, pair.a), face, &a.params)
        });
        search(l, a, &a.ee, (&ee, drawn), |pair| {
            let ends = |e: u32| l.read(a.edges, e).map(|v| moving(l, &a.frames, v));
            Edges::<S>::new(ends(pair.a), ends(pair.b), &a.params)
        });
    });
}

/// A block's candidates of one kind: that numbered `first`, and every `stride` on.
struct Share {
    count: u64,
    first: u64,
    stride: u64,
    /// Which shared word counts those that are drawn.
    drawn: u32,
}

/// Draws candidates and searches their motion until there are no more.
fn search<R: Real, S: Grid, const N: usize, L: Lane>(
    l: &L,
    a: &CertifyArgs<R>,
    of: &Listed,
    (share, drawn): (&Share, Shared<u32>),
    motion: impl Fn(Pair) -> Local<S, N>,
) {
    let mut stack = [const { MaybeUninit::uninit() }; STACK];
    let mut under_way: Option<(Pair, Search<S, N>)> = None;
    let mut more = true;
    while l.any(more) {
        let mut told = None;
        if more && under_way.is_none() {
            let i = share.first + share.stride * l.shared_add(drawn, share.drawn, 1) as u64;
            more = i < share.count;
            if more {
                let pair = l.read(of.pairs, i as u32);
                under_way = match Search::begin(motion(pair), &a.params, &mut stack) {
                    Ok(search) => Some((pair, search)),
                    Err((verdict, settled)) => {
                        told = Some(Told { pair, verdict, settled });
                        None
                    }
                };
            }
        }
        // Lanes that drew and lanes that did not look side by side.
        if l.any(under_way.is_some())
            && let Some((pair, search)) = &mut under_way
            && let Some((verdict, settled)) = search.step(&a.params)
        {
            told = Some(Told { pair: *pair, verdict, settled });
            under_way = None;
        }
        if let Some(told) = told {
            tell(l, a, of, told);
        }
    }
}

/// An answer.
struct Told {
    pair: Pair,
    verdict: Verdict,
    /// More precision would tell nothing that was asked.
    settled: bool,
}

/// Puts a pair where it belongs.
fn tell<R: Real, L: Lane>(l: &L, a: &CertifyArgs<R>, of: &Listed, Told { pair, verdict, settled }: Told) {
    if a.flags & ESCALATE != 0 && !settled {
        let place = l.fetch_add(a.counters, of.escalated_at, 1);
        if place < of.escalated.len {
            l.write(of.escalated, place as u32, pair);
        }
    } else if !verdict.is_separated() {
        if !verdict.is_contact() {
            l.fetch_add(a.counters, counter::UNRESOLVED, 1);
        }
        if !a.earliest.is_empty() {
            // Times are in [0, 1]: their bits are ordered as they are.
            l.fetch_min(a.earliest, 0, verdict.toi.to_bits());
        } else {
            if verdict.exhausted() {
                l.fetch_add(a.counters, counter::ENDED, 1);
                l.fetch_add(a.counters, counter::ENDED_UNRESOLVED, !verdict.is_contact() as u64);
            }
            let place = l.fetch_add(a.counters, of.hits_at, 1);
            if place < of.hits.len {
                l.write(of.hits, place as u32, Hit { a: pair.a, b: pair.b, verdict });
            }
        }
    }
}
