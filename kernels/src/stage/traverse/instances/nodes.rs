//! # Nodes of instances: pairs of nodes → pairs of the nodes below
//! Paper    not in the paper, whose queues hold pairs of nodes of binary trees.
//! Launch   blocks of a warp, which stride over the pairs; once for each level. First over the roots
//!          of all relations.
//! Reads    a relation, two nodes and up to 32 below each.
//! Writes   pairs of tiles, or pairs for the next level, in no order.
//! Before   relations and pairs are listed. The children of a node are all tiles, or none is.
//! After    tile_pairs ∪ next ⊇ {(c, d) : c below a, d below b, boxes overlap in both frames}, for
//!          each (a, b) in pairs. A tile is below itself. [`nodes`], [`moving_nodes`]: so is
//!          a node above tiles, if the other is higher; and tile_pairs has no tiles whose oriented boxes
//!          are apart.
//!          A pair that is left out has no two triangles with a common point.
//! Room     both lists may be too short: counters go on, the host grows them and runs again.
//! Cost     32 B a node; a box in the other frame 50 operations. Those of one side that meet the
//!          node of the other are rows, a vote each. [`nodes`]: 96 B from cache and 200 operations a
//!          pair of tiles, in full warps ([`crate::bvh::tile_box`]).
//!
//! [`moving_nodes`] does the same for a step, by boxes around both ends, and by oriented boxes that are
//! apart on one side at both: see [`crate::bvh::motion`].
//!
//! [`nodes_within`] keeps pairs whose gap is within the bound of their relation, see
//! [`super::within`].

use crate::abi::{
    MeshNode, MovingNodesArgs, NodePair, NodesArgs, NodesWithinArgs, Output, Relation, counter,
};
use crate::bvh::gap::CloseInBoth;
use crate::bvh::pieces::Pieces;
use crate::bvh::relation::{Both, Related};
use crate::bvh::tile_box::{APART, Oriented, TilesApart};
use crate::bvh::tiles::TILE;
use crate::exec::{Block, Lane, Own, PairTest, Shared, Slot};
use bytemuck::Zeroable;

/// Lanes of a block: a lane a node below.
pub const LANES: u32 = TILE;
/// Pairs of nodes below two.
const FOUND: u32 = LANES * LANES;
/// Shared memory of a block.
pub const SHARED: u32 = shared_bytes::<Overlap>();
/// That of [`nodes_within`], which also has a word for the largest gap.
pub const SHARED_WITHIN: u32 = shared_bytes::<Near>() + 16;

const fn shared_bytes<T: Test>() -> u32 {
    Pieces::<T::Item>::bytes(LANES) + 4 * LANES + 8 * FOUND
}

/// A test of two volumes, each in both frames.
trait Test: PairTest {
    /// A volume as an item, with the square of the largest gap.
    fn item(both: Both, limit: f32) -> Self::Item;
}

/// Whether boxes overlap in both frames.
struct Overlap;

impl PairTest for Overlap {
    type Item = Both;
    #[inline(always)]
    fn test(a: &Both, b: &Both) -> bool {
        a.overlaps(b)
    }
}

impl Test for Overlap {
    #[inline(always)]
    fn item(both: Both, _: f32) -> Both {
        both
    }
}

/// Whether gaps in both frames are within the limit.
struct Near;

impl PairTest for Near {
    type Item = CloseInBoth;
    #[inline(always)]
    fn test(a: &CloseInBoth, b: &CloseInBoth) -> bool {
        a.reaches(b)
    }
}

impl Test for Near {
    #[inline(always)]
    fn item(both: Both, limit: f32) -> CloseInBoth {
        CloseInBoth { both, limit }
    }
}

/// The nodes below a node: the first, and how many.
#[inline(always)]
fn below(at: u32, node: &MeshNode) -> (u32, u32) {
    if node.count == 0 { (at, 1) } else { (node.first, node.count) }
}

/// Parts of a descent beyond its test.
trait Descent<Q: Related, B: Block> {
    /// Whether a tile or a node above tiles stays if the other node is higher. Both are above tiles in
    /// the end, and one block has all their tiles. Levels are as many as those of the higher mesh.
    const IS_EVEN: bool;
    /// The square of the largest gap of a relation's nodes.
    fn limit(&mut self, block: &mut B, number: u32, relation: &Q) -> f32;
    /// Leaves out pairs of tiles that are apart. Given are the first tile of each body, and pairs of
    /// places behind these. The others stay in their order. Returns how many.
    fn sift(&mut self, block: &mut B, of: &Q, tiles: [u32; 2], found: (Shared<[u32; 2]>, u32)) -> u32;
    /// Tests of it so far.
    fn tests(&self) -> u64 {
        0
    }
}

/// Pairs whose gap is within a bound.
struct Within<'a> {
    args: &'a NodesWithinArgs,
    word: Shared<u32>,
}

impl<B: Block> Descent<Relation, B> for Within<'_> {
    const IS_EVEN: bool = false;
    #[inline(always)]
    fn limit(&mut self, block: &mut B, number: u32, relation: &Relation) -> f32 {
        super::within::reach(block, &self.args.words, self.word, (number, relation))
    }
    #[inline(always)]
    fn sift(&mut self, _: &mut B, _: &Relation, _: [u32; 2], (_, fill): (Shared<[u32; 2]>, u32)) -> u32 {
        fill
    }
}

/// Pairs whose oriented boxes are not apart, of tiles.
struct ByOrientedBoxes<'a, B: Block> {
    args: &'a NodesArgs,
    verdicts: B::Slot<Option<([u32; 2], u32)>>,
    tests: u64,
}

impl<Q: Oriented, B: Block> Descent<Q, B> for ByOrientedBoxes<'_, B> {
    const IS_EVEN: bool = true;
    #[inline(always)]
    fn limit(&mut self, _: &mut B, _: u32, _: &Q) -> f32 {
        0.0
    }
    #[inline(always)]
    fn sift(
        &mut self,
        block: &mut B,
        of: &Q,
        [a, b]: [u32; 2],
        (found, fill): (Shared<[u32; 2]>, u32),
    ) -> u32 {
        let boxes = self.args.boxes;
        if boxes.is_empty() {
            return fill;
        }
        self.tests += fill as u64;
        let map = TilesApart { relation: *of };
        let (mut at, mut left) = (0, 0);
        while at < fill {
            block.map_rows(
                &map,
                |lane| (at + lane.lane() < fill).then(|| lane.get(found, at + lane.lane())),
                |lane, [p, q]| Some([lane.read(boxes, a + p), lane.read(boxes, b + q)]),
                |lane, result| {
                    *self.verdicts.of(lane) = result;
                    lane.meet();
                },
            );
            // Never behind its own place, which was read.
            left += block.select(
                LANES,
                |lane| match *self.verdicts.of(lane) {
                    Some((pair, verdict)) => (verdict != APART, pair),
                    None => (false, [0; 2]),
                },
                |lane, place, pair| lane.put(found, left + place, pair),
            );
            at += LANES;
        }
        left
    }
    #[inline(always)]
    fn tests(&self) -> u64 {
        self.tests
    }
}

/// Pairs of nodes below pairs.
pub fn nodes<B: Block>(block: &mut B, args: &NodesArgs) {
    let mut descent = ByOrientedBoxes { args, verdicts: block.slot(None), tests: 0 };
    descend::<Overlap, _, _, _>(block, args, args.relations, &mut descent);
}

/// Pairs of nodes below pairs of bodies in motion.
pub fn moving_nodes<B: Block>(block: &mut B, args: &MovingNodesArgs) {
    let mut descent = ByOrientedBoxes { args: &args.of, verdicts: block.slot(None), tests: 0 };
    descend::<Overlap, _, _, _>(block, &args.of, args.relations, &mut descent);
}

/// Pairs of nodes below pairs that may hold the nearest pair of triangles.
pub fn nodes_within<B: Block>(block: &mut B, args: &NodesWithinArgs) {
    let word = block.shared::<u32>(4);
    descend::<Near, _, _, _>(block, &args.of, args.of.relations, &mut Within { args, word });
}

/// Pairs of nodes below pairs, by a test.
#[inline(always)]
fn descend<T: Test, Q: Related, B: Block, D: Descent<Q, B>>(
    block: &mut B,
    args: &NodesArgs,
    relations: Output<Q>,
    descent: &mut D,
) {
    let is_root = args.pairs.items().is_empty();
    let count = if is_root { relations.listed(block) } else { args.pairs.listed(block) };
    let share = block.share(count, 1);
    if share.is_empty() {
        return;
    }
    let rows = Pieces::<T::Item>::new(block, LANES);
    let names = block.shared::<u32>(LANES);
    let found = block.shared::<[u32; 2]>(FOUND);
    let mut columns = block.slot((T::Item::zeroed(), false));
    let (mut unit, mut tests) = (share.first, 0u64);
    while unit < share.end {
        let pair = if is_root { NodePair::zeroed() } else { block.load(args.pairs.items(), unit) };
        let number = if is_root { unit } else { pair.relation };
        let relation = block.load(relations.items(), number);
        let [a, b] = if is_root {
            relation.bodies().map(|body| {
                let mesh = block.load(args.tables.bodies, body).mesh;
                block.load(args.tables.meshes, mesh).root
            })
        } else {
            [pair.a, pair.b]
        };
        let [of_a, of_b] = [a, b].map(|node| block.load(args.tables.nodes, node));
        let is_low = |node: &MeshNode| (node.count == 0) | (node.first < args.tables.tiles);
        let (low_a, low_b) = (is_low(&of_a), is_low(&of_b));
        let stays = |own: bool, other: bool| D::IS_EVEN & own & !other;
        let (a, a_count) = if stays(low_a, low_b) { (a, 1) } else { below(a, &of_a) };
        let (b, b_count) = if stays(low_b, low_a) { (b, 1) } else { below(b, &of_b) };
        let most = descent.limit(block, number, &relation);
        let [whole_a, whole_b] =
            [relation.first_in_both(&of_a.volume), relation.second_in_both(&of_b.volume)]
                .map(|both| T::item(both, most));
        let height = block.select(
            a_count.max(b_count),
            |lane| {
                let i = lane.lane();
                let (mut row, mut is_row) = (T::Item::zeroed(), false);
                if i < a_count {
                    let volume = lane.read(args.tables.nodes, a + i).volume;
                    row = T::item(relation.first_in_both(&volume), most);
                    is_row = T::test(&row, &whole_b);
                }
                if i < b_count {
                    let volume = lane.read(args.tables.nodes, b + i).volume;
                    let column = T::item(relation.second_in_both(&volume), most);
                    *columns.of(lane) = (column, T::test(&column, &whole_a));
                }
                (is_row, row)
            },
            |lane, at, row| {
                rows.put(lane, at, row);
                lane.put(names, at, lane.lane());
            },
        );
        tests += (a_count + b_count + height * LANES) as u64;
        unit += share.step;
        if height == 0 {
            continue;
        }
        let mut fill = block.cross_own::<T>(
            0..height,
            0,
            |lane, k| rows.get(lane, k),
            |lane| {
                let (item, meets) = *columns.of(lane);
                let is_column = (lane.lane() < b_count) & meets;
                Own { item, name: lane.lane(), end: if is_column { height } else { 0 } }
            },
            |lane, at, [k, name]| lane.put(found, at, [lane.get(names, k), name]),
        );
        // Nodes below a node are of one level.
        let are_tiles = (a < args.tables.tiles) & (b < args.tables.tiles);
        let to: Output<NodePair> = if are_tiles { args.tile_pairs } else { args.next };
        if are_tiles {
            fill = descent.sift(block, &relation, [a, b], (found, fill));
        }
        let base = to.reserve(block, fill as u64);
        block.phase(|lane| {
            let mut at = lane.lane();
            while at < fill {
                let [first, second] = lane.get(found, at);
                let pair = NodePair { relation: number, a: a + first, b: b + second, pad: 0 };
                to.put(lane, base + at as u64, pair);
                at += LANES;
            }
            lane.meet();
        });
    }
    args.counters.add_once(block, counter::STEPS, tests + descent.tests());
}
