//! # Reject: candidates → candidates that may meet
//! Paper    not in the paper, which solves the cubic for every candidate.
//! Launch   a lane a candidate, both kinds in one launch; a grid of any size strides.
//! Reads    candidates, faces or edges, positions of both frames (four vertices).
//! Writes   the candidates that may meet.
//! Before   candidates are complete.
//! After    survivors ⊇ {candidates that meet}. A candidate is dropped in two cases, both beyond
//!          all rounding.
//!          (1) The boxes around its features, moving with them, share a point at no time.
//!          (2) Its four points share no plane while these boxes overlap.
//!          With a known time also if the boxes first share a point behind the horizon
//!          ([`crate::bvh::horizon`]).
//!          All in f32, after a subtraction in the precision of the positions. See
//!          [`crate::prim::isolate`].
//! Room     survivors: counted past the end, grown, run again.
//! Cost     8 B candidate, 12 B indices, 128 B positions (gathered).
//!          About 100 operations for half of the candidates of real cloth, 300 for the others. On a
//!          CPU 300 for all, in vectors.
//!          A tenth survives.

use super::{append_mapped, edge, expect, moving};
use crate::abi::{CullArgs, earliest};
use crate::bvh::horizon::Horizon;
use crate::exec::{Block, Lane, RowMap};
use crate::math::Real;
use crate::prim::cubic::Moving;
use crate::prim::inclusion::Params;
use crate::prim::isolate::ladder::rejected_before;
use crate::prim::isolate::{Edges, Face};
use core::marker::PhantomData;

/// Both kinds. If only the pairs at the earliest time are wanted (`FIRST`), none without a time. Each
/// kernel has an instance of its own: one that both called would be out of line, and copy arguments.
pub fn cull<const FIRST: bool, R: Real, B: Block>(block: &mut B, args: &CullArgs<R>) {
    if FIRST && block.load(args.known, earliest::KEY) == u64::MAX {
        return;
    }
    let later = block.blocks() * block.lanes();
    let count = args.vf.listed(block);
    let horizon = Horizon::of(block, args.known).time();
    let may = VertexFace(args.params, horizon, PhantomData);
    append_mapped(
        block,
        count,
        args.may_vf,
        &may,
        |lane, i| {
            let pair = args.vf.get(lane, i);
            let face = lane.read(args.faces, pair.b);
            [pair.a, face[0], face[1], face[2]]
                .into_iter()
                .for_each(|vertex| lane.expect(args.frames.moving, vertex));
            expect(lane, &args.vf, i + later, count, |pair| lane.expect(args.faces, pair.b));
            (pair, face)
        },
        |lane, (pair, [x, y, z])| {
            let at = |vertex| moving(lane, &args.frames, vertex);
            [at(pair.a), at(x), at(y), at(z)]
        },
    );
    let count = args.ee.listed(block);
    let may = EdgeEdge(args.params, horizon, PhantomData);
    append_mapped(
        block,
        count,
        args.may_ee,
        &may,
        |lane, i| {
            let pair = args.ee.get(lane, i);
            let edges = [lane.read(args.edges, pair.a), lane.read(args.edges, pair.b)];
            edges.into_iter().flatten().for_each(|vertex| lane.expect(args.frames.moving, vertex));
            expect(lane, &args.ee, i + later, count, |pair| {
                lane.expect(args.edges, pair.a);
                lane.expect(args.edges, pair.b);
            });
            (pair, edges)
        },
        |lane, (_, [x, y])| [edge(lane, &args.frames, x), edge(lane, &args.frames, y)],
    );
}

/// Whether a vertex may meet a face, before a horizon.
struct VertexFace<R>(Params, f32, PhantomData<R>);

impl<R: Real> RowMap for VertexFace<R> {
    type Number = R;
    type Row = [Moving<R>; 4];
    #[inline(always)]
    fn at_once(&self, [v, x, y, z]: [Moving<R>; 4]) -> u32 {
        !rejected_before(&Face::new(v, [x, y, z], &self.0), self.1) as u32
    }
}

/// Whether two edges may meet, before a horizon.
struct EdgeEdge<R>(Params, f32, PhantomData<R>);

impl<R: Real> RowMap for EdgeEdge<R> {
    type Number = R;
    type Row = [[Moving<R>; 2]; 2];
    #[inline(always)]
    fn at_once(&self, [a, b]: [[Moving<R>; 2]; 2]) -> u32 {
        !rejected_before(&Edges::new(a, b, &self.0), self.1) as u32
    }
}
