//! # Separate: pairs that may come within a separation → proven contacts
//! Paper    not in the paper.
//! Launch   as many blocks as are resident, both kinds of pairs in one launch. In f64, over the rest
//!          of [`super::abreast`] or over all. Advancements differ in length: a lane takes one step,
//!          then the next.
//!          A finished lane draws the next pair of its block, so few lanes idle.
//!          A block's pairs are a grid apart. The kinds begin at opposite ends of the grid.
//! Reads    pairs, those of `abreast` with a time; faces or edges, positions of both frames (four
//!          vertices); tolerances of bodies, if they differ.
//! Writes   contacts and undecided pairs with bounds of toi; or the earliest.
//! Before   pairs are complete. Before its time a pair is certainly farther apart.
//! After    {pairs that come within the separation} ⊆ listed; no time is late. See
//!          [`crate::prim::isolate::advance`].
//!          A pair whose steps run out is listed as undecided.
//! Room     hits: counted past the end, grown, run again.
//! Cost     16 B pair (8 B without a time), 12 B indices, 128 B positions (gathered). 300 to 600
//!          operations a step, mostly one or two steps behind f32, two to fifteen without it.

use super::climb::emit;
use super::{edge_edge, of_edge_edge, of_vertex_face, vertex_face};
use crate::abi::{Listed, Pair, RungArgs};
use crate::exec::{Block, Lane};
use crate::math::Real;
use crate::prim::isolate::normal::{NUMBERS, Normal};
use crate::prim::isolate::separation::Double;
use crate::prim::isolate::{Edges, Face};

/// Bytes of shared memory of a block: a normal a lane, and the numbers of pairs drawn.
pub const fn shared_bytes(lanes: u32) -> u32 {
    8 * NUMBERS as u32 * lanes + 8
}

/// How many pairs there are. They have times if `is_begun`.
#[inline(always)]
fn listed<B: Block>(block: &B, of: &Listed, is_begun: bool) -> u32 {
    if is_begun { of.begun.listed(block) } else { of.pairs.listed(block) }
}

/// A pair, and the time where f64 begins.
#[inline(always)]
fn nth<L: Lane>(lane: &L, of: &Listed, is_begun: bool, i: u32) -> (Pair, f64) {
    if is_begun {
        let begun = of.begun.get(lane, i);
        (begun.pair, f64::from_bits(begun.from))
    } else {
        (of.pairs.get(lane, i), 0.0)
    }
}

/// All pairs of both lists.
#[inline(always)]
pub fn separate<R: Real, B: Block>(block: &mut B, args: &RungArgs<R>) {
    let (first, blocks) = (block.block(), block.blocks());
    // Whether f32 has left the pairs.
    let is_begun = !args.vf.begun.count().is_empty();
    let (count_vf, count_ee) = (listed(block, &args.vf, is_begun), listed(block, &args.ee, is_begun));
    let lanes = block.lanes();
    let (normals, drawn) = (block.shared::<u64>(NUMBERS as u32 * lanes), block.shared::<u32>(2));
    block.phase(|lane| {
        if lane.lane() == 0 {
            lane.put(drawn, 0, 0);
            lane.put(drawn, 1, 0);
        }
    });
    block.phase(|lane| {
        // The normal does not change: it is computed once, and needs no registers.
        let put = |normal: Normal<f64>| {
            let numbers = normal.numbers();
            for (k, number) in numbers.into_iter().enumerate() {
                lane.put(normals, k as u32 * lanes + lane.lane(), number.to_bits());
            }
        };
        let normal = || {
            let mut numbers = [0.0; NUMBERS];
            for (k, number) in numbers.iter_mut().enumerate() {
                *number = f64::from_bits(lane.get(normals, k as u32 * lanes + lane.lane()));
            }
            Normal::of_numbers(numbers)
        };
        let mut under_way: Option<(Pair, Double)> = None;
        // A quarter of the lanes begins with vertices and faces, so that few warps have both kinds.
        let (mut is_face, mut kinds) = (lane.lane() < lanes / 4, 2);
        while lane.any(kinds > 0 || under_way.is_some()) {
            if kinds > 0 && under_way.is_none() {
                let i = blocks as u64 * lane.shared_add(drawn, is_face as u32, 1) as u64;
                let (i, count) = if is_face {
                    (i + first as u64, count_vf)
                } else {
                    (i + (blocks - 1 - first) as u64, count_ee)
                };
                if i >= count as u64 {
                    (is_face, kinds) = (!is_face, kinds - 1);
                } else if is_face {
                    let (pair, from) = nth(lane, &args.vf, is_begun, i as u32);
                    let p = of_vertex_face(lane, args, pair);
                    let (v, f) = vertex_face(lane, &args.frames, args.faces, pair);
                    let face = Face::new(v, f, &p);
                    put(face.normal());
                    under_way = Some((pair, Double::begin(face.of_four(), from, &p)));
                } else {
                    let (pair, from) = nth(lane, &args.ee, is_begun, i as u32);
                    let p = of_edge_edge(lane, args, pair);
                    let [x, y] = edge_edge(lane, &args.frames, args.edges, pair);
                    let edges = Edges::new(x, y, &p);
                    put(edges.normal());
                    under_way = Some((pair, Double::begin(edges, from, &p)));
                }
            }
            // Lanes that drew and lanes that did not step side by side.
            if lane.any(under_way.is_some())
                && let Some((pair, double)) = &mut under_way
                && let Some(verdict) = double.step(&args.params, normal)
            {
                if double.is_face() {
                    emit(lane, args, &args.vf, *pair, verdict);
                } else {
                    emit(lane, args, &args.ee, *pair, verdict);
                }
                under_way = None;
            }
        }
        lane.meet();
    });
}
