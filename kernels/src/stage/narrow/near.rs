//! # Near: vertex/face and edge/edge candidates → those within a distance, at rest
//! Paper    the distance of two triangles is the seed's other query; it answers with one number, this with every pair of features.
//! Launch   a lane a candidate, both kinds in one launch; a grid of any size strides.
//! Reads    candidates, faces or edges, positions (four vertices).
//! Writes   the pairs that are not certainly farther apart, with squared distance and where they are nearest; how many of them are
//!          not certainly within it.
//! Before   candidates are complete. Positions are finite. The distance is a number above 0.
//! After    every candidate within the distance is listed; none that is farther by more than rounding, see [`crate::prim::near`].
//! Room     hits: counted past the end, grown, run again.
//! Departs  all in f64, whatever the positions are: then the bound is that of f64, and two thirds of the candidates of real cloth are
//!          hits, so there is little to be won by a filter.
//! Cost     8 B candidate, 12 B indices, 64 B positions (f64: 128 B; gathered), 32 B a hit; about 220 operations of f64, five of them
//!          divisions.

use super::{append_each, edge_edge_at, listed, vertex_face_at};
use crate::abi::{NearArgs, NearHit, Pair, counter};
use crate::exec::{Block, Lane};
use crate::math::Real;
use crate::prim::near::{Near, edge_edge, vertex_face};

/// Both kinds.
pub fn near<R: Real, B: Block>(b: &mut B, a: &NearArgs<R>) {
    let count = listed(b, a.vf, a.counters, counter::VF);
    append_each(b, count, (a.vf_hits, a.counters, counter::VF_HITS), |l, i| {
        let pair = l.read(a.vf, i);
        let (v, f) = vertex_face_at(l, (a.positions, a.faces), pair);
        hit(l, a, pair, vertex_face(v, f, a.distance)?)
    });
    let count = listed(b, a.ee, a.counters, counter::EE);
    append_each(b, count, (a.ee_hits, a.counters, counter::EE_HITS), |l, i| {
        let pair = l.read(a.ee, i);
        let [x, y] = edge_edge_at(l, (a.positions, a.edges), pair);
        hit(l, a, pair, edge_edge(x, y, a.distance)?)
    });
}

/// What is listed; counts what is not certain.
#[inline(always)]
fn hit<R: Real, L: Lane>(l: &L, a: &NearArgs<R>, pair: Pair, near: Near) -> Option<NearHit> {
    if !near.certain {
        l.fetch_add(a.counters, counter::UNRESOLVED, 1);
    }
    Some(NearHit { a: pair.a, b: pair.b, squared: near.squared, at: near.at })
}
