//! # Climb: vertex/face and edge/edge pairs → proven contacts; the rest, for the next rung
//! Paper    not in the paper.
//! Launch   [`isolate()`] in f32 over the survivors, then [`isolate_and_settle()`] in f64 over the
//!          rest (or one of them over all), then the slices of [`super::slice`] over the rest of
//!          that. If f32 is all, [`settle`] over what it leaves. A separation has rungs of its own:
//!          [`super::abreast`], then [`super::separate`].
//!          A query of what approaches has the first rung twice at the same time, over the two lists
//!          that [`super::approach`] leaves. Both append to the same lists.
//!          If f64 has a long list, it settles no pair: [`settle`] does, before the slices, in full
//!          warps.
//!          A lane a pair, both kinds in one launch. A block takes tiles of one kind; a grid of any
//!          size strides. In f64 it is as many blocks of one warp as run at once: few pairs are
//!          left, and they are spread over all of them, 16 lanes of a warp at least.
//!          The sample of an earliest query only wants a bound: f64 ends at once if f32 has found a
//!          time. Whether it has does not depend on the order.
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
//! Room     hits, left, asked: counted past the end, grown, run again.
//! Cost     8 B pair, 12 B indices, 128 B positions (gathered). Isolation: about 1,100 operations
//!          for a pair with a root, as many in f64. There instructions are few, and waiting for
//!          their code and for each other is the time.
//!          Settling: some 30 exact signs for pairs that may touch at the start.

use super::{edge_edge, lower, of_edge_edge, of_vertex_face, vertex_face};
use crate::abi::{Counter, Hit, Listed, Output, Pair, RungArgs, RungFlags, counter, earliest};
use crate::exec::{Block, Lane, Slot};
use crate::math::Real;
use crate::prim::inclusion::{Grid, Params, Verdict};
use crate::prim::isolate::ladder::{
    ee_settled, ee_touch, isolated, isolated_last, may_settle, settled, vf_settled, vf_touch,
};
use crate::prim::isolate::{self, Edges, Face};

/// Isolation of roots in f32, positions in R. With [`RungFlags::EVERYTHING`] it accepts any
/// contact.
pub fn isolate<R: Real, B: Block>(block: &mut B, args: &RungArgs<R>) {
    let last = args.flags.has(RungFlags::EVERYTHING);
    rung(
        block,
        args,
        |lane, pair| {
            let (p, (v, f)) =
                (of_vertex_face(lane, args, pair), vertex_face(lane, &args.frames, args.faces, pair));
            let pair = Face::<f32>::new(v, f, &p);
            unless_later(lane, args, &pair, |pair| isolated(pair, &p, last).into())
        },
        |lane, pair| {
            let (p, [x, y]) =
                (of_edge_edge(lane, args, pair), edge_edge(lane, &args.frames, args.edges, pair));
            let pair = Edges::<f32>::new(x, y, &p);
            unless_later(lane, args, &pair, |pair| isolated(pair, &p, last).into())
        },
    );
}

/// Isolation of roots in f64, positions in R; then touching at the start, and flat motion.
#[inline(always)]
pub fn isolate_and_settle<R: Real, B: Block>(block: &mut B, args: &RungArgs<R>) {
    let vf = |lane: &B::Lane, pair| {
        (of_vertex_face(lane, args, pair), vertex_face(lane, &args.frames, args.faces, pair))
    };
    let ee = |lane: &B::Lane, pair| {
        (of_edge_edge(lane, args, pair), edge_edge(lane, &args.frames, args.edges, pair))
    };
    if args.flags.has(RungFlags::UNLESS_MARKED) && block.load(args.earliest, earliest::MARK) == 0 {
        return;
    }
    let counts = [args.vf.pairs, args.ee.pairs].map(|of| of.listed(block));
    let [vf_tiles, ee_tiles] = dealt(block, counts, FEWEST);
    let is_long = vf_tiles.count as u64 + ee_tiles.count as u64 > LONG;
    let is_deferred = is_long && args.flags.has(RungFlags::DEFERS);
    let open = Settle {
        count: counter::VF_OPEN,
        asked: is_deferred.then_some(args.vf_asked),
        settle: |lane: &B::Lane, pair, apart| {
            let (p, (v, f)) = vf(lane, pair);
            vf_settled(v, f, apart, p)
        },
    };
    each(block, args, (&args.vf, vf_tiles), Some(open), |lane, pair| {
        let (p, (v, f)) = vf(lane, pair);
        let pair = Face::<f64>::new(v, f, &p);
        unless_later(lane, args, &pair, |pair| in_double(pair, &p))
    });
    let open = Settle {
        count: counter::EE_OPEN,
        asked: is_deferred.then_some(args.ee_asked),
        settle: |lane: &B::Lane, pair, apart| {
            let (p, [x, y]) = ee(lane, pair);
            ee_settled(x, y, apart, p)
        },
    };
    each(block, args, (&args.ee, ee_tiles), Some(open), |lane, pair| {
        let (p, [x, y]) = ee(lane, pair);
        let pair = Edges::<f64>::new(x, y, &p);
        unless_later(lane, args, &pair, |pair| in_double(pair, &p))
    });
}

#[inline(always)]
fn in_double<const N: usize>(pair: &isolate::Pair<f64, N>, p: &Params) -> Tested {
    match isolated_last(pair, p) {
        Ok(verdict) => Tested::Verdict(verdict),
        Err(apart) if may_settle(pair, apart) => Tested::Settle { apart },
        Err(_) => Tested::Open,
    }
}

/// Touching at the start, and flat motion: for pairs that f64 asks for. With
/// [`RungFlags::EVERYTHING`] all that isolation in f32 leaves, if there is no other rung: also
/// directions, and nearness.
pub fn settle<R: Real, B: Block>(block: &mut B, args: &RungArgs<R>) {
    let all = args.flags.has(RungFlags::EVERYTHING);
    rung(
        block,
        args,
        |lane, pair| {
            let (p, (v, f)) =
                (of_vertex_face(lane, args, pair), vertex_face(lane, &args.frames, args.faces, pair));
            let pair = Face::<f64>::new(v, f, &p);
            unless_later(lane, args, &pair, |pair| settled(pair, || vf_touch(v, f), all, &p).ok().into())
        },
        |lane, pair| {
            let (p, [x, y]) =
                (of_edge_edge(lane, args, pair), edge_edge(lane, &args.frames, args.edges, pair));
            let pair = Edges::<f64>::new(x, y, &p);
            unless_later(lane, args, &pair, |pair| settled(pair, || ee_touch(x, y), all, &p).ok().into())
        },
    );
}

/// The test. It is "separated" if only the earliest is wanted and no verdict of the pair begins
/// before a known time.
#[inline(always)]
fn unless_later<R: Real, S: Grid, L: Lane, const N: usize>(
    lane: &L,
    args: &RungArgs<R>,
    pair: &isolate::Pair<S, N>,
    test: impl FnOnce(&isolate::Pair<S, N>) -> Tested,
) -> Tested {
    if !args.earliest.is_empty()
        && let Some(window) = pair.window()
        && earliest::key(pair.not_before(window), false) >= lane.fetch_load(args.earliest, earliest::KEY)
    {
        return Tested::Verdict(Verdict::separated(args.params.end, 0));
    }
    test(pair)
}

/// The result of a rung for a pair.
#[derive(Clone, Copy)]
pub(super) enum Tested {
    /// Decided.
    Verdict(Verdict),
    /// Left to the next rung.
    Open,
    /// Not decided by isolation; perhaps by [`Settle`].
    Settle {
        /// Whether the features are certainly apart at the start.
        apart: bool,
    },
}

impl From<Option<Verdict>> for Tested {
    #[inline(always)]
    fn from(verdict: Option<Verdict>) -> Self {
        verdict.map_or(Tested::Open, Tested::Verdict)
    }
}

/// How the pairs of a kind are treated that isolation leaves. All are counted. Those that ask for
/// it are settled, in a phase that reads a pair again: they are few, and the others keep their
/// registers. Or they are listed in `asked`, for a launch of their own.
struct Settle<F> {
    count: Counter,
    asked: Option<Output<Pair>>,
    settle: F,
}

/// The tiles of a kind for a block.
#[derive(Clone, Copy)]
pub(super) struct Tiles {
    /// How many pairs there are.
    pub count: u32,
    /// The block's first tile; then one a grid on.
    pub first: u32,
    /// How many pairs a tile has.
    pub width: u32,
}

/// Deals pairs to blocks in tiles: those of vertices and faces, then those of edges, a block's
/// tiles a grid apart. A tile has as many pairs as a block has lanes, or down to the fewest: a short
/// list is spread over the grid, and each block has a tile at most. Then few lanes of a warp wait
/// for each other.
#[inline(always)]
pub(super) fn dealt<B: Block>(block: &B, [vf, ee]: [u32; 2], fewest: u32) -> [Tiles; 2] {
    let (block_at, blocks, lanes) = (block.block(), block.blocks(), block.lanes());
    // Each kind may have a tile that is not full.
    let even = || (vf as u64 + ee as u64).div_ceil(blocks.max(3) as u64 - 2);
    let width = if fewest < lanes { even().clamp(fewest as u64, lanes as u64) as u32 } else { lanes };
    let behind = vf.div_ceil(width) % blocks;
    let first = if block_at < behind { block_at + blocks - behind } else { block_at - behind };
    [Tiles { count: vf, first: block_at, width }, Tiles { count: ee, first, width }]
}

/// Least pairs of a tile. With fewer, more warps fetch the same code at different times, which
/// costs more than they save (measured: `benches/NOTES.md`).
pub(super) const FEWEST: u32 = 16;

/// More pairs than this are a long list. As many run at once on a GPU of 128 processors, so each
/// warp takes one tile of a shorter list. A warp waits for its slowest lane, and pairs settle in
/// very different times. At rest 67,366 pairs settled in 600 us in this launch, and in 170 us in
/// their own (measured: `benches/NOTES.md`). The number decides where a pair is settled, never how.
const LONG: u64 = 1 << 15;

/// The fate of a pair: nothing, [`LISTED`] or [`LEFT`]. Both are counted in one word.
const LISTED: u32 = 1;
const LEFT: u32 = 1 << 16;

/// Tests each pair of both kinds.
#[inline(always)]
pub(super) fn rung<R: Real, B: Block>(
    block: &mut B,
    args: &RungArgs<R>,
    vf: impl Fn(&B::Lane, Pair) -> Tested,
    ee: impl Fn(&B::Lane, Pair) -> Tested,
) {
    let counts = [args.vf.pairs, args.ee.pairs].map(|of| of.listed(block));
    let [vf_tiles, ee_tiles] = dealt(block, counts, block.lanes());
    let none = || None::<Settle<fn(&B::Lane, Pair, bool) -> Option<Verdict>>>;
    each(block, args, (&args.vf, vf_tiles), none(), vf);
    each(block, args, (&args.ee, ee_tiles), none(), ee);
}

/// Tests each pair of one kind. Lists undecided pairs and contacts; leaves pairs without an answer
/// to the next rung.
#[inline(always)]
fn each<R: Real, B: Block>(
    block: &mut B,
    args: &RungArgs<R>,
    (of, tiles): (&Listed, Tiles),
    open: Option<Settle<impl Fn(&B::Lane, Pair, bool) -> Option<Verdict>>>,
    test: impl Fn(&B::Lane, Pair) -> Tested,
) {
    let Tiles { count, first, width } = tiles;
    let stride = block.blocks() * width;
    let mut hits = block.slot(Hit::default());
    let mut wishes = block.slot(0u32);
    let mut places = block.slot(0u32);
    let mut asks = block.slot(0u32);
    let mut opened = block.slot(0u32);
    let is_deferred = open.as_ref().is_some_and(|open| open.asked.is_some());
    let mut base = first * width;
    while base < count {
        block.phase(|lane| {
            let i = base + lane.lane();
            let (mut wish, mut is_open, mut ask) = (0, false, 0);
            if lane.lane() < width && i < count {
                let pair = of.pairs.get(lane, i);
                let found = test(lane, pair);
                let verdict = if let Tested::Verdict(verdict) = found { Some(verdict) } else { None };
                *hits.of(lane) = Hit { a: pair.a, b: pair.b, verdict: verdict.unwrap_or_default() };
                is_open = verdict.is_none();
                if let Tested::Settle { apart } = found {
                    ask = 1 + apart as u32;
                }
                wish = match verdict {
                    None if ask > 0 && is_deferred => 0,
                    None => LEFT,
                    Some(verdict) if keep(lane, args, verdict) => LISTED,
                    Some(_) => 0,
                };
            }
            *wishes.of(lane) = wish;
            *places.of(lane) = wish;
            *asks.of(lane) = ask;
            *opened.of(lane) = is_open as u32;
            lane.meet();
        });
        if let Some(Settle { settle, asked: None, .. }) = &open {
            block.phase(|lane| {
                let ask = *asks.of(lane);
                if ask > 0 {
                    let hit = hits.of(lane);
                    if let Some(verdict) = settle(lane, Pair { a: hit.a, b: hit.b }, ask > 1) {
                        hit.verdict = verdict;
                        let wish = if keep(lane, args, verdict) { LISTED } else { 0 };
                        *wishes.of(lane) = wish;
                        *places.of(lane) = wish;
                    }
                }
                lane.meet();
            });
        }
        let total = block.scan(&mut places);
        let wanted = [(total & (LEFT - 1)) as u64, (total / LEFT) as u64];
        let mut deferred = None;
        if let Some(Settle { count, asked, .. }) = &open {
            let opened = block.scan(&mut opened);
            args.counters.add_once(block, *count, opened as u64);
            deferred = asked.map(|asked| (asked, asked.reserve(block, opened as u64 - wanted[1])));
        }
        let [start, start_left] = block.reserve_both([of.hits.count(), of.left.count()], wanted);
        block.phase(|lane| {
            let (wish, before, hit) = (*wishes.of(lane), *places.of(lane), *hits.of(lane));
            let place = start + (before & (LEFT - 1)) as u64;
            if wish == LISTED {
                of.hits.put(lane, place, hit);
            }
            let left_before = (before / LEFT) as u64;
            if wish == LEFT {
                of.left.put(lane, start_left + left_before, Pair { a: hit.a, b: hit.b });
            }
            if let Some((asked, first)) = deferred
                && *asks.of(lane) > 0
            {
                // Those that isolation leaves are left, or ask.
                let before = *opened.of(lane) as u64 - left_before;
                asked.put(lane, first + before, Pair { a: hit.a, b: hit.b });
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
        if args.flags.has(RungFlags::MARKS) && lane.fetch_load(args.earliest, earliest::MARK) != 0 {
            lane.fetch_min(args.earliest, earliest::MARK, 0);
        }
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
