//! # Separate: pairs that may come within a separation → proven contacts
//! Paper    not in the paper.
//! Launch   as many blocks as are resident, both kinds of pairs in one launch. In f32 over the rest
//!          of `climb::separate_at_once`.
//!          Then in f64 over the rest of that, or over all. Advancements differ in length: a lane
//!          takes one step, then the next.
//!          A finished lane draws the next pair of its block, so few lanes idle.
//!          A block's pairs are a grid apart. The kinds begin at opposite ends of the grid.
//! Reads    pairs, faces or edges, positions of both frames (four vertices); tolerances of bodies,
//!          if they differ.
//! Writes   contacts and undecided pairs with bounds of toi; or the earliest. In f32 the rest, in
//!          its own list.
//! Before   pairs are complete.
//! After    {pairs that come within the separation} ⊆ listed ∪ left; no time is late. See
//!          [`crate::prim::isolate::advance`].
//!          A pair whose steps run out in f64 is listed as undecided.
//! Room     hits, left: counted past the end, grown, run again.
//! Cost     8 B pair, 12 B indices, 128 B positions (gathered). 300 to 600 operations a step,
//!          mostly two to fifteen steps.

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
pub fn separate<R: Real, V: Rung<3>, E: Rung<4>, B: Block>(block: &mut B, args: &RungArgs<R>) {
    let share = |block: &B, of: &Listed, first: u32, drawn: u32| WorkRange {
        count: of.pairs.listed(block) as u64,
        first: first as u64,
        stride: block.blocks() as u64,
        drawn,
    };
    let vf = share(block, &args.vf, block.block(), 0);
    let ee = share(block, &args.ee, block.blocks() - 1 - block.block(), 1);
    let drawn = block.shared::<u32>(2);
    block.phase(|lane| {
        if lane.lane() == 0 {
            lane.put(drawn, 0, 0);
            lane.put(drawn, 1, 0);
        }
    });
    block.phase(|lane| {
        advance::<R, V, 3, _>(
            lane,
            args,
            &args.vf,
            &vf,
            drawn,
            |pair| of_vertex_face(lane, args, pair),
            |pair, p| {
                let (v, f) = vertex_face(lane, &args.frames, args.faces, pair);
                Face::new(v, f, p)
            },
        );
        advance::<R, E, 4, _>(
            lane,
            args,
            &args.ee,
            &ee,
            drawn,
            |pair| of_edge_edge(lane, args, pair),
            |pair, p| {
                let [x, y] = edge_edge(lane, &args.frames, args.edges, pair);
                Edges::new(x, y, p)
            },
        );
        lane.meet();
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
    lane: &L,
    args: &RungArgs<R>,
    of: &Listed,
    share: &WorkRange,
    drawn: Shared<u32>,
    params: impl Fn(Pair) -> Params,
    motion: impl Fn(Pair, &Params) -> isolate::Pair<T::S, N>,
) {
    let mut under_way: Option<(Pair, T)> = None;
    let mut more = true;
    while lane.any(more || under_way.is_some()) {
        if more && under_way.is_none() {
            let i = share.first + share.stride * lane.shared_add(drawn, share.drawn, 1) as u64;
            more = i < share.count;
            if more {
                let pair = of.pairs.get(lane, i as u32);
                let p = params(pair);
                under_way = Some((pair, T::begin(motion(pair, &p), &p)));
            }
        }
        // Lanes that drew and lanes that did not step side by side.
        if lane.any(under_way.is_some())
            && let Some((pair, rung)) = &mut under_way
            && let Some(answer) = rung.step(&args.params)
        {
            match answer {
                Some(verdict) => emit(lane, args, of, *pair, verdict),
                None => of.left.push(lane, *pair),
            }
            under_way = None;
        }
    }
}
