//! # Triangles of instances: pairs of tiles → candidates
//! Paper    not in the paper.
//! Launch   blocks of a warp, which stride over the pairs of tiles.
//! Reads    a relation, two nodes, 32 contiguous boxes and triangles of each tile.
//! Writes   candidates: a pair of tiles and two places, each once, in no order.
//! Before   relations and pairs of tiles are listed.
//! After    pairs ⊇ {(p, q) : p in tile a, q in tile b, placed triangles share a point}.
//!          Boxes overlap in the frame of the first body, and no plane of the two parts them.
//!          [`moving_candidates`]: that come within the query's distance in the step.
//! Room     `pairs` may be too short: counters go on, the host grows it and runs again.
//! Cost     24 B a triangle, contiguous; 48 B one that meets the other tile's box. Those that do are
//!          rows on the side that has fewer of them, and columns on the other, a lane each; a row
//!          takes a test of all columns and a vote. Planes take full warps: 100 operations in f32 a
//!          pair.

use crate::abi::{
    Candidate, InstanceTables, InstancesArgs, MeshLeaf, MovingInstancesArgs, MovingRelation, NONE, NodePair,
    Output, Pair, Relation, counter,
};
use crate::bv::FrameBox;
use crate::bvh::pieces::Pieces;
use crate::bvh::relation::Related;
use crate::bvh::tiles::TILE;
use crate::exec::{Block, Lane, Own, PairTest, RowMap, Shared, Slot};
use bytemuck::Pod;
use core::marker::PhantomData;

/// Lanes of a block.
pub const LANES: u32 = TILE;
/// Words of a tile's boxes, by columns.
const COLUMNS: u32 = MeshLeaf::COLUMNS * TILE;
/// Pairs of triangles of two tiles.
const FOUND: u32 = LANES * LANES;
/// Corners of a triangle.
pub type Corners = [[f32; 3]; 3];
/// Shared memory of a block.
pub const SHARED: u32 = shared_bytes::<Relation>();
/// That of [`moving_candidates`].
pub const SHARED_MOVING: u32 = shared_bytes::<MovingRelation>();

const fn shared_bytes<Q: Related>() -> u32 {
    2 * Pieces::<FrameBox>::bytes(LANES) + Pieces::<Q::Seen>::bytes(LANES) + 2 * 4 * LANES + 4 * FOUND
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
    triangles(block, args, args.relations, &mut ListAll);
}

/// Candidates of pairs of tiles of bodies in motion.
pub fn moving_candidates<B: Block>(block: &mut B, args: &MovingInstancesArgs) {
    triangles(block, &args.of, args.relations, &mut ListAll);
}

/// Pairs of triangles of pairs of tiles, taken by `to`.
#[inline(always)]
pub fn triangles<Q: Related, B: Block, T: Take<B>>(
    block: &mut B,
    args: &InstancesArgs,
    relations: Output<Q>,
    to: &mut T,
) {
    let (count, tables) = (args.tile_pairs.listed(block), &args.tables);
    let share = block.share(count, T::RUN);
    if share.is_empty() {
        return;
    }
    let sides = [Pieces::<FrameBox>::new(block, LANES), Pieces::<FrameBox>::new(block, LANES)];
    let corners = Pieces::<Q::Seen>::new(block, LANES);
    let names = [block.shared::<u32>(LANES), block.shared::<u32>(LANES)];
    let found = block.shared::<u32>(FOUND);
    let mut verdicts = block.slot(None);
    let (mut run, mut next, mut tests) = (share.first, share.first, 0u64);
    while next < share.end {
        let unit = next;
        next += 1;
        if next == run + T::RUN {
            run += share.step;
            next = run;
        }
        let pair = block.load(args.tile_pairs.items(), unit);
        let relation = block.load(relations.items(), pair.relation);
        let Some(most) = to.matters(block, relation.bodies(), &pair) else { continue };
        let [tile_a, tile_b] = [pair.a, pair.b].map(|tile| block.load(tables.nodes, tile).volume);
        let in_second = relation.first_in_both(&tile_a).second;
        let in_first = relation.second_in_both(&tile_b).first;
        tests += 2 * LANES as u64;
        let mut of_a =
            block.select_columns::<Overlap>(tables.columns, pair.a * COLUMNS, &in_first, |lane, at| {
                sides[0].put(lane, at, lane.read(tables.leaves, pair.a * TILE + lane.lane()).volume);
                lane.put(names[0], at, lane.lane());
            });
        if most != ALL {
            of_a = block.select(
                of_a,
                |lane| {
                    let name = lane.get(names[0], lane.lane());
                    let leaf = lane.read(tables.leaves, pair.a * TILE + name);
                    (leaf.number <= most, (name, leaf.volume))
                },
                |lane, at, (name, volume)| {
                    sides[0].put(lane, at, volume);
                    lane.put(names[0], at, name);
                },
            );
        }
        if of_a == 0 {
            continue;
        }
        let nearly = overlapping(block, tables, pair.b, &in_second, names[1]);
        let of_b = block.select(
            nearly,
            |lane| {
                let name = lane.get(names[1], lane.lane());
                let corners = lane.read(tables.triangles, pair.b * TILE + name).corners;
                let (seen, volume) = relation.seen(&corners);
                (volume.overlaps(&tile_a), (name, seen, volume))
            },
            |lane, at, (name, seen, volume)| {
                sides[1].put(lane, at, volume);
                corners.put(lane, at, seen);
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
        let fill = block.cross_own::<Overlap>(
            0..height,
            0,
            |lane, k| rows.get(lane, k),
            |lane| column(lane, columns, width, height),
            |lane, at, [k, name]| {
                lane.put(found, at, Candidate::word(if is_turned { [name, k] } else { [k, name] }));
            },
        );
        let map = Planes::<Q> { slack: relation.plane_slack(), of: PhantomData };
        let fits = sift(
            block,
            &map,
            (found, fill),
            &mut verdicts,
            |lane, [p, q]| {
                let place = pair.a * TILE + lane.get(names[0], p);
                Q::row(lane.read(tables.triangles, place).corners, corners.get(lane, q))
            },
            |_, verdict| verdict == MAY_MEET,
            names,
        );
        to.take(block, args, (unit, relation.bodies(), pair), found, fits);
    }
    args.counters.add_once(block, counter::STEPS, tests);
}

/// Puts the places of a tile's triangles whose boxes overlap a volume. Returns how many.
#[inline(always)]
pub fn overlapping<B: Block>(
    block: &mut B,
    tables: &InstanceTables,
    tile: u32,
    volume: &FrameBox,
    names: Shared<u32>,
) -> u32 {
    block.select_columns::<Overlap>(tables.columns, tile * COLUMNS, volume, |lane, at| {
        lane.put(names, at, lane.lane());
    })
}

/// A lane's column of at least one, against all rows. The last for lanes without one: a branch would
/// double the loop over rows.
#[inline(always)]
pub fn column<T: Pod, L: Lane>(lane: &L, columns: Pieces<T>, width: u32, height: u32) -> Own<T> {
    let item = columns.get(lane, lane.lane().min(width - 1));
    Own { item, name: lane.lane(), end: if lane.lane() < width { height } else { 0 } }
}

/// Maps collected pairs of triangles, and keeps some, in their order. Full warps. `gather` reads the
/// corners of a pair. Those kept get their places in the tiles, by `names`. Returns how many.
#[inline(always)]
pub fn sift<B: Block, M: RowMap>(
    block: &mut B,
    map: &M,
    (found, fill): (Shared<u32>, u32),
    verdicts: &mut B::Slot<Option<(u32, u32)>>,
    mut gather: impl FnMut(&B::Lane, [u32; 2]) -> M::Row,
    mut keeps: impl FnMut(&B::Lane, u32) -> bool,
    names: [Shared<u32>; 2],
) -> u32 {
    let (mut at, mut fits) = (0, 0);
    while at < fill {
        block.map_rows(
            map,
            |lane| (at + lane.lane() < fill).then(|| lane.get(found, at + lane.lane())),
            |lane, word| Some(gather(lane, Candidate::of_word(word))),
            |lane, result| {
                *verdicts.of(lane) = result;
                lane.meet();
            },
        );
        // Never behind its own place, which was read.
        fits += block.select(
            LANES,
            |lane| match *verdicts.of(lane) {
                Some((word, verdict)) => (keeps(lane, verdict), word),
                None => (false, 0),
            },
            |lane, place, word| {
                let [p, q] = Candidate::of_word(word);
                let places = [lane.get(names[0], p), lane.get(names[1], q)];
                lane.put(found, fits + place, Candidate::word(places));
            },
        );
        at += LANES;
    }
    fits
}

/// Lists pairs of triangles of a pair of tiles as candidates.
#[inline(always)]
pub fn list<B: Block>(block: &mut B, pairs: Output<Pair>, tile_pair: u32, (found, fits): (Shared<u32>, u32)) {
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
