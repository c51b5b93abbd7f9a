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
//! Before   candidates are complete. Positions are finite. distance > 0.
//! After    hits ⊇ {candidates within the distance}, less those that the scene excludes
//!          ([`super::exclude`]). None is farther by more than the rounding of
//!          f64, see [`crate::prim::near`].
//! Room     hits: counted past the end, grown, run again.
//! Departs  pairs are measured in f64 for positions of either precision, so the bound is that of
//!          f64.
//! Cost     8 B candidate, 12 B indices, 64 B positions (f64: 128 B; gathered), again for each
//!          measured pair; 32 B a hit.
//!          About 220 operations of f32, and as many of f64 for a measured pair, five of them
//!          divisions.

use super::{Entries, edge_edge_at, exclude, stride, vertex_face_at};
use crate::abi::{NearArgs, NearExcludingArgs, NearHit, Output, Pair, counter};
use crate::exec::{Block, Lane, RowMap};
use crate::math::{Real, Vec3};
use crate::prim::near::{Filter, Near, edge_edge, vertex_face};

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
        args,
        (args.vf, args.vf_hits),
        &Filter::<R, true>::new(args.distance),
        |lane, pair| {
            let (v, [x, y, z]) = vertex_face_at(lane, args.positions, args.faces, pair);
            [v, x, y, z]
        },
        |[v, x, y, z]| vertex_face(v, [x, y, z], args.distance),
        excludes_vf,
    );
    each(
        block,
        args,
        (args.ee, args.ee_hits),
        &Filter::<R, false>::new(args.distance),
        |lane, pair| {
            let [[x, y], [z, w]] = edge_edge_at(lane, args.positions, args.edges, pair);
            [x, y, z, w]
        },
        |[x, y, z, w]| edge_edge([x, y], [z, w], args.distance),
        excludes_ee,
    );
}

/// One kind: filters the candidates of each stretch, and measures the rest.
#[inline(always)]
fn each<R: Real, B: Block, M: RowMap<Row = [Vec3<R>; 4]>>(
    block: &mut B,
    args: &NearArgs<R>,
    (pairs, hits): (Output<Pair>, Output<NearHit>),
    filter: &M,
    gather: impl Fn(&B::Lane, Pair) -> [Vec3<R>; 4],
    measure: impl Fn([Vec3<R>; 4]) -> Option<Near>,
    excludes: impl Fn(&B::Lane, Pair) -> bool,
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
                    let near = measure(gather(lane, pair))?;
                    if excludes(lane, pair) {
                        return None;
                    }
                    if !near.certain {
                        args.counters.add(lane, counter::UNDECIDED, 1);
                    }
                    Some(NearHit { a: pair.a, b: pair.b, squared: near.squared, at: near.at })
                });
                entries.set(lane, hit);
            },
        );
        entries.append(block, hits);
    });
}
