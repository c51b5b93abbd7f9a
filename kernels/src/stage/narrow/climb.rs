//! # Climb: vertex/face and edge/edge pairs → proven contacts; the rest, for the next rung
//! Paper    not in the paper.
//! Launch   [`isolate()`] in f32 over the survivors, then in f64 over the rest (or in one of them
//!          over all). [`settle`] over the rest of that.
//!          Then the slices of [`super::slice`] over the rest of that. A separation has rungs of its
//!          own: [`super::abreast`], then [`super::separate`].
//!          A lane a pair, both kinds in one launch. A block takes tiles of one kind; a grid of any
//!          size strides.
//! Reads    pairs, faces or edges, positions of both frames (four vertices); tolerances of bodies,
//!          if they differ.
//! Writes   contacts and undecided pairs with bounds of toi; or one number, for an earliest query.
//!          The rest, in its own list.
//! Before   candidates are complete.
//! After    {pairs that meet} ⊆ listed ∪ left; no time is late. See [`crate::prim::isolate`].
//!          earliest = min {(toi, undecided) of each pair of the continuous query}.
//!          A pair is skipped if none of its verdicts could begin before a known time
//!          ([`Pair::not_before`](isolate::Pair::not_before)).
//!          So the result is the same in any order.
//! Room     hits, left: counted past the end, grown, run again.
//! Cost     8 B pair, 12 B indices, 128 B positions (gathered). Isolation: about 1,100 operations
//!          for a pair with a root, as many in f64.
//!          Settling: some 30 exact signs for pairs that touch at the start.

use super::{edge_edge, lower, of_edge_edge, of_vertex_face, vertex_face};
use crate::abi::{Hit, Listed, Pair, RungArgs, RungFlags, counter, earliest};
use crate::exec::{Block, Lane, Slot};
use crate::math::Real;
use crate::prim::inclusion::{Grid, Verdict};
use crate::prim::isolate::ladder::{ee_touch, isolated, settled, vf_touch};
use crate::prim::isolate::{self, Edges, Face};

/// Isolation of roots, positions in R, computed in S.
pub fn isolate<R: Real, S: Grid, B: Block>(block: &mut B, args: &RungArgs<R>) {
    let last = args.flags.has(RungFlags::EVERYTHING);
    rung(
        block,
        args,
        |lane, pair| {
            let (p, (v, f)) =
                (of_vertex_face(lane, args, pair), vertex_face(lane, &args.frames, args.faces, pair));
            let pair = Face::<S>::new(v, f, &p);
            unless_later(lane, args, &pair, |pair| isolated(pair, &p, last))
        },
        |lane, pair| {
            let (p, [x, y]) =
                (of_edge_edge(lane, args, pair), edge_edge(lane, &args.frames, args.edges, pair));
            let pair = Edges::<S>::new(x, y, &p);
            unless_later(lane, args, &pair, |pair| isolated(pair, &p, last))
        },
    );
}

/// Touching at the start, and flat motion; with [`RungFlags::EVERYTHING`] all that is left.
pub fn settle<R: Real, B: Block>(block: &mut B, args: &RungArgs<R>) {
    let all = args.flags.has(RungFlags::EVERYTHING);
    rung(
        block,
        args,
        |lane, pair| {
            let (p, (v, f)) =
                (of_vertex_face(lane, args, pair), vertex_face(lane, &args.frames, args.faces, pair));
            let pair = Face::<f64>::new(v, f, &p);
            unless_later(lane, args, &pair, |pair| settled(pair, || vf_touch(v, f), all, &p).ok())
        },
        |lane, pair| {
            let (p, [x, y]) =
                (of_edge_edge(lane, args, pair), edge_edge(lane, &args.frames, args.edges, pair));
            let pair = Edges::<f64>::new(x, y, &p);
            unless_later(lane, args, &pair, |pair| settled(pair, || ee_touch(x, y), all, &p).ok())
        },
    );
}

/// The verdict. It is "separated" if only the earliest is wanted and no verdict of the pair begins
/// before a known time.
#[inline(always)]
fn unless_later<R: Real, S: Grid, L: Lane, const N: usize>(
    lane: &L,
    args: &RungArgs<R>,
    pair: &isolate::Pair<S, N>,
    test: impl FnOnce(&isolate::Pair<S, N>) -> Option<Verdict>,
) -> Option<Verdict> {
    if !args.earliest.is_empty()
        && let Some(window) = pair.window()
        && earliest::key(pair.not_before(window), false) >= lane.fetch_load(args.earliest, earliest::KEY)
    {
        return Some(Verdict::separated(args.params.end, 0));
    }
    test(pair)
}

/// The fate of a pair: nothing, [`LISTED`] or [`LEFT`]. Both are counted in one word.
const LISTED: u32 = 1;
const LEFT: u32 = 1 << 16;

/// Tests each pair of both kinds. The kinds begin at opposite ends of the grid, so short lists
/// spread over it.
#[inline(always)]
fn rung<R: Real, B: Block>(
    block: &mut B,
    args: &RungArgs<R>,
    vf: impl Fn(&B::Lane, Pair) -> Option<Verdict>,
    ee: impl Fn(&B::Lane, Pair) -> Option<Verdict>,
) {
    let (first, blocks) = (block.block(), block.blocks());
    each(block, args, &args.vf, first, vf);
    each(block, args, &args.ee, blocks - 1 - first, ee);
}

/// Tests each pair of one kind. Lists undecided pairs and contacts; leaves pairs without an answer
/// to the next rung.
#[inline(always)]
fn each<R: Real, B: Block>(
    block: &mut B,
    args: &RungArgs<R>,
    of: &Listed,
    first: u32,
    test: impl Fn(&B::Lane, Pair) -> Option<Verdict>,
) {
    let (lanes, stride) = (block.lanes(), block.blocks() * block.lanes());
    let count = of.pairs.listed(block);
    let mut hits = block.slot(Hit::default());
    let mut wishes = block.slot(0u32);
    let mut places = block.slot(0u32);
    let mut base = first * lanes;
    while base < count {
        block.phase(|lane| {
            let i = base + lane.lane();
            let mut wish = 0;
            if i < count {
                let pair = of.pairs.get(lane, i);
                let answer = test(lane, pair);
                *hits.of(lane) = Hit { a: pair.a, b: pair.b, verdict: answer.unwrap_or_default() };
                wish = match answer {
                    None => LEFT,
                    Some(verdict) if keep(lane, args, verdict) => LISTED,
                    Some(_) => 0,
                };
            }
            *wishes.of(lane) = wish;
            *places.of(lane) = wish;
            lane.meet();
        });
        let total = block.scan(&mut places);
        let wanted = [(total & (LEFT - 1)) as u64, (total / LEFT) as u64];
        let [start, start_left] = block.reserve_both([of.hits.count(), of.left.count()], wanted);
        block.phase(|lane| {
            let (wish, before, hit) = (*wishes.of(lane), *places.of(lane), *hits.of(lane));
            let place = start + (before & (LEFT - 1)) as u64;
            if wish == LISTED {
                of.hits.put(lane, place, hit);
            }
            let place = start_left + (before / LEFT) as u64;
            if wish == LEFT {
                of.left.put(lane, place, Pair { a: hit.a, b: hit.b });
            }
            lane.meet();
        });
        base += stride;
    }
}

/// Lists an answer that is to be listed; a lane by itself.
#[inline(always)]
pub(super) fn emit<R: Real, L: Lane>(
    lane: &L,
    args: &RungArgs<R>,
    of: &Listed,
    pair: Pair,
    verdict: Verdict,
) {
    if keep(lane, args, verdict) {
        of.hits.push(lane, Hit { a: pair.a, b: pair.b, verdict });
    }
}

/// Whether to list a verdict. Counts the undecided, or lowers the earliest time if only that is
/// wanted. Then the pairs with a verdict depend on the order, so none is counted.
#[inline(always)]
fn keep<R: Real, L: Lane>(lane: &L, args: &RungArgs<R>, verdict: Verdict) -> bool {
    if verdict.is_separated() {
        return false;
    }
    if !args.earliest.is_empty() {
        lower(lane, args.earliest, verdict);
        return false;
    }
    if !verdict.is_contact() {
        args.counters.add(lane, counter::UNDECIDED, 1);
    }
    if verdict.exhausted() {
        args.counters.add(lane, counter::ENDED, 1);
        args.counters.add(lane, counter::ENDED_UNDECIDED, !verdict.is_contact() as u64);
    }
    true
}
