//! # Turning: pairs of triangles of bodies that turn → proven contacts
//! Paper    not in the paper. The motion is that of FCL's and parry's interpolations; the proof is
//!          [`crate::prim::turning`].
//! Launch   [`features()`] over the pairs, a warp a block, which leaves out features that planes
//!          keep apart ([`crate::prim::turning::apart`]), and of bodies that turn far triangles in
//!          balls that stay apart; then [`solve`] over its lists, both kinds in one launch. A lane
//!          a pair; a grid of any size strides. Only in a step in which a body may turn.
//! Reads    pairs, their features, bodies that turn, points at rest and vertices; tolerances of
//!          bodies, if they differ.
//! Writes   contacts and undecided pairs with bounds of toi; or the earliest.
//! Before   pairs are complete: volumes hold the paths, and all within a tolerance of them.
//! After    {pairs that meet on their true paths} ⊆ listed; no time is late.
//! Room     pairs, hits: counted past the end, grown, run again.
//! Cost     8 B pair, 160 B each of two bodies and 24 B a vertex (gathered). A pair of triangles
//!          takes some 1,500 operations, half of them in f32; those that one window does not decide
//!          take them again, and three times as many. About 6 slices and 17 places a pair of
//!          features.

use super::climb::emit;
use super::features::{VERTICES, owned, two_edges, vertex_and_face};
use super::{of_edge_edge, of_vertex_face, stride};
use crate::abi::{Output, Pair, Point, Positions, Span, TurnRecord, TurningArgs, TurningFeaturesArgs};
use crate::bvh::turns::body_of;
use crate::exec::{Block, Lane, WARP};
use crate::math::{Vec3, rigid};
use crate::prim::balls::stay_apart;
use crate::prim::turning::apart::Course;
use crate::prim::turning::{Side, edge_edge, vertex_face};
use crate::queue::waiting::{Waiting, waiting_bytes};

/// Lanes of a block of [`features()`]: one warp.
pub const LANES: u32 = WARP;
/// Bytes of shared memory of a block of [`features()`]: pairs that wait.
pub const SHARED: u32 = waiting_bytes(LANES);

/// The tests that the triangles of each pair own, unless the triangles or the features stay apart.
/// Most pairs end in one window of the whole step. The others wait on chip until there is one a
/// lane.
#[inline(always)]
pub fn features<B: Block>(block: &mut B, args: &TurningFeaturesArgs) {
    let (count, lanes) = (args.pairs.listed(block), block.lanes());
    let share = block.share(count, lanes);
    let mut waiting = Waiting::new(block);
    let mut base = share.first;
    loop {
        let is_end = base >= share.end;
        block.phase(|lane| {
            let i = base + lane.lane();
            let pair = (!is_end && i < count).then(|| in_order(lane, args, args.pairs.get(lane, i)));
            waiting.set(lane, pair.filter(|&pair| may_meet(lane, args, pair)));
        });
        waiting.add(block);
        let (from, some) = waiting.take(block, is_end);
        if some > 0 {
            block.phase(|lane| {
                if lane.lane() < some {
                    list(lane, args, waiting.get(lane, from + lane.lane()));
                }
                lane.meet();
            });
        }
        if is_end & waiting.is_empty() {
            break;
        }
        base = if is_end { base } else { base + share.step };
    }
}

/// Whether a pair owns a test, and its triangles do not stay apart for a reason that is quickly
/// found.
#[inline(always)]
fn may_meet<L: Lane>(lane: &L, args: &TurningFeaturesArgs, pair: Pair) -> bool {
    let [p, q] = [pair.a, pair.b].map(|triangle| lane.read(args.facets, triangle));
    let tests = owned(&p, &q);
    if tests == 0 {
        return false;
    }
    let [a, b] = sides(lane, (&args.frames, args.rest), &p.corners, &q.corners);
    match Course::new(&a, &b) {
        Some(course) if course.turns_far() => !stay_apart(&a, &b, args.gap),
        Some(course) => !course.are_apart(args.gap, tests),
        None => true,
    }
}

/// Lists those tests of a pair whose features may meet.
#[inline(always)]
fn list<L: Lane>(lane: &L, args: &TurningFeaturesArgs, pair: Pair) {
    let facet = |triangle| lane.read(args.facets, triangle);
    let (p, q) = (facet(pair.a), facet(pair.b));
    let [a, b] = sides(lane, (&args.frames, args.rest), &p.corners, &q.corners);
    let tests = owned(&p, &q);
    let mut open = Course::new(&a, &b).map_or(tests, |course| course.open_in_halves(args.gap, tests));
    while open != 0 {
        let test = open.trailing_zeros();
        open &= open - 1;
        if VERTICES >> test & 1 == 1 {
            args.vf.push(lane, vertex_and_face(facet, pair, test));
        } else {
            args.ee.push(lane, two_edges(facet, pair, test - 6));
        }
    }
}

/// The pair with the triangle that turns more first, or the one with the smaller number if both
/// turn alike. In another order the last bits differ, and what is left with them.
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
