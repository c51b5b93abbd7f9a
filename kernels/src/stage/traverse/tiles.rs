//! # Pairs of tiles: nodes → tiles that overlap
//! Paper    nothing of the seed's.
//! Launch   a block of a warp a tile of what moves, or of a share of it.
//! Reads    nodes, 32 of the top level or twice 16 below others at once.     Writes   pairs of tiles, the earlier first.
//! Before   all nodes are fitted.
//! After    each pair of tiles whose volumes overlap, of which the first is one that seeks and whose triangles may meet, but for a tile with itself. Nodes
//!          whose tiles are all at or before the own one are passed over. Of a sample: of every so many tiles the first. Where an
//!          earliest time is sought, none that only meets behind the horizon. With rims, of two tiles round one hub
//!          only such of which one's rim overlaps the other.
//! Room     `tile_pairs` may be too short: counters go on, the host grows it and runs again. On chip it cannot run out: two nodes are
//!          taken from the top of the stack, those below the lower one put back first; so of each level at most 32 wait.
//! Cost     a test a node of the top level behind the own one, 16 a node that overlaps.

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
pub fn pairs<const HORIZON: bool, V: Volume, B: Block>(b: &mut B, a: &TilePairsArgs<V>) {
    let stack = b.shared::<u32>(STACK);
    let found = b.shared::<u32>(FOUND);
    let mut hit = b.slot((NONE, NONE));
    let mut nodes = b.slot(0u32);
    let mut tiles = b.slot(0u32);
    let mut tests = 0u64;
    let horizon = Horizon::of(b, a.known);
    let mut tile = a.from + b.block() * a.every;
    while tile < a.to {
        let own = horizon.cut::<HORIZON, V>(b.load(a.nodes, tile).volume);
        let filters = a.filters.nodes;
        let whose = if filters.is_empty() { NodeFilter::default() } else { b.load(filters, tile) };
        let hub = if a.rims.is_empty() { 0 } else { b.load(a.rims, tile).link };
        let (mut waiting, mut fill) = (0, 0);
        let mut top = tile >> a.shift;
        while top < a.tops || waiting > 0 {
            let taken = waiting.min(2);
            b.phase(|l| {
                let place = if taken == 0 {
                    if top + l.lane() < a.tops { a.top + top + l.lane() } else { NONE }
                } else if l.lane() / FAN < taken {
                    l.get(stack, waiting - taken + l.lane() / FAN) + l.lane() % FAN
                } else {
                    NONE
                };
                *hit.of(l) = (NONE, NONE);
                (*nodes.of(l), *tiles.of(l)) = (0, 0);
                if place != NONE {
                    let node = l.read(a.nodes, place);
                    let meets = node.link != NONE
                        && node.last > tile
                        && own.may_overlap(&horizon.cut::<HORIZON, V>(node.volume))
                        && (filters.is_empty() || a.filters.allows(l, whose, l.read(filters, place)))
                        && (hub == 0 || {
                            let other = l.read(a.rims, place);
                            let [rim, round] = [l.read(a.rims, tile).volume, other.volume]
                                .map(|volume| horizon.cut::<HORIZON, V>(volume));
                            other.link != hub
                                || rim.may_overlap(&horizon.cut::<HORIZON, V>(node.volume))
                                || own.may_overlap(&round)
                        });
                    if meets {
                        *hit.of(l) = (node.link, node.last);
                        let is_tile = node.link & LEAF != 0;
                        (*nodes.of(l), *tiles.of(l)) = (!is_tile as u32, is_tile as u32);
                    }
                }
            });
            tests += LANES as u64;
            let [met, hits] = [b.number(&mut nodes), b.number(&mut tiles)];
            waiting -= taken;
            b.phase(|l| {
                let (link, last) = *hit.of(l);
                if link != NONE && link & LEAF == 0 {
                    l.put(stack, waiting + *nodes.of(l), link);
                } else if link != NONE {
                    l.put(found, fill + *tiles.of(l), last);
                }
            });
            if taken == 0 {
                top += LANES;
            }
            waiting += met;
            fill += hits;
            if fill > FOUND - LANES {
                write(b, a, (found, fill), tile);
                fill = 0;
            }
        }
        write(b, a, (found, fill), tile);
        tile += b.blocks() * a.every;
    }
    a.counters.add_once(b, counter::STEPS, tests);
}

/// Appends the pairs of a tile with those that it has found.
fn write<V: Volume, B: Block>(b: &mut B, a: &TilePairsArgs<V>, (found, fill): (Shared<u32>, u32), tile: u32) {
    let base = a.tile_pairs.reserve(b, fill as u64);
    b.phase(|l| {
        let mut i = l.lane();
        while i < fill {
            a.tile_pairs.put(l, base + i as u64, Pair { a: tile, b: l.get(found, i) });
            i += LANES;
        }
    });
}
