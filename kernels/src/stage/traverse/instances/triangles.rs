//! # Triangles of instances: pairs of tiles → candidates
//! Paper    not in the paper.
//! Launch   blocks of a warp, which stride over the pairs of tiles.
//! Reads    a relation, two nodes, 32 contiguous triangles of each tile.
//! Writes   candidates: a pair of tiles and two places, each once, in no order.
//! Before   relations and pairs of tiles are listed.
//! After    pairs ⊇ {(p, q) : p in tile a, q in tile b, placed triangles share a point}.
//!          Boxes overlap in the frame of the first body, and no plane of the two parts them.
//! Room     `pairs` may be too short: counters go on, the host grows it and runs again.
//! Cost     32 B a triangle, contiguous; 48 B one that meets the other tile's box. Triangles that meet the other tile's box are rows on the
//!          side that has fewer of them, and columns on the other, a lane each; a row takes a test of
//!          all columns and a vote. Planes take full warps: 100 operations in f32 a pair.

use crate::abi::{Candidate, InstancesArgs, NONE, NodePair, Output, Pair, counter};
use crate::bv::FrameBox;
use crate::bvh::pieces::Pieces;
use crate::bvh::tiles::TILE;
use crate::exec::{Block, Lane, Own, PairTest, RowMap, Shared, Slot};
use crate::math::Vec3;
use crate::prim::planes;
use bytemuck::Zeroable;

/// Lanes of a block.
pub const LANES: u32 = TILE;
/// Pairs of triangles of two tiles.
const FOUND: u32 = LANES * LANES;
/// Corners of a triangle.
pub type Corners = [[f32; 3]; 3];
/// Shared memory of a block.
pub const SHARED: u32 =
    Pieces::<FrameBox>::bytes(LANES) + 2 * Pieces::<Corners>::bytes(LANES) + 4 * LANES + 4 * FOUND;

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
struct Planes {
    slack: f32,
}

/// Result for two triangles that a plane parts.
const APART: u32 = 0;
/// For two that may meet.
const MAY_MEET: u32 = 1;

impl RowMap for Planes {
    type Number = f32;
    type Row = [Corners; 2];
    #[inline(always)]
    fn at_once(&self, [p, q]: [Corners; 2]) -> u32 {
        let corners = |t: Corners| [Vec3(t[0]), Vec3(t[1]), Vec3(t[2])];
        if planes::apart(&corners(p), &corners(q), self.slack) { APART } else { MAY_MEET }
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
    /// How many pairs of tiles a block takes behind one another. Most are of one relation: what is
    /// known from the first may end the others.
    const RUN: u32;
    /// The largest number, in its mesh, of a triangle of the first body that matters in a pair of
    /// tiles; `None` if none does.
    fn matters(&mut self, block: &mut B, bodies: [u32; 2], tiles: &NodePair) -> Option<u32>;
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

/// The largest number of a triangle.
pub const ALL: u32 = NONE - 1;

/// Lists all as candidates.
struct ListAll;

impl<B: Block> Take<B> for ListAll {
    const RUN: u32 = 1;
    #[inline(always)]
    fn matters(&mut self, _: &mut B, _: [u32; 2], _: &NodePair) -> Option<u32> {
        Some(ALL)
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
        list(block, args.pairs, tile_pair, (found, fits));
    }
}

/// Candidates of pairs of tiles.
pub fn candidates<B: Block>(block: &mut B, args: &InstancesArgs) {
    triangles(block, args, &mut ListAll);
}

/// Pairs of triangles of pairs of tiles, taken by `to`.
#[inline(always)]
pub fn triangles<B: Block, T: Take<B>>(block: &mut B, args: &InstancesArgs, to: &mut T) {
    let rows = Pieces::<FrameBox>::new(block, LANES);
    let corners = [Pieces::<Corners>::new(block, LANES), Pieces::<Corners>::new(block, LANES)];
    let names = block.shared::<u32>(LANES);
    let found = block.shared::<u32>(FOUND);
    let mut two = block.slot(Two { boxes: [FrameBox::zeroed(); 2], meet: [false; 2] });
    let mut firsts = block.slot(0u32);
    let mut seconds = block.slot(0u32);
    let mut kept = block.slot(None);
    let (count, tables) = (args.tile_pairs.listed(block), &args.tables);
    let (mut next, mut tests) = (block.block() * T::RUN, 0u64);
    while next < count {
        let unit = next;
        next += 1;
        if next % T::RUN == 0 {
            next += (block.blocks() - 1) * T::RUN;
        }
        let pair = block.load(args.tile_pairs.items(), unit);
        let relation = block.load(args.relations.items(), pair.relation);
        let Some(most) = to.matters(block, relation.bodies, &pair) else { continue };
        let [tile_a, tile_b] = [pair.a, pair.b].map(|tile| block.load(tables.nodes, tile).volume);
        let (in_second, in_first) = (relation.of_first(&tile_a).second, relation.of_second(&tile_b).first);
        block.phase(|lane| {
            let i = lane.lane();
            let places = [pair.a * TILE + i, pair.b * TILE + i];
            let (p, q) = (lane.read(tables.leaves, places[0]), lane.read(tables.leaves, places[1]));
            let mut own = Two { boxes: [p.volume; 2], meet: [false; 2] };
            if (p.number <= most) & p.volume.overlaps(&in_first) {
                own.meet[0] = true;
                corners[0].put(lane, i, lane.read(tables.triangles, places[0]).corners);
            }
            if (q.number != NONE) & q.volume.overlaps(&in_second) {
                let [x, y, z] = lane.read(tables.triangles, places[1]).corners;
                let moved = [relation.to_first(x), relation.to_first(y), relation.to_first(z)];
                own.boxes[1] = relation.around(&moved);
                own.meet[1] = own.boxes[1].overlaps(&tile_a);
                corners[1].put(lane, i, moved);
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
        let map = Planes { slack: relation.slack };
        let fits = sift(block, &map, corners, (found, fill), (&mut firsts, &mut kept), |_, verdict| {
            verdict == MAY_MEET
        });
        to.take(block, args, (unit, relation.bodies, pair), found, fits);
    }
    args.counters.add_once(block, counter::STEPS, tests);
}

/// Maps collected pairs of triangles, whose corners are on chip, and keeps some, in their order. Full
/// warps. Returns how many.
#[inline(always)]
pub fn sift<B: Block, M: RowMap<Row = [Corners; 2]>>(
    block: &mut B,
    map: &M,
    corners: [Pieces<Corners>; 2],
    (found, fill): (Shared<u32>, u32),
    (places, kept): (&mut B::Slot<u32>, &mut B::Slot<Option<u32>>),
    mut keeps: impl FnMut(&B::Lane, u32) -> bool,
) -> u32 {
    let (mut at, mut fits) = (0, 0);
    while at < fill {
        block.map_rows(
            map,
            |lane| (at + lane.lane() < fill).then(|| lane.get(found, at + lane.lane())),
            |lane, word| {
                let [p, q] = Candidate::of_word(word);
                Some([corners[0].get(lane, p), corners[1].get(lane, q)])
            },
            |lane, result| {
                let own = result.and_then(|(word, verdict)| keeps(lane, verdict).then_some(word));
                *places.of(lane) = own.is_some() as u32;
                *kept.of(lane) = own;
                lane.meet();
            },
        );
        let some = block.number(places);
        block.phase(|lane| {
            if let Some(word) = *kept.of(lane) {
                // Never behind its own place, which was read.
                lane.put(found, fits + *places.of(lane), word);
            }
            lane.meet();
        });
        fits += some;
        at += LANES;
    }
    fits
}

/// Lists pairs of triangles of a pair of tiles as candidates.
#[inline(always)]
pub fn list<B: Block>(
    block: &mut B,
    pairs: Output<Pair>,
    tile_pair: u32,
    (found, fits): (Shared<u32>, u32),
) {
    let base = pairs.reserve(block, fits as u64);
    block.phase(|lane| {
        let mut at = lane.lane();
        while at < fits {
            let places = Candidate::of_word(lane.get(found, at));
            pairs.put(lane, base + at as u64, Candidate { tile_pair, places }.pair());
            at += LANES;
        }
        lane.meet();
    });
}
