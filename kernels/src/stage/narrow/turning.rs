//! # Turning: pairs of triangles of bodies that turn → proven contacts
//! Paper    not in the paper. The motion is that of FCL's and parry's interpolations; the proof is
//!          [`crate::prim::turning`].
//! Launch   [`features()`] over the pairs, which leaves out triangles and features in balls that
//!          stay apart; then [`solve`] over its lists, both kinds in one launch. A lane a pair; a
//!          grid of any size strides. Only in a step in which a body may turn.
//! Reads    pairs, their features, bodies that turn, points at rest and vertices; tolerances of
//!          bodies, if they differ.
//! Writes   contacts and undecided pairs with bounds of toi; or the earliest.
//! Before   pairs are complete: volumes hold the paths, and all within a tolerance of them.
//! After    {pairs that meet on their true paths} ⊆ listed; no time is late.
//! Room     pairs, hits: counted past the end, grown, run again.
//! Cost     8 B pair, 160 B each of two bodies and 24 B a vertex (gathered). About 15 slices a pair,
//!          each 40 ns on a CPU.

use super::climb::emit;
use super::features::{VERTICES, owned, two_edges, vertex_and_face};
use super::{of_edge_edge, of_vertex_face, stride};
use crate::abi::{Output, Pair, Point, Positions, Span, TurnRecord, TurningArgs, TurningFeaturesArgs};
use crate::bvh::turns::body_of;
use crate::exec::{Block, Lane};
use crate::math::{Vec3, pick, rigid};
use crate::prim::balls::stay_apart;
use crate::prim::turning::{Side, edge_edge, vertex_face};

/// The tests that the triangles of each pair own, unless the triangles or the features stay apart.
pub fn features<B: Block>(block: &mut B, args: &TurningFeaturesArgs) {
    each(block, args.pairs, |lane, pair| {
        let facet = |triangle| lane.read(args.facets, triangle);
        let (p, q) = (facet(pair.a), facet(pair.b));
        let mut mask = owned(&p, &q);
        if mask == 0 {
            return;
        }
        let [a, b] = sides(lane, (&args.frames, args.rest), [&p.corners, &q.corners]);
        if stay_apart(&a, &b, args.gap) {
            return;
        }
        while mask != 0 {
            let test = mask.trailing_zeros();
            mask &= mask - 1;
            let (of_a, of_b) = parts(&a, &b, test);
            if stay_apart(&of_a, &of_b, args.gap) {
                continue;
            }
            if VERTICES >> test & 1 == 1 {
                args.vf.push(lane, vertex_and_face(facet, pair, test));
            } else {
                args.ee.push(lane, two_edges(facet, pair, test - 6));
            }
        }
    });
}

/// Runs `body` for each pair of a list, a lane each, in a grid of any size.
#[inline(always)]
fn each<B: Block>(block: &mut B, pairs: Output<Pair>, mut body: impl FnMut(&B::Lane, Pair)) {
    let count = pairs.listed(block);
    stride(block, count, |block, base| {
        block.phase(|lane| {
            let i = base + lane.lane();
            if i < count {
                body(lane, pairs.get(lane, i));
            }
            lane.meet();
        });
    });
}

/// The features of a test, see [`owned`], each as three points: a vertex thrice, or the ends of an
/// edge and the middle between them.
#[inline(always)]
fn parts(a: &Side, b: &Side, test: u32) -> (Side, Side) {
    let vertex = |side: &Side, k: u32| Side { points: [pick(side.points, k); 3], ..*side };
    let edge = |side: &Side, k: u32| {
        let [x, y, z] = side.points;
        let ends = [pick([x, y, z], k), pick([y, z, x], k)];
        let middle = [0, 1].map(|end| (ends[0][end] + ends[1][end]) * 0.5);
        Side { points: [ends[0], ends[1], middle], ..*side }
    };
    if test < 3 {
        (vertex(a, test), *b)
    } else if test < 6 {
        (*a, vertex(b, test - 3))
    } else {
        (edge(a, (test - 6) / 3), edge(b, (test - 6) % 3))
    }
}

/// The contacts of both kinds.
pub fn solve<B: Block>(block: &mut B, args: &TurningArgs) {
    let rung = &args.rung;
    let places = (&rung.frames, args.rest);
    each(block, rung.vf.pairs, |lane, pair| {
        let face = lane.read(rung.faces, pair.b);
        let [v, f] = sides(lane, places, [&[pair.a], &face]);
        let verdict = vertex_face(&v, &f, &of_vertex_face(lane, rung, pair));
        emit(lane, rung, &rung.vf, pair, verdict);
    });
    each(block, rung.ee.pairs, |lane, pair| {
        let ends = [pair.a, pair.b].map(|edge| lane.read(rung.edges, edge));
        let [a, b] = sides(lane, places, [&ends[0], &ends[1]]);
        let verdict = edge_edge(&a, &b, &of_edge_edge(lane, rung, pair));
        emit(lane, rung, &rung.ee, pair, verdict);
    });
}

/// The motions of two features, each of one body. Vertices that do not turn are seen from the
/// pivot of the others, so that nothing far from the origin is rounded but their difference.
#[inline(always)]
fn sides<L: Lane>(
    lane: &L,
    (frames, rest): (&Positions<f64>, Span<Point<f64>>),
    features: [&[u32]; 2],
) -> [Side; 2] {
    let bodies = features.map(|vertices| body_of(lane, frames.turns, vertices[0]));
    [0, 1].map(|i| {
        let others = bodies[1 - i].unwrap_or_default();
        let mut points = [[Vec3([0.0; 3]); 2]; 3];
        let Some(own) = bodies[i] else {
            let pivot = others.path.map(Vec3);
            for (point, &vertex) in points.iter_mut().zip(features[i]) {
                let ends = lane.read(frames.moving, vertex);
                *point = [ends.t0.at - pivot[0], ends.t1.at - pivot[1]];
            }
            return Side { phi: Vec3([0.0; 3]), pivot, points };
        };
        for (point, &vertex) in points.iter_mut().zip(features[i]) {
            *point = [turned(&own, lane.read(rest, own.rest + (vertex - own.vertex)).at); 2];
        }
        Side { phi: Vec3(own.turn), pivot: own.path.map(Vec3), points }
    })
}

/// A point of a mesh from the pivot, turned as at the start of the step.
#[inline(always)]
fn turned(body: &TurnRecord, at_rest: Vec3<f64>) -> Vec3<f64> {
    rigid::moved(&rigid::rows(body.rotation), &[0.0; 3], at_rest - Vec3(body.pivot))
}
