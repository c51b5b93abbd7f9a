//! # Bodies: candidates of instances → pairs of bodies that share a point, or their distances
//! Paper    the thesis, section 6.2, the separation distance of two models; here for each pair of
//!          bodies, with its triangles.
//! Launch   pairs that share a point: `exact`, then `meeting`, a lane a relation.
//!          Distances: `exact`, `least`, `first`, `nearest`, a lane a candidate; `exact` and once
//!          more `nearest` over candidates that were left by [`crate::stage::traverse::instances`] as
//!          it looked for bodies that share a point.
//!          A grid of any size strides.
//! Reads    candidates, pairs of tiles, relations and their words; frames and meshes.
//! Writes   words of relations; undecided candidates; pairs of bodies; the nearest triangles of
//!          each.
//! Before   candidates are those of [`crate::stage::traverse::instances`]. `pairs` of `exact` have
//!          all that signs in f64 do not decide and that come before the known ones.
//! After    exact  touching(r) ≠ 0 ⇔ a candidate of r shares a point, or it was before.
//!          Without `any`, touching(r) is the complement of the key of the first of them.
//!          meeting = {r : touching(r) ≠ 0}, as pairs of bodies.
//!          least  bound(r) = the least computed distance D of the bodies of r, if none of their
//!          triangles share a point and D ≤ the distance of the query. If all relations have one
//!          word, D is the least of all of them.
//!          first(r) = the complement of the key of the first candidate at D; 0 if there is none.
//!          nearest = {(0, p, q) : key(p, q) of touching(r)} of those that were left, and
//!          {(D, p, q) : key(p, q) of first(r)} of the others.
//!          A bound is at least D before (`crate::stage::traverse::instances::within`), and a pair
//!          at D is a candidate. Its boxes' gap is at most D
//!          ([`crate::prim::nearest`]), so it is measured whatever other lanes found before. So
//!          nothing depends on the schedule.
//! Room     lists: counted past the end, grown, run again. Words keep their values: relations have
//!          the same numbers, and a word only says what is true of its bodies.
//! Cost     8 B a candidate, 500 B gathered. 4,000 operations for a distance, if the boxes are nearer
//!          than the best known; thousands for exact signs.

use super::{append_each, stride};
use crate::abi::{BodiesNarrowArgs, NearestHit, Pair};
use crate::bvh::placing::{PlacedTriangle, candidate, first_of, key};
use crate::exec::{Block, Lane};
use crate::math::Real;
use crate::prim::nearest::{BARELY, Corners, Nearest, apart, gap};
use crate::prim::tri_tri::{Certain, meets};

/// A candidate: its relation, its triangles, and its key.
#[derive(Clone, Copy)]
struct Given {
    relation: u32,
    triangles: [PlacedTriangle; 2],
    key: u64,
}

impl Given {
    #[inline(always)]
    fn of<L: Lane>(lane: &L, args: &BodiesNarrowArgs, pair: Pair) -> Given {
        let (relation, triangles) = candidate(lane, args.relations.items(), args.tile_pairs, pair);
        let [p, q] = triangles.map(|triangle| triangle.number(lane, &args.tables));
        Given { relation, triangles, key: key(p, q) }
    }
    #[inline(always)]
    fn corners<L: Lane>(&self, lane: &L, args: &BodiesNarrowArgs) -> [Corners<f64>; 2] {
        self.triangles.map(|triangle| triangle.corners(lane, &args.tables))
    }
    /// Whether it adds nothing to what is known of its bodies.
    #[inline(always)]
    fn is_known<L: Lane>(&self, lane: &L, args: &BodiesNarrowArgs) -> bool {
        let known = lane.fetch_load(args.words.touching, self.relation);
        (known >= self.key) | ((args.any != 0) & (known != 0))
    }
    /// Its triangles share a point.
    #[inline(always)]
    fn touches<L: Lane>(&self, lane: &L, args: &BodiesNarrowArgs) {
        lane.fetch_max(args.words.touching, self.relation, self.key);
    }
    /// Whether some triangles of its bodies share a point. Nothing in this launch changes it.
    #[inline(always)]
    fn bodies_touch<L: Lane>(&self, lane: &L, args: &BodiesNarrowArgs) -> bool {
        lane.read(args.words.touching, self.relation) != 0
    }
}

/// Runs `body` for each candidate, a lane each, in a grid of any size.
#[inline(always)]
fn each<B: Block>(block: &mut B, args: &BodiesNarrowArgs, mut body: impl FnMut(&B::Lane, Given)) {
    let count = args.pairs.listed(block);
    stride(block, count, |block, base| {
        block.phase(|lane| {
            let i = base + lane.lane();
            if i < count {
                body(lane, Given::of(lane, args, args.pairs.get(lane, i)));
            }
            lane.meet();
        });
    });
}

/// Exact signs of candidates that are left.
pub fn exact<B: Block>(block: &mut B, args: &BodiesNarrowArgs) {
    each(block, args, |lane, given| {
        if !given.is_known(lane, args) && certainly_meet(given.corners(lane, args)) {
            given.touches(lane, args);
        }
    });
}

/// Whether triangles share a point. By value and out of line: few lanes come here.
#[inline(never)]
fn certainly_meet([p, q]: [Corners<f64>; 2]) -> bool {
    meets::<f64, Certain>(&p, &q) != Some(false)
}

/// Pairs of bodies that share a point.
pub fn meeting<B: Block>(block: &mut B, args: &BodiesNarrowArgs) {
    let count = args.relations.listed(block);
    append_each(block, count, args.meeting, |lane, i| {
        let [a, b] = args.relations.get(lane, i).bodies;
        (lane.read(args.words.touching, i) != 0).then_some(Pair { a, b })
    });
}

/// The least distances of bodies that share no point.
pub fn least<B: Block>(block: &mut B, args: &BodiesNarrowArgs) {
    each(block, args, |lane, given| {
        if !given.bodies_touch(lane, args) {
            let corners = given.corners(lane, args);
            if gap(&corners[0], &corners[1]) < args.words.bound(lane, given.relation) {
                args.words.lower(lane, given.relation, apart(&corners));
            }
        }
    });
}

/// The first candidates at these distances.
pub fn first<B: Block>(block: &mut B, args: &BodiesNarrowArgs) {
    each(block, args, |lane, given| {
        let known = lane.fetch_load(args.words.first, given.relation);
        if known < given.key && !given.bodies_touch(lane, args) {
            let best = args.words.still_bound(lane, given.relation);
            let corners = given.corners(lane, args);
            if gap(&corners[0], &corners[1]) <= best && apart(&corners) == best {
                lane.fetch_max(args.words.first, given.relation, given.key);
            }
        }
    });
}

/// The nearest triangles of each pair of bodies, with their nearest points.
pub fn nearest<B: Block>(block: &mut B, args: &BodiesNarrowArgs) {
    each(block, args, |lane, given| {
        let touching = lane.read(args.words.touching, given.relation);
        let meets = args.of_touching != 0;
        let is_of_these = meets == (touching != 0);
        let wanted = if meets { touching } else { lane.read(args.words.first, given.relation) };
        if is_of_these && wanted == given.key {
            args.nearest.push(lane, hit(given.key, given.corners(lane, args), meets));
        }
    });
}

/// Two triangles with their nearest points. By value and out of line: one candidate of a relation
/// comes here.
#[inline(never)]
fn hit(key: u64, triangles: [Corners<f64>; 2], meets: bool) -> NearestHit {
    let [p, q] = &triangles;
    let found = if meets { Nearest::meeting(p, q) } else { Nearest::of(p, q) };
    let distance = if meets { 0.0 } else { found.distance.greater(BARELY) };
    let points = found.points(&triangles);
    NearestHit { a: first_of(key), b: !key as u32, distance, at: found.at, points }
}
