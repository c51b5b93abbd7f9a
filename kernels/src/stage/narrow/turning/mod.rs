//! # Turning: pairs of triangles of bodies that turn → proven contacts
//! Paper    not in the paper. The motion is that of FCL's and parry's interpolations; the proof is
//!          [`crate::prim::turning`].
//! Launch   [`features`] first; then [`common`] over its lists with one slice, [`common`] over what
//!          that leaves with all, and [`solve`] over the rest. Each has both kinds in one
//!          launch: as many blocks of one warp as run at once. In `common` a lane has a pair; in
//!          `solve` it takes the next one when its walk has ended. With a separation `solve` has all
//!          pairs. Only in a step in which a body may turn.
//! Reads    pairs of features, bodies that turn, points at rest and vertices; tolerances of bodies, if
//!          they differ.
//! Writes   contacts and undecided pairs with bounds of toi; or the earliest.
//! Before   pairs are complete: volumes hold the paths, and all within a tolerance of them.
//! After    {pairs that meet on their true paths} ⊆ listed; no time is late.
//!          earliest = min {(toi, undecided) of each pair of the continuous query}: a walk ends if
//!          all before a known time is clear. So the result is the same in any order.
//! Room     pairs, hits, left: counted past the end, grown, run again.
//! Cost     8 B pair, 160 B each of two bodies and 24 B a vertex (gathered). A pair: about 8 places
//!          and one slice in `common`, 6 slices and 17 places in `solve`.

pub mod features;

use super::climb::{self, Tested, emit};
use super::{of_edge_edge, of_vertex_face};
use crate::abi::{Listed, Pair, Point, Positions, RungArgs, Span, TurnRecord, TurningArgs, earliest};
use crate::bvh::turns::body_of;
use crate::exec::{Block, Lane, Slot};
use crate::math::{Vec3, rigid};
use crate::prim::inclusion::{Params, Verdict};
use crate::prim::turning::{Motion, Side, Walk};

/// Turns that lanes take before those whose walks have ended take new pairs, at least. A pair of
/// features takes some 20.
const TURNS: u32 = 4;

/// The verdicts of both kinds in the common case; the other pairs are left.
pub fn common<B: Block>(block: &mut B, args: &TurningArgs) {
    let rung = &args.rung;
    let places = (&rung.frames, args.rest);
    climb::rung(
        block,
        rung,
        |lane, pair| unless_late(lane, rung, || of_face(lane, rung, places, pair)),
        |lane, pair| unless_late(lane, rung, || of_edges(lane, rung, places, pair)),
    );
}

/// The common case of a pair, unless every verdict is late. All its slices decide whether it has one,
/// so no other time may end it.
#[inline(always)]
fn unless_late<L: Lane, const N: usize>(
    lane: &L,
    args: &RungArgs<f64>,
    motion: impl FnOnce() -> (Motion<N>, Params),
) -> Tested {
    if is_late(lane, args, 0.0) {
        return Tested::Verdict(Verdict::separated(args.params.end, 0));
    }
    let (motion, params) = motion();
    motion.common(&params).into()
}

/// The contacts of both kinds.
pub fn solve<B: Block>(block: &mut B, args: &TurningArgs) {
    let rung = &args.rung;
    let places = (&rung.frames, args.rest);
    walk_all(block, rung, &rung.vf, |lane, pair| of_face(lane, rung, places, pair));
    walk_all(block, rung, &rung.ee, |lane, pair| of_edges(lane, rung, places, pair));
}

/// Places of vertices in the step, and without a pose.
type Places<'a> = (&'a Positions<f64>, Span<Point<f64>>);

/// The motion of a vertex and a face, and its parameters.
#[inline(always)]
fn of_face<L: Lane>(lane: &L, args: &RungArgs<f64>, places: Places, pair: Pair) -> (Motion<3>, Params) {
    let face = lane.read(args.faces, pair.b);
    let [v, f] = sides(lane, places, &[pair.a], &face);
    (Motion::new(&v, &f), of_vertex_face(lane, args, pair))
}

/// The motion of two edges, and its parameters.
#[inline(always)]
fn of_edges<L: Lane>(lane: &L, args: &RungArgs<f64>, places: Places, pair: Pair) -> (Motion<4>, Params) {
    let ends = [pair.a, pair.b].map(|edge| lane.read(args.edges, edge));
    let [a, b] = sides(lane, places, &ends[0], &ends[1]);
    (Motion::of_edges(&a, &b), of_edge_edge(lane, args, pair))
}

/// Walks through the step with each pair of a kind. Lanes take turns together; those whose walks
/// have ended take the block's next pairs together.
#[inline(always)]
fn walk_all<B: Block, const N: usize>(
    block: &mut B,
    args: &RungArgs<f64>,
    of: &Listed,
    begin: impl Fn(&B::Lane, Pair) -> (Motion<N>, Params),
) {
    // Walks of few pairs are spread over all blocks: lanes of a warp that do not walk do not wait.
    let count = of.pairs.listed(block);
    let lanes = count.div_ceil(block.blocks()).max(1).min(block.lanes());
    let share = block.share(count, lanes);
    // The first of as many pairs as lanes that walk, of which one is number `k` of the block.
    let first = |k: u64| share.first as u64 + k / lanes as u64 * share.step as u64;
    let mut motions = block.slot(Motion::<N>::default());
    let mut walks = block.slot(Walk::<N>::NONE);
    let mut pairs = block.slot(None::<Pair>);
    let mut places = block.slot(0);
    let mut taken = 0;
    let mut is_last = false;
    while !is_last {
        block.phase(|lane| {
            *places.of(lane) = pairs.of(lane).is_none() as u32;
            lane.meet();
        });
        let idle = block.number(&mut places);
        block.phase(|lane| {
            if pairs.of(lane).is_none() {
                let k = taken + *places.of(lane) as u64;
                let i = first(k) + k % lanes as u64;
                if first(k) < share.end as u64 && i < count as u64 {
                    let pair = of.pairs.get(lane, i as u32);
                    let (motion, params) = begin(lane, pair);
                    *motions.of(lane) = motion;
                    match walks.of(lane).begin(motions.of(lane), &params) {
                        Some(verdict) => emit(lane, args, of, pair, verdict),
                        None => *pairs.of(lane) = Some(pair),
                    }
                }
            }
            lane.meet();
        });
        taken += idle as u64;
        is_last = first(taken) >= share.end as u64;
        block.phase(|lane| {
            let (motion, walk, pair) = (motions.of(lane), walks.of(lane), pairs.of(lane));
            let (mut turns, mut goes_on) = (0, true);
            while goes_on {
                if let Some(of_lane) = *pair
                    && let Some(verdict) = turn(lane, args, motion, walk)
                {
                    emit(lane, args, of, of_lane, verdict);
                    *pair = None;
                }
                turns += 1;
                let is_idle = pair.is_none();
                goes_on = if is_last { lane.any(!is_idle) } else { !lane.any(is_idle & (turns >= TURNS)) };
            }
            lane.meet();
        });
    }
}

/// Whether only the earliest time is wanted, and no verdict that begins at this time would lower it.
#[inline(always)]
fn is_late<L: Lane>(lane: &L, args: &RungArgs<f64>, t: f64) -> bool {
    !args.earliest.is_empty() && earliest::key(t, false) >= lane.fetch_load(args.earliest, earliest::KEY)
}

/// A turn of a walk. It ends as separated if only the earliest time is wanted and no verdict of the
/// walk begins before a known time.
#[inline(always)]
fn turn<L: Lane, const N: usize>(
    lane: &L,
    args: &RungArgs<f64>,
    motion: &Motion<N>,
    walk: &mut Walk<N>,
) -> Option<Verdict> {
    if is_late(lane, args, walk.clear_until()) {
        return Some(Verdict::separated(args.params.end, 0));
    }
    walk.turn(motion, &args.params)
}

/// The motions of two features, each of one body. Vertices that do not turn are seen from the
/// pivot of the others, so that nothing far from the origin is rounded but their difference.
#[inline(always)]
fn sides<L: Lane, const P: usize, const Q: usize>(
    lane: &L,
    places: Places,
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
    (frames, rest): Places,
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
