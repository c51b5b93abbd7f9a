//! # Within: pairs of nodes and tiles → bounds of the least distance, and candidates within them
//! Paper    the thesis, section 6.2, and Larsen et al. 1999: branch and bound by distances of
//!          volumes. Here level by level, for all pairs of bodies at once.
//! Launch   `bounds`: a lane a pair of nodes; a grid of any size strides; before each level, first
//!          over the roots of all relations.
//!          `corners`, `candidates`: blocks of a warp, which stride over the pairs of tiles.
//! Reads    a relation and its bound; two nodes; 32 triangles of each tile.
//! Writes   bounds; candidates, a pair of tiles and two places, each once, in no order.
//! Before   relations and pairs are listed. A bound is none, or at least the least distance of its
//!          two bodies, as computed; of any two, if all relations have one word. Bodies that are known to share a point have a word that is not 0
//!          ([`super::touching`]), and nothing is read or written for them.
//! After    the same of bounds. They are at most the largest distance of volumes of a pair, and
//!          the least distance of first corners of a pair of tiles.
//!          pairs ⊇ {(p, q) : p in tile a, q in tile b, computed distance = the least of the bodies
//!          ≤ the distance of the query}, of bodies that are not known to share a point.
//!          Bounds change while they are read, so other candidates depend on the schedule. A pair
//!          above is within every bound: see [`crate::bvh::gap`].
//! Room     `pairs` may be too short: counters go on, the host grows it and runs again.
//! Cost     `bounds` 150 operations a pair. `corners` 96 distances of points a pair of tiles.
//!          `candidates` 200 operations in f32 a pair of triangles whose boxes are near.

use super::triangles::{Corners, column, list, overlapping, sift};
use crate::abi::{
    Candidate, InstancesWithinArgs, MeshNode, NONE, NodePair, NodesWithinArgs, Relation, RelationWords,
    counter,
};
use crate::bv::FrameBox;
use crate::bvh::gap::{Close, apart, farthest, limit};
use crate::bvh::pieces::Pieces;
use crate::bvh::tiles::TILE;
use crate::exec::{Block, Lane, PairTest, RowMap, Shared};
use crate::math::{Real, Vec3};
use crate::prim::planes;
use bytemuck::Zeroable;

/// Lanes of a block, a lane a triangle.
pub const LANES: u32 = TILE;
/// Pairs of triangles of two tiles.
const FOUND: u32 = LANES * LANES;
/// A point, in shared memory.
type Point = [f32; 3];
/// Shared memory of `corners`: the largest gap, the least squares, and points.
pub const SHARED_CORNERS: u32 = 48 + 2 * Pieces::<Point>::bytes(LANES);
/// Shared memory of `candidates`: the largest gap, the least square, two sides with their names,
/// corners, and what was found.
pub const SHARED: u32 =
    32 + 2 * Pieces::<Close>::bytes(LANES) + Pieces::<Corners>::bytes(LANES) + 2 * 4 * LANES + 4 * FOUND;

/// No gap is within it.
const NOTHING: f32 = -1.0;

/// The square of the largest gap of a relation's volumes, the same for all lanes of the block.
#[inline(always)]
pub fn reach<B: Block>(
    block: &mut B,
    words: &RelationWords,
    word: Shared<u32>,
    (number, relation): (u32, &Relation),
) -> f32 {
    block.phase(|lane| {
        if lane.lane() == 0 {
            let is_known = lane.read(words.touching, number) != 0;
            let reach = limit(words.bound(lane, number), relation.slack);
            lane.put(word, 0, (if is_known { NOTHING } else { reach }).to_bits());
        }
        lane.meet();
    });
    f32::from_bits(block.peek(word, 0))
}

/// Lowers bounds by the largest distances of volumes.
pub fn bounds<B: Block>(block: &mut B, args: &NodesWithinArgs) {
    let of = &args.of;
    let is_root = of.pairs.items().is_empty();
    let count = if is_root { of.relations.listed(block) } else { of.pairs.listed(block) };
    let lanes = block.lanes();
    let mut base = block.block() * lanes;
    while base < count {
        block.phase(|lane| {
            let i = base + lane.lane();
            let pair = if is_root | (i >= count) { NodePair::zeroed() } else { of.pairs.get(lane, i) };
            let number = if is_root { i } else { pair.relation };
            if i < count && lane.read(args.words.touching, number) == 0 {
                let relation = of.relations.get(lane, number);
                let root =
                    |body: u32| lane.read(of.tables.meshes, lane.read(of.tables.bodies, body).mesh).root;
                let [a, b] = if is_root { relation.bodies.map(root) } else { [pair.a, pair.b] };
                let [a, b] = [a, b].map(|node| lane.read(of.tables.nodes, node).volume);
                args.words.lower(lane, number, farthest(&relation, &a, &b));
            }
            lane.meet();
        });
        base += block.blocks() * lanes;
    }
}

/// A pair of tiles, its relation, and the square of the largest gap.
struct Tiles {
    pair: NodePair,
    relation: Relation,
    nodes: [MeshNode; 2],
    limit: f32,
}

/// The pair of a number.
#[inline(always)]
fn tiles<B: Block>(block: &mut B, args: &InstancesWithinArgs, word: Shared<u32>, unit: u32) -> Tiles {
    let pair = block.load(args.of.tile_pairs.items(), unit);
    let relation = block.load(args.of.relations.items(), pair.relation);
    let limit = reach(block, &args.words, word, (pair.relation, &relation));
    let nodes = [pair.a, pair.b].map(|tile| block.load(args.of.tables.nodes, tile));
    Tiles { pair, relation, nodes, limit }
}

impl Tiles {
    /// The volumes of both tiles in the frame of the first body.
    #[inline(always)]
    fn volumes(&self) -> [Close; 2] {
        let second = self.relation.of_second(&self.nodes[1].volume).first;
        [self.nodes[0].volume, second].map(|volume| Close { volume, limit: self.limit })
    }
}

/// Lowers bounds by distances of first corners of triangles: that of the first tile next to the
/// middle of the second, its neighbour there, and the neighbour of that one.
pub fn corners<B: Block>(block: &mut B, args: &InstancesWithinArgs) {
    let (count, tables) = (args.of.tile_pairs.listed(block), &args.of.tables);
    let share = block.share(count, 1);
    if share.is_empty() {
        return;
    }
    let (word, closest) = (block.shared::<u32>(4), block.shared::<u64>(4));
    let points = [Pieces::<Point>::new(block, LANES), Pieces::<Point>::new(block, LANES)];
    let mut unit = share.first;
    while unit < share.end {
        let at = tiles(block, args, word, unit);
        unit += share.step;
        let [a, b] = at.volumes();
        if !a.reaches(&b) {
            continue;
        }
        let middle = [0, 1, 2].map(|k| 0.5 * b.volume.lo[k] + 0.5 * b.volume.hi[k]);
        block.phase(|lane| {
            // The first place of a tile has a triangle.
            let corner = |tile: u32| {
                let place = tile * TILE + lane.lane();
                let is_empty = lane.read(tables.leaves, place).number == NONE;
                lane.read(tables.triangles, if is_empty { tile * TILE } else { place }).corners[0]
            };
            points[0].put(lane, lane.lane(), corner(at.pair.a));
            points[1].put(lane, lane.lane(), at.relation.to_first(corner(at.pair.b)));
            if lane.lane() < 3 {
                lane.put(closest, lane.lane(), u64::MAX);
            }
            lane.meet();
        });
        let mut step = 0;
        while step < 3 {
            block.phase(|lane| {
                let side = step % 2;
                let from = if step == 0 {
                    middle
                } else {
                    points[1 - side].get(lane, lane.get(closest, step as u32 - 1) as u32)
                };
                let to = points[side].get(lane, lane.lane());
                let d = Vec3(from) - Vec3(to);
                lane.shared_min(closest, step as u32, (d.dot(d).to_bits() as u64) << 32 | lane.lane() as u64);
                lane.meet();
            });
            step += 1;
        }
        block.phase(|lane| {
            if lane.lane() == 0 {
                let squared = f32::from_bits((lane.get(closest, 2) >> 32) as u32).wide();
                args.words.lower(lane, at.pair.relation, apart(&at.relation, squared));
            }
            lane.meet();
        });
    }
}

/// Whether a gap is within the limit.
struct Near;

impl PairTest for Near {
    type Item = Close;
    #[inline(always)]
    fn test(a: &Close, b: &Close) -> bool {
        a.reaches(b)
    }
}

/// Two triangles: [`BEYOND`], or one more than the bits of the least square of two corners' distance.
struct Between {
    slack: f32,
    /// The root of the largest gap's square.
    length: f32,
}

/// Result for two that are farther apart than the length.
const BEYOND: u32 = 0;

impl RowMap for Between {
    type Number = f32;
    type Row = [Corners; 2];
    #[inline(always)]
    fn at_once(&self, [p, q]: [Corners; 2]) -> u32 {
        let corners = |t: Corners| [Vec3(t[0]), Vec3(t[1]), Vec3(t[2])];
        let (p, q) = (corners(p), corners(q));
        let is_beyond = planes::farther(&p, &q, (self.slack, self.length));
        if is_beyond { BEYOND } else { planes::corners_apart(&p, &q).to_bits() + 1 }
    }
}

/// A box that is larger on all sides. `by` has the slack in it, which is more than roundings.
#[inline(always)]
fn grown(FrameBox { lo, hi }: FrameBox, by: f32) -> FrameBox {
    FrameBox { lo: [lo[0] - by, lo[1] - by, lo[2] - by], hi: [hi[0] + by, hi[1] + by, hi[2] + by] }
}

/// Candidates of pairs of tiles: pairs of triangles of which neither boxes in the frame of the first
/// body nor heights exceed the bound. Lowers bounds by the distances of their corners.
pub fn candidates<B: Block>(block: &mut B, args: &InstancesWithinArgs) {
    let (count, tables) = (args.of.tile_pairs.listed(block), &args.of.tables);
    let share = block.share(count, 1);
    if share.is_empty() {
        return;
    }
    let (word, closest) = (block.shared::<u32>(4), block.shared::<u64>(2));
    let (rows, columns) = (Pieces::<Close>::new(block, LANES), Pieces::<Close>::new(block, LANES));
    let corners = Pieces::<Corners>::new(block, LANES);
    let names = [block.shared::<u32>(LANES), block.shared::<u32>(LANES)];
    let found = block.shared::<u32>(FOUND);
    let mut verdicts = block.slot(None);
    let (mut unit, mut tests) = (share.first, 0u64);
    while unit < share.end {
        let (at, tile_pair) = (tiles(block, args, word, unit), unit);
        unit += share.step;
        let [a, b] = at.volumes();
        if !a.reaches(&b) {
            continue;
        }
        tests += 2 * LANES as u64;
        let close = |volume| Close { volume, limit: at.limit };
        let (length, slack) = (Real::sqrt(at.limit), at.relation.slack);
        // Boxes that overlap a larger one first: of all triangles of a tile at once.
        let grown = |volume| grown(volume, length + slack);
        let (in_second, in_first) = (at.relation.of_first(&a.volume).second, b.volume);
        let nearly = overlapping(block, tables, at.pair.a, &grown(in_first), names[0]);
        let height = block.select(
            nearly,
            |lane| {
                let name = lane.get(names[0], lane.lane());
                let own = close(lane.read(tables.leaves, at.pair.a * TILE + name).volume);
                (own.reaches(&b), (name, own))
            },
            |lane, to, (name, own)| {
                rows.put(lane, to, own);
                lane.put(names[0], to, name);
            },
        );
        if height == 0 {
            continue;
        }
        let nearly = overlapping(block, tables, at.pair.b, &grown(in_second), names[1]);
        let width = block.select(
            nearly,
            |lane| {
                let name = lane.get(names[1], lane.lane());
                let own = lane.read(tables.triangles, at.pair.b * TILE + name).corners;
                let (moved, volume) = at.relation.triangle_to_first(&own);
                (close(volume).reaches(&a), (name, moved, close(volume)))
            },
            |lane, to, (name, moved, own)| {
                columns.put(lane, to, own);
                corners.put(lane, to, moved);
                lane.put(names[1], to, name);
            },
        );
        tests += (LANES * height) as u64;
        if width == 0 {
            continue;
        }
        block.phase(|lane| {
            if lane.lane() == 0 {
                lane.put(closest, 0, u64::MAX);
            }
            lane.meet();
        });
        let fill = block.cross_own::<Near>(
            0..height,
            0,
            |lane, k| rows.get(lane, k),
            |lane| column(lane, columns, width, height),
            |lane, to, pair| lane.put(found, to, Candidate::word(pair)),
        );
        let map = Between { slack, length };
        let fits = sift(
            block,
            &map,
            (found, fill),
            &mut verdicts,
            |lane, [p, q]| {
                let place = at.pair.a * TILE + lane.get(names[0], p);
                [lane.read(tables.triangles, place).corners, corners.get(lane, q)]
            },
            |lane, verdict| {
                let is_kept = verdict != BEYOND;
                if is_kept {
                    // Squares are at least 0: their bits are ordered as they are.
                    lane.shared_min(closest, 0, (verdict - 1) as u64);
                }
                is_kept
            },
            names,
        );
        if fits == 0 {
            continue;
        }
        block.phase(|lane| {
            if lane.lane() == 0 {
                let squared = f32::from_bits(lane.get(closest, 0) as u32).wide();
                args.words.lower(lane, at.pair.relation, apart(&at.relation, squared));
            }
            lane.meet();
        });
        list(block, args.of.pairs, tile_pair, (found, fits));
    }
    args.of.counters.add_once(block, counter::STEPS, tests);
}
