//! # Discrete: triangle pairs that share a point
//! Paper    section 6.2.5 ([`moller()`], the seed's); beyond it: [`filter`] and [`exact`], the default.
//! Launch   a lane a pair; a grid of any size strides. `filter` over the candidates; of f32 positions `wide` over what that
//!          left undecided; `exact` over what is still undecided. [`Still`] where nothing moves; [`Start`] at the start of a
//!          step, over the candidates of the whole step, each a kernel of its own.
//! Reads    candidates, faces, positions.   Writes   contacts; `filter` and `wide` also the undecided pairs.
//! Before   candidates are complete. Positions are finite.
//! After    moller  the pairs that the float test believes in: it can miss and it can err.
//!          filter, wide, exact  exactly the pairs whose closed triangles share a point; of pairs with a common vertex,
//!          those that meet beyond it.
//!          Of `Start`: contacts = {(a, b) in candidates : no common vertex, closed triangles share a point at t = 0}.
//!          These are all such pairs of the scene: a swept volume holds its triangle at t = 0, so the volumes of such a pair
//!          overlap at t = 0. A horizon is above 0, and a volume that is cut at it keeps its start; growth by a separation only adds
//!          candidates. The list that an earliest query has after its sample is whole in this sense.
//! Room     contacts, undecided: counted past the end, grown, run again.
//!          `Start` has room for no contact: their number is what counts.
//! Cost     8 B pair, 24 B faces, 96 B positions (gathered); about 100 operations for a pair that a plane separates, 40 for one of
//!          `Start` whose boxes are apart. A sign
//!          takes `wide` some 30 operations in f64, `exact` thousands on integers.

use super::{Entries, append_each, expect, stride};
use crate::abi::{DiscreteArgs, DiscreteFlags, Pair, Positions};
use crate::exec::{Block, Lane, OPEN, RowMap, Slot};
use crate::math::{Real, Vec3};
use crate::prim::adjacent::{Shared, meets_beyond_shared, share_a_vertex};
use crate::prim::moller;
use crate::prim::tri_tri::{self, Certain, Filter, SIGNS, Wide, meets, parted};
use core::marker::PhantomData;

/// Which positions are read, and what the first look at a pair of triangles is.
pub trait Frame<R: Real> {
    /// Whether pairs with a common vertex are among the candidates and are left out.
    const LEAVES_OUT_ADJACENT: bool;
    /// A vertex will be read soon.
    fn expect<L: Lane>(l: &L, frames: &Positions<R>, vertex: u32);
    /// Reads a vertex.
    fn at<L: Lane>(l: &L, frames: &Positions<R>, vertex: u32) -> Vec3<R>;
    /// Whether two triangles are apart, by a test without branches that most pairs pass. False proves nothing.
    fn are_apart(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3]) -> bool;
}

/// Nothing moves. Candidates overlap here; most are parted by a plane.
pub struct Still;

impl<R: Real> Frame<R> for Still {
    const LEAVES_OUT_ADJACENT: bool = false;
    #[inline(always)]
    fn expect<L: Lane>(l: &L, frames: &Positions<R>, vertex: u32) {
        l.expect(frames.still, vertex);
    }
    #[inline(always)]
    fn at<L: Lane>(l: &L, frames: &Positions<R>, vertex: u32) -> Vec3<R> {
        l.read(frames.still, vertex).at
    }
    #[inline(always)]
    fn are_apart(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3]) -> bool {
        parted(p, q)
    }
}

/// The start of a step. Candidates overlap at some time of it; the boxes of most are apart here.
pub struct Start;

impl<R: Real> Frame<R> for Start {
    const LEAVES_OUT_ADJACENT: bool = true;
    #[inline(always)]
    fn expect<L: Lane>(l: &L, frames: &Positions<R>, vertex: u32) {
        l.expect(frames.moving, vertex);
    }
    #[inline(always)]
    fn at<L: Lane>(l: &L, frames: &Positions<R>, vertex: u32) -> Vec3<R> {
        l.read(frames.moving, vertex).t0.at
    }
    #[inline(always)]
    fn are_apart(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3]) -> bool {
        let ends = |[x, y, z]: &[Vec3<R>; 3]| [x.lesser(*y).lesser(*z), x.greater(*y).greater(*z)];
        let ([p_lo, p_hi], [q_lo, q_hi]) = (ends(p), ends(q));
        let apart = |k: usize| (p_hi[k] < q_lo[k]) | (q_hi[k] < p_lo[k]);
        apart(0) | apart(1) | apart(2)
    }
}

/// The corners of a triangle.
fn corners<R: Real, F: Frame<R>, L: Lane>(l: &L, a: &DiscreteArgs<R>, face: [u32; 3]) -> [Vec3<R>; 3] {
    face.map(|vertex| F::at(l, &a.frames, vertex))
}

/// The seed's test, in f32.
pub fn moller<R: Real, B: Block>(b: &mut B, a: &DiscreteArgs<R>) {
    let count = a.pairs.listed(b);
    append_each(b, count, a.contacts, |l, i| {
        let pair = a.pairs.get(l, i);
        let triangle = |t: u32| corners::<R, Still, _>(l, a, l.read(a.faces, t));
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

/// The first look at two triangles; what it does not decide is [`OPEN`].
struct Apart<R, F>(PhantomData<(R, F)>);

/// What [`Apart`] makes of two triangles that are apart.
const APART: u32 = 0;

impl<R: Real, F: Frame<R>> RowMap for Apart<R, F> {
    type Number = R;
    type Row = [[Vec3<R>; 3]; 2];
    #[inline(always)]
    fn at_once(&self, [p, q]: [[Vec3<R>; 3]; 2]) -> u32 {
        if F::are_apart(&p, &q) { APART } else { OPEN }
    }
}

/// Shared memory of `filter`: pairs that wait.
pub const fn shared_bytes(lanes: u32) -> u32 {
    2 * lanes * size_of::<Pair>() as u32
}

/// Signs with an error bound, in the precision of the positions: contacts, and pairs that it cannot decide. Most pairs are parted by a
/// plane, which takes no branch; the others wait until there is one a lane.
pub fn filter<R: Real, F: Frame<R>, B: Block>(b: &mut B, a: &DiscreteArgs<R>) {
    let (count, lanes) = (a.pairs.listed(b), b.lanes());
    let later = b.blocks() * lanes;
    let waiting = b.shared::<[u32; 2]>(2 * lanes);
    let mut verdicts = Verdicts::new(b);
    let mut open = b.slot(None);
    let mut places = b.slot(0u32);
    let mut fill = 0;
    stride(b, count, |b, base| {
        b.map_rows(
            &Apart::<R, F>(PhantomData),
            |l| {
                let i = base + l.lane();
                if i >= count {
                    return None;
                }
                let pair = a.pairs.get(l, i);
                let faces = [l.read(a.faces, pair.a), l.read(a.faces, pair.b)];
                expect(l, &a.pairs, (i + later, count), |pair| {
                    l.expect(a.faces, pair.a);
                    l.expect(a.faces, pair.b);
                });
                if F::LEAVES_OUT_ADJACENT && share_a_vertex(faces[0], faces[1]) {
                    return None;
                }
                faces.into_iter().flatten().for_each(|vertex| F::expect(l, &a.frames, vertex));
                Some((pair, faces[0], faces[1]))
            },
            |l, (_, p, q)| {
                (!beyond_shared(a, p, q)).then(|| [corners::<R, F, _>(l, a, p), corners::<R, F, _>(l, a, q)])
            },
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
            decide::<R, F, B>(b, a, &mut verdicts, |l| Some(l.get(waiting, fill + l.lane())));
        }
    });
    decide::<R, F, B>(b, a, &mut verdicts, |l| (l.lane() < fill).then(|| l.get(waiting, l.lane())));
}

/// Whether a pair is asked about what is beyond the corners that it shares, which the filter leaves to others.
#[inline(always)]
fn beyond_shared<R: Real>(a: &DiscreteArgs<R>, p: [u32; 3], q: [u32; 3]) -> bool {
    a.flags.has(DiscreteFlags::KEEP_ADJACENT) && Shared::by_index(p, q) != Shared::Nothing
}

/// All signs of the pairs that lanes have.
#[inline(always)]
fn decide<R: Real, F: Frame<R>, B: Block>(
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
                let [x, y] = faces.map(|face| corners::<R, F, _>(l, a, face));
                meets::<R, Filter>(&x, &y)
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
pub fn wide<F: Frame<f32>, B: Block>(b: &mut B, a: &DiscreteArgs<f32>) {
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
            let (x, y) = (corners::<f32, F, _>(l, a, p), corners::<f32, F, _>(l, a, q));
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
pub fn exact<R: Real, F: Frame<R>, B: Block>(b: &mut B, a: &DiscreteArgs<R>) {
    let count = a.pairs.listed(b);
    if a.flags.has(DiscreteFlags::KEEP_ADJACENT) || count > b.blocks() * TOGETHER {
        append_each(b, count, a.contacts, |l, i| {
            let (pair, [p, q], shared) = given::<R, F, _>(l, a, i);
            // `Certain` always answers; were it not to, the pair stays.
            (meets_beyond_shared::<R, Certain>(&p, &q, shared) != Some(false)).then_some(pair)
        });
    } else {
        exact_of_few::<R, F, B>(b, a, count);
    }
}

/// The same of so few pairs that a lane works out one sign. One lane of each pair decides; it asks for more where the triangles lie in
/// one plane.
fn exact_of_few<R: Real, F: Frame<R>, B: Block>(b: &mut B, a: &DiscreteArgs<R>, count: u32) {
    let lanes = b.lanes();
    let signs = b.shared::<u32>(TOGETHER * LANES_A_PAIR);
    let base = (b.block() * TOGETHER).min(count);
    let some = TOGETHER.min(count - base);
    b.phase(|l| {
        let mut i = l.lane();
        while i < some * LANES_A_PAIR {
            let which = i % LANES_A_PAIR;
            if which < SIGNS {
                let (_, [p, q], _) = given::<R, F, _>(l, a, base + i / LANES_A_PAIR);
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
            let (pair, [p, q], _) = given::<R, F, _>(l, a, base + i);
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
fn given<R: Real, F: Frame<R>, L: Lane>(
    l: &L,
    a: &DiscreteArgs<R>,
    i: u32,
) -> (Pair, [[Vec3<R>; 3]; 2], Shared) {
    let pair = a.pairs.get(l, i);
    let (p, q) = (l.read(a.faces, pair.a), l.read(a.faces, pair.b));
    (pair, [corners::<R, F, _>(l, a, p), corners::<R, F, _>(l, a, q)], Shared::by_index(p, q))
}
