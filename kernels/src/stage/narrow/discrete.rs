//! # Discrete: triangle pairs that share a point
//! Paper    the thesis, section 6.2.5, for [`moller()`]. [`filter`] and [`exact`], the default, are
//!          not in the paper.
//! Launch   a lane a pair; a grid of any size strides. `filter` over the candidates.
//!          With f32 positions `wide` over its uncertain pairs. `exact` over those that are still
//!          uncertain.
//!          [`Still`] at rest; [`Start`] at the start of a step, over the candidates of the whole
//!          step. Each is a kernel of its own.
//! Reads    candidates, faces, positions.
//! Writes   contacts; `filter` and `wide` also the uncertain pairs.
//! Before   candidates are complete. Positions are finite.
//! After    filter, wide, exact  contacts = {(a, b) in candidates : closed triangles share a
//!          point}. With a common vertex: beyond it.
//!          moller  contacts = the pairs that a float test accepts: it can miss and it can err.
//!          `Start`  contacts = {(a, b) in candidates : no common vertex, closed triangles share a
//!          point at t = 0}.
//!          These are all such pairs of the scene. A swept volume holds its triangle at t = 0, so
//!          the volumes overlap at t = 0.
//!          A horizon is above 0, and a volume cut at it keeps its start. A separation only adds
//!          candidates.
//!          So the list of an earliest query, after its sample, is complete in this sense.
//! Room     contacts, uncertain: counted past the end, grown, run again.
//!          `Start` has room for no contact: their number is the answer.
//! Cost     8 B pair, 24 B faces, 96 B positions (gathered). About 100 operations for a pair that a
//!          plane separates.
//!          40 for a pair of `Start` whose boxes are apart. A sign takes `wide` some 30 operations
//!          in f64, `exact` thousands on integers.

use super::{Entries, append_each, expect, stride};
use crate::abi::{DiscreteArgs, DiscreteFlags, Pair, Positions};
use crate::exec::{Block, Lane, OPEN, RowMap, Slot};
use crate::math::{Real, Vec3};
use crate::prim::adjacent::{Shared, meets_beyond_shared, share_a_vertex};
use crate::prim::moller;
use crate::prim::tri_tri::{self, Certain, Filter, SIGNS, Wide, meets, parted};
use core::marker::PhantomData;

/// The positions to read, and the first test of a pair of triangles.
pub trait Frame<R: Real> {
    /// Whether pairs with a common vertex are among the candidates and are left out.
    const LEAVES_OUT_ADJACENT: bool;
    /// A vertex will be read soon.
    fn expect<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32);
    /// Reads a vertex.
    fn at<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) -> Vec3<R>;
    /// Whether two triangles are apart, by a test without branches that holds for most pairs. False
    /// proves nothing.
    fn are_apart(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3]) -> bool;
}

/// Nothing moves. Candidates overlap here; most are parted by a plane.
pub struct Still;

impl<R: Real> Frame<R> for Still {
    const LEAVES_OUT_ADJACENT: bool = false;
    #[inline(always)]
    fn expect<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) {
        lane.expect(frames.still, vertex);
    }
    #[inline(always)]
    fn at<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) -> Vec3<R> {
        lane.read(frames.still, vertex).at
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
    fn expect<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) {
        lane.expect(frames.moving, vertex);
    }
    #[inline(always)]
    fn at<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) -> Vec3<R> {
        lane.read(frames.moving, vertex).t0.at
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
fn corners<R: Real, F: Frame<R>, L: Lane>(lane: &L, args: &DiscreteArgs<R>, face: [u32; 3]) -> [Vec3<R>; 3] {
    face.map(|vertex| F::at(lane, &args.frames, vertex))
}

/// The paper's test (Möller), in f32.
pub fn moller<R: Real, B: Block>(block: &mut B, args: &DiscreteArgs<R>) {
    let count = args.pairs.listed(block);
    append_each(block, count, args.contacts, |lane, i| {
        let pair = args.pairs.get(lane, i);
        let triangle = |t: u32| corners::<R, Still, _>(lane, args, lane.read(args.faces, t));
        let (p, q) = (triangle(pair.a), triangle(pair.b));
        // The float test depends on roundings: f32 numbers are rounded in f32, whatever else is in
        // the scene.
        let is_single = p.iter().chain(&q).all(|x| x.is_single());
        let meet = if is_single {
            moller::moller(&p.map(|x| x.narrow()), &q.map(|x| x.narrow()))
        } else {
            moller::moller(&p, &q)
        };
        meet.then_some(pair)
    });
}

/// Pairs of a block and the verdict of each.
struct Verdicts<B: Block> {
    pairs: B::Slot<Pair>,
    verdicts: B::Slot<Option<bool>>,
    entries: Entries<B, Pair>,
}

impl<B: Block> Verdicts<B> {
    fn new(block: &B) -> Self {
        Verdicts {
            pairs: block.slot(Pair::default()),
            verdicts: block.slot(Some(false)),
            entries: Entries::new(block),
        }
    }

    #[inline(always)]
    fn set(&mut self, lane: &B::Lane, pair: Pair, verdict: Option<bool>) {
        *self.pairs.of(lane) = pair;
        *self.verdicts.of(lane) = verdict;
    }

    /// Those that meet go to the contacts, those without an answer to the uncertain.
    fn sort_out<R: Real>(&mut self, block: &mut B, args: &DiscreteArgs<R>) {
        for (verdict, list) in [(Some(true), args.contacts), (None, args.uncertain)] {
            block.phase(|lane| {
                let mine = *self.verdicts.of(lane) == verdict;
                self.entries.set(lane, mine.then_some(*self.pairs.of(lane)));
            });
            self.entries.append(block, list);
        }
    }
}

/// The first test of two triangles; [`OPEN`] if it does not decide.
struct Apart<R, F>(PhantomData<(R, F)>);

/// Result of [`Apart`] for two triangles that are apart.
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

/// Signs with an error bound, in the precision of the positions: contacts, and uncertain pairs.
/// Most pairs are separated by a plane, without a branch. The others are collected until there is
/// one a lane.
pub fn filter<R: Real, F: Frame<R>, B: Block>(block: &mut B, args: &DiscreteArgs<R>) {
    let (count, lanes) = (args.pairs.listed(block), block.lanes());
    let later = block.blocks() * lanes;
    let waiting = block.shared::<[u32; 2]>(2 * lanes);
    let mut verdicts = Verdicts::new(block);
    let mut open = block.slot(None);
    let mut places = block.slot(0u32);
    let mut fill = 0;
    stride(block, count, |block, base| {
        block.map_rows(
            &Apart::<R, F>(PhantomData),
            |lane| {
                let i = base + lane.lane();
                if i >= count {
                    return None;
                }
                let pair = args.pairs.get(lane, i);
                let faces = [lane.read(args.faces, pair.a), lane.read(args.faces, pair.b)];
                expect(lane, &args.pairs, i + later, count, |pair| {
                    lane.expect(args.faces, pair.a);
                    lane.expect(args.faces, pair.b);
                });
                if F::LEAVES_OUT_ADJACENT && share_a_vertex(faces[0], faces[1]) {
                    return None;
                }
                faces.into_iter().flatten().for_each(|vertex| F::expect(lane, &args.frames, vertex));
                Some((pair, faces[0], faces[1]))
            },
            |lane, (_, p, q)| {
                (!beyond_shared(args, p, q))
                    .then(|| [corners::<R, F, _>(lane, args, p), corners::<R, F, _>(lane, args, q)])
            },
            |lane, result| {
                let left = result.and_then(|((pair, ..), verdict)| (verdict != APART).then_some(pair));
                *open.of(lane) = left;
                *places.of(lane) = left.is_some() as u32;
                lane.meet();
            },
        );
        let found = block.scan(&mut places);
        block.phase(|lane| {
            if let Some(pair) = *open.of(lane) {
                lane.put(waiting, fill + *places.of(lane), [pair.a, pair.b]);
            }
            lane.meet();
        });
        fill += found;
        if fill >= lanes {
            fill -= lanes;
            decide::<R, F, B>(block, args, &mut verdicts, |lane| Some(lane.get(waiting, fill + lane.lane())));
        }
    });
    decide::<R, F, B>(block, args, &mut verdicts, |lane| {
        (lane.lane() < fill).then(|| lane.get(waiting, lane.lane()))
    });
}

/// Whether a pair is tested beyond the corners that it shares; the filter leaves those to others.
#[inline(always)]
fn beyond_shared<R: Real>(args: &DiscreteArgs<R>, p: [u32; 3], q: [u32; 3]) -> bool {
    args.flags.has(DiscreteFlags::KEEP_ADJACENT) && Shared::by_index(p, q) != Shared::Nothing
}

/// All signs of the pairs that lanes have.
#[inline(always)]
fn decide<R: Real, F: Frame<R>, B: Block>(
    block: &mut B,
    args: &DiscreteArgs<R>,
    verdicts: &mut Verdicts<B>,
    which: impl Fn(&B::Lane) -> Option<[u32; 2]>,
) {
    block.phase(|lane| {
        let result = which(lane).map(|[p, q]| {
            let faces = [lane.read(args.faces, p), lane.read(args.faces, q)];
            let verdict = if beyond_shared(args, faces[0], faces[1]) {
                None
            } else {
                let [x, y] = faces.map(|face| corners::<R, F, _>(lane, args, face));
                meets::<R, Filter>(&x, &y)
            };
            (Pair { a: p, b: q }, verdict)
        });
        let (pair, verdict) = result.unwrap_or((Pair::default(), Some(false)));
        verdicts.set(lane, pair, verdict);
        lane.meet();
    });
    verdicts.sort_out(block, args);
}

/// The same in f64, for pairs that f32 left uncertain.
pub fn wide<F: Frame<f32>, B: Block>(block: &mut B, args: &DiscreteArgs<f32>) {
    let count = args.pairs.listed(block);
    let mut verdicts = Verdicts::new(block);
    stride(block, count, |block, base| {
        block.phase(|lane| {
            let i = base + lane.lane();
            if i >= count {
                return verdicts.set(lane, Pair::default(), Some(false));
            }
            let pair = args.pairs.get(lane, i);
            let (p, q) = (lane.read(args.faces, pair.a), lane.read(args.faces, pair.b));
            let (x, y) = (corners::<f32, F, _>(lane, args, p), corners::<f32, F, _>(lane, args, q));
            let verdict = match Shared::by_index(p, q) {
                Shared::Nothing => meets::<f32, Wide>(&x, &y),
                shared => beyond(x, y, shared),
            };
            verdicts.set(lane, pair, verdict);
        });
        verdicts.sort_out(block, args);
    });
}

/// Tests a pair that shares corners. By value and out of line: such pairs are few, and the others
/// keep their registers.
#[inline(never)]
fn beyond(p: [Vec3<f32>; 3], q: [Vec3<f32>; 3], shared: Shared) -> Option<bool> {
    meets_beyond_shared::<f32, Wide>(&p, &q, shared)
}

/// Pairs that a block of `exact` tests together.
const TOGETHER: u32 = 4;
/// Lanes of a pair: one a sign, and one idle.
const LANES_A_PAIR: u32 = SIGNS.next_power_of_two();
/// Shared memory of `exact`: signs.
pub const EXACT_SHARED: u32 = 4 * TOGETHER * LANES_A_PAIR;

/// Exact signs, for the pairs that the filters left uncertain: some thousand operations each, in
/// sequence.
pub fn exact<R: Real, F: Frame<R>, B: Block>(block: &mut B, args: &DiscreteArgs<R>) {
    let count = args.pairs.listed(block);
    if args.flags.has(DiscreteFlags::KEEP_ADJACENT) || count > block.blocks() * TOGETHER {
        append_each(block, count, args.contacts, |lane, i| {
            let (pair, [p, q], shared) = given::<R, F, _>(lane, args, i);
            // `Certain` always answers; were it not to, the pair stays.
            (meets_beyond_shared::<R, Certain>(&p, &q, shared) != Some(false)).then_some(pair)
        });
    } else {
        exact_of_few::<R, F, B>(block, args, count);
    }
}

/// The same for few pairs: a lane computes one sign. One lane of each pair decides; it computes
/// more signs if the triangles are coplanar.
fn exact_of_few<R: Real, F: Frame<R>, B: Block>(block: &mut B, args: &DiscreteArgs<R>, count: u32) {
    let lanes = block.lanes();
    let signs = block.shared::<u32>(TOGETHER * LANES_A_PAIR);
    let base = (block.block() * TOGETHER).min(count);
    let some = TOGETHER.min(count - base);
    block.phase(|lane| {
        let mut i = lane.lane();
        while i < some * LANES_A_PAIR {
            let which = i % LANES_A_PAIR;
            if which < SIGNS {
                let (_, [p, q], _) = given::<R, F, _>(lane, args, base + i / LANES_A_PAIR);
                let sign = tri_tri::sign::<R, Certain>(&p, &q, which).unwrap_or(0);
                lane.put(signs, i, (sign + 1) as u32);
            }
            i += lanes;
        }
        lane.meet();
    });
    block.phase(|lane| {
        let mut i = lane.lane();
        while i < some {
            let (pair, [p, q], _) = given::<R, F, _>(lane, args, base + i);
            let sign = |k: usize| lane.get(signs, i * LANES_A_PAIR + k as u32) as i32 - 1;
            let verdict = tri_tri::decided(&core::array::from_fn(sign));
            if verdict.or_else(|| meets::<R, Certain>(&p, &q)) != Some(false) {
                args.contacts.push(lane, pair);
            }
            i += lanes;
        }
        lane.meet();
    });
}

/// A pair, its corners, and their shared vertices.
#[inline(always)]
fn given<R: Real, F: Frame<R>, L: Lane>(
    lane: &L,
    args: &DiscreteArgs<R>,
    i: u32,
) -> (Pair, [[Vec3<R>; 3]; 2], Shared) {
    let pair = args.pairs.get(lane, i);
    let (p, q) = (lane.read(args.faces, pair.a), lane.read(args.faces, pair.b));
    (pair, [corners::<R, F, _>(lane, args, p), corners::<R, F, _>(lane, args, q)], Shared::by_index(p, q))
}
