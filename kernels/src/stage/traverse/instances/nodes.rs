//! # Nodes of instances: pairs of nodes → pairs of the nodes below
//! Paper    not in the paper, whose queues hold pairs of nodes of binary trees.
//! Launch   blocks of a warp, which stride over the pairs; once for each level. First over the roots
//!          of all relations.
//! Reads    a relation, two nodes and up to 32 below each.
//! Writes   pairs of tiles, or pairs for the next level, in no order.
//! Before   relations and pairs are listed. The children of a node are all tiles, or none is.
//! After    tile_pairs ∪ next ⊇ {(c, d) : c below a, d below b, boxes overlap in both frames}, for
//!          each (a, b) in pairs. A tile is below itself.
//!          A pair that is left out has no two triangles with a common point.
//! Room     both lists may be too short: counters go on, the host grows them and runs again.
//! Cost     32 B a node; a box in the other frame 50 operations. Those of one side that meet the
//!          node of the other are rows, a vote each.
//!
//! [`moving_nodes`] does the same for a step, by boxes around both ends: see [`crate::bvh::motion`].
//!
//! [`nodes_within`] keeps pairs whose gap is within the bound of their relation, see
//! [`super::within`].

use crate::abi::{MeshNode, MovingNodesArgs, NodePair, NodesArgs, NodesWithinArgs, Output, counter};
use crate::bvh::gap::{CloseInBoth, limit};
use crate::bvh::pieces::Pieces;
use crate::bvh::relation::{Both, Related};
use crate::bvh::tiles::TILE;
use crate::exec::{Block, Lane, Own, PairTest, Slot};
use bytemuck::Zeroable;

/// Lanes of a block: a lane a node below.
pub const LANES: u32 = TILE;
/// Pairs of nodes below two.
const FOUND: u32 = LANES * LANES;
/// Shared memory of a block.
pub const SHARED: u32 = shared_bytes::<Overlap>();
/// That of [`nodes_within`], which also has a word for a bound.
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

/// Pairs of nodes below pairs.
pub fn nodes<B: Block>(block: &mut B, args: &NodesArgs) {
    descend::<Overlap, _, B>(block, args, args.relations, |_, _, _| 0.0);
}

/// Pairs of nodes below pairs of bodies in motion.
pub fn moving_nodes<B: Block>(block: &mut B, args: &MovingNodesArgs) {
    descend::<Overlap, _, B>(block, &args.of, args.relations, |_, _, _| 0.0);
}

/// Pairs of nodes below pairs that may hold the nearest pair of triangles.
pub fn nodes_within<B: Block>(block: &mut B, args: &NodesWithinArgs) {
    let word = block.shared::<u64>(1);
    descend::<Near, _, B>(block, &args.of, args.of.relations, |block, number, relation| {
        limit(super::within::bound(block, &args.words, word, number), relation.slack)
    });
}

/// Pairs of nodes below pairs, by a test. `limit` returns the square of the largest gap of a
/// relation's nodes.
#[inline(always)]
fn descend<T: Test, Q: Related, B: Block>(
    block: &mut B,
    args: &NodesArgs,
    relations: Output<Q>,
    mut limit: impl FnMut(&mut B, u32, &Q) -> f32,
) {
    let rows = Pieces::<T::Item>::new(block, LANES);
    let names = block.shared::<u32>(LANES);
    let found = block.shared::<[u32; 2]>(FOUND);
    let mut own = block.slot([T::Item::zeroed(); 2]);
    let mut firsts = block.slot(0u32);
    let mut meets = block.slot([false; 2]);
    let is_root = args.pairs.items().is_empty();
    let count = if is_root { relations.listed(block) } else { args.pairs.listed(block) };
    let (mut unit, mut tests) = (block.block(), 0u64);
    while unit < count {
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
        let ((a, a_count), (b, b_count)) = (below(a, &of_a), below(b, &of_b));
        let most = limit(block, number, &relation);
        let [whole_a, whole_b] =
            [relation.first_in_both(&of_a.volume), relation.second_in_both(&of_b.volume)]
                .map(|x| T::item(x, most));
        block.phase(|lane| {
            let i = lane.lane();
            let mut both = [T::Item::zeroed(); 2];
            let mut meet = [false; 2];
            if i < a_count {
                let volume = lane.read(args.tables.nodes, a + i).volume;
                both[0] = T::item(relation.first_in_both(&volume), most);
                meet[0] = T::test(&both[0], &whole_b);
            }
            if i < b_count {
                let volume = lane.read(args.tables.nodes, b + i).volume;
                both[1] = T::item(relation.second_in_both(&volume), most);
                meet[1] = T::test(&both[1], &whole_a);
            }
            *own.of(lane) = both;
            *meets.of(lane) = meet;
            *firsts.of(lane) = meet[0] as u32;
            lane.meet();
        });
        let height = block.number(&mut firsts);
        tests += (a_count + b_count + height * LANES) as u64;
        unit += block.blocks();
        if height == 0 {
            continue;
        }
        block.phase(|lane| {
            if meets.of(lane)[0] {
                rows.put(lane, *firsts.of(lane), own.of(lane)[0]);
                lane.put(names, *firsts.of(lane), lane.lane());
            }
            lane.meet();
        });
        let fill = block.cross_own::<T>(
            0..height,
            0,
            |lane, k| rows.get(lane, k),
            |lane| Own {
                item: own.of(lane)[1],
                name: lane.lane(),
                end: if meets.of(lane)[1] { height } else { 0 },
            },
            |lane, at, [k, name]| lane.put(found, at, [lane.get(names, k), name]),
        );
        // Nodes below a node are of one level.
        let are_tiles = (a < args.tables.tiles) & (b < args.tables.tiles);
        let to: Output<NodePair> = if are_tiles { args.tile_pairs } else { args.next };
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
    args.counters.add_once(block, counter::STEPS, tests);
}
