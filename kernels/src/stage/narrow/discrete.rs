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

use super::{Entries, append_each, expect, stride};
use crate::abi::{DiscreteArgs, DiscreteFlags, Pair};
use crate::exec::{Block, Lane, OPEN, RowMap, Slot};
use crate::math::{Real, Vec3};
use crate::prim::adjacent::{Shared, meets_beyond_shared};
use crate::prim::moller;
use crate::prim::tri_tri::{self, Certain, Filter, SIGNS, Wide, meets, parted};
use core::marker::PhantomData;

/// The corners of a triangle.
fn corners<R: Real, L: Lane>(l: &L, a: &DiscreteArgs<R>, face: [u32; 3]) -> [Vec3<R>; 3] {
    let at = |v| l.read(a.positions, v).at;
    [at(face[0]), at(face[1]), at(face[2])]
}

/// The seed's test, in f32.
pub fn moller<R: Real, B: Block>(b: &mut B, a: &DiscreteArgs<R>) {
    let count = a.pairs.listed(b);
    append_each(b, count, a.contacts, |l, i| {
        let pair = a.pairs.get(l, i);
        let triangle = |t: u32| corners(l, a, l.read(a.faces, t));
        let (p, q) = (triangle(pair.a), triangle(pair.b));
        // What it believes depends on roundings: f32 numbers have those of f32, whatever else is in the scene.
        let is_single = p.iter().chain(&q).all(|x| x.is_single());
        let meet = if is_single {
            moller::moller(&p.map(|x| x.narrow()), &q.map(|x| x.narrow()))
        } else {
            moller::moller(&p, &q)
        };
        meet.then_some(pair)
    });
}

/// Pairs of a block and what is known of each.
struct Verdicts<B: Block> {
    pairs: B::Slot<Pair>,
    verdicts: B::Slot<Option<bool>>,
    entries: Entries<B, Pair>,
}

impl<B: Block> Verdicts<B> {
    fn new(b: &B) -> Self {
        Verdicts { pairs: b.slot(Pair::default()), verdicts: b.slot(Some(false)), entries: Entries::new(b) }
    }

    #[inline(always)]
    fn set(&mut self, l: &B::Lane, pair: Pair, verdict: Option<bool>) {
        *self.pairs.of(l) = pair;
        *self.verdicts.of(l) = verdict;
    }

    /// Those that meet go to the contacts, those without an answer to the undecided.
    fn sort_out<R: Real>(&mut self, b: &mut B, a: &DiscreteArgs<R>) {
        for (verdict, list) in [(Some(true), a.contacts), (None, a.undecided)] {
            b.phase(|l| {
                let mine = *self.verdicts.of(l) == verdict;
                self.entries.set(l, mine.then_some(*self.pairs.of(l)));
            });
            self.entries.append(b, list);
        }
    }
}

/// Whether one of two triangles' planes parts them; what it does not is [`OPEN`].
struct Parted<R>(PhantomData<R>);

/// What [`Parted`] makes of two triangles that are apart.
const APART: u32 = 0;

impl<R: Real> RowMap for Parted<R> {
    type Number = R;
    type Row = [[Vec3<R>; 3]; 2];
    #[inline(always)]
    fn at_once(&self, [p, q]: [[Vec3<R>; 3]; 2]) -> u32 {
        if parted(&p, &q) { APART } else { OPEN }
    }
}

/// Shared memory of `filter`: pairs that wait.
pub const fn shared_bytes(lanes: u32) -> u32 {
    2 * lanes * size_of::<Pair>() as u32
}

/// Signs with an error bound, in the precision of the positions: contacts, and pairs that it cannot decide. Most pairs are parted by a
/// plane, which takes no branch; the others wait until there is one a lane.
pub fn filter<R: Real, B: Block>(b: &mut B, a: &DiscreteArgs<R>) {
    let (count, lanes) = (a.pairs.listed(b), b.lanes());
    let later = b.blocks() * lanes;
    let waiting = b.shared::<[u32; 2]>(2 * lanes);
    let mut verdicts = Verdicts::new(b);
    let mut open = b.slot(None);
    let mut places = b.slot(0u32);
    let mut fill = 0;
    stride(b, count, |b, base| {
        b.map_rows(
            &Parted(PhantomData),
            |l| {
                let i = base + l.lane();
                if i >= count {
                    return None;
                }
                let pair = a.pairs.get(l, i);
                let faces = [l.read(a.faces, pair.a), l.read(a.faces, pair.b)];
                faces.into_iter().flatten().for_each(|vertex| l.expect(a.positions, vertex));
                expect(l, &a.pairs, (i + later, count), |pair| {
                    l.expect(a.faces, pair.a);
                    l.expect(a.faces, pair.b);
                });
                Some((pair, faces[0], faces[1]))
            },
            |l, (_, p, q)| (!beyond_shared(a, p, q)).then(|| [corners(l, a, p), corners(l, a, q)]),
            |l, told| {
                let left = told.and_then(|((pair, ..), what)| (what != APART).then_some(pair));
                *open.of(l) = left;
                *places.of(l) = left.is_some() as u32;
                l.meet();
            },
        );
        let found = b.scan(&mut places);
        b.phase(|l| {
            if let Some(pair) = *open.of(l) {
                l.put(waiting, fill + *places.of(l), [pair.a, pair.b]);
            }
            l.meet();
        });
        fill += found;
        if fill >= lanes {
            fill -= lanes;
            decide(b, a, &mut verdicts, |l| Some(l.get(waiting, fill + l.lane())));
        }
    });
    decide(b, a, &mut verdicts, |l| (l.lane() < fill).then(|| l.get(waiting, l.lane())));
}

/// Whether a pair is asked about what is beyond the corners that it shares, which the filter leaves to others.
#[inline(always)]
fn beyond_shared<R: Real>(a: &DiscreteArgs<R>, p: [u32; 3], q: [u32; 3]) -> bool {
    a.flags.has(DiscreteFlags::KEEP_ADJACENT) && Shared::by_index(p, q) != Shared::Nothing
}

/// All signs of the pairs that lanes have.
#[inline(always)]
fn decide<R: Real, B: Block>(
    b: &mut B,
    a: &DiscreteArgs<R>,
    verdicts: &mut Verdicts<B>,
    which: impl Fn(&B::Lane) -> Option<[u32; 2]>,
) {
    b.phase(|l| {
        let told = which(l).map(|[p, q]| {
            let faces = [l.read(a.faces, p), l.read(a.faces, q)];
            let verdict = if beyond_shared(a, faces[0], faces[1]) {
                None
            } else {
                meets::<R, Filter>(&corners(l, a, faces[0]), &corners(l, a, faces[1]))
            };
            (Pair { a: p, b: q }, verdict)
        });
        let (pair, verdict) = told.unwrap_or((Pair::default(), Some(false)));
        verdicts.set(l, pair, verdict);
        l.meet();
    });
    verdicts.sort_out(b, a);
}

/// The same in f64, for what f32 left undecided.
pub fn wide<B: Block>(b: &mut B, a: &DiscreteArgs<f32>) {
    let count = a.pairs.listed(b);
    let mut verdicts = Verdicts::new(b);
    stride(b, count, |b, base| {
        b.phase(|l| {
            let i = base + l.lane();
            if i >= count {
                return verdicts.set(l, Pair::default(), Some(false));
            }
            let pair = a.pairs.get(l, i);
            let (p, q) = (l.read(a.faces, pair.a), l.read(a.faces, pair.b));
            let (x, y) = (corners(l, a, p), corners(l, a, q));
            let verdict = match Shared::by_index(p, q) {
                Shared::Nothing => meets::<f32, Wide>(&x, &y),
                shared => beyond(x, y, shared),
            };
            verdicts.set(l, pair, verdict);
        });
        verdicts.sort_out(b, a);
    });
}

/// Of a pair that shares corners. By value and out of line: few pairs are such, and the others keep their registers.
#[inline(never)]
fn beyond(p: [Vec3<f32>; 3], q: [Vec3<f32>; 3], shared: Shared) -> Option<bool> {
    meets_beyond_shared::<f32, Wide>(&p, &q, shared)
}

/// Pairs that a block of `exact` looks at together.
const TOGETHER: u32 = 4;
/// Lanes of a pair: as many as signs, and one that waits.
const LANES_A_PAIR: u32 = SIGNS.next_power_of_two();
/// Shared memory of `exact`: signs.
pub const EXACT_SHARED: u32 = 4 * TOGETHER * LANES_A_PAIR;

/// Exact signs, for what the filters left undecided: each some thousand operations, one after the other.
pub fn exact<R: Real, B: Block>(b: &mut B, a: &DiscreteArgs<R>) {
    let count = a.pairs.listed(b);
    if a.flags.has(DiscreteFlags::KEEP_ADJACENT) || count > b.blocks() * TOGETHER {
        append_each(b, count, a.contacts, |l, i| {
            let (pair, [p, q], shared) = given(l, a, i);
            // `Certain` always answers; were it not to, the pair stays.
            (meets_beyond_shared::<R, Certain>(&p, &q, shared) != Some(false)).then_some(pair)
        });
    } else {
        exact_of_few(b, a, count);
    }
}

/// The same of so few pairs that a lane works out one sign. One lane of each pair decides; it asks for more where the triangles lie in
/// one plane.
fn exact_of_few<R: Real, B: Block>(b: &mut B, a: &DiscreteArgs<R>, count: u32) {
    let lanes = b.lanes();
    let signs = b.shared::<u32>(TOGETHER * LANES_A_PAIR);
    let base = (b.block() * TOGETHER).min(count);
    let some = TOGETHER.min(count - base);
    b.phase(|l| {
        let mut i = l.lane();
        while i < some * LANES_A_PAIR {
            let which = i % LANES_A_PAIR;
            if which < SIGNS {
                let (_, [p, q], _) = given(l, a, base + i / LANES_A_PAIR);
                let sign = tri_tri::sign::<R, Certain>(&p, &q, which).unwrap_or(0);
                l.put(signs, i, (sign + 1) as u32);
            }
            i += lanes;
        }
        l.meet();
    });
    b.phase(|l| {
        let mut i = l.lane();
        while i < some {
            let (pair, [p, q], _) = given(l, a, base + i);
            let sign = |k: usize| l.get(signs, i * LANES_A_PAIR + k as u32) as i32 - 1;
            let verdict = tri_tri::decided(&core::array::from_fn(sign));
            if verdict.or_else(|| meets::<R, Certain>(&p, &q)) != Some(false) {
                a.contacts.push(l, pair);
            }
            i += lanes;
        }
        l.meet();
    });
}

/// A pair, its corners, and what they share.
#[inline(always)]
fn given<R: Real, L: Lane>(l: &L, a: &DiscreteArgs<R>, i: u32) -> (Pair, [[Vec3<R>; 3]; 2], Shared) {
    let pair = a.pairs.get(l, i);
    let (p, q) = (l.read(a.faces, pair.a), l.read(a.faces, pair.b));
    (pair, [corners(l, a, p), corners(l, a, q)], Shared::by_index(p, q))
}
