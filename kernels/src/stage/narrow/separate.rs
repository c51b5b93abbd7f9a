//! # Separate: pairs that may come within a separation → contacts, proven, with bounds of their first time
//! Paper    none: beyond it.
//! Launch   as many blocks as run at once, both kinds of pairs in one: in f32 over what `climb::separate_at_once` left, then in
//!          f64 over what that left, or over all. Advancements are of different lengths: a lane takes a step, then the
//!          next, and a lane that is done draws its block's next pair, so that few lanes wait. A block's pairs lie a grid apart,
//!          and the kinds begin at opposite ends of the grid.
//! Reads    pairs, faces or edges, positions of both frames (four vertices); tolerances of bodies, if they differ.
//! Writes   contacts and unresolved pairs with toi and toi_hi; or the earliest. And in f32 what is left, in its own list.
//! Before   pairs are complete.
//! After    every pair that comes within the separation is listed or left, none late; see [`crate::prim::isolate::advance`].
//!          A pair whose steps end in f64 is listed as unresolved.
//! Room     hits, left: counted past the end, grown, run again.
//! Cost     8 B pair, 12 B indices, 128 B positions (gathered); 300 to 600 operations a step, mostly two to fifteen
//!          steps.

use super::climb::emit;
use super::{edge_edge, of_edge_edge, of_vertex_face, vertex_face};
use crate::abi::{Listed, Pair, RungArgs};
use crate::exec::{Block, Lane, Shared};
use crate::math::Real;
use crate::prim::inclusion::Params;
use crate::prim::isolate::separation::Rung;
use crate::prim::isolate::{self, Edges, Face};

/// Bytes of shared memory of a block: the numbers of pairs drawn.
pub const SHARED: u32 = 8;

/// All pairs of a list, by a rung.
#[inline(always)]
pub fn separate<R: Real, V: Rung<3>, E: Rung<4>, B: Block>(b: &mut B, a: &RungArgs<R>) {
    let share = |b: &B, of: &Listed, first: u32, drawn: u32| WorkRange {
        count: of.pairs.listed(b) as u64,
        first: first as u64,
        stride: b.blocks() as u64,
        drawn,
    };
    let vf = share(b, &a.vf, b.block(), 0);
    let ee = share(b, &a.ee, b.blocks() - 1 - b.block(), 1);
    let drawn = b.shared::<u32>(2);
    b.phase(|l| {
        if l.lane() == 0 {
            l.put(drawn, 0, 0);
            l.put(drawn, 1, 0);
        }
    });
    b.phase(|l| {
        advance::<R, V, 3, _>(
            l,
            a,
            &a.vf,
            (&vf, drawn),
            |pair| of_vertex_face(l, a, pair),
            |pair, p| {
                let (v, f) = vertex_face(l, (&a.frames, a.faces), pair);
                Face::new(v, f, p)
            },
        );
        advance::<R, E, 4, _>(
            l,
            a,
            &a.ee,
            (&ee, drawn),
            |pair| of_edge_edge(l, a, pair),
            |pair, p| {
                let [x, y] = edge_edge(l, (&a.frames, a.edges), pair);
                Edges::new(x, y, p)
            },
        );
        l.meet();
    });
}

/// A block's pairs of one kind: that numbered `first`, and every `stride` on.
struct WorkRange {
    count: u64,
    first: u64,
    stride: u64,
    /// Which shared word counts those that are drawn.
    drawn: u32,
}

/// Draws pairs and advances them until there are no more.
#[inline(always)]
fn advance<R: Real, T: Rung<N>, const N: usize, L: Lane>(
    l: &L,
    a: &RungArgs<R>,
    of: &Listed,
    (share, drawn): (&WorkRange, Shared<u32>),
    asked: impl Fn(Pair) -> Params,
    motion: impl Fn(Pair, &Params) -> isolate::Pair<T::S, N>,
) {
    let mut under_way: Option<(Pair, T)> = None;
    let mut more = true;
    while l.any(more || under_way.is_some()) {
        if more && under_way.is_none() {
            let i = share.first + share.stride * l.shared_add(drawn, share.drawn, 1) as u64;
            more = i < share.count;
            if more {
                let pair = of.pairs.get(l, i as u32);
                let p = asked(pair);
                under_way = Some((pair, T::begin(motion(pair, &p), &p)));
            }
        }
        // Lanes that drew and lanes that did not step side by side.
        if l.any(under_way.is_some())
            && let Some((pair, rung)) = &mut under_way
            && let Some(told) = rung.step(&a.params)
        {
            match told {
                Some(verdict) => emit(l, a, of, (*pair, verdict)),
                None => of.left.push(l, *pair),
            }
            under_way = None;
        }
    }
}
