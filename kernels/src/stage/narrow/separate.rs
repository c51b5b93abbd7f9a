//! # Separate: pairs that may come within a separation → proven contacts
//! Paper    not in the paper.
//! Launch   as many blocks as are resident, both kinds of pairs in one launch. In f64, over the rest
//!          of [`super::abreast`] or over all. Advancements differ in length: a lane takes one step,
//!          then the next.
//!          A finished lane draws the next pair of its block, so few lanes idle.
//!          A block's pairs are a grid apart. The kinds begin at opposite ends of the grid.
//!          Pairs of vertices with different radii have a kernel of their own, [`thick`].
//! Reads    pairs, those of `abreast` with a time; faces or edges, positions of both frames (four
//!          vertices); tolerances of bodies, if they differ; radii, with a thickness.
//! Writes   contacts and undecided pairs with bounds of toi; or the earliest.
//! Before   pairs are complete. Before its time a pair is certainly farther apart.
//! After    {pairs that come within the separation} ⊆ listed; no time is late. See
//!          [`crate::prim::isolate::advance`].
//!          A pair whose steps run out is listed as undecided.
//! Room     hits: counted past the end, grown, run again.
//! Cost     16 B pair (8 B without a time), 12 B indices, 128 B positions (gathered). 300 to 600
//!          operations a step, mostly one or two steps behind f32, two to fifteen without it.

use super::climb::emit;
use super::{edge_edge, of_edge_edge, of_vertex_face, radii_of_edges, radii_of_face, vertex_face};
use crate::abi::{Listed, Pair, RungArgs, ThickRungArgs};
use crate::exec::{Block, Lane};
use crate::math::Real;
use crate::prim::inclusion::{Params, Verdict};
use crate::prim::isolate::normal::{NUMBERS, Normal};
use crate::prim::isolate::separation::Double;
use crate::prim::isolate::thick::{Uneven, is_even};
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

/// A pair under way.
pub trait UnderWay<R: Real, L: Lane>: Copy {
    /// The arguments of its kernel.
    type Args;
    /// Those of every rung.
    fn rung(args: &Self::Args) -> &RungArgs<R>;
    /// A vertex and a face, from a time before which they are certainly farther apart. Its normal is
    /// kept by `put`.
    fn of_face(lane: &L, args: &Self::Args, from: (Pair, f64), put: impl FnOnce(Normal<f64>)) -> Self;
    /// Two edges.
    fn of_edges(lane: &L, args: &Self::Args, from: (Pair, f64), put: impl FnOnce(Normal<f64>)) -> Self;
    /// Whether it is a vertex and a face.
    fn is_face(&self) -> bool;
    /// A step; once it was the last, the verdict.
    fn step(&mut self, p: &Params, normal: impl Fn() -> Normal<f64>) -> Option<Verdict>;
}

impl<R: Real, L: Lane> UnderWay<R, L> for Double {
    type Args = RungArgs<R>;
    #[inline(always)]
    fn rung(args: &RungArgs<R>) -> &RungArgs<R> {
        args
    }
    #[inline(always)]
    fn of_face(
        lane: &L,
        args: &RungArgs<R>,
        (pair, from): (Pair, f64),
        put: impl FnOnce(Normal<f64>),
    ) -> Self {
        let p = of_vertex_face(lane, args, pair);
        let (v, f) = vertex_face(lane, &args.frames, args.faces, pair);
        let face = Face::new(v, f, &p);
        put(face.normal());
        Double::begin(face.of_four(), from, &p)
    }
    #[inline(always)]
    fn of_edges(
        lane: &L,
        args: &RungArgs<R>,
        (pair, from): (Pair, f64),
        put: impl FnOnce(Normal<f64>),
    ) -> Self {
        let p = of_edge_edge(lane, args, pair);
        let [x, y] = edge_edge(lane, &args.frames, args.edges, pair);
        let edges = Edges::new(x, y, &p);
        put(edges.normal());
        Double::begin(edges, from, &p)
    }
    #[inline(always)]
    fn is_face(&self) -> bool {
        Double::is_face(self)
    }
    #[inline(always)]
    fn step(&mut self, p: &Params, normal: impl Fn() -> Normal<f64>) -> Option<Verdict> {
        Double::step(self, p, normal)
    }
}

/// A pair of vertices with a thickness: of one radius a feature, or of several.
#[derive(Clone, Copy)]
enum Thick {
    Even(Double),
    Uneven(Uneven),
}

impl<R: Real, L: Lane> UnderWay<R, L> for Thick {
    type Args = ThickRungArgs<R>;
    #[inline(always)]
    fn rung(args: &ThickRungArgs<R>) -> &RungArgs<R> {
        &args.rung
    }
    #[inline(always)]
    fn of_face(
        lane: &L,
        args: &ThickRungArgs<R>,
        (pair, from): (Pair, f64),
        put: impl FnOnce(Normal<f64>),
    ) -> Self {
        let radii = radii_of_face(lane, args.radii, args.rung.faces, pair);
        let p = of_radii(of_vertex_face(lane, &args.rung, pair), &args.rung.params, radii);
        let (v, f) = vertex_face(lane, &args.rung.frames, args.rung.faces, pair);
        let face = Face::new(v, f, &p);
        put(face.normal());
        Thick::begin(face.of_four(), radii, from, &p)
    }
    #[inline(always)]
    fn of_edges(
        lane: &L,
        args: &ThickRungArgs<R>,
        (pair, from): (Pair, f64),
        put: impl FnOnce(Normal<f64>),
    ) -> Self {
        let radii = radii_of_edges(lane, args.radii, args.rung.edges, pair);
        let p = of_radii(of_edge_edge(lane, &args.rung, pair), &args.rung.params, radii);
        let [x, y] = edge_edge(lane, &args.rung.frames, args.rung.edges, pair);
        let edges = Edges::new(x, y, &p);
        put(edges.normal());
        Thick::begin(edges, radii, from, &p)
    }
    #[inline(always)]
    fn is_face(&self) -> bool {
        match self {
            Thick::Even(double) => double.is_face(),
            Thick::Uneven(uneven) => uneven.is_face(),
        }
    }
    #[inline(always)]
    fn step(&mut self, p: &Params, normal: impl Fn() -> Normal<f64>) -> Option<Verdict> {
        match self {
            Thick::Even(double) => double.step(p, normal),
            Thick::Uneven(uneven) => uneven.step(p),
        }
    }
}

/// Parameters of a pair whose separation is that of the query, and the radius if there is one.
#[inline(always)]
fn of_radii(of_bodies: Params, query: &Params, radii: [f64; 4]) -> Params {
    let radius = if is_even(radii) { radii[0] } else { 0.0 };
    Params { min_separation: query.min_separation + radius, ..of_bodies }
}

impl Thick {
    #[inline(always)]
    fn begin(pair: Edges<f64>, radii: [f64; 4], from: f64, p: &Params) -> Self {
        if is_even(radii) {
            Thick::Even(Double::begin(pair, from, p))
        } else {
            Thick::Uneven(Uneven::begin(&pair, radii, from, p))
        }
    }
}

/// All pairs of both lists.
#[inline(always)]
pub fn separate<R: Real, B: Block>(block: &mut B, args: &RungArgs<R>) {
    each::<R, B, Double>(block, args);
}

/// All pairs of both lists, of vertices with a thickness.
#[inline(always)]
pub fn thick<R: Real, B: Block>(block: &mut B, args: &ThickRungArgs<R>) {
    each::<R, B, Thick>(block, args);
}

#[inline(always)]
fn each<R: Real, B: Block, U: UnderWay<R, B::Lane>>(block: &mut B, of_kernel: &U::Args) {
    let args = U::rung(of_kernel);
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
        let mut under_way: Option<(Pair, U)> = None;
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
                    let begun = nth(lane, &args.vf, is_begun, i as u32);
                    under_way = Some((begun.0, U::of_face(lane, of_kernel, begun, put)));
                } else {
                    let begun = nth(lane, &args.ee, is_begun, i as u32);
                    under_way = Some((begun.0, U::of_edges(lane, of_kernel, begun, put)));
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
