//! # Near: vertex/face and edge/edge candidates → those within a distance, at rest
//! Paper    not in the paper. The paper's distance query returns one number for two models; this
//!          one every pair of features.
//! Launch   a lane a candidate, both kinds in one launch; a grid of any size strides. First in f32,
//!          on a CPU in vectors.
//!          The same lane measures the rest in f64. Numbering these first, for full warps, takes a
//!          third longer on an H200 (`benches/NOTES.md`).
//! Reads    candidates, faces or edges, positions (four vertices).
//! Writes   pairs with squared distance and nearest points; the number of pairs that are not
//!          certainly within the distance.
//! Before   candidates are complete. Positions are finite. distance > 0; with a thickness from 0.
//! After    hits ⊇ {candidates within the distance, and with a thickness both radii}, less those that
//!          the scene excludes ([`super::exclude`]). None is farther by more than the rounding of
//!          f64, see [`crate::prim::near`].
//! Room     hits: counted past the end, grown, run again.
//! Departs  pairs are measured in f64 for positions of either precision, so the bound is that of
//!          f64.
//! Cost     8 B candidate, 12 B indices, 64 B positions (f64: 128 B; gathered), again for each
//!          measured pair; 32 B a hit.
//!          About 220 operations of f32, and as many of f64 for a measured pair, five of them
//!          divisions. With a thickness 32 B radii and some 300 operations a measured pair more.

use super::{Entries, edge_edge_at, exclude, stride, vertex_face_at};
use crate::abi::{Counters, NearArgs, NearExcludingArgs, NearHit, Output, Pair, ThickNearArgs, counter};
use crate::exec::{Block, Lane, RowMap};
use crate::math::Real;
use crate::prim::near::{
    Filter, Near, ThickFilter, edge_edge, thick_edge_edge, thick_vertex_face, vertex_face,
};

/// Both kinds.
pub fn near<R: Real, B: Block>(block: &mut B, args: &NearArgs<R>) {
    both(block, args, |_, _| false, |_, _| false);
}

/// Both kinds, without pairs that the scene excludes. They are looked up once measured, when few are
/// left.
pub fn near_excluding<R: Real, B: Block>(block: &mut B, args: &NearExcludingArgs<R>) {
    let NearExcludingArgs { near, tables } = args;
    both(
        block,
        near,
        |lane: &B::Lane, pair| exclude::vertex_face(lane, tables, near.faces, pair),
        |lane: &B::Lane, pair| exclude::edge_edge(lane, tables, near.edges, pair),
    );
}

/// Both kinds, without pairs that are excluded.
#[inline(always)]
fn both<R: Real, B: Block>(
    block: &mut B,
    args: &NearArgs<R>,
    excludes_vf: impl Fn(&B::Lane, Pair) -> bool,
    excludes_ee: impl Fn(&B::Lane, Pair) -> bool,
) {
    each(
        block,
        (args.vf, args.vf_hits, args.counters),
        &Filter::<R, true>::new(args.distance),
        |lane, pair| {
            let (v, [x, y, z]) = vertex_face_at(lane, args.positions, args.faces, pair);
            [v, x, y, z]
        },
        |lane, pair, [v, x, y, z]| {
            vertex_face(v, [x, y, z], args.distance).filter(|_| !excludes_vf(lane, pair))
        },
    );
    each(
        block,
        (args.ee, args.ee_hits, args.counters),
        &Filter::<R, false>::new(args.distance),
        |lane, pair| {
            let [[x, y], [z, w]] = edge_edge_at(lane, args.positions, args.edges, pair);
            [x, y, z, w]
        },
        |lane, pair, [x, y, z, w]| {
            edge_edge([x, y], [z, w], args.distance).filter(|_| !excludes_ee(lane, pair))
        },
    );
}

/// Both kinds, of vertices with a thickness, without pairs that the scene excludes.
pub fn thick<R: Real, B: Block>(block: &mut B, args: &ThickNearArgs<R>) {
    let ThickNearArgs { near, radii, tables } = args;
    let vf = |lane: &B::Lane, pair: Pair| {
        let [x, y, z] = lane.read(near.faces, pair.b);
        [pair.a, x, y, z]
    };
    let ee = |lane: &B::Lane, pair: Pair| {
        let [[x, y], [z, w]] = [pair.a, pair.b].map(|edge| lane.read(near.edges, edge));
        [x, y, z, w]
    };
    let points = |lane: &B::Lane, of: [u32; 4]| of.map(|vertex| lane.read(near.positions, vertex));
    // In f32 the radius of a point is rounded up.
    let exact = |lane: &B::Lane, of: [u32; 4]| of.map(|vertex| lane.read(*radii, vertex));
    each(
        block,
        (near.vf, near.vf_hits, near.counters),
        &ThickFilter::<R, true>::new(near.distance),
        |lane, pair| points(lane, vf(lane, pair)),
        |lane, pair, row| {
            let found = thick_vertex_face(row.map(|p| p.at), exact(lane, vf(lane, pair)), near.distance);
            found.filter(|_| !exclude::vertex_face(lane, tables, near.faces, pair))
        },
    );
    each(
        block,
        (near.ee, near.ee_hits, near.counters),
        &ThickFilter::<R, false>::new(near.distance),
        |lane, pair| points(lane, ee(lane, pair)),
        |lane, pair, row| {
            let found = thick_edge_edge(row.map(|p| p.at), exact(lane, ee(lane, pair)), near.distance);
            found.filter(|_| !exclude::edge_edge(lane, tables, near.edges, pair))
        },
    );
}

/// One kind: filters the candidates of each stretch, and measures the rest.
#[inline(always)]
fn each<B: Block, M: RowMap>(
    block: &mut B,
    (pairs, hits, counters): (Output<Pair>, Output<NearHit>, Counters),
    filter: &M,
    gather: impl Fn(&B::Lane, Pair) -> M::Row,
    measure: impl Fn(&B::Lane, Pair, M::Row) -> Option<Near>,
) {
    let count = pairs.listed(block);
    let mut entries = Entries::new(block);
    stride(block, count, |block, base| {
        block.map_rows(
            filter,
            |lane| {
                let i = base + lane.lane();
                (i < count).then(|| pairs.get(lane, i))
            },
            |lane, pair| Some(gather(lane, pair)),
            |lane, result| {
                let kept = result.filter(|(_, keep)| *keep != 0).map(|(pair, _)| pair);
                let hit = kept.and_then(|pair| {
                    let near = measure(lane, pair, gather(lane, pair))?;
                    if !near.certain {
                        counters.add(lane, counter::UNDECIDED, 1);
                    }
                    Some(NearHit { a: pair.a, b: pair.b, squared: near.squared, at: near.at })
                });
                entries.set(lane, hit);
            },
        );
        entries.append(block, hits);
    });
}
