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
use crate::math::{Vec3, rigid};
use crate::prim::balls::stay_apart;
use crate::prim::turning::apart::{open, turn_far};
use crate::prim::turning::{Side, edge_edge, vertex_face};

/// The tests that the triangles of each pair own, unless the triangles or the features stay apart.
pub fn features<B: Block>(block: &mut B, args: &TurningFeaturesArgs) {
    each(block, args.pairs, |lane, pair| {
        let facet = |triangle| lane.read(args.facets, triangle);
        let pair = in_order(lane, args, pair);
        let (p, q) = (facet(pair.a), facet(pair.b));
        let tests = owned(&p, &q);
        if tests == 0 {
            return;
        }
        let [a, b] = sides(lane, (&args.frames, args.rest), &p.corners, &q.corners);
        if turn_far(&a, &b) && stay_apart(&a, &b, args.gap) {
            return;
        }
        let mut open = open(&a, &b, args.gap, tests);
        while open != 0 {
            let test = open.trailing_zeros();
            open &= open - 1;
            if VERTICES >> test & 1 == 1 {
                args.vf.push(lane, vertex_and_face(facet, pair, test));
            } else {
                args.ee.push(lane, two_edges(facet, pair, test - 6));
            }
        }
    });
}

/// The pair with the triangle that turns more first, or the one with the smaller number if both
/// turn alike. In any order the same is proven, but up to the last bits, and with them what is left.
#[inline(always)]
fn in_order<L: Lane>(lane: &L, args: &TurningFeaturesArgs, pair: Pair) -> Pair {
    let square = |triangle| {
        let body = body_of(lane, args.frames.turns, lane.read(args.facets, triangle).corners[0]);
        body.map_or(0.0, |body| Vec3(body.turn).dot(Vec3(body.turn)))
    };
    let (a, b) = (square(pair.a), square(pair.b));
    let is_first = a > b || (a == b && pair.a < pair.b);
    if is_first { pair } else { Pair { a: pair.b, b: pair.a } }
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

/// The contacts of both kinds.
pub fn solve<B: Block>(block: &mut B, args: &TurningArgs) {
    let rung = &args.rung;
    let places = (&rung.frames, args.rest);
    each(block, rung.vf.pairs, |lane, pair| {
        let face = lane.read(rung.faces, pair.b);
        let [v, f] = sides(lane, places, &[pair.a], &face);
        let verdict = vertex_face(&v, &f, &of_vertex_face(lane, rung, pair));
        emit(lane, rung, &rung.vf, pair, verdict);
    });
    each(block, rung.ee.pairs, |lane, pair| {
        let ends = [pair.a, pair.b].map(|edge| lane.read(rung.edges, edge));
        let [a, b] = sides(lane, places, &ends[0], &ends[1]);
        let verdict = edge_edge(&a, &b, &of_edge_edge(lane, rung, pair));
        emit(lane, rung, &rung.ee, pair, verdict);
    });
}

/// The motions of two features, each of one body. Vertices that do not turn are seen from the
/// pivot of the others, so that nothing far from the origin is rounded but their difference.
#[inline(always)]
fn sides<L: Lane, const P: usize, const Q: usize>(
    lane: &L,
    places: (&Positions<f64>, Span<Point<f64>>),
    p: &[u32; P],
    q: &[u32; Q],
) -> [Side; 2] {
    let turns = places.0.turns;
    let (a, b) = (body_of(lane, turns, p[0]), body_of(lane, turns, q[0]));
    [side(lane, places, p, (&a, &b)), side(lane, places, q, (&b, &a))]
}

/// The motion of a feature of a body that turns, or of another one against a body that does.
#[inline(always)]
fn side<L: Lane, const N: usize>(
    lane: &L,
    (frames, rest): (&Positions<f64>, Span<Point<f64>>),
    vertices: &[u32; N],
    (own, other): (&Option<TurnRecord>, &Option<TurnRecord>),
) -> Side {
    let mut points = [[Vec3([0.0; 3]); 2]; 3];
    let Some(own) = own else {
        let pivot = other.map_or([Vec3([0.0; 3]); 2], |other| other.path.map(Vec3));
        for k in 0..N {
            let ends = lane.read(frames.moving, vertices[k]);
            points[k] = [ends.t0.at - pivot[0], ends.t1.at - pivot[1]];
        }
        return Side { phi: Vec3([0.0; 3]), pivot, points };
    };
    for k in 0..N {
        points[k] = [turned(own, lane.read(rest, own.rest + (vertices[k] - own.vertex)).at); 2];
    }
    Side { phi: Vec3(own.turn), pivot: own.path.map(Vec3), points }
}

/// A point of a mesh from the pivot, turned as at the start of the step.
#[inline(always)]
fn turned(body: &TurnRecord, at_rest: Vec3<f64>) -> Vec3<f64> {
    rigid::moved(&rigid::rows(body.rotation), &[0.0; 3], at_rest - Vec3(body.pivot))
}
