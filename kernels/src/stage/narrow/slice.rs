//! # Slice: the few pairs that isolation leaves → proven contacts
//! Paper    not in the paper.
//! Launch   a block a pair, best of [`SLICES`] lanes. A lane takes a slice of the pair's window,
//!          then every [`SLICES`] / lanes on.
//!          A grid of any size strides.
//! Reads    pairs, faces or edges, positions of both frames (four vertices); tolerances of bodies,
//!          if they differ.
//! Writes   contacts and undecided pairs; or the earliest.
//! Before   no pair touches at the start: `climb::isolate_and_settle` has decided these.
//! After    {pairs that meet} ⊆ listed; no time is late. The first slice that is not apart decides.
//!          One lane decides a slice that is left open: by nearness, then by a search of boxes. A
//!          pair whose iterations run out is listed.
//! Room     hits: counted past the end, grown, run again.
//! Cost     about 3,000 operations of f64 a lane. One lane reads a pair again that a slice leaves
//!          open, which is rare. Its search costs 1,200 operations a box, and its stack of boxes is
//!          local memory, 3 KB.

use super::climb::emit;
use super::{edge_edge, of_edge_edge, of_vertex_face, vertex_face};
use crate::abi::{Listed, Pair, RungArgs};
use crate::exec::{Block, Lane, Shared, Slot};
use crate::math::Real;
use crate::prim::inclusion::{Params, Verdict};
use crate::prim::isolate::ladder::{SLICES, Slice, decided, ee_searched, sliced, vf_searched};
use crate::prim::isolate::{self, Edges, Face};

/// Bytes of shared memory of a block: which slices are not apart.
pub const SHARED: u32 = 4;

/// All slices of all pairs.
pub fn slice<R: Real, B: Block>(block: &mut B, args: &RungArgs<R>) {
    let met = block.shared::<u32>(1);
    each(
        block,
        args,
        &args.vf,
        met,
        |lane, pair| of_vertex_face(lane, args, pair),
        |lane, pair, p| {
            let (v, f) = vertex_face(lane, &args.frames, args.faces, pair);
            Face::new(v, f, p)
        },
        |lane, pair, from| {
            let (v, f) = vertex_face(lane, &args.frames, args.faces, pair);
            vf_searched(v, f, from, of_vertex_face(lane, args, pair))
        },
    );
    each(
        block,
        args,
        &args.ee,
        met,
        |lane, pair| of_edge_edge(lane, args, pair),
        |lane, pair, p| {
            let [x, y] = edge_edge(lane, &args.frames, args.edges, pair);
            Edges::new(x, y, p)
        },
        |lane, pair, from| {
            let [x, y] = edge_edge(lane, &args.frames, args.edges, pair);
            ee_searched(x, y, from, of_edge_edge(lane, args, pair))
        },
    );
}

/// All pairs of one kind.
#[inline(always)]
fn each<R: Real, B: Block, const N: usize>(
    block: &mut B,
    args: &RungArgs<R>,
    of: &Listed,
    met: Shared<u32>,
    params: impl Fn(&B::Lane, Pair) -> Params,
    motion: impl Fn(&B::Lane, Pair, &Params) -> isolate::Pair<f64, N>,
    search: impl Fn(&B::Lane, Pair, f64) -> Verdict,
) {
    let count = of.pairs.listed(block);
    let lanes = block.lanes();
    let mut mine = block.slot(Slice::Apart);
    let mut begins = block.slot(0.0);
    let mut i = block.block();
    while i < count {
        block.phase(|lane| {
            if lane.lane() == 0 {
                lane.put(met, 0, 0);
            }
        });
        block.phase(|lane| {
            *mine.of(lane) = Slice::Apart;
            let indices = of.pairs.get(lane, i);
            let p = params(lane, indices);
            let pair = motion(lane, indices, &p);
            let Some(window) = pair.window() else { return };
            *begins.of(lane) = pair.not_before(window);
            let mut slice = lane.lane();
            while slice < SLICES {
                // A slice behind another that is not apart cannot change the answer. A late read of
                // that is harmless.
                let earlier = lane.shared_add(met, 0, 0) & ((1 << slice) - 1);
                if earlier != 0 {
                    return;
                }
                let verdict = sliced(&pair, window, slice, &p);
                if verdict != Slice::Apart {
                    *mine.of(lane) = verdict;
                    lane.shared_add(met, 0, 1 << slice);
                    return;
                }
                slice += lanes;
            }
        });
        // The lane of the first slice that is not apart stopped at it.
        let first = block.peek(met, 0).trailing_zeros() % SLICES % lanes;
        block.phase(|lane| {
            if lane.lane() != first {
                return;
            }
            let indices = of.pairs.get(lane, i);
            let search = |from| search(lane, indices, from);
            let verdict = decided(*mine.of(lane), *begins.of(lane), search, &args.params);
            emit(lane, args, of, indices, verdict);
        });
        i += block.blocks();
    }
}
