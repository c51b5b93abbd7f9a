//! # Discrete: triangle pairs that share a point
//! Paper    the thesis, section 6.2.5, for [`moller()`]. [`filter`] and [`super::certain`], the
//!          default, are not in the paper.
//! Launch   a lane a pair; a grid of any size strides. `filter` over the candidates.
//!          [`Still`] at rest; [`Start`] at the start of a step, over the candidates of the whole
//!          step. Each is a kernel of its own.
//! Reads    candidates, faces, positions.
//! Writes   contacts; `filter` also the uncertain pairs.
//! Before   candidates are complete. Positions are finite.
//! After    filter, certain  contacts = {(a, b) in candidates : closed triangles share a point}.
//!          With a common vertex: beyond it.
//!          With `ONLY_CROSSING`: those that cross ([`crate::prim::crossing`]). All contacts of
//!          `filter` do: an edge strictly passes the inside of a triangle.
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
//!          40 for a pair of `Start` whose boxes are apart. 600 for all signs of another, without
//!          branches; on a CPU in vectors.

use super::{Entries, append_each, expect, sort_out};
use crate::abi::{DiscreteArgs, DiscreteFlags, Pair};
use crate::exec::{Block, Lane, OPEN, RowMap, Slot};
use crate::math::{Real, Vec3};
use crate::prim::adjacent::{Shared, share_a_vertex};
use crate::prim::at_once::meets_at_once;
use crate::prim::moller;
use crate::prim::tri_tri::parted;
use crate::queue::waiting::{Waiting, waiting_bytes};
use core::marker::PhantomData;

/// How the triangles of pairs are read, and their first test.
pub trait Frame<R: Real> {
    /// Arguments of the kernels.
    type Args;
    /// The name of a vertex.
    type Corner: Copy;
    /// Whether pairs with a common vertex are among the candidates and are left out.
    const LEAVES_OUT_ADJACENT: bool;
    /// Whether candidates are parted by planes already, so that a first test of these finds nothing.
    const ARE_PARTED: bool;
    /// The lists, and the flags of the test.
    fn lists(args: &Self::Args) -> &DiscreteArgs<R>;
    /// The triangles of a pair will be read soon.
    fn expect_pair<L: Lane>(lane: &L, args: &Self::Args, pair: Pair);
    /// The corners of both triangles of a pair.
    fn triangles<L: Lane>(lane: &L, args: &Self::Args, pair: Pair) -> [[Self::Corner; 3]; 2];
    /// The common vertices of two triangles.
    fn shared(p: [Self::Corner; 3], q: [Self::Corner; 3]) -> Shared;
    /// Whether there are any.
    fn share_a_vertex(p: [Self::Corner; 3], q: [Self::Corner; 3]) -> bool;
    /// A vertex will be read soon.
    fn expect<L: Lane>(lane: &L, args: &Self::Args, corner: Self::Corner);
    /// Reads a vertex.
    fn at<L: Lane>(lane: &L, args: &Self::Args, corner: Self::Corner) -> Vec3<R>;
    /// Whether two triangles are apart, by a test without branches that holds for most pairs. False
    /// proves nothing.
    fn are_apart(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3]) -> bool;
    /// A pair as a contact: the numbers of its triangles, the smaller first.
    fn contact<L: Lane>(lane: &L, args: &Self::Args, pair: Pair) -> Pair;
}

/// Nothing moves. Candidates overlap here; most are parted by a plane.
pub struct Still;

/// The start of a step. Candidates overlap at some time of it; the boxes of most are apart here.
pub struct Start;

/// Pairs that name triangles of the scene, whose vertices are in memory.
macro_rules! in_memory {
    ($Frame:ident, $leaves_out:literal, $of:ident, |$found:ident| $at:expr, $apart:expr) => {
        impl<R: Real> Frame<R> for $Frame {
            type Args = DiscreteArgs<R>;
            type Corner = u32;
            const LEAVES_OUT_ADJACENT: bool = $leaves_out;
            const ARE_PARTED: bool = false;
            #[inline(always)]
            fn lists(args: &DiscreteArgs<R>) -> &DiscreteArgs<R> {
                args
            }
            #[inline(always)]
            fn expect_pair<L: Lane>(lane: &L, args: &DiscreteArgs<R>, pair: Pair) {
                lane.expect(args.faces, pair.a);
                lane.expect(args.faces, pair.b);
            }
            #[inline(always)]
            fn triangles<L: Lane>(lane: &L, args: &DiscreteArgs<R>, pair: Pair) -> [[u32; 3]; 2] {
                [lane.read(args.faces, pair.a), lane.read(args.faces, pair.b)]
            }
            #[inline(always)]
            fn shared(p: [u32; 3], q: [u32; 3]) -> Shared {
                Shared::by_index(p, q)
            }
            #[inline(always)]
            fn share_a_vertex(p: [u32; 3], q: [u32; 3]) -> bool {
                share_a_vertex(p, q)
            }
            #[inline(always)]
            fn expect<L: Lane>(lane: &L, args: &DiscreteArgs<R>, vertex: u32) {
                lane.expect(args.frames.$of, vertex);
            }
            #[inline(always)]
            fn at<L: Lane>(lane: &L, args: &DiscreteArgs<R>, vertex: u32) -> Vec3<R> {
                let $found = lane.read(args.frames.$of, vertex);
                $at
            }
            #[inline(always)]
            fn are_apart(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3]) -> bool {
                $apart(p, q)
            }
            #[inline(always)]
            fn contact<L: Lane>(_: &L, _: &DiscreteArgs<R>, pair: Pair) -> Pair {
                pair
            }
        }
    };
}

in_memory!(Still, false, still, |found| found.at, parted);
in_memory!(Start, true, moving, |found| found.t0.at, boxes_apart);

/// Whether the boxes of two triangles are apart.
#[inline(always)]
fn boxes_apart<R: Real>(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3]) -> bool {
    let ends = |[x, y, z]: &[Vec3<R>; 3]| [x.lesser(*y).lesser(*z), x.greater(*y).greater(*z)];
    let ([p_lo, p_hi], [q_lo, q_hi]) = (ends(p), ends(q));
    let apart = |k: usize| (p_hi[k] < q_lo[k]) | (q_hi[k] < p_lo[k]);
    apart(0) | apart(1) | apart(2)
}

/// The corners of a triangle.
#[inline(always)]
pub fn corners<R: Real, F: Frame<R>, L: Lane>(
    lane: &L,
    args: &F::Args,
    face: [F::Corner; 3],
) -> [Vec3<R>; 3] {
    [F::at(lane, args, face[0]), F::at(lane, args, face[1]), F::at(lane, args, face[2])]
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

/// The first test of two triangles: [`APART`] or [`LEFT`].
struct Apart<R, F>(PhantomData<(R, F)>);

/// Result of a test for two triangles that are apart.
const APART: u32 = 0;
/// For two that it leaves to the next one.
const LEFT: u32 = 1;
/// Result of all signs for two that meet.
const MEET: u32 = 2;

impl<R: Real, F: Frame<R>> RowMap for Apart<R, F> {
    type Number = R;
    type Row = [[Vec3<R>; 3]; 2];
    #[inline(always)]
    fn at_once(&self, [p, q]: [[Vec3<R>; 3]; 2]) -> u32 {
        if F::are_apart(&p, &q) { APART } else { LEFT }
    }
}

/// All signs of two triangles: [`APART`], [`MEET`], or [`LEFT`] if they do not decide.
struct Meet<R>(PhantomData<R>);

impl<R: Real> RowMap for Meet<R> {
    type Number = R;
    type Row = [[Vec3<R>; 3]; 2];
    #[inline(always)]
    fn at_once(&self, [p, q]: [[Vec3<R>; 3]; 2]) -> u32 {
        match meets_at_once(p, q) {
            Some(true) => MEET,
            Some(false) => APART,
            None => LEFT,
        }
    }
}

/// Shared memory of `filter`: pairs that wait.
pub const fn shared_bytes(lanes: u32) -> u32 {
    waiting_bytes(lanes)
}

/// Signs with an error bound, in the precision of the positions: contacts, and uncertain pairs.
/// Most pairs are separated by a plane, unless they were tested so before. The others wait until
/// there is one a lane.
pub fn filter<R: Real, F: Frame<R>, B: Block>(block: &mut B, args: &F::Args) {
    let lists = F::lists(args);
    let (count, lanes) = (lists.pairs.listed(block), block.lanes());
    let share = block.share(count, lanes);
    if share.is_empty() {
        return;
    }
    let (mut base, mut decision) = (share.first, Decision::new(block));
    if F::ARE_PARTED {
        while base < share.end {
            decision.run::<R, F>(block, args, |lane| {
                let i = base + lane.lane();
                (i < share.end).then(|| lists.pairs.get(lane, i))
            });
            base += share.step;
        }
        return;
    }
    let mut waiting = Waiting::new(block);
    // One place in the code for what is behind it, or the compiler puts it out of line: so the last
    // turn has no pairs.
    loop {
        block.map_rows(
            &Apart::<R, F>(PhantomData),
            |lane| {
                let i = base + lane.lane();
                if i >= share.end {
                    return None;
                }
                let pair = lists.pairs.get(lane, i);
                let faces = F::triangles(lane, args, pair);
                expect(lane, &lists.pairs, i + share.step, share.end, |pair| {
                    F::expect_pair(lane, args, pair)
                });
                if F::LEAVES_OUT_ADJACENT && F::share_a_vertex(faces[0], faces[1]) {
                    return None;
                }
                faces.into_iter().flatten().for_each(|vertex| F::expect(lane, args, vertex));
                Some((pair, faces[0], faces[1]))
            },
            |lane, (_, p, q)| rows::<R, F, _>(lane, args, p, q),
            |lane, result| {
                let left = result.and_then(|((pair, ..), verdict)| (verdict != APART).then_some(pair));
                waiting.set(lane, left);
            },
        );
        waiting.add(block);
        let is_end = base >= share.end;
        let (from, some) = waiting.take(block, is_end);
        if some > 0 {
            decision.run::<R, F>(block, args, |lane| {
                (lane.lane() < some).then(|| waiting.get(lane, from + lane.lane()))
            });
        }
        if is_end {
            break;
        }
        base += share.step;
    }
}

/// The corners of two triangles, unless they are tested beyond corners that they share: that is
/// left to others.
#[inline(always)]
fn rows<R: Real, F: Frame<R>, L: Lane>(
    lane: &L,
    args: &F::Args,
    p: [F::Corner; 3],
    q: [F::Corner; 3],
) -> Option<[[Vec3<R>; 3]; 2]> {
    let is_beyond_shared =
        F::lists(args).flags.has(DiscreteFlags::KEEP_ADJACENT) && F::shared(p, q) != Shared::Nothing;
    (!is_beyond_shared).then(|| [corners::<R, F, _>(lane, args, p), corners::<R, F, _>(lane, args, q)])
}

/// All signs of the pairs that wait: to the contacts, to the uncertain, or neither.
struct Decision<B: Block> {
    pairs: B::Slot<(Pair, u32)>,
    entries: Entries<B, Pair>,
}

impl<B: Block> Decision<B> {
    fn new(block: &B) -> Self {
        Decision { pairs: block.slot((Pair::default(), APART)), entries: Entries::new(block) }
    }

    /// Decides the lanes' pairs.
    #[inline(always)]
    fn run<R: Real, F: Frame<R>>(
        &mut self,
        block: &mut B,
        args: &F::Args,
        pair_of: impl Fn(&B::Lane) -> Option<Pair>,
    ) {
        block.map_rows(
            &Meet::<R>(PhantomData),
            pair_of,
            |lane, pair| {
                let [p, q] = F::triangles(lane, args, pair);
                rows::<R, F, _>(lane, args, p, q)
            },
            |lane, result| {
                *self.pairs.of(lane) = result.unwrap_or((Pair::default(), APART));
                lane.meet();
            },
        );
        // Pairs that are tested beyond their common corners have no row, and are `OPEN`.
        sort_out(block, F::lists(args), &mut self.entries, |lane, is_meeting| {
            let (pair, found) = *self.pairs.of(lane);
            if is_meeting {
                (found == MEET).then(|| F::contact(lane, args, pair))
            } else {
                ((found == LEFT) | (found == OPEN)).then_some(pair)
            }
        });
    }
}
