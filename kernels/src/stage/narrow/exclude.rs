//! # Exclude: pairs of features, or of triangles → those that the scene does not exclude
//! Paper    not in the paper.
//! Launch   a lane a pair; a grid of any size strides. Only in a scene that excludes some: behind
//!          the cull, before a solver; behind the signs of triangles. Near looks its pairs up
//!          itself, once they are measured ([`super::near`]).
//! Reads    pairs, their vertices, the tables.
//! Writes   pairs, in no order.
//! Before   pairs are listed. Keys of partners ascend, and each of two partners has the other. The
//!          bits of a vertex are those of its partners. A reach has all features of its vertex.
//! After    kept = {(a, b) in pairs : not excluded(a, b)}. A pair is excluded in three cases.
//!          (1) Some vertex of a and some vertex of b are partners.
//!          (2) Both are of one body with a rest shape, and as computed in f64 they are nearer
//!              there than its distance ([`crate::prim::near`], [`crate::prim::nearest`]).
//!          (3) a or b is a face that takes no part.
//!          Vertices and edges of such faces alone have no owner, so no list has them.
//! Room     kept: counted past the end, grown, run again.
//! Cost     8 B pair, 24 B indices. For each vertex of the first feature 16 B of bits. A set bit
//!          takes 8 B of a range, and 4 B for each partner that may have it: two or three of 20. A
//!          clear bit decides 85 in 100 pairs of vertices. With a rest shape 32 B of two reaches.
//!          If these meet, 128 B of vertices are gathered. Boxes decide most of them: 40
//!          operations. The others take 200 of f64, two triangles 4,000.

use crate::abi::{ExcludeArgs, ExcludeTrianglesArgs, ExclusionTables, Pair, PartnerBits, Span, partner_key};
use crate::bvh::filter::{has, holder};
use crate::exec::entries::append_each;
use crate::exec::{Block, Lane};
use crate::math::tolerance::DISTANCE_LISTED;
use crate::math::{Real, Vec3};
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
        let at = |vertex| at_rest(lane, tables, vertex);
        let (p, [x, y, z]) = (at(pair.a), face.map(at));
        !are_apart(&[p], &[x, y, z], within) && distance::<f64, true>([p, x, y, z]).0 < within
    };
    takes_no_part(lane, tables, pair.b)
        || has_partner(lane, tables, pair.a, &face.map(partner_key))
        || rest_shape(lane, tables, [pair.a, face[0]]).is_some_and(near)
}

/// Whether two edges are excluded.
#[inline(always)]
pub fn edge_edge<L: Lane>(lane: &L, tables: &ExclusionTables, edges: Span<[u32; 2]>, pair: Pair) -> bool {
    let [a, b] = [pair.a, pair.b].map(|edge| lane.read(edges, edge));
    let near = |within: f64| {
        let at = |vertex| at_rest(lane, tables, vertex);
        let ([p, q], [x, y]) = (a.map(at), b.map(at));
        !are_apart(&[p, q], &[x, y], within) && distance::<f64, false>([p, q, x, y]).0 < within
    };
    let keys = b.map(partner_key);
    let has = |vertex| has_partner(lane, tables, vertex, &keys);
    has(a[0]) || has(a[1]) || rest_shape(lane, tables, [a[0], b[0]]).is_some_and(near)
}

/// Whether two triangles are excluded.
#[inline(always)]
fn triangles<L: Lane>(lane: &L, tables: &ExclusionTables, faces: Span<[u32; 3]>, pair: Pair) -> bool {
    let [a, b] = [pair.a, pair.b].map(|face| lane.read(faces, face));
    let near = |within: f64| {
        let [p, q] = [a, b].map(|face| face.map(|vertex| at_rest(lane, tables, vertex)));
        !are_apart(&p, &q, within) && Nearest::meeting(&p, &q).distance < within
    };
    let keys = b.map(partner_key);
    let has = |vertex| has_partner(lane, tables, vertex, &keys);
    takes_no_part(lane, tables, pair.a)
        || takes_no_part(lane, tables, pair.b)
        || has(a[0])
        || has(a[1])
        || has(a[2])
        || rest_shape(lane, tables, [a[0], b[0]]).is_some_and(near)
}

/// Whether a face takes no part.
#[inline(always)]
fn takes_no_part<L: Lane>(lane: &L, tables: &ExclusionTables, face: u32) -> bool {
    !tables.faces.is_empty() && lane.read(tables.faces, face / 32) >> (face % 32) & 1 != 0
}

/// Most partners that are compared one by one. A search by halves has branches that a CPU cannot
/// foresee (measured: `benches/NOTES.md`).
const FEW: u32 = 8;

/// Whether one of the vertices of a feature is a partner of a vertex, by their keys.
#[inline(always)]
fn has_partner<L: Lane, const N: usize>(
    lane: &L,
    tables: &ExclusionTables,
    vertex: u32,
    keys: &[u32; N],
) -> bool {
    if tables.partners.is_empty() {
        return false;
    }
    let bits = lane.read(tables.bits, vertex);
    let (mut found, mut k) = (false, 0);
    while k < N {
        found |= bits.has(keys[k]);
        k += 1;
    }
    if !found {
        return false;
    }
    let range = [vertex, vertex + 1].map(|word| lane.read(tables.partners, word));
    (found, k) = (false, 0);
    while k < N {
        found |=
            bits.has(keys[k]) && is_listed(bits, range, keys[k], |word| lane.read(tables.partners, word));
        k += 1;
    }
    found
}

/// Whether the keys from the first place to before the second have a key whose bit is set.
///
/// Keys ascend, and so do their bits. Each lower bit has a key before the place of this one, each
/// higher bit a key behind it. So all keys of this bit have places from the number of lower bits on.
/// The last such place is farther by the number of keys beyond one a bit.
#[inline(always)]
pub fn is_listed(bits: PartnerBits, [first, end]: [u32; 2], key: u32, word: impl Fn(u32) -> u32) -> bool {
    let mut at = first + bits.before(key);
    let last = at + (end - first - bits.count());
    if last - at >= FEW {
        return has(key, [at, last + 1], word);
    }
    let mut found = false;
    while at <= last {
        found |= word(at) == key;
        at += 1;
    }
    found
}

/// The distance of the rest shape that two vertices have in common, if it may exclude a pair of
/// their features.
#[inline(always)]
fn rest_shape<L: Lane>(lane: &L, tables: &ExclusionTables, [p, q]: [u32; 2]) -> Option<f64> {
    if tables.rest.is_empty() {
        return None;
    }
    let [own, other] = [p, q].map(|vertex| lane.read(tables.reaches, vertex));
    if own.is_apart(&other) {
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

/// Whether the boxes of two features are farther apart than a length, beyond all rounding: then the
/// computed distance is no less. The true one exceeds the length by more than a computed one errs
/// ([`crate::prim::near`]).
#[inline(always)]
fn are_apart<const M: usize, const N: usize>(a: &[Vec3<f64>; M], b: &[Vec3<f64>; N], length: f64) -> bool {
    let ([low, high], [from, to]) = (bounds(a), bounds(b));
    let gaps = (from - high).greater(low - to);
    let sides = high.greater(to) - low.lesser(from);
    let largest = |v: Vec3<f64>| v[0].greater(v[1]).greater(v[2]);
    largest(gaps) > length + DISTANCE_LISTED * (length + largest(sides))
}

/// The least and the greatest coordinates.
#[inline(always)]
fn bounds<const N: usize>(points: &[Vec3<f64>; N]) -> [Vec3<f64>; 2] {
    let (mut low, mut high, mut i) = (points[0], points[0], 1);
    while i < N {
        (low, high) = (low.lesser(points[i]), high.greater(points[i]));
        i += 1;
    }
    [low, high]
}
