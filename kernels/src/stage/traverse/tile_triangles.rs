//! # Triangles of tiles: pairs of tiles → candidates
//! Paper    nothing of the seed's.
//! Launch   blocks of a warp, as many as run at once, stride over the tiles of what moves, each with itself, and the pairs of tiles.
//! Reads    32 leaves in a row of each tile; whose the triangles of a candidate are, and their faces.
//! Writes   candidate pairs, the smaller index first, each once, in no order.
//! Before   leaves and tiles are fitted, pairs of tiles are listed.
//! After    every pair of triangles that may meet and whose volumes overlap, but
//!          for those that share a vertex index unless
//!          [`TraverseFlags::KEEP_ADJACENT`] asks for them: what walks of a tree write. But of a sample those of its tiles, and
//!          where an earliest time is sought, none that only meets behind the horizon.
//! Room     `pairs` may be too short: counters go on, the host grows it and runs again.
//! Cost     64 tests against the other tile, then each of the one that overlaps that against each of the other. An atomic a warp and
//!          512 candidates.

use crate::abi::{LEAF, MIXED, NONE, Pair, TileTrianglesArgs, TraverseFlags, counter};
use crate::bv::Volume;
use crate::bvh::horizon::Horizon;
use crate::bvh::on_chip::OnChip;
use crate::bvh::tiles::TILE;
use crate::exec::{Block, Lane, Shared, Slot};
use crate::prim::adjacent::share_a_vertex;

/// Lanes of a block.
pub const LANES: u32 = TILE;
/// Candidates that are found before they are written: triangles or, of volumes that are asked in parts, places of leaves.
const FOUND: u32 = 512;
/// What a pair of triangles costs that the narrow phase is asked, in tests of two volumes: as measured on an H200, cloth and 10 million
/// triangles in motion. It divides work among devices, and is in no answer.
pub const CANDIDATE: u64 = 40;
/// Set in the first triangle of one that is found: whether the two may meet is still to be asked.
const ASK: u32 = 1 << 31;

/// Shared memory of a block.
pub const fn shared_bytes<V: Volume>() -> u32 {
    OnChip::bytes::<V>(LANES) + 4 * LANES + 8 * FOUND
}

/// Two tiles, which may be one.
#[derive(Clone, Copy)]
struct Two {
    tiles: Pair,
    /// [`ASK`] where triangles of more than one body lie in one of them.
    ask: u32,
}

impl Two {
    /// Unit `i` of the work; `None` for a tile whose triangles may not meet each other, and behind the last one.
    #[inline(always)]
    fn of<V: Volume, B: Block>(b: &B, a: &TileTrianglesArgs<V>, (i, total): (u64, u64)) -> Option<Two> {
        if i >= total {
            return None;
        }
        let alone = a.alone();
        let same = i < alone;
        let tiles = if same {
            let tile = a.from + i as u32 * a.every;
            Pair { a: tile, b: tile }
        } else {
            b.load(a.tile_pairs.items(), (i - alone) as u32)
        };
        let filters = a.filters.nodes;
        if filters.is_empty() {
            return Some(Two { tiles, ask: 0 });
        }
        let [p, q] = [tiles.a, tiles.b].map(|tile| b.load(filters, tile));
        // Of pairs of tiles this was asked where they were found.
        let refused = same && !p.meets_itself();
        (!refused).then_some(Two { tiles, ask: if (p.who | q.who) & MIXED != 0 { ASK } else { 0 } })
    }
}

impl<V: Volume> TileTrianglesArgs<V> {
    /// How many tiles are looked at with themselves.
    fn alone(&self) -> u64 {
        (self.to - self.from).div_ceil(self.every) as u64
    }
}

/// Pairs of triangles that overlap, before the horizon.
pub fn triangles<const HORIZON: bool, V: Volume, B: Block>(b: &mut B, a: &TileTrianglesArgs<V>) {
    let rows = OnChip::new::<V, B>(b, LANES);
    let ids = b.shared::<u32>(LANES);
    let found = b.shared::<[u32; 2]>(FOUND);
    let mut column = b.slot((V::zeroed(), NONE));
    let mut row = b.slot((V::zeroed(), NONE));
    let mut masks = b.slot(0u32);
    let mut counts = b.slot(0u32);
    let (mut fill, mut tests) = (0, 0u64);
    let horizon = Horizon::of(b, a.known);
    let total = a.alone() + a.tile_pairs.listed(b) as u64;
    let mut unit = b.block() as u64;
    let mut next = Two::of(b, a, (unit, total));
    while unit < total {
        let two = next;
        unit += b.blocks() as u64;
        // On its way while this one is looked at.
        next = Two::of(b, a, (unit, total));
        let Some(Two { tiles, ask }) = two else { continue };
        let same = tiles.a == tiles.b;
        let [first, second] =
            [tiles.a, tiles.b].map(|tile| horizon.cut::<HORIZON, V>(b.load(a.nodes, tile).volume));
        b.phase(|l| {
            let leaf = |tile: u32| {
                let place = tile * TILE + l.lane();
                let leaf = l.read(a.leaves, place);
                let name = if V::IN_PARTS { place } else { leaf.link & !LEAF };
                (horizon.cut::<HORIZON, V>(leaf.volume), if leaf.link == NONE { NONE } else { name })
            };
            let ((p, own), (q, other)) = (leaf(tiles.a), leaf(tiles.b));
            let is_row = own != NONE && (same || p.may_overlap(&second));
            let is_column = other != NONE && (same || q.may_overlap(&first));
            *row.of(l) = (p, if is_row { own | ask } else { NONE });
            *column.of(l) = (q, if is_column { other } else { NONE });
            *counts.of(l) = is_row as u32;
        });
        let height = b.number(&mut counts);
        b.phase(|l| {
            let (volume, triangle) = *row.of(l);
            if triangle != NONE {
                let at = *counts.of(l);
                rows.put(l, at, volume);
                l.put(ids, at, triangle);
            }
        });
        b.phase(|l| {
            let (volume, triangle) = *column.of(l);
            let mut mask = 0;
            if triangle != NONE {
                // Of a tile with itself each pair once: rows before the column; none is left out there.
                let height = if same { l.lane() } else { height };
                let mut k = 0;
                while k < height {
                    mask |= (volume.may_overlap(&rows.get(l, k)) as u32) << k;
                    k += 1;
                }
            }
            *masks.of(l) = mask;
            *counts.of(l) = mask.count_ones();
        });
        let asked = (2 * LANES + LANES * height) as u64;
        tests += asked;
        let count = b.scan(&mut counts);
        if !a.work.is_empty() {
            b.reserve(a.work, tiles.a, asked + CANDIDATE * count as u64);
        }
        let mut done = 0;
        while done < count {
            let now = (FOUND - fill).min(count - done);
            b.phase(|l| {
                let (mut mask, mut at) = (*masks.of(l), *counts.of(l));
                while mask != 0 {
                    let k = mask.trailing_zeros();
                    mask &= mask - 1;
                    if at >= done && at < done + now {
                        l.put(found, fill + at - done, [l.get(ids, k), column.of(l).1]);
                    }
                    at += 1;
                }
            });
            done += now;
            fill += now;
            if fill == FOUND {
                write::<HORIZON, V, B>(b, a, horizon, (found, fill));
                fill = 0;
            }
        }
    }
    write::<HORIZON, V, B>(b, a, horizon, (found, fill));
    a.counters.add_once(b, counter::STEPS, tests);
}

/// Appends candidates: of those that were found the ones that may meet, and without those that share a vertex.
fn write<const HORIZON: bool, V: Volume, B: Block>(
    b: &mut B,
    a: &TileTrianglesArgs<V>,
    horizon: Horizon,
    (found, fill): (Shared<[u32; 2]>, u32),
) {
    let mut masks = b.slot(0u32);
    let mut counts = b.slot(0u32);
    b.phase(|l| {
        let (mut mask, mut k) = (0u32, 0);
        while k * LANES + l.lane() < fill {
            let at = k * LANES + l.lane();
            let [p, mut q] = l.get(found, at);
            let (ask, mut p) = (p & ASK != 0, p & !ASK);
            let mut keeps = true;
            if V::IN_PARTS {
                let [first, second] = [p, q].map(|place| l.read(a.leaves, place));
                keeps = if HORIZON {
                    first.volume.overlaps_before(&second.volume, horizon.time())
                } else {
                    first.volume.overlaps(&second.volume)
                };
                (p, q) = (first.triangle(), second.triangle());
                l.put(found, at, [p, q]);
            }
            keeps = keeps
                && (!ask || a.filters.allows(l, l.read(a.whose, p), l.read(a.whose, q)))
                && (a.flags.has(TraverseFlags::KEEP_ADJACENT)
                    || !share_a_vertex(l.read(a.faces, p), l.read(a.faces, q)));
            mask |= (keeps as u32) << k;
            k += 1;
        }
        *masks.of(l) = mask;
        *counts.of(l) = mask.count_ones();
    });
    let base = a.pairs.append(b, &mut counts);
    b.phase(|l| {
        let (mut mask, mut at) = (*masks.of(l), base + *counts.of(l) as u64);
        while mask != 0 {
            let k = mask.trailing_zeros();
            mask &= mask - 1;
            let [p, q] = l.get(found, k * LANES + l.lane());
            let p = p & !ASK;
            a.pairs.put(l, at, Pair { a: p.min(q), b: p.max(q) });
            at += 1;
        }
    });
}
