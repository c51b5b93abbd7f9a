//! # Discrete: triangle pairs that share a point
//! Paper    section 6.2.5 ([`moller`], the seed's); beyond it: [`filter`] and [`exact`], the default.
//! Launch   a lane a pair; a grid of any size strides. `exact` after `filter`, over what that left undecided.
//! Reads    candidates, faces, positions.   Writes   contacts; `filter` also the undecided pairs.
//! Before   candidates are complete. Positions are finite.
//! After    moller  the pairs that the float test believes in: it can miss and it can err.
//!          filter, then exact  exactly the pairs whose closed triangles share a point; of pairs with a common vertex,
//!          those that meet beyond it.
//! Room     contacts, undecided: counted past the end, grown, run again.
//! Cost     8 B pair, 24 B faces, 72 B positions (gathered); about 100 operations for a pair that a plane separates.

use super::{append_each, listed};
use crate::abi::{DiscreteArgs, KEEP_ADJACENT, Pair, counter};
use crate::exec::{Block, Lane, Slot};
use crate::math::{Real, Vec3};
use crate::prim::{Exact, Filter, meets, meets_beyond_shared, moller};

/// The corners of a triangle.
fn corners<R: Real, L: Lane>(l: &L, a: &DiscreteArgs<R>, face: [u32; 3]) -> [Vec3<R>; 3] {
    face.map(|v| l.read(a.positions, v))
}

/// Which corners of two triangles are the same vertex: pairs (corner of p, corner of q), and how many.
fn shared(p: [u32; 3], q: [u32; 3]) -> ([(u8, u8); 3], usize) {
    let mut found = [(0, 0); 3];
    let mut count = 0;
    for i in 0..3 {
        for j in 0..3 {
            // A face may name a vertex twice; the vertex is shared once.
            let new = !p[..i].contains(&p[i]) && !q[..j].contains(&q[j]);
            if p[i] == q[j] && new {
                found[count] = (i as u8, j as u8);
                count += 1;
            }
        }
    }
    (found, count)
}

/// The seed's test, in f32.
pub fn moller<R: Real, B: Block>(b: &mut B, a: &DiscreteArgs<R>) {
    let count = listed(b, a.pairs, a.counters, a.pairs_at);
    append_each(b, count, (a.contacts, a.counters, counter::CONTACTS), |l, i| {
        let pair = l.read(a.pairs, i);
        let narrow = |v: u32| corners(l, a, l.read(a.faces, v)).map(|p| p.map(|x| x.wide() as f32));
        moller::meets(narrow(pair.a), narrow(pair.b)).then_some(pair)
    });
}

/// Signs with an error bound, in the precision of the positions: contacts, and pairs that it cannot decide.
pub fn filter<R: Real, B: Block>(b: &mut B, a: &DiscreteArgs<R>) {
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
                let (p, q) = (l.read(a.faces, pair.a), l.read(a.faces, pair.b));
                let beyond = a.flags & KEEP_ADJACENT != 0 && shared(p, q).1 > 0;
                *pairs.of(l) = pair;
                *verdicts.of(l) =
                    if beyond { None } else { meets::<R, Filter>(&corners(l, a, p), &corners(l, a, q)) };
            }
        });
        for (verdict, list, at) in
            [(Some(true), a.contacts, counter::CONTACTS), (None, a.undecided, counter::UNDECIDED)]
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

/// Exact signs, for what the filter left undecided.
pub fn exact<R: Real, B: Block>(b: &mut B, a: &DiscreteArgs<R>) {
    let count = listed(b, a.undecided, a.counters, counter::UNDECIDED);
    append_each(b, count, (a.contacts, a.counters, counter::CONTACTS), |l, i| {
        let pair = l.read(a.undecided, i);
        let (p, q) = (l.read(a.faces, pair.a), l.read(a.faces, pair.b));
        let (common, n) = shared(p, q);
        let (p, q) = (corners(l, a, p), corners(l, a, q));
        let verdict = if n > 0 {
            meets_beyond_shared::<R, Exact>(&p, &q, &common[..n])
        } else {
            meets::<f64, Filter>(&p.map(Vec3::wide), &q.map(Vec3::wide))
                .or_else(|| meets::<R, Exact>(&p, &q))
        };
        (verdict != Some(false)).then_some(pair)
    });
}
