//! # Turning: features of triangle pairs of bodies that turn, unless planes keep them apart
//! Paper    not in the paper.
//! Launch   a warp a block, as many as run at once. [`chords()`] over all pairs, then [`features()`] over
//!          those that it leaves. Only in a step in which a body may turn.
//! Reads    pairs, what they own, bodies that turn; [`chords()`] positions of both frames,
//!          [`features()`] points at rest and vertices.
//! Writes   vertex/face and edge/edge pairs; [`chords()`] also pairs that leave their chords far.
//! Before   pairs are complete: volumes hold the paths, and all within the gap of them.
//! After    {pairs of features within the gap on their true paths, each at its owners} ⊆ listed.
//!          Whether a pair is listed depends on its own triangles and bodies alone.
//! Room     all lists: counted past the end, grown, run again.
//! Cost     8 B pair, 128 B of what they own, and [`chords()`] 88 B of each of two bodies and 64 B of
//!          each of six vertices (gathered). Some 2,000 operations of f32, three times as many of
//!          triangles that go past each other by more than three eighths of an edge. [`features()`]: 160 B of
//!          each body and 24 B a vertex; some 1,500 operations, half of them in f32. Those that one
//!          window does not decide take four times as many if both turn by more than 3 degrees.

use super::super::divide::seen;
use super::super::features::owned;
use super::sides;
use crate::abi::{Facet, Pair, TurningFeaturesArgs};
use crate::bvh::turns::{body_of, turning};
use crate::exec::entries::{Entries, stride};
use crate::exec::{Block, Lane, WARP};
use crate::math::Vec3;
use crate::prim::balls::stay_apart;
use crate::prim::turning::apart::Course;
use crate::prim::turning::chords;
use crate::queue::listing::{FeatureLists, Listing, listing_bytes};
use crate::queue::waiting::{Waiting, waiting_bytes};

/// Lanes of a block: one warp.
pub const LANES: u32 = WARP;
/// Bytes of shared memory of a block of [`chords()`]: tests that are to be listed.
pub const SHARED_OF_CHORDS: u32 = listing_bytes(LANES);
/// That of [`features()`], where pairs wait too.
pub const SHARED: u32 = waiting_bytes(LANES) + listing_bytes(LANES);

/// The lists of a launch.
fn lists(args: &TurningFeaturesArgs) -> FeatureLists {
    FeatureLists { facets: args.facets, vf: args.vf, ee: args.ee }
}

#[inline(always)]
fn facets<L: Lane>(lane: &L, args: &TurningFeaturesArgs, pair: Pair) -> [Facet; 2] {
    [pair.a, pair.b].map(|triangle| lane.read(args.facets, triangle))
}

/// The tests that the triangles of each pair own, unless the features stay apart by their chords. Pairs
/// that leave these far go to another list.
pub fn chords<B: Block>(block: &mut B, args: &TurningFeaturesArgs) {
    let (count, lists) = (args.pairs.listed(block), lists(args));
    let (mut listing, mut far) = (Listing::new(block), Entries::new(block));
    stride(block, count, |block, base| {
        block.phase(|lane| {
            let i = base + lane.lane();
            let pair = (i < count).then(|| sorted(args.pairs.get(lane, i)));
            let open = pair.map_or(Some(0), |pair| open_by_chords(lane, args, pair));
            far.set(lane, pair.filter(|_| open.is_none()));
            listing.set(lane, open.unwrap_or(0));
        });
        far.append(block, args.far);
        listing.put(block, &lists, |lane, i| sorted(args.pairs.get(lane, base + i)));
    });
}

/// The pair with the smaller number first. In another order the last bits differ, and what is left
/// with them.
#[inline(always)]
fn sorted(pair: Pair) -> Pair {
    if pair.a < pair.b { pair } else { Pair { a: pair.b, b: pair.a } }
}

/// Those tests of a pair whose features may meet. `None` if its triangles leave their chords far.
#[inline(always)]
fn open_by_chords<L: Lane>(lane: &L, args: &TurningFeaturesArgs, pair: Pair) -> Option<u32> {
    let [p, q] = facets(lane, args, pair);
    let seen = |facet: &Facet| {
        let record = turning(lane, args.frames.turns, facet.corners[0]);
        seen(lane, &args.frames, facet, record)
    };
    let ((a, s), (b, t)) = (seen(&p), seen(&q));
    chords::open(&a, &b, (s as f64 + t as f64, args.gap), owned(&p, &q))
}

/// The tests that the triangles of each pair own, unless the triangles or the features stay apart in
/// the frame of one body. Many pairs end in one window of the whole step. The others wait on chip
/// until there is one a lane.
#[inline(always)]
pub fn features<B: Block>(block: &mut B, args: &TurningFeaturesArgs) {
    let (count, lanes) = (args.pairs.listed(block), block.lanes());
    let share = block.share(count, lanes);
    let (mut waiting, mut listing, lists) = (Waiting::new(block), Listing::new(block), lists(args));
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
                let pair = (lane.lane() < some).then(|| waiting.get(lane, from + lane.lane()));
                listing.set(lane, pair.map_or(0, |pair| open(lane, args, pair)));
            });
            listing.put(block, &lists, |lane, i| waiting.get(lane, from + i));
        }
        if is_end & waiting.is_empty() {
            break;
        }
        base = if is_end { base } else { base + share.step };
    }
}

/// Whether the triangles of a pair do not stay apart for a reason that is quickly found.
#[inline(always)]
fn may_meet<L: Lane>(lane: &L, args: &TurningFeaturesArgs, pair: Pair) -> bool {
    let [p, q] = facets(lane, args, pair);
    let tests = owned(&p, &q);
    let [a, b] = sides(lane, (&args.frames, args.rest), &p.corners, &q.corners);
    match Course::new(&a, &b) {
        Some(course) if course.turns_far() => !stay_apart(&a, &b, args.gap),
        Some(course) => !course.are_apart(args.gap, tests),
        None => true,
    }
}

/// Those tests of a pair whose features may meet.
#[inline(always)]
fn open<L: Lane>(lane: &L, args: &TurningFeaturesArgs, pair: Pair) -> u32 {
    let [p, q] = facets(lane, args, pair);
    let [a, b] = sides(lane, (&args.frames, args.rest), &p.corners, &q.corners);
    let tests = owned(&p, &q);
    Course::new(&a, &b).map_or(tests, |course| course.open_in_halves(args.gap, tests))
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
