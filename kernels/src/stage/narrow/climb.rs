//! # Climb: vertex/face and edge/edge pairs → contacts, proven, with bounds of their first time; what is left, for the next rung
//! Paper    none: beyond it.
//! Launch   [`isolate()`] in f32 over what may meet, then in f64 over what that left (or in one of them over all); [`settle`]
//!          over what isolation left; the slices of [`super::slice`] over the rest. With a separation [`separate_at_once`] over
//!          all candidates, then [`super::separate`]. A lane a pair, both kinds in one launch: a block takes tiles of one kind; a
//!          grid of any size strides.
//! Reads    pairs, faces or edges, positions of both frames (four vertices); tolerances of bodies, if they differ.
//! Writes   contacts and unresolved pairs with toi and toi_hi; or, when only the earliest is asked for, one number. And what
//!          is left, in its own list.
//! Before   candidates are complete.
//! After    every pair that meets is listed here or left, none late; see [`crate::prim::isolate`].
//!          earliest = min {(toi, undecided) of each pair of the continuous query}. A pair is skipped if no verdict of
//!          its own could begin before a time that is known ([`Pair::not_before`](isolate::Pair::not_before)): the
//!          result is the same in any order.
//! Room     hits, left: counted past the end, grown, run again.
//! Cost     8 B pair, 12 B indices, 128 B positions (gathered); isolation about 1,100 operations for a pair with a root, of
//!          f64 as many; settling some 30 exact signs for what touches at the start; the first planes of a separation
//!          400 operations.

use super::{edge_edge, lower, of_edge_edge, of_vertex_face, vertex_face};
use crate::abi::{Hit, Listed, Pair, RungArgs, RungFlags, counter, earliest};
use crate::exec::{Block, Lane, Slot};
use crate::math::Real;
use crate::prim::inclusion::{Grid, Verdict};
use crate::prim::isolate::ladder::{ee_touch, isolated, settled, vf_touch};
use crate::prim::isolate::separation::at_once;
use crate::prim::isolate::{self, Edges, Face};

/// Isolation of roots, positions in R, computed in S.
pub fn isolate<R: Real, S: Grid, B: Block>(b: &mut B, a: &RungArgs<R>) {
    let last = a.flags.has(RungFlags::EVERYTHING);
    rung(
        b,
        a,
        |l, pair| {
            let (p, (v, f)) = (of_vertex_face(l, a, pair), vertex_face(l, (&a.frames, a.faces), pair));
            let pair = Face::<S>::new(v, f, &p);
            unless_later(l, a, &pair, |pair| isolated(pair, &p, last))
        },
        |l, pair| {
            let (p, [x, y]) = (of_edge_edge(l, a, pair), edge_edge(l, (&a.frames, a.edges), pair));
            let pair = Edges::<S>::new(x, y, &p);
            unless_later(l, a, &pair, |pair| isolated(pair, &p, last))
        },
    );
}

/// Touching at the start, and what is flat; with [`RungFlags::EVERYTHING`] all that is left.
pub fn settle<R: Real, B: Block>(b: &mut B, a: &RungArgs<R>) {
    let all = a.flags.has(RungFlags::EVERYTHING);
    rung(
        b,
        a,
        |l, pair| {
            let (p, (v, f)) = (of_vertex_face(l, a, pair), vertex_face(l, (&a.frames, a.faces), pair));
            let pair = Face::<f64>::new(v, f, &p);
            unless_later(l, a, &pair, |pair| settled(pair, || vf_touch(v, f), all, &p).ok())
        },
        |l, pair| {
            let (p, [x, y]) = (of_edge_edge(l, a, pair), edge_edge(l, (&a.frames, a.edges), pair));
            let pair = Edges::<f64>::new(x, y, &p);
            unless_later(l, a, &pair, |pair| settled(pair, || ee_touch(x, y), all, &p).ok())
        },
    );
}

/// The first rung of a separation, in f32.
pub fn separate_at_once<R: Real, B: Block>(b: &mut B, a: &RungArgs<R>) {
    rung(
        b,
        a,
        |l, pair| {
            let (p, (v, f)) = (of_vertex_face(l, a, pair), vertex_face(l, (&a.frames, a.faces), pair));
            at_once(&Face::new(v, f, &p), &p)
        },
        |l, pair| {
            let (p, [x, y]) = (of_edge_edge(l, a, pair), edge_edge(l, (&a.frames, a.edges), pair));
            at_once(&Edges::new(x, y, &p), &p)
        },
    );
}

/// The verdict; separated if only the earliest is asked for and no verdict of the pair begins before one that is known.
#[inline(always)]
fn unless_later<R: Real, S: Grid, L: Lane, const N: usize>(
    l: &L,
    a: &RungArgs<R>,
    pair: &isolate::Pair<S, N>,
    ask: impl FnOnce(&isolate::Pair<S, N>) -> Option<Verdict>,
) -> Option<Verdict> {
    if !a.earliest.is_empty()
        && let Some(window) = pair.window()
        && earliest::key(pair.not_before(window), false) >= l.fetch_load(a.earliest, earliest::KEY)
    {
        return Some(Verdict::separated(a.params.end, 0));
    }
    ask(pair)
}

/// What becomes of a pair: nothing, [`LISTED`] or [`LEFT`]; both are counted in one word.
const LISTED: u32 = 1;
const LEFT: u32 = 1 << 16;

/// Asks each pair of both kinds. The kinds begin at opposite ends of the grid, so that short lists are spread over it.
#[inline(always)]
fn rung<R: Real, B: Block>(
    b: &mut B,
    a: &RungArgs<R>,
    vf: impl Fn(&B::Lane, Pair) -> Option<Verdict>,
    ee: impl Fn(&B::Lane, Pair) -> Option<Verdict>,
) {
    let (first, blocks) = (b.block(), b.blocks());
    each(b, (a, &a.vf), first, vf);
    each(b, (a, &a.ee), blocks - 1 - first, ee);
}

/// Asks each pair of one kind; lists what is unresolved or in contact, and leaves to the next rung what has no answer.
#[inline(always)]
fn each<R: Real, B: Block>(
    b: &mut B,
    (a, of): (&RungArgs<R>, &Listed),
    first: u32,
    ask: impl Fn(&B::Lane, Pair) -> Option<Verdict>,
) {
    let (lanes, stride) = (b.lanes(), b.blocks() * b.lanes());
    let count = of.pairs.listed(b);
    let mut hits = b.slot(Hit::default());
    let mut wishes = b.slot(0u32);
    let mut places = b.slot(0u32);
    let mut base = first * lanes;
    while base < count {
        b.phase(|l| {
            let i = base + l.lane();
            let mut wish = 0;
            if i < count {
                let pair = of.pairs.get(l, i);
                let told = ask(l, pair);
                *hits.of(l) = Hit { a: pair.a, b: pair.b, verdict: told.unwrap_or_default() };
                wish = match told {
                    None => LEFT,
                    Some(verdict) if keep(l, a, verdict) => LISTED,
                    Some(_) => 0,
                };
            }
            *wishes.of(l) = wish;
            *places.of(l) = wish;
            l.meet();
        });
        let total = b.scan(&mut places);
        let wanted = [(total & (LEFT - 1)) as u64, (total / LEFT) as u64];
        let [start, start_left] = b.reserve_both([of.hits.count(), of.left.count()], wanted);
        b.phase(|l| {
            let (wish, before, hit) = (*wishes.of(l), *places.of(l), *hits.of(l));
            let place = start + (before & (LEFT - 1)) as u64;
            if wish == LISTED {
                of.hits.put(l, place, hit);
            }
            let place = start_left + (before / LEFT) as u64;
            if wish == LEFT {
                of.left.put(l, place, Pair { a: hit.a, b: hit.b });
            }
            l.meet();
        });
        base += stride;
    }
}

/// Lists an answer that is to be listed; a lane by itself.
#[inline(always)]
pub(super) fn emit<R: Real, L: Lane>(l: &L, a: &RungArgs<R>, of: &Listed, (pair, verdict): (Pair, Verdict)) {
    if keep(l, a, verdict) {
        of.hits.push(l, Hit { a: pair.a, b: pair.b, verdict });
    }
}

/// Whether a verdict is to be listed. Counts what is unresolved, or lowers the earliest time if only that is asked for: then
/// which pairs have a verdict depends on the order, so none is counted.
#[inline(always)]
fn keep<R: Real, L: Lane>(l: &L, a: &RungArgs<R>, verdict: Verdict) -> bool {
    if verdict.is_separated() {
        return false;
    }
    if !a.earliest.is_empty() {
        lower(l, a.earliest, verdict);
        return false;
    }
    if !verdict.is_contact() {
        a.counters.add(l, counter::UNRESOLVED, 1);
    }
    if verdict.exhausted() {
        a.counters.add(l, counter::ENDED, 1);
        a.counters.add(l, counter::ENDED_UNRESOLVED, !verdict.is_contact() as u64);
    }
    true
}
