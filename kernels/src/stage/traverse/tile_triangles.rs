//! # Triangles of tiles: pairs of tiles → candidates
//! Paper    not in the paper.
//! Launch   blocks of a warp, as many as are resident. They stride over the moving tiles, each with
//!          itself, and then the pairs of tiles.
//! Reads    32 contiguous leaves of each tile; the bodies and faces of candidate triangles.
//! Writes   candidate pairs, the smaller index first, each once, in no order.
//! Before   leaves and tiles are fitted; pairs of tiles are listed.
//! After    pairs = {(a, b) : a < b, volumes overlap, filters allow, no common vertex}.
//!          With [`TraverseFlags::KEEP_ADJACENT`] pairs with a common vertex stay. A sample
//!          restricts the set to its tiles.
//!          With a horizon: {(a, b) : volumes overlap before the horizon}.
//! Room     `pairs` may be too short: counters go on, the host grows it and runs again.
//! Cost     64 tests against the other tile. Then each leaf of one side that overlaps it, against
//!          each of the other.
//!          An atomic a warp and 512 candidates.

use crate::abi::{LEAF, MIXED, NONE, Pair, TileTrianglesArgs, TraverseFlags, counter};
use crate::bv::Volume;
use crate::bvh::horizon::Horizon;
use crate::bvh::on_chip::OnChip;
use crate::bvh::tiles::TILE;
use crate::exec::{Block, Lane, Shared, Slot};
use crate::prim::adjacent::share_a_vertex;

/// Lanes of a block.
pub const LANES: u32 = TILE;
/// Candidates collected before they are written: triangles or, for volumes tested in two parts,
/// places of leaves.
const FOUND: u32 = 512;
/// Cost of a candidate in the narrow phase, in tests of two volumes. Measured on an H200 with cloth
/// and 10 million triangles in motion. It divides work among devices. No answer depends on it.
pub const CANDIDATE: u64 = 40;
/// Set in the first triangle of a collected pair whose filters are still to be tested.
const UNTESTED: u32 = 1 << 31;

/// Shared memory of a block.
pub const fn shared_bytes<V: Volume>() -> u32 {
    OnChip::bytes::<V>(LANES) + 4 * LANES + 8 * FOUND
}

/// Two tiles, which may be one.
#[derive(Clone, Copy)]
struct Two {
    tiles: Pair,
    /// [`UNTESTED`] if one of them has triangles of more than one body.
    untested: u32,
}

impl Two {
    /// Unit `i` of the work. `None` for a tile whose triangles may not meet each other, and beyond
    /// the last unit.
    #[inline(always)]
    fn of<V: Volume, B: Block>(block: &B, args: &TileTrianglesArgs<V>, i: u64, total: u64) -> Option<Two> {
        if i >= total {
            return None;
        }
        let alone = args.alone();
        let same = i < alone;
        let tiles = if same {
            let tile = args.from + i as u32 * args.every;
            Pair { a: tile, b: tile }
        } else {
            block.load(args.tile_pairs.items(), (i - alone) as u32)
        };
        let filters = args.filters.nodes;
        if filters.is_empty() {
            return Some(Two { tiles, untested: 0 });
        }
        let [p, q] = [tiles.a, tiles.b].map(|tile| block.load(filters, tile));
        // Pairs of tiles were tested when they were listed.
        let refused = same && !p.self_collides();
        (!refused).then_some(Two { tiles, untested: if (p.who | q.who) & MIXED != 0 { UNTESTED } else { 0 } })
    }
}

impl<V: Volume> TileTrianglesArgs<V> {
    /// How many tiles are looked at with themselves.
    fn alone(&self) -> u64 {
        (self.to - self.from).div_ceil(self.every) as u64
    }
}

/// Pairs of triangles that overlap, before the horizon.
pub fn triangles<const HORIZON: bool, V: Volume, B: Block>(block: &mut B, args: &TileTrianglesArgs<V>) {
    let rows = OnChip::new::<V, B>(block, LANES);
    let ids = block.shared::<u32>(LANES);
    let found = block.shared::<[u32; 2]>(FOUND);
    let mut column = block.slot((V::zeroed(), NONE));
    let mut row = block.slot((V::zeroed(), NONE));
    let mut masks = block.slot(0u32);
    let mut counts = block.slot(0u32);
    let (mut fill, mut tests) = (0, 0u64);
    let horizon = Horizon::of(block, args.known);
    let total = args.alone() + args.tile_pairs.listed(block) as u64;
    let mut unit = block.block() as u64;
    let mut next = Two::of(block, args, unit, total);
    while unit < total {
        let two = next;
        unit += block.blocks() as u64;
        // On its way while this one is looked at.
        next = Two::of(block, args, unit, total);
        let Some(Two { tiles, untested }) = two else { continue };
        let same = tiles.a == tiles.b;
        let [first, second] =
            [tiles.a, tiles.b].map(|tile| horizon.cut::<HORIZON, V>(block.load(args.nodes, tile).volume));
        block.phase(|lane| {
            let leaf = |tile: u32| {
                let place = tile * TILE + lane.lane();
                let leaf = lane.read(args.leaves, place);
                let name = if V::IN_PARTS { place } else { leaf.link & !LEAF };
                (horizon.cut::<HORIZON, V>(leaf.volume), if leaf.link == NONE { NONE } else { name })
            };
            let ((p, own), (q, other)) = (leaf(tiles.a), leaf(tiles.b));
            let is_row = own != NONE && (same || p.may_overlap(&second));
            let is_column = other != NONE && (same || q.may_overlap(&first));
            *row.of(lane) = (p, if is_row { own | untested } else { NONE });
            *column.of(lane) = (q, if is_column { other } else { NONE });
            *counts.of(lane) = is_row as u32;
        });
        let height = block.number(&mut counts);
        block.phase(|lane| {
            let (volume, triangle) = *row.of(lane);
            if triangle != NONE {
                let at = *counts.of(lane);
                rows.put(lane, at, volume);
                lane.put(ids, at, triangle);
            }
        });
        block.phase(|lane| {
            let (volume, triangle) = *column.of(lane);
            let mut mask = 0;
            if triangle != NONE {
                // A tile with itself has each pair once: rows before the column. All its rows are
                // present.
                let height = if same { lane.lane() } else { height };
                let mut k = 0;
                while k < height {
                    mask |= (volume.may_overlap(&rows.get(lane, k)) as u32) << k;
                    k += 1;
                }
            }
            *masks.of(lane) = mask;
            *counts.of(lane) = mask.count_ones();
            lane.meet();
        });
        let tested = (2 * LANES + LANES * height) as u64;
        tests += tested;
        let count = block.scan(&mut counts);
        if !args.work.is_empty() {
            block.reserve(args.work, tiles.a, tested + CANDIDATE * count as u64);
        }
        let mut done = 0;
        while done < count {
            let now = (FOUND - fill).min(count - done);
            block.phase(|lane| {
                let (mut mask, mut at) = (*masks.of(lane), *counts.of(lane));
                while mask != 0 {
                    let k = mask.trailing_zeros();
                    mask &= mask - 1;
                    if at >= done && at < done + now {
                        lane.put(found, fill + at - done, [lane.get(ids, k), column.of(lane).1]);
                    }
                    at += 1;
                }
                lane.meet();
            });
            done += now;
            fill += now;
            if fill == FOUND {
                write::<HORIZON, V, B>(block, args, horizon, found, fill);
                fill = 0;
            }
        }
    }
    write::<HORIZON, V, B>(block, args, horizon, found, fill);
    args.counters.add_once(block, counter::STEPS, tests);
}

/// Appends the collected candidates that pass the remaining tests and share no vertex.
fn write<const HORIZON: bool, V: Volume, B: Block>(
    block: &mut B,
    args: &TileTrianglesArgs<V>,
    horizon: Horizon,
    found: Shared<[u32; 2]>,
    fill: u32,
) {
    let mut masks = block.slot(0u32);
    let mut counts = block.slot(0u32);
    block.phase(|lane| {
        let (mut mask, mut k) = (0u32, 0);
        while k * LANES + lane.lane() < fill {
            let at = k * LANES + lane.lane();
            let [p, mut q] = lane.get(found, at);
            let (untested, mut p) = (p & UNTESTED != 0, p & !UNTESTED);
            let mut keeps = true;
            if V::IN_PARTS {
                let [first, second] = [p, q].map(|place| lane.read(args.leaves, place));
                keeps = if HORIZON {
                    first.volume.overlaps_before(&second.volume, horizon.time())
                } else {
                    first.volume.overlaps(&second.volume)
                };
                (p, q) = (first.triangle(), second.triangle());
                lane.put(found, at, [p, q]);
            }
            keeps = keeps
                && (!untested
                    || args.filters.allows(lane, lane.read(args.whose, p), lane.read(args.whose, q)))
                && (args.flags.has(TraverseFlags::KEEP_ADJACENT)
                    || !share_a_vertex(lane.read(args.faces, p), lane.read(args.faces, q)));
            mask |= (keeps as u32) << k;
            k += 1;
        }
        *masks.of(lane) = mask;
        *counts.of(lane) = mask.count_ones();
        lane.meet();
    });
    let base = args.pairs.append(block, &mut counts);
    block.phase(|lane| {
        let (mut mask, mut at) = (*masks.of(lane), base + *counts.of(lane) as u64);
        while mask != 0 {
            let k = mask.trailing_zeros();
            mask &= mask - 1;
            let [p, q] = lane.get(found, k * LANES + lane.lane());
            let p = p & !UNTESTED;
            args.pairs.put(lane, at, Pair { a: p.min(q), b: p.max(q) });
            at += 1;
        }
        lane.meet();
    });
}
