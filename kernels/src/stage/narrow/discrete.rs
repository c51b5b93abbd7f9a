//! # Discrete: triangle pairs that share a point
//! Paper    section 6.2.5 ([`moller()`], the seed's); beyond it: [`filter`] and [`exact`], the default.
//! Launch   a lane a pair; a grid of any size strides. `filter` over the candidates; of f32 positions `wide` over what that
//!          left undecided; `exact` over what is still undecided.
//! Reads    candidates, faces, positions.   Writes   contacts; `filter` and `wide` also the undecided pairs.
//! Before   candidates are complete. Positions are finite.
//! After    moller  the pairs that the float test believes in: it can miss and it can err.
//!          filter, wide, exact  exactly the pairs whose closed triangles share a point; of pairs with a common vertex,
//!          those that meet beyond it.
//! Room     contacts, undecided: counted past the end, grown, run again.
//! Cost     8 B pair, 24 B faces, 96 B positions (gathered); about 100 operations for a pair that a plane separates. A sign
//!          takes `wide` some 30 operations in f64, `exact` thousands on integers.

use super::{append_each, listed};
use crate::abi::{DiscreteArgs, KEEP_ADJACENT, Pair, counter};
use crate::exec::{Block, Lane, Slot};
use crate::math::{Real, Vec3};
use crate::prim::adjacent::{Shared, meets_beyond_shared};
use crate::prim::moller;
use crate::prim::tri_tri::{Certain, Filter, Wide, meets};

/// The corners of a triangle.
fn corners<R: Real, L: Lane>(l: &L, a: &DiscreteArgs<R>, face: [u32; 3]) -> [Vec3<R>; 3] {
    face.map(|v| l.read(a.positions, v).at)
}

/// The seed's test, in f32.
pub fn moller<R: Real, B: Block>(b: &mut B, a: &DiscreteArgs<R>) {
    let count = listed(b, a.pairs, a.counters, a.pairs_at);
    append_each(b, count, (a.contacts, a.counters, counter::CONTACTS), |l, i| {
        let pair = l.read(a.pairs, i);
        let triangle = |t: u32| corners(l, a, l.read(a.faces, t));
        moller::moller(&triangle(pair.a), &triangle(pair.b)).then_some(pair)
    });
}

/// Asks each pair; those that meet go to the contacts, those without an answer to the undecided.
fn sort_out<R: Real, B: Block>(
    b: &mut B,
    a: &DiscreteArgs<R>,
    mut ask: impl FnMut(&B::Lane, Pair) -> Option<bool>,
) {
    let count = listed(b, a.pairs, a.counters, a.pairs_at);
    let lanes = b.lanes();
    let mut pairs = b.slot(Pair::default());
    let mut verdicts = b.slot(Some(false));
    let mut places = b.slot(0u32);
    let mut base = b.block() * lanes;
    while base < count {
        b.phase(|l| {
            let i = base + l.lane();
            *verdicts.of(l) = Some(false);
            if i < count {
                let pair = l.read(a.pairs, i);
                *pairs.of(l) = pair;
                *verdicts.of(l) = ask(l, pair);
            }
        });
        for (verdict, list, at) in
            [(Some(true), a.contacts, counter::CONTACTS), (None, a.undecided, a.undecided_at)]
        {
            b.phase(|l| *places.of(l) = (*verdicts.of(l) == verdict) as u32);
            let start = b.append(&mut places, a.counters, at);
            b.phase(|l| {
                let place = start + *places.of(l) as u64;
                if *verdicts.of(l) == verdict && place < list.len {
                    l.write(list, place as u32, *pairs.of(l));
                }
            });
        }
        base += b.blocks() * lanes;
    }
}

/// Signs with an error bound, in the precision of the positions: contacts, and pairs that it cannot decide.
pub fn filter<R: Real, B: Block>(b: &mut B, a: &DiscreteArgs<R>) {
    sort_out(b, a, |l, pair| {
        let (p, q) = (l.read(a.faces, pair.a), l.read(a.faces, pair.b));
        let beyond = a.flags & KEEP_ADJACENT != 0 && Shared::by_index(p, q) != Shared::Nothing;
        if beyond { None } else { meets::<R, Filter>(&corners(l, a, p), &corners(l, a, q)) }
    });
}

/// The same in f64, for what f32 left undecided.
pub fn wide<B: Block>(b: &mut B, a: &DiscreteArgs<f32>) {
    sort_out(b, a, |l, pair| {
        let (p, q) = (l.read(a.faces, pair.a), l.read(a.faces, pair.b));
        let (x, y) = (corners(l, a, p), corners(l, a, q));
        match Shared::by_index(p, q) {
            Shared::Nothing => meets::<f32, Wide>(&x, &y),
            shared => beyond(x, y, shared),
        }
    });
}

/// Of a pair that shares corners. By value and out of line: few pairs are such, and the others keep their registers.
#[inline(never)]
fn beyond(p: [Vec3<f32>; 3], q: [Vec3<f32>; 3], shared: Shared) -> Option<bool> {
    meets_beyond_shared::<f32, Wide>(&p, &q, shared)
}

/// Exact signs, for what the filters left undecided.
pub fn exact<R: Real, B: Block>(b: &mut B, a: &DiscreteArgs<R>) {
    let count = listed(b, a.pairs, a.counters, a.pairs_at);
    append_each(b, count, (a.contacts, a.counters, counter::CONTACTS), |l, i| {
        let pair = l.read(a.pairs, i);
        let (p, q) = (l.read(a.faces, pair.a), l.read(a.faces, pair.b));
        let shared = Shared::by_index(p, q);
        let verdict = meets_beyond_shared::<R, Certain>(&corners(l, a, p), &corners(l, a, q), shared);
        // `Certain` always answers; were it not to, the pair stays.
        (verdict != Some(false)).then_some(pair)
    });
}
