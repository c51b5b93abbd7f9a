//! # Near: vertex/face and edge/edge candidates → those within a distance, at rest
//! Paper    not in the paper. The paper's distance query returns one number for two models; this
//!          one every pair of features.
//! Launch   a lane a candidate, both kinds in one launch; a grid of any size strides. First in f32,
//!          on a CPU in vectors.
//!          The same lane measures the rest in f64. Numbering these first, within a stretch of a
//!          block of 128, takes a third longer on an H200 (`benches/NOTES.md`).
//!          With exclusions a warp a block, as many blocks as are resident. There the rest wait on
//!          chip until there is one a lane: a measured pair costs more.
//!          Vertices with a thickness have two launches of their own, see [`thick`].
//! Reads    candidates, faces or edges, positions (four vertices).
//! Writes   pairs with squared distance and nearest points; the number of pairs that are not
//!          certainly within the distance.
//! Before   candidates are complete. Positions are finite. distance > 0.
//! After    hits ⊇ {candidates within the distance}, less those that the scene excludes
//!          ([`super::exclude`]). None is farther by more than the rounding of f64, see
//!          [`crate::prim::near`].
//! Room     hits: counted past the end, grown, run again. Pairs that wait: less than one a lane
//!          is left when a stretch adds at most one a lane, so two a lane are always enough.
//! Departs  pairs are measured in f64 for positions of either precision, so the bound is that of
//!          f64.
//! Cost     8 B candidate, 12 B indices, 64 B positions (f64: 128 B; gathered), again for each
//!          measured pair; 32 B a hit.
//!          About 220 operations of f32, and as many of f64 for a measured pair, five of them
//!          divisions.

pub mod thick;

use super::{Entries, edge_edge_at, exclude, stride, vertex_face_at};
use crate::abi::{Counters, NearArgs, NearExcludingArgs, NearHit, Output, Pair, counter};
use crate::exec::{ALONE, Block, Lane, RowMap, WARP};
use crate::math::Real;
use crate::prim::near::{Filter, Near, edge_edge, vertex_face};
use crate::queue::waiting::{Waiting, waiting_bytes};

/// Lanes of a block whose pairs wait: one warp, whose barriers and numbering cost next to nothing.
pub const LANES: u32 = WARP;
/// Bytes of shared memory of such a block.
pub const SHARED: u32 = waiting_bytes(LANES);
/// Stretches of neighbours that such a block takes in sequence: neighbours share vertices.
const RUN: u32 = 4;

/// Both kinds.
pub fn near<R: Real, B: Block>(block: &mut B, args: &NearArgs<R>) {
    both(block, args, None, |_, _| false, |_, _| false);
}

/// Both kinds, without pairs that the scene excludes. They are looked up once measured, when few are
/// left.
pub fn near_excluding<R: Real, B: Block>(block: &mut B, args: &NearExcludingArgs<R>) {
    let NearExcludingArgs { near, tables } = args;
    let mut waiting = Waiting::new(block);
    both(
        block,
        near,
        Some(&mut waiting),
        |lane: &B::Lane, pair| exclude::vertex_face(lane, tables, near.faces, pair),
        |lane: &B::Lane, pair| exclude::edge_edge(lane, tables, near.edges, pair),
    );
}

/// Both kinds, without pairs that are excluded. With a place to wait, pairs wait there before they
/// are measured.
#[inline(always)]
fn both<R: Real, B: Block>(
    block: &mut B,
    args: &NearArgs<R>,
    mut waiting: Option<&mut Waiting<B>>,
    excludes_vf: impl Fn(&B::Lane, Pair) -> bool,
    excludes_ee: impl Fn(&B::Lane, Pair) -> bool,
) {
    each(
        block,
        waiting.as_deref_mut(),
        (args.vf, args.vf_hits, args.counters),
        &Filter::<R, true>::new(args.distance),
        |lane, pair| {
            let (v, [x, y, z]) = vertex_face_at(lane, args.positions, args.faces, pair);
            [v, x, y, z]
        },
        |lane, pair, [v, x, y, z]| {
            vertex_face(v, [x, y, z], args.distance).filter(|_| !excludes_vf(lane, pair))
        },
    );
    each(
        block,
        waiting,
        (args.ee, args.ee_hits, args.counters),
        &Filter::<R, false>::new(args.distance),
        |lane, pair| {
            let [[x, y], [z, w]] = edge_edge_at(lane, args.positions, args.edges, pair);
            [x, y, z, w]
        },
        |lane, pair, [x, y, z, w]| {
            edge_edge([x, y], [z, w], args.distance).filter(|_| !excludes_ee(lane, pair))
        },
    );
}

/// The lists of one kind: candidates, hits, and the frame's counters.
type Lists = (Output<Pair>, Output<NearHit>, Counters);

/// One kind: filters the candidates of each stretch, and measures the rest.
#[inline(always)]
fn each<B: Block, M: RowMap>(
    block: &mut B,
    waiting: Option<&mut Waiting<B>>,
    (pairs, hits, counters): Lists,
    filter: &M,
    gather: impl Fn(&B::Lane, Pair) -> M::Row,
    measure: impl Fn(&B::Lane, Pair, M::Row) -> Option<Near>,
) {
    if let Some(waiting) = waiting {
        return in_full_warps(block, waiting, (pairs, hits, counters), filter, gather, measure);
    }
    let count = pairs.listed(block);
    let mut entries = Entries::new(block);
    stride(block, count, |block, base| {
        block.map_rows(
            filter,
            |lane| {
                let i = base + lane.lane();
                (i < count).then(|| pairs.get(lane, i))
            },
            |lane, pair| Some(gather(lane, pair)),
            |lane, result| {
                let kept = result.filter(|(_, keep)| *keep != 0).map(|(pair, _)| pair);
                let hit = kept.and_then(|pair| {
                    let near = measure(lane, pair, gather(lane, pair))?;
                    Some(counted(lane, counters, pair, near))
                });
                entries.set(lane, hit);
            },
        );
        entries.append(block, hits);
    });
}

/// The row of a pair, counted if it is not decided.
#[inline(always)]
fn counted<L: Lane>(lane: &L, counters: Counters, pair: Pair, near: Near) -> NearHit {
    if !near.certain {
        counters.add(lane, counter::UNDECIDED, 1);
    }
    NearHit { a: pair.a, b: pair.b, squared: near.squared, at: near.at }
}

/// As [`each`], but the rest wait until there is one a lane, and are measured together. Else a warp
/// takes as long for its one pair as for 32.
///
/// A turn adds at most one a lane and takes out as many, if they are there. So the last turn, which
/// adds none, empties the list.
#[inline(always)]
fn in_full_warps<B: Block, M: RowMap>(
    block: &mut B,
    waiting: &mut Waiting<B>,
    (pairs, hits, counters): Lists,
    filter: &M,
    gather: impl Fn(&B::Lane, Pair) -> M::Row,
    measure: impl Fn(&B::Lane, Pair, M::Row) -> Option<Near>,
) {
    let (count, lanes) = (pairs.listed(block), block.lanes());
    let share = block.share(count, RUN * lanes);
    if ALONE && share.is_empty() {
        return;
    }
    let mut entries = Entries::new(block);
    let (mut base, mut turn, end) = (share.first as u64, 0, share.end as u64);
    // One place in the code for each step, or the compiler puts it out of line: so the last turn
    // has no new pairs.
    loop {
        let is_end = base >= end;
        block.map_rows(
            filter,
            |lane| {
                let i = base + lane.lane() as u64;
                (i < end).then(|| pairs.get(lane, i as u32))
            },
            |lane, pair| Some(gather(lane, pair)),
            |lane, result| {
                waiting.set(lane, result.and_then(|(pair, keep)| (keep != 0).then_some(pair)));
            },
        );
        waiting.add(block);
        let (from, some) = waiting.take(block, is_end);
        if some > 0 {
            block.phase(|lane| {
                let mine = (lane.lane() < some).then(|| waiting.get(lane, from + lane.lane()));
                let hit = mine.and_then(|pair| {
                    let near = measure(lane, pair, gather(lane, pair))?;
                    Some(counted(lane, counters, pair, near))
                });
                entries.set(lane, hit);
            });
            entries.append(block, hits);
        }
        if is_end {
            break;
        }
        turn += 1;
        let is_run = turn % RUN != 0;
        base += if is_run { lanes as u64 } else { (share.step - (RUN - 1) * lanes) as u64 };
    }
}
