//! # Near: vertex/face and edge/edge candidates → those within a distance, at rest
//! Paper    the distance of two triangles is the seed's other query; it answers with one number, this with every pair of features.
//! Launch   a lane a candidate, both kinds in one launch; a grid of any size strides. In f32 first, on a CPU in vectors; what that does
//!          not let go is measured in f64 by the same lane: numbering it first, so that lanes are neighbours that measure, takes
//!          a third longer on an H200 (`benches/NOTES.md`).
//! Reads    candidates, faces or edges, positions (four vertices).
//! Writes   the pairs that are not certainly farther apart, with squared distance and where they are nearest; how many of them are
//!          not certainly within it.
//! Before   candidates are complete. Positions are finite. The distance is a number above 0.
//! After    every candidate within the distance is listed; none that is farther by more than rounding of f64, see
//!          [`crate::prim::near`].
//! Room     hits: counted past the end, grown, run again.
//! Departs  what is listed is measured in f64 whatever the positions are: then the bound is that of f64.
//! Cost     8 B candidate, 12 B indices, 64 B positions (f64: 128 B; gathered), both again for what is measured, 32 B a hit; about
//!          220 operations of f32, and as many of f64 for what is measured, five of them divisions.

use super::{Entries, edge_edge_at, stride, vertex_face_at};
use crate::abi::{NearArgs, NearHit, Output, Pair, counter};
use crate::exec::{Block, Lane, RowMap};
use crate::math::{Real, Vec3};
use crate::prim::near::{Filter, Near, edge_edge, vertex_face};

/// Both kinds.
pub fn near<R: Real, B: Block>(b: &mut B, a: &NearArgs<R>) {
    each(
        b,
        (a, a.vf, a.vf_hits),
        &Filter::<R, true>::new(a.distance),
        |l, pair| {
            let (v, [x, y, z]) = vertex_face_at(l, (a.positions, a.faces), pair);
            [v, x, y, z]
        },
        |[v, x, y, z]| vertex_face(v, [x, y, z], a.distance),
    );
    each(
        b,
        (a, a.ee, a.ee_hits),
        &Filter::<R, false>::new(a.distance),
        |l, pair| {
            let [[x, y], [z, w]] = edge_edge_at(l, (a.positions, a.edges), pair);
            [x, y, z, w]
        },
        |[x, y, z, w]| edge_edge([x, y], [z, w], a.distance),
    );
}

/// One kind: filters the candidates of each stretch, and measures what is kept.
#[inline(always)]
fn each<R: Real, B: Block, M: RowMap<Row = [Vec3<R>; 4]>>(
    b: &mut B,
    (a, pairs, hits): (&NearArgs<R>, Output<Pair>, Output<NearHit>),
    filter: &M,
    gather: impl Fn(&B::Lane, Pair) -> [Vec3<R>; 4],
    measure: impl Fn([Vec3<R>; 4]) -> Option<Near>,
) {
    let count = pairs.listed(b);
    let mut entries = Entries::new(b);
    stride(b, count, |b, base| {
        b.map_rows(
            filter,
            |l| {
                let i = base + l.lane();
                (i < count).then(|| pairs.get(l, i))
            },
            |l, pair| Some(gather(l, pair)),
            |l, told| {
                let kept = told.filter(|(_, keep)| *keep != 0).map(|(pair, _)| pair);
                let hit = kept.and_then(|pair| {
                    let near = measure(gather(l, pair))?;
                    if !near.certain {
                        a.counters.add(l, counter::UNRESOLVED, 1);
                    }
                    Some(NearHit { a: pair.a, b: pair.b, squared: near.squared, at: near.at })
                });
                entries.set(l, hit);
            },
        );
        entries.append(b, hits);
    });
}
