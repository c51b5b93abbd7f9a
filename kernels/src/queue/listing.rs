//! Tests of pairs of triangles, to lists of pairs of features.

use crate::abi::{Facet, Output, Pair, Span};
use crate::exec::{Block, Lane, Shared, Slot};
use crate::math::pick;
use crate::prim::sweep::MOST;

/// Numbers of tests of a lane, with one to spare.
const TESTS: u32 = 16;
/// Bits of the tests that are vertices and faces.
const VERTICES: u32 = 63;
/// Counts of both kinds in one word: at most 15 a lane, so blocks of up to 1,024 lanes fit 16 bits.
const EE: u32 = 1 << 16;

/// Bytes of shared memory of a block: a number of each test that is to be listed.
pub const fn listing_bytes(lanes: u32) -> u32 {
    4 * MOST * lanes
}

/// The lists of both kinds, and the triangles that they are of.
pub struct FeatureLists {
    /// Every triangle's vertices and edges.
    pub facets: Span<Facet>,
    /// Out: vertex, face.
    pub vf: Output<Pair>,
    /// Out: edge, edge.
    pub ee: Output<Pair>,
}

/// The tests of the lanes' pairs. They are numbered in shared memory first, so that all lanes write.
pub struct Listing<B: Block> {
    /// Which lane's test each candidate is.
    listed: Shared<u32>,
    masks: B::Slot<u32>,
    places: B::Slot<u32>,
}

impl<B: Block> Listing<B> {
    /// No tests yet.
    #[inline(always)]
    pub fn new(block: &mut B) -> Self {
        let listed = block.shared::<u32>(MOST * block.lanes());
        Listing { listed, masks: block.slot(0), places: block.slot(0) }
    }

    /// The tests of a lane's pair, as bits of `owned` in [`crate::stage::narrow::features`]; the last call of a phase.
    #[inline(always)]
    pub fn set(&mut self, lane: &B::Lane, mask: u32) {
        *self.masks.of(lane) = mask;
        *self.places.of(lane) = (mask & VERTICES).count_ones() + EE * (mask & !VERTICES).count_ones();
        lane.meet();
    }

    /// Lists them. `pair_of` gives the pair of a lane, by its number.
    #[inline(always)]
    pub fn put(&mut self, block: &mut B, lists: &FeatureLists, pair_of: impl Fn(&B::Lane, u32) -> Pair) {
        let (lanes, listed) = (block.lanes(), self.listed);
        let total = block.scan(&mut self.places);
        let (vf, ee) = (total % EE, total / EE);
        let starts = block.reserve_both([lists.vf.count(), lists.ee.count()], [vf.into(), ee.into()]);
        // Written by few lanes that have many, read by all.
        block.phase(|lane| {
            let (mut mask, before) = (*self.masks.of(lane), *self.places.of(lane));
            let (mut next_vf, mut next_ee) = (before % EE, vf + before / EE);
            while mask != 0 {
                let k = mask.trailing_zeros();
                mask &= mask - 1;
                let next = if k < 6 { &mut next_vf } else { &mut next_ee };
                lane.put(listed, *next, lane.lane() * TESTS + k);
                *next += 1;
            }
            lane.meet();
        });
        block.phase(|lane| {
            let facet = |triangle| lane.read(lists.facets, triangle);
            let mut i = lane.lane();
            while i < vf + ee {
                let test = lane.get(listed, i);
                let (pair, k) = (pair_of(lane, test / TESTS), test % TESTS);
                if i < vf {
                    lists.vf.put(lane, starts[0] + i as u64, vertex_and_face(facet, pair, k));
                } else {
                    let place = starts[1] + (i - vf) as u64;
                    lists.ee.put(lane, place, two_edges(facet, pair, k - 6));
                }
                i += lanes;
            }
            lane.meet();
        });
    }
}

/// Test 0 to 5: a vertex of the first triangle and the second, or the other way round.
#[inline(always)]
fn vertex_and_face(facet: impl Fn(u32) -> Facet, pair: Pair, test: u32) -> Pair {
    let (of, face, k) = if test < 3 { (pair.a, pair.b, test) } else { (pair.b, pair.a, test - 3) };
    Pair { a: pick(facet(of).corners, k), b: face }
}

/// Test 6 to 14, less 6: an edge of each.
#[inline(always)]
fn two_edges(facet: impl Fn(u32) -> Facet, pair: Pair, test: u32) -> Pair {
    let edge = |of: u32, k: u32| pick(facet(of).edges, k);
    let (x, y) = (edge(pair.a, test / 3), edge(pair.b, test % 3));
    Pair { a: x.min(y), b: x.max(y) }
}
