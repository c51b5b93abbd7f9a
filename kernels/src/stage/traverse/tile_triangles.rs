//! # Triangles of tiles: pairs of tiles → candidates
//! Paper    not in the paper.
//! Launch   blocks of a warp, [`turns`] times as many as are resident. They stride over the moving
//!          tiles, each with itself, and then the pairs of tiles.
//! Reads    32 contiguous leaves of each tile; filters of bodies and faces of candidate triangles.
//! Writes   candidate pairs, the smaller index first, each once, in no order.
//! Before   leaves and tiles are fitted; pairs of tiles are listed.
//! After    pairs = {(a, b) : a < b, volumes overlap, filters allow, no common vertex}.
//!          With [`TraverseFlags::KEEP_ADJACENT`] pairs with a common vertex stay. A sample
//!          restricts the set to its tiles.
//!          With a horizon volumes are those until the horizon.
//! Room     `pairs` may be too short: counters go on, the host grows it and runs again.
//! Cost     64 tests against the other tile. Leaves that overlap it are rows on the side that has
//!          fewer of them, and columns on the other, a lane each. Each row takes a test of all
//!          columns and a vote: 27 instructions for a box, 37 for one that moves.
//!          The second part of a test in two parts takes full warps, from volumes on chip: read
//!          from device memory they would fill the L1 cache.
//!          An atomic a warp and 512 candidates.

use crate::abi::{LEAF, MIXED, NONE, Pair, TileTrianglesArgs, TraverseFlags, counter};
use crate::bv::Volume;
use crate::bvh::horizon::Horizon;
use crate::bvh::on_chip::OnChip;
use crate::bvh::tiles::TILE;
use crate::exec::{ALONE, Block, Lane, Own, PairTest, Shared, Slot};
use crate::prim::adjacent::share_a_vertex;
use core::marker::PhantomData;

/// Lanes of a block.
pub const LANES: u32 = TILE;
/// Candidates collected before they are written.
const FOUND: u32 = 512;
/// Rows for which there is to be room, or candidates are written first.
const ROWS: u32 = 4;
/// How often the machine is filled with blocks. Blocks end at different times, and those of moving
/// volumes have enough to do that a further one pays (measured, `benches/NOTES.md`).
pub const fn turns<V: Volume>() -> u32 {
    if V::IN_PARTS { 3 } else { 1 }
}

/// Cost of a candidate in the narrow phase, in tests of two volumes. Measured on an H200 with cloth
/// and 10 million triangles in motion. It divides work among devices. No answer depends on it.
pub const CANDIDATE: u64 = 40;
/// Set in the first triangle of a collected pair whose filters are still to be tested.
const UNTESTED: u32 = 1 << 31;

/// Shared memory of a block.
pub const fn shared_bytes<V: Volume>() -> u32 {
    let sides = if V::IN_PARTS { 2 } else { 1 };
    sides * (OnChip::bytes::<V>(LANES) + 4 * LANES) + 8 * FOUND
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

/// Pairs of triangles that overlap, until the horizon.
pub fn triangles<const HORIZON: bool, V: Volume, B: Block>(block: &mut B, args: &TileTrianglesArgs<V>) {
    let total = args.alone() + args.tile_pairs.listed(block) as u64;
    if ALONE && block.block() as u64 >= total {
        return;
    }
    let rows = Side::new::<V, B>(block);
    // Volumes that are tested in two parts: the second part takes full warps.
    let columns = if V::IN_PARTS { Side::new::<V, B>(block) } else { rows };
    let found = block.shared::<[u32; 2]>(FOUND);
    let mut both = block.slot([(V::zeroed(), NONE); 2]);
    let mut places = block.slot(0u32);
    let mut ends = block.slot(0u32);
    let (mut fill, mut tests) = (0, 0u64);
    let horizon = Horizon::of(block, args.known);
    let mut unit = block.block() as u64;
    let mut next = Two::of(block, args, unit, total);
    // One place in the code for what is written, or the compiler puts it there twice: so the last
    // turn has no rows.
    loop {
        let two = next;
        let is_end = unit >= total;
        unit += block.blocks() as u64;
        // On its way while this one is looked at.
        next = Two::of(block, args, unit, total);
        let (mut height, mut met) = (0, 0);
        if let Some(Two { tiles, untested }) = two {
            let same = tiles.a == tiles.b;
            let [first, second] =
                [tiles.a, tiles.b].map(|tile| horizon.cut::<HORIZON, V>(block.load(args.nodes, tile).volume));
            block.phase(|lane| {
                let leaf = |tile: u32| {
                    let place = tile * TILE + lane.lane();
                    let leaf = lane.read(args.leaves, place);
                    let triangle = if leaf.link == NONE { NONE } else { leaf.link & !LEAF };
                    (horizon.cut::<HORIZON, V>(leaf.volume), triangle)
                };
                let ((p, own), (q, other)) = (leaf(tiles.a), leaf(tiles.b));
                let is_p = own != NONE && (same || p.may_overlap(&second));
                let is_q = other != NONE && (same || q.may_overlap(&first));
                *both.of(lane) = [(p, if is_p { own } else { NONE }), (q, if is_q { other } else { NONE })];
                *places.of(lane) = is_p as u32;
                *ends.of(lane) = is_q as u32;
            });
            let [of_p, of_q] = [block.number(&mut places), block.number(&mut ends)];
            // Rows are the fewer ones; columns, a lane each, cost nothing.
            let is_turned = of_q < of_p;
            height = if is_turned { of_q } else { of_p };
            block.phase(|lane| {
                let [p, q] = *both.of(lane);
                let (row, column) = if is_turned { (q, p) } else { (p, q) };
                let at = if is_turned { *ends.of(lane) } else { *places.of(lane) };
                if row.1 != NONE {
                    rows.put(lane, at, (row.0, row.1 | untested));
                }
                if V::IN_PARTS {
                    columns.put(lane, lane.lane(), column);
                }
                both.of(lane)[1] = column;
                // A tile with itself has each pair once: rows before the column. All its rows are
                // present.
                let end = if same { lane.lane() } else { height };
                *ends.of(lane) = if column.1 == NONE { 0 } else { end };
            });
            tests += (2 * LANES + LANES * height) as u64;
        }
        let mut from = 0;
        while from < height || is_end {
            let room = (FOUND - fill) / LANES;
            if is_end || room < ROWS.min(height - from) {
                write(block, args, found, fill);
                fill = 0;
                if is_end {
                    break;
                }
                continue;
            }
            let to = (from + room).min(height);
            let before = fill;
            fill = block.cross_own::<MayOverlap<V>>(
                from..to,
                fill,
                |lane, k| rows.volume(lane, k),
                |lane| {
                    let (item, triangle) = both.of(lane)[1];
                    let name = if V::IN_PARTS { lane.lane() } else { triangle };
                    Own { item, name, end: *ends.of(lane) }
                },
                |lane, at, [k, name]| {
                    lane.put(found, at, [if V::IN_PARTS { k } else { rows.triangle(lane, k) }, name]);
                },
            );
            if V::IN_PARTS {
                let count = fill - before;
                fill = block.cross(
                    0..count.div_ceil(LANES),
                    before,
                    |lane, k| {
                        let i = k * LANES + lane.lane();
                        if i >= count {
                            return None;
                        }
                        let [row, column] = lane.get(found, before + i);
                        let [p, q] = [rows.volume::<V, _>(lane, row), columns.volume(lane, column)];
                        p.overlaps(&q).then(|| [rows.triangle(lane, row), columns.triangle(lane, column)])
                    },
                    // Never behind its own place, which was read.
                    |lane, at, pair| lane.put(found, at, pair),
                );
            }
            met += fill - before;
            from = to;
        }
        if is_end {
            break;
        }
        if !args.work.is_empty()
            && let Some(Two { tiles, .. }) = two
        {
            let cost = (2 * LANES + LANES * height) as u64 + CANDIDATE * met as u64;
            block.reserve(args.work, tiles.a, cost);
        }
    }
    args.counters.add_once(block, counter::STEPS, tests);
}

/// The first part of the test of two volumes.
struct MayOverlap<V>(PhantomData<V>);

impl<V: Volume> PairTest for MayOverlap<V> {
    type Item = V;
    #[inline(always)]
    fn test(a: &V, b: &V) -> bool {
        a.may_overlap(b)
    }
}

/// Triangles of a tile on chip, with their volumes.
#[derive(Clone, Copy)]
struct Side {
    volumes: OnChip,
    triangles: Shared<u32>,
}

impl Side {
    #[inline(always)]
    fn new<V: Volume, B: Block>(block: &mut B) -> Side {
        Side { volumes: OnChip::new::<V, B>(block, LANES), triangles: block.shared(LANES) }
    }

    #[inline(always)]
    fn put<V: Volume, L: Lane>(self, lane: &L, at: u32, (volume, triangle): (V, u32)) {
        self.volumes.put(lane, at, volume);
        lane.put(self.triangles, at, triangle);
    }

    #[inline(always)]
    fn volume<V: Volume, L: Lane>(self, lane: &L, at: u32) -> V {
        self.volumes.get(lane, at)
    }

    #[inline(always)]
    fn triangle<L: Lane>(self, lane: &L, at: u32) -> u32 {
        lane.get(self.triangles, at)
    }
}

/// Appends the collected candidates whose filters allow them and which share no vertex, if these
/// are not wanted.
#[inline(always)]
fn write<V: Volume, B: Block>(
    block: &mut B,
    args: &TileTrianglesArgs<V>,
    found: Shared<[u32; 2]>,
    fill: u32,
) {
    let keeps_adjacent = args.flags.has(TraverseFlags::KEEP_ADJACENT);
    let mut kept = fill;
    if !keeps_adjacent || !args.whose.is_empty() {
        kept = block.cross(
            0..fill.div_ceil(LANES),
            0,
            |lane, k| {
                let at = k * LANES + lane.lane();
                if at >= fill {
                    return None;
                }
                if ALONE && at + LANES < fill {
                    let later = lane.get(found, at + LANES);
                    later.into_iter().for_each(|triangle| lane.expect(args.faces, triangle & !UNTESTED));
                }
                let [p, q] = lane.get(found, at);
                let (untested, p) = (p & UNTESTED != 0, p & !UNTESTED);
                let keeps = (!untested
                    || args.filters.allows(lane, lane.read(args.whose, p), lane.read(args.whose, q)))
                    && (keeps_adjacent
                        || !share_a_vertex(lane.read(args.faces, p), lane.read(args.faces, q)));
                keeps.then_some([p, q])
            },
            // Never behind its own place, which was read.
            |lane, at, pair| lane.put(found, at, pair),
        );
    }
    let base = args.pairs.reserve(block, kept as u64);
    block.phase(|lane| {
        let mut at = lane.lane();
        while at < kept {
            let [p, q] = lane.get(found, at);
            args.pairs.put(lane, base + at as u64, Pair { a: p.min(q), b: p.max(q) });
            at += LANES;
        }
        lane.meet();
    });
}
