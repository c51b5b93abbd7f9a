//! # Exclude: pairs of features, or of triangles → those that the scene does not exclude
//! Paper    not in the paper.
//! Launch   a lane a pair; a grid of any size strides. Only in a scene that excludes some: behind
//!          the cull, before a solver; behind the signs of triangles. Near looks its pairs up
//!          itself, once they are measured ([`super::near`]).
//! Reads    pairs, their vertices, the tables.
//! Writes   pairs, in no order.
//! Before   pairs are listed. Ranges of partners ascend.
//! After    kept = {(a, b) in pairs : not excluded(a, b)}. A pair is excluded in three cases.
//!          (1) Some vertex of a and some vertex of b are partners.
//!          (2) Both are of one body with a rest shape, and as computed in f64 they are nearer
//!              there than its distance ([`crate::prim::near`], [`crate::prim::nearest`]).
//!          (3) a or b is a face that takes no part.
//!          Vertices and edges of such faces alone have no owner, so no list has them.
//! Room     kept: counted past the end, grown, run again.
//! Cost     8 B pair, 24 B indices. For each of 4 pairs of vertices (vertex/face: 3, triangles: 9)
//!          8 B of a range, and log2 of the partners reads of 4 B. With a rest shape 128 B of
//!          vertices, gathered, and some 200 operations of f64; for two triangles 4,000.

use crate::abi::{ExcludeArgs, ExcludeTrianglesArgs, ExclusionTables, Pair, Span};
use crate::bvh::filter::{holder, is_left_out};
use crate::exec::entries::append_each;
use crate::exec::{Block, Lane};
use crate::math::Vec3;
use crate::prim::near::distance;
use crate::prim::nearest::Nearest;

/// Both kinds of pairs of features.
pub fn exclude<B: Block>(block: &mut B, args: &ExcludeArgs) {
    let count = args.vf.listed(block);
    append_each(block, count, args.kept_vf, |lane, i| {
        let pair = args.vf.get(lane, i);
        (!vertex_face(lane, &args.tables, args.faces, pair)).then_some(pair)
    });
    let count = args.ee.listed(block);
    append_each(block, count, args.kept_ee, |lane, i| {
        let pair = args.ee.get(lane, i);
        (!edge_edge(lane, &args.tables, args.edges, pair)).then_some(pair)
    });
}

/// Pairs of triangles.
pub fn exclude_triangles<B: Block>(block: &mut B, args: &ExcludeTrianglesArgs) {
    let count = args.pairs.listed(block);
    append_each(block, count, args.kept, |lane, i| {
        let pair = args.pairs.get(lane, i);
        (!triangles(lane, &args.tables, args.faces, pair)).then_some(pair)
    });
}

/// Whether a vertex and a face are excluded.
#[inline(always)]
pub fn vertex_face<L: Lane>(lane: &L, tables: &ExclusionTables, faces: Span<[u32; 3]>, pair: Pair) -> bool {
    let face = lane.read(faces, pair.b);
    let near = |within: f64| {
        let corners = [pair.a, face[0], face[1], face[2]].map(|vertex| at_rest(lane, tables, vertex));
        distance::<f64, true>(corners).0 < within
    };
    takes_no_part(lane, tables, pair.b)
        || are_partners(lane, tables, &[pair.a], &face)
        || rest_shape(lane, tables, [pair.a, face[0]]).is_some_and(near)
}

/// Whether two edges are excluded.
#[inline(always)]
pub fn edge_edge<L: Lane>(lane: &L, tables: &ExclusionTables, edges: Span<[u32; 2]>, pair: Pair) -> bool {
    let [a, b] = [pair.a, pair.b].map(|edge| lane.read(edges, edge));
    let near = |within: f64| {
        let ends = [a[0], a[1], b[0], b[1]].map(|vertex| at_rest(lane, tables, vertex));
        distance::<f64, false>(ends).0 < within
    };
    are_partners(lane, tables, &a, &b) || rest_shape(lane, tables, [a[0], b[0]]).is_some_and(near)
}

/// Whether two triangles are excluded.
#[inline(always)]
fn triangles<L: Lane>(lane: &L, tables: &ExclusionTables, faces: Span<[u32; 3]>, pair: Pair) -> bool {
    let [a, b] = [pair.a, pair.b].map(|face| lane.read(faces, face));
    let near = |within: f64| {
        let [p, q] = [a, b].map(|face| face.map(|vertex| at_rest(lane, tables, vertex)));
        Nearest::meeting(&p, &q).distance < within
    };
    takes_no_part(lane, tables, pair.a)
        || takes_no_part(lane, tables, pair.b)
        || are_partners(lane, tables, &a, &b)
        || rest_shape(lane, tables, [a[0], b[0]]).is_some_and(near)
}

/// Whether a face takes no part.
#[inline(always)]
fn takes_no_part<L: Lane>(lane: &L, tables: &ExclusionTables, face: u32) -> bool {
    !tables.faces.is_empty() && lane.read(tables.faces, face / 32) >> (face % 32) & 1 != 0
}

/// Whether a vertex of one feature is a partner of one of the other.
#[inline(always)]
fn are_partners<L: Lane, const M: usize, const N: usize>(
    lane: &L,
    tables: &ExclusionTables,
    a: &[u32; M],
    b: &[u32; N],
) -> bool {
    if tables.partners.is_empty() {
        return false;
    }
    let mut i = 0;
    while i < M {
        let mut k = 0;
        while k < N {
            if is_left_out(a[i], b[k], |word| lane.read(tables.partners, word)) {
                return true;
            }
            k += 1;
        }
        i += 1;
    }
    false
}

/// The distance of the rest shape that two vertices have in common, if it excludes any pair.
#[inline(always)]
fn rest_shape<L: Lane>(lane: &L, tables: &ExclusionTables, [p, q]: [u32; 2]) -> Option<f64> {
    if tables.rest.is_empty() {
        return None;
    }
    let within = lane.read(tables.rest, p).within;
    // All vertices of a body have the same distance.
    if within <= 0.0 || lane.read(tables.rest, q).within != within {
        return None;
    }
    let body =
        |vertex: u32| holder(tables.bodies.len(), vertex, |body| lane.read(tables.bodies, body).vertex);
    (body(p) == body(q)).then_some(within)
}

/// The place of a vertex in the rest shape of its body.
#[inline(always)]
fn at_rest<L: Lane>(lane: &L, tables: &ExclusionTables, vertex: u32) -> Vec3<f64> {
    lane.read(tables.rest, vertex).at
}
