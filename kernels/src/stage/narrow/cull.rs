//! # Reject: candidates → candidates that may meet
//! Paper    none: the paper solves the cubic for every candidate.
//! Launch   a lane a candidate, both kinds in one launch; a grid of any size strides.
//! Reads    candidates, faces or edges, positions of both frames (four vertices).
//! Writes   the candidates that may meet.
//! Before   candidates are complete.
//! After    no contact is left out: a candidate goes only when the boxes around its features, moving with them, share a point
//!          at no time, or its four points never share a plane in the time that they do; both beyond all rounding. f32
//!          throughout, after a subtraction in the precision of the positions. See [`crate::prim::isolate`]. If a time is
//!          known, also when those boxes first share a point behind the horizon ([`crate::bvh::horizon`]).
//! Room     survivors: counted past the end, grown, run again.
//! Cost     8 B candidate, 12 B indices, 128 B positions (gathered); about 100 operations for half of the candidates of real
//!          cloth, 300 for the others; on a CPU 300 for all, in vectors. A tenth survives.

use super::{append_mapped, edge, expect, moving};
use crate::abi::CullArgs;
use crate::bvh::horizon::Horizon;
use crate::exec::{Block, Lane, RowMap};
use crate::math::Real;
use crate::prim::cubic::Moving;
use crate::prim::inclusion::Params;
use crate::prim::isolate::ladder::rejected_before;
use crate::prim::isolate::{Edges, Face};
use core::marker::PhantomData;

/// Both kinds.
pub fn cull<R: Real, B: Block>(b: &mut B, a: &CullArgs<R>) {
    let later = b.blocks() * b.lanes();
    let count = a.vf.listed(b);
    let horizon = Horizon::of(b, a.known).time();
    let may = VertexFace(a.params, horizon, PhantomData);
    append_mapped(
        b,
        count,
        a.may_vf,
        &may,
        |l, i| {
            let (pair, later) = (a.vf.get(l, i), (i + later, count));
            let face = l.read(a.faces, pair.b);
            [pair.a, face[0], face[1], face[2]]
                .into_iter()
                .for_each(|vertex| l.expect(a.frames.moving, vertex));
            expect(l, &a.vf, later, |pair| l.expect(a.faces, pair.b));
            (pair, face)
        },
        |l, (pair, [x, y, z])| {
            let at = |vertex| moving(l, &a.frames, vertex);
            [at(pair.a), at(x), at(y), at(z)]
        },
    );
    let count = a.ee.listed(b);
    let may = EdgeEdge(a.params, horizon, PhantomData);
    append_mapped(
        b,
        count,
        a.may_ee,
        &may,
        |l, i| {
            let (pair, later) = (a.ee.get(l, i), (i + later, count));
            let edges = [l.read(a.edges, pair.a), l.read(a.edges, pair.b)];
            edges.into_iter().flatten().for_each(|vertex| l.expect(a.frames.moving, vertex));
            expect(l, &a.ee, later, |pair| {
                l.expect(a.edges, pair.a);
                l.expect(a.edges, pair.b);
            });
            (pair, edges)
        },
        |l, (_, [x, y])| [edge(l, &a.frames, x), edge(l, &a.frames, y)],
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
