//! # Triangles of instances: pairs of tiles → candidates
//! Paper    not in the paper.
//! Launch   blocks of a warp, which stride over the pairs of tiles.
//! Reads    a relation, two nodes, 32 contiguous triangles of each tile.
//! Writes   candidates: a pair of tiles and two places, each once, in no order.
//! Before   relations and pairs of tiles are listed.
//! After    pairs ⊇ {(p, q) : p in tile a, q in tile b, placed triangles share a point}.
//!          Boxes overlap in the frame of the first body, and no plane of the two parts them.
//!          [`moving_candidates`]: that come within the query's distance in the step.
//! Room     `pairs` may be too short: counters go on, the host grows it and runs again.
//! Cost     32 B a triangle, contiguous; 48 B one that meets the other tile's box. Triangles that
//!          meet the other tile's box are rows on the side that has fewer of them, and columns on the other, a lane each; a row takes a test of
//!          all columns and a vote. Planes take full warps: 100 operations in f32 a pair.

use crate::abi::{Candidate, InstancesArgs, MovingInstancesArgs, MovingRelation, NONE, NodePair};
use crate::abi::{Output, Relation, counter};
use crate::bv::FrameBox;
use crate::bvh::pieces::Pieces;
use crate::bvh::relation::Related;
use crate::bvh::tiles::TILE;
use crate::exec::{Block, Lane, Own, PairTest, RowMap, Shared, Slot};
use bytemuck::Zeroable;
use core::marker::PhantomData;

/// Lanes of a block.
pub const LANES: u32 = TILE;
/// Pairs of triangles of two tiles.
const FOUND: u32 = LANES * LANES;
/// Corners of a triangle.
type Corners = [[f32; 3]; 3];
/// Shared memory of a block.
pub const SHARED: u32 = shared_bytes::<Relation>();
/// That of [`moving_candidates`].
pub const SHARED_MOVING: u32 = shared_bytes::<MovingRelation>();

const fn shared_bytes<Q: Related>() -> u32 {
    let corners = Pieces::<Corners>::bytes(LANES) + Pieces::<Q::Seen>::bytes(LANES);
    Pieces::<FrameBox>::bytes(LANES) + corners + 4 * LANES + 4 * FOUND
}

/// Whether boxes overlap.
struct Overlap;

impl PairTest for Overlap {
    type Item = FrameBox;
    #[inline(always)]
    fn test(a: &FrameBox, b: &FrameBox) -> bool {
        a.overlaps(b)
    }
}

/// The planes of two triangles.
struct Planes<Q> {
    slack: f32,
    of: PhantomData<Q>,
}

/// Result for two triangles that a plane parts.
const APART: u32 = 0;
/// For two that may meet.
const MAY_MEET: u32 = 1;

impl<Q: Related> RowMap for Planes<Q> {
    type Number = f32;
    type Row = Q::Row;
    #[inline(always)]
    fn at_once(&self, row: Q::Row) -> u32 {
        if Q::are_apart(row, self.slack) { APART } else { MAY_MEET }
    }
}

/// A lane's triangles of both tiles, in the frame of the first.
#[derive(Clone, Copy)]
struct Two {
    boxes: [FrameBox; 2],
    meet: [bool; 2],
}

/// The end of a pair of tiles.
pub trait Take<B: Block> {
    /// Whether pairs of tiles of a relation, and of its bodies, need no test.
    fn is_over(&mut self, block: &mut B, relation: u32, bodies: [u32; 2]) -> bool;
    /// Takes `fits` pairs of triangles that may meet, as words of [`Candidate`]. Given are the number
    /// of the pair of tiles, the bodies, and the pair.
    fn take(
        &mut self,
        block: &mut B,
        args: &InstancesArgs,
        of: (u32, [u32; 2], NodePair),
        found: Shared<u32>,
        fits: u32,
    );
}

/// Lists all as candidates.
struct ListAll;

impl<B: Block> Take<B> for ListAll {
    #[inline(always)]
    fn is_over(&mut self, _: &mut B, _: u32, _: [u32; 2]) -> bool {
        false
    }
    #[inline(always)]
    fn take(
        &mut self,
        block: &mut B,
        args: &InstancesArgs,
        (tile_pair, ..): (u32, [u32; 2], NodePair),
        found: Shared<u32>,
        fits: u32,
    ) {
        let base = args.pairs.reserve(block, fits as u64);
        block.phase(|lane| {
            let mut at = lane.lane();
            while at < fits {
                let places = Candidate::of_word(lane.get(found, at));
                args.pairs.put(lane, base + at as u64, Candidate { tile_pair, places }.pair());
                at += LANES;
            }
            lane.meet();
        });
    }
}

/// Candidates of pairs of tiles.
pub fn candidates<B: Block>(block: &mut B, args: &InstancesArgs) {
    triangles(block, args, args.relations, &mut ListAll);
}

/// Candidates of pairs of tiles of bodies in motion.
pub fn moving_candidates<B: Block>(block: &mut B, args: &MovingInstancesArgs) {
    triangles(block, &args.of, args.relations, &mut ListAll);
}

/// Pairs of triangles of pairs of tiles, taken by `to`.
#[inline(always)]
pub fn triangles<Q: Related, B: Block>(
    block: &mut B,
    args: &InstancesArgs,
    relations: Output<Q>,
    to: &mut impl Take<B>,
) {
    let rows = Pieces::<FrameBox>::new(block, LANES);
    let of_first = Pieces::<Corners>::new(block, LANES);
    let of_second = Pieces::<Q::Seen>::new(block, LANES);
    let names = block.shared::<u32>(LANES);
    let found = block.shared::<u32>(FOUND);
    let mut two = block.slot(Two { boxes: [FrameBox::zeroed(); 2], meet: [false; 2] });
    let mut firsts = block.slot(0u32);
    let mut seconds = block.slot(0u32);
    let mut kept = block.slot(None);
    let (count, tables) = (args.tile_pairs.listed(block), &args.tables);
    let (mut unit, mut tests) = (block.block(), 0u64);
    while unit < count {
        let pair = block.load(args.tile_pairs.items(), unit);
        let relation = block.load(relations.items(), pair.relation);
        if to.is_over(block, pair.relation, relation.bodies()) {
            unit += block.blocks();
            continue;
        }
        let [tile_a, tile_b] = [pair.a, pair.b].map(|tile| block.load(tables.nodes, tile).volume);
        let in_second = relation.first_in_both(&tile_a).second;
        let in_first = relation.second_in_both(&tile_b).first;
        block.phase(|lane| {
            let i = lane.lane();
            let places = [pair.a * TILE + i, pair.b * TILE + i];
            let (p, q) = (lane.read(tables.leaves, places[0]), lane.read(tables.leaves, places[1]));
            let mut own = Two { boxes: [p.volume; 2], meet: [false; 2] };
            if (p.number != NONE) & p.volume.overlaps(&in_first) {
                own.meet[0] = true;
                of_first.put(lane, i, lane.read(tables.triangles, places[0]).corners);
            }
            if (q.number != NONE) & q.volume.overlaps(&in_second) {
                let seen = relation.seen(lane.read(tables.triangles, places[1]).corners);
                own.boxes[1] = relation.around_seen(&seen);
                own.meet[1] = own.boxes[1].overlaps(&tile_a);
                of_second.put(lane, i, seen);
            }
            *two.of(lane) = own;
            (*firsts.of(lane), *seconds.of(lane)) = (own.meet[0] as u32, own.meet[1] as u32);
            lane.meet();
        });
        let [of_a, of_b] = [block.number(&mut firsts), block.number(&mut seconds)];
        // Rows are the fewer ones; columns, a lane each, cost nothing.
        let is_turned = of_b < of_a;
        let height = if is_turned { of_b } else { of_a };
        tests += (2 * LANES + LANES * height) as u64;
        let tile_pair = unit;
        unit += block.blocks();
        if height == 0 {
            continue;
        }
        block.phase(|lane| {
            let own = *two.of(lane);
            let (row, is_row) =
                if is_turned { (own.boxes[1], own.meet[1]) } else { (own.boxes[0], own.meet[0]) };
            let at = if is_turned { *seconds.of(lane) } else { *firsts.of(lane) };
            if is_row {
                rows.put(lane, at, row);
                lane.put(names, at, lane.lane());
            }
            lane.meet();
        });
        let fill = block.cross_own::<Overlap>(
            0..height,
            0,
            |lane, k| rows.get(lane, k),
            |lane| {
                let own = *two.of(lane);
                let (item, is_column) =
                    if is_turned { (own.boxes[0], own.meet[0]) } else { (own.boxes[1], own.meet[1]) };
                Own { item, name: lane.lane(), end: if is_column { height } else { 0 } }
            },
            |lane, at, [k, name]| {
                let row = lane.get(names, k);
                let places = if is_turned { [name, row] } else { [row, name] };
                lane.put(found, at, Candidate::word(places));
            },
        );
        let map = Planes::<Q> { slack: relation.slack(), of: PhantomData };
        let (mut at, mut fits) = (0, 0);
        while at < fill {
            block.map_rows(
                &map,
                |lane| (at + lane.lane() < fill).then(|| lane.get(found, at + lane.lane())),
                |lane, word| {
                    let [p, q] = Candidate::of_word(word);
                    Some(Q::row(of_first.get(lane, p), of_second.get(lane, q)))
                },
                |lane, result| {
                    let own = result.and_then(|(word, verdict)| (verdict == MAY_MEET).then_some(word));
                    *firsts.of(lane) = own.is_some() as u32;
                    *kept.of(lane) = own;
                    lane.meet();
                },
            );
            let some = block.number(&mut firsts);
            block.phase(|lane| {
                if let Some(word) = *kept.of(lane) {
                    // Never behind its own place, which was read.
                    lane.put(found, fits + *firsts.of(lane), word);
                }
                lane.meet();
            });
            fits += some;
            at += LANES;
        }
        to.take(block, args, (tile_pair, relation.bodies(), pair), found, fits);
    }
    args.counters.add_once(block, counter::STEPS, tests);
}
