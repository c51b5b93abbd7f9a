//! # Triangles of instances: pairs of tiles → candidates
//! Paper    not in the paper.
//! Launch   blocks of a warp, which stride over the pairs of tiles.
//! Reads    a relation, two nodes, 32 contiguous boxes and triangles of each tile.
//! Writes   candidates: a pair of tiles and two places, each once, in no order.
//! Before   relations and pairs of tiles are listed.
//! After    pairs ⊇ {(p, q) : p in tile a, q in tile b, placed triangles share a point}.
//!          Boxes overlap in the frame of the first body, and no plane of the two parts them.
//! Room     `pairs` may be too short: counters go on, the host grows it and runs again.
//! Cost     24 B a triangle, contiguous; 48 B one that meets the other tile's box. Those that do are
//!          rows on the side that has fewer of them, and columns on the other, a lane each; a row
//!          takes a test of all columns and a vote. Planes take full warps: 100 operations in f32 a
//!          pair.

use crate::abi::{Candidate, InstancesArgs, MeshLeaf, NodePair, counter};
use crate::bv::FrameBox;
use crate::bvh::pieces::Pieces;
use crate::bvh::tiles::TILE;
use crate::exec::{Block, Lane, Own, PairTest, RowMap, Shared, Slot};
use crate::math::Vec3;
use crate::prim::planes;

/// Lanes of a block.
pub const LANES: u32 = TILE;
/// Words of a tile's boxes, by columns.
const COLUMNS: u32 = MeshLeaf::COLUMNS * TILE;
/// Pairs of triangles of two tiles.
const FOUND: u32 = LANES * LANES;
/// Corners of a triangle.
type Corners = [[f32; 3]; 3];
/// Shared memory of a block.
pub const SHARED: u32 =
    2 * Pieces::<FrameBox>::bytes(LANES) + Pieces::<Corners>::bytes(LANES) + 2 * 4 * LANES + 4 * FOUND;

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
    triangles(block, args, &mut ListAll);
}

/// Pairs of triangles of pairs of tiles, taken by `to`.
#[inline(always)]
pub fn triangles<B: Block>(block: &mut B, args: &InstancesArgs, to: &mut impl Take<B>) {
    let (count, tables) = (args.tile_pairs.listed(block), &args.tables);
    let share = block.share(count, 1);
    if share.is_empty() {
        return;
    }
    let sides = [Pieces::<FrameBox>::new(block, LANES), Pieces::<FrameBox>::new(block, LANES)];
    let corners = Pieces::<Corners>::new(block, LANES);
    let names = [block.shared::<u32>(LANES), block.shared::<u32>(LANES)];
    let found = block.shared::<u32>(FOUND);
    let mut column = block.slot(FrameBox::default());
    let mut verdicts = block.slot(None);
    let (mut unit, mut tests) = (share.first, 0u64);
    while unit < share.end {
        let pair = block.load(args.tile_pairs.items(), unit);
        let relation = block.load(args.relations.items(), pair.relation);
        let tile_pair = unit;
        unit += share.step;
        if to.is_over(block, pair.relation, relation.bodies) {
            continue;
        }
        let [tile_a, tile_b] = [pair.a, pair.b].map(|tile| block.load(tables.nodes, tile).volume);
        let (in_second, in_first) = (relation.of_first(&tile_a).second, relation.of_second(&tile_b).first);
        tests += 2 * LANES as u64;
        let of_a =
            block.select_columns::<Overlap>(tables.columns, pair.a * COLUMNS, &in_first, |lane, at| {
                sides[0].put(lane, at, lane.read(tables.leaves, pair.a * TILE + lane.lane()).volume);
                lane.put(names[0], at, lane.lane());
            });
        if of_a == 0 {
            continue;
        }
        let nearly =
            block.select_columns::<Overlap>(tables.columns, pair.b * COLUMNS, &in_second, |lane, at| {
                lane.put(names[1], at, lane.lane());
            });
        let of_b = block.select(
            nearly,
            |lane| {
                let name = lane.get(names[1], lane.lane());
                let corners = lane.read(tables.triangles, pair.b * TILE + name).corners;
                let (moved, volume) = relation.triangle_to_first(&corners);
                (volume.overlaps(&tile_a), (name, moved, volume))
            },
            |lane, at, (name, moved, volume)| {
                sides[1].put(lane, at, volume);
                corners.put(lane, at, moved);
                lane.put(names[1], at, name);
            },
        );
        // Rows are the fewer ones; columns, a lane each, cost nothing.
        let is_turned = of_b < of_a;
        let (rows, columns) = if is_turned { (sides[1], sides[0]) } else { (sides[0], sides[1]) };
        let (height, width) = if is_turned { (of_b, of_a) } else { (of_a, of_b) };
        tests += (LANES * height) as u64;
        if height == 0 {
            continue;
        }
        block.phase(|lane| {
            if lane.lane() < width {
                *column.of(lane) = columns.get(lane, lane.lane());
            }
            lane.meet();
        });
        let fill = block.cross_own::<Overlap>(
            0..height,
            0,
            |lane, k| rows.get(lane, k),
            |lane| {
                let end = if lane.lane() < width { height } else { 0 };
                Own { item: *column.of(lane), name: lane.lane(), end }
            },
            |lane, at, [k, name]| {
                lane.put(found, at, Candidate::word(if is_turned { [name, k] } else { [k, name] }));
            },
        );
        let map = Planes { slack: relation.slack };
        let (mut at, mut fits) = (0, 0);
        while at < fill {
            block.map_rows(
                &map,
                |lane| (at + lane.lane() < fill).then(|| lane.get(found, at + lane.lane())),
                |lane, word| {
                    let [p, q] = Candidate::of_word(word);
                    let place = pair.a * TILE + lane.get(names[0], p);
                    Some([lane.read(tables.triangles, place).corners, corners.get(lane, q)])
                },
                |lane, result| {
                    *verdicts.of(lane) = result;
                    lane.meet();
                },
            );
            // Never behind its own place, which was read.
            fits += block.select(
                LANES,
                |lane| {
                    let (word, verdict) = verdicts.of(lane).unwrap_or((0, APART));
                    (verdict == MAY_MEET, word)
                },
                |lane, place, word| {
                    let [p, q] = Candidate::of_word(word);
                    let places = [lane.get(names[0], p), lane.get(names[1], q)];
                    lane.put(found, fits + place, Candidate::word(places));
                },
            );
            at += LANES;
        }
        to.take(block, args, (tile_pair, relation.bodies, pair), found, fits);
    }
    args.counters.add_once(block, counter::STEPS, tests);
}
