//! # Slice: the few pairs that isolation leaves → contacts, proven, with bounds of their first time
//! Paper    none: beyond it.
//! Launch   a block a pair, best of [`SLICES`] lanes: a lane a slice of the pair's window, and every so many lanes one more; a
//!          grid of any size strides.
//! Reads    pairs, faces or edges, positions of both frames (four vertices); tolerances of bodies, if they differ.
//! Writes   contacts and unresolved pairs; or the earliest.
//! Before   the pairs do not touch at the start: `climb::settle` has seen to it.
//! After    every pair that meets is listed, none late. The first slice that is not apart decides; what it leaves open the
//!          last rungs decide, in one lane: nearness, then a search by boxes. A pair whose budget ends is listed.
//! Room     hits: counted past the end, grown, run again.
//! Cost     about 3,000 operations of f64 a lane; a search 1,200 a box, one lane. Boxes wait in a stack in local memory, 3 KB.

use super::climb::emit;
use super::{edge_edge, of_edge_edge, of_vertex_face, vertex_face};
use crate::abi::{Listed, Pair, RungArgs};
use crate::exec::{Block, Lane, Shared, Slot};
use crate::math::Real;
use crate::prim::inclusion::{self, Params, Verdict};
use crate::prim::isolate::ladder::{SLICES, Slice, decided, searched, sliced};
use crate::prim::isolate::{self, Edges, Face};

/// Bytes of shared memory of a block: which slices are not apart.
pub const SHARED: u32 = 4;

/// All slices of all pairs.
pub fn slice<R: Real, B: Block>(b: &mut B, a: &RungArgs<R>) {
    let open = b.shared::<u32>(1);
    each(
        b,
        (a, &a.vf, open),
        |l, pair| of_vertex_face(l, a, pair),
        |l, pair, p| {
            let (v, f) = vertex_face(l, (&a.frames, a.faces), pair);
            Face::new(v, f, p)
        },
        |l, pair, (known, p)| {
            let (v, f) = vertex_face(l, (&a.frames, a.faces), pair);
            searched(inclusion::Face::<f64>::new(v, f, p), known, p)
        },
    );
    each(
        b,
        (a, &a.ee, open),
        |l, pair| of_edge_edge(l, a, pair),
        |l, pair, p| {
            let [x, y] = edge_edge(l, (&a.frames, a.edges), pair);
            Edges::new(x, y, p)
        },
        |l, pair, (known, p)| {
            let [x, y] = edge_edge(l, (&a.frames, a.edges), pair);
            searched(inclusion::Edges::<f64>::new(x, y, p), known, p)
        },
    );
}

/// All pairs of one kind.
#[inline(always)]
fn each<R: Real, B: Block, const N: usize>(
    b: &mut B,
    (a, of, open): (&RungArgs<R>, &Listed, Shared<u32>),
    asked: impl Fn(&B::Lane, Pair) -> Params,
    motion: impl Fn(&B::Lane, Pair, &Params) -> isolate::Pair<f64, N>,
    search: impl Fn(&B::Lane, Pair, (Verdict, &Params)) -> Verdict,
) {
    let count = of.pairs.listed(b);
    let lanes = b.lanes();
    let mut mine = b.slot(Slice::Apart);
    let mut i = b.block();
    while i < count {
        b.phase(|l| {
            if l.lane() == 0 {
                l.put(open, 0, 0);
            }
        });
        b.phase(|l| {
            *mine.of(l) = Slice::Apart;
            let indices = of.pairs.get(l, i);
            let p = asked(l, indices);
            let pair = motion(l, indices, &p);
            let Some(window) = pair.window() else { return };
            let mut slice = l.lane();
            while slice < SLICES {
                // One behind another that is not apart has nothing to say. Whether it heard of that in time is all the same.
                let earlier = l.shared_add(open, 0, 0) & ((1 << slice) - 1);
                if earlier != 0 {
                    return;
                }
                let told = sliced(&pair, window, slice, &p);
                if told != Slice::Apart {
                    *mine.of(l) = told;
                    l.shared_add(open, 0, 1 << slice);
                    return;
                }
                slice += lanes;
            }
        });
        // The lane of the first slice that is not apart stopped at it.
        let first = b.peek(open, 0).trailing_zeros() % SLICES % lanes;
        b.phase(|l| {
            if l.lane() != first {
                return;
            }
            let indices = of.pairs.get(l, i);
            let p = asked(l, indices);
            let pair = motion(l, indices, &p);
            let Some(window) = pair.window() else { return };
            let search = |known| search(l, indices, (known, &p));
            let verdict = decided(&pair, *mine.of(l), window, search, &p);
            emit(l, a, of, (indices, verdict));
        });
        i += b.blocks();
    }
}
