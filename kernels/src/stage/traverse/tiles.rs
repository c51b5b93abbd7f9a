//! # Pairs of tiles: nodes → tiles that overlap
//! Paper    not in the paper.
//! Launch   a block of a warp a moving tile, or a tile of a share of them.
//! Reads    nodes: 32 of the top level, or twice 16 below others, at once.
//! Writes   pairs of tiles, the earlier first.
//! Before   all nodes are fitted.
//! After    tile_pairs = {(a, b) : a < b, volumes overlap, a moves, filters allow}.
//!          With a share or a sample: a in [from, to), every `every`-th. With a horizon: volumes
//!          overlap before it.
//!          With rims, for two tiles round one hub also: one's rim overlaps the other.
//! Room     `tile_pairs` may be too short: counters go on, the host grows it and runs again. The
//!          stack on chip cannot overflow.
//!          Two nodes are taken from its top, and children of the lower one are put back first. So
//!          each level has at most 32 on it.
//! Cost     a test a node of the top level from the tile's own on, 16 a node that overlaps.

use crate::abi::{LEAF, NONE, NodeFilter, Pair, TilePairsArgs, counter};
use crate::bv::Volume;
use crate::bvh::horizon::Horizon;
use crate::bvh::tiles::{FAN, MOST_LEVELS, TILE};
use crate::exec::{Block, Lane, Shared, Slot};

/// Lanes of a block: two nodes' children.
pub const LANES: u32 = 2 * FAN;
const _: () = assert!(LANES == TILE);
/// Nodes that wait.
const STACK: u32 = LANES * MOST_LEVELS;
/// Tiles that are found before they are written.
const FOUND: u32 = 256;
/// Shared memory of a block.
pub const SHARED: u32 = 4 * (STACK + FOUND);

/// Pairs of tiles that overlap, before the horizon.
pub fn pairs<const HORIZON: bool, V: Volume, B: Block>(block: &mut B, args: &TilePairsArgs<V>) {
    let stack = block.shared::<u32>(STACK);
    let found = block.shared::<u32>(FOUND);
    let mut hit = block.slot((NONE, NONE));
    let mut nodes = block.slot(0u32);
    let mut tiles = block.slot(0u32);
    let mut tests = 0u64;
    let horizon = Horizon::of(block, args.known);
    let mut tile = args.from + block.block() * args.every;
    while tile < args.to {
        let own = horizon.cut::<HORIZON, V>(block.load(args.nodes, tile).volume);
        let filters = args.filters.nodes;
        let whose = if filters.is_empty() { NodeFilter::default() } else { block.load(filters, tile) };
        let hub = if args.rims.is_empty() { 0 } else { block.load(args.rims, tile).link };
        let (mut waiting, mut fill) = (0, 0);
        let mut top = tile >> args.shift;
        while top < args.tops || waiting > 0 {
            let taken = waiting.min(2);
            block.phase(|lane| {
                let place = if taken == 0 {
                    if top + lane.lane() < args.tops { args.top + top + lane.lane() } else { NONE }
                } else if lane.lane() / FAN < taken {
                    lane.get(stack, waiting - taken + lane.lane() / FAN) + lane.lane() % FAN
                } else {
                    NONE
                };
                *hit.of(lane) = (NONE, NONE);
                (*nodes.of(lane), *tiles.of(lane)) = (0, 0);
                if place != NONE {
                    let node = lane.read(args.nodes, place);
                    let meets = node.link != NONE
                        && node.last > tile
                        && own.may_overlap(&horizon.cut::<HORIZON, V>(node.volume))
                        && (filters.is_empty() || {
                            let other = lane.read(filters, place);
                            args.filters.allows(lane, whose, other)
                                && !args.filters.leaves_out(lane, whose, other)
                        })
                        && (hub == 0 || {
                            let other = lane.read(args.rims, place);
                            let [rim, round] = [lane.read(args.rims, tile).volume, other.volume]
                                .map(|volume| horizon.cut::<HORIZON, V>(volume));
                            other.link != hub
                                || rim.may_overlap(&horizon.cut::<HORIZON, V>(node.volume))
                                || own.may_overlap(&round)
                        });
                    if meets {
                        *hit.of(lane) = (node.link, node.last);
                        let is_tile = node.link & LEAF != 0;
                        (*nodes.of(lane), *tiles.of(lane)) = (!is_tile as u32, is_tile as u32);
                    }
                }
            });
            tests += LANES as u64;
            let [met, hits] = [block.number(&mut nodes), block.number(&mut tiles)];
            waiting -= taken;
            block.phase(|lane| {
                let (link, last) = *hit.of(lane);
                if link != NONE && link & LEAF == 0 {
                    lane.put(stack, waiting + *nodes.of(lane), link);
                } else if link != NONE {
                    lane.put(found, fill + *tiles.of(lane), last);
                }
            });
            if taken == 0 {
                top += LANES;
            }
            waiting += met;
            fill += hits;
            if fill > FOUND - LANES {
                write(block, args, tile, found, fill);
                fill = 0;
            }
        }
        write(block, args, tile, found, fill);
        tile += block.blocks() * args.every;
    }
    args.counters.add_once(block, counter::STEPS, tests);
}

/// Appends the pairs of a tile with those that it has found.
fn write<V: Volume, B: Block>(
    block: &mut B,
    args: &TilePairsArgs<V>,
    tile: u32,
    found: Shared<u32>,
    fill: u32,
) {
    let base = args.tile_pairs.reserve(block, fill as u64);
    block.phase(|lane| {
        let mut i = lane.lane();
        while i < fill {
            args.tile_pairs.put(lane, base + i as u64, Pair { a: tile, b: lane.get(found, i) });
            i += LANES;
        }
    });
}
