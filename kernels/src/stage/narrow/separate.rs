//! # Separate: pairs that may come within a separation → contacts, proven, with bounds of their first time
//! Paper    none: beyond it.
//! Launch   as many blocks as run at once, both kinds of pairs in one; over what f32 left, or over all. Advancements are of
//!          different lengths: a lane takes a step, then the next, and a lane that is done draws its block's next pair, so that
//!          few lanes wait. A block's pairs lie a grid apart, and the kinds begin at opposite ends of the grid.
//! Reads    pairs, faces or edges, positions of both frames (four vertices).
//! Writes   contacts and unresolved pairs with toi and toi_hi; or the earliest.
//! Before   pairs are complete.
//! After    every pair that comes within the separation is listed, none late; see [`crate::prim::isolate::advance`]. A pair whose
//!          steps end is listed as unresolved.
//! Room     hits: counted past the end, grown, run again.
//! Cost     8 B pair, 12 B indices, 128 B positions (gathered); 150 operations of f64 a step, mostly two to ten steps.

use super::climb::{edge_edge, tell, vertex_face};
use super::listed;
use crate::abi::{Listed, Pair, RungArgs};
use crate::exec::{Block, Lane, Shared};
use crate::math::Real;
use crate::prim::isolate::ladder::Separating;
use crate::prim::isolate::{self, Edges, Face};

/// Bytes of shared memory of a block: the numbers of pairs drawn.
pub const SHARED: u32 = 8;

/// All that is left, in f64.
pub fn separate<R: Real, B: Block>(b: &mut B, a: &RungArgs<R>) {
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
        advance(l, a, &a.vf, (&vf, drawn), |pair| {
            let (v, f) = vertex_face(l, a, pair);
            Face::new(v, f, &a.params)
        });
        advance(l, a, &a.ee, (&ee, drawn), |pair| {
            let [x, y] = edge_edge(l, a, pair);
            Edges::new(x, y, &a.params)
        });
    });
}

/// A block's pairs of one kind: that numbered `first`, and every `stride` on.
struct Share {
    count: u64,
    first: u64,
    stride: u64,
    /// Which shared word counts those that are drawn.
    drawn: u32,
}

/// Draws pairs and advances them until there are no more.
fn advance<R: Real, const N: usize, L: Lane>(
    l: &L,
    a: &RungArgs<R>,
    of: &Listed,
    (share, drawn): (&Share, Shared<u32>),
    motion: impl Fn(Pair) -> isolate::Pair<f64, N>,
) {
    let mut under_way: Option<(Pair, Separating<N>)> = None;
    let mut more = true;
    while l.any(more || under_way.is_some()) {
        if more && under_way.is_none() {
            let i = share.first + share.stride * l.shared_add(drawn, share.drawn, 1) as u64;
            more = i < share.count;
            if more {
                let pair = l.read(of.pairs, i as u32);
                under_way = Some((pair, Separating::begin(motion(pair), &a.params)));
            }
        }
        // Lanes that drew and lanes that did not step side by side.
        if l.any(under_way.is_some())
            && let Some((pair, separating)) = &mut under_way
            && let Some(verdict) = separating.step(&a.params)
        {
            tell(l, a, of, (*pair, verdict));
            under_way = None;
        }
    }
}
