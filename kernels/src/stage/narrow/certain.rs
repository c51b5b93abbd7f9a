//! # Certain: the triangle pairs that the filter left uncertain → those that share a point
//! Paper    not in the paper.
//! Launch   [`wide`] with f32 positions, in f64; then [`exact`] over those that are still
//!          uncertain, on integers. A lane a pair; a grid of any size strides. A lane a sign if
//!          there are few pairs.
//!          [`super::discrete::Still`] at rest, [`super::discrete::Start`] at the start of a step.
//! Reads    uncertain pairs, faces, positions.
//! Writes   contacts; `wide` also the pairs that are still uncertain.
//! Before   pairs = those that the kernel before did not decide. Positions are finite.
//! After    contacts ∪= {(a, b) in pairs : closed triangles share a point}; with a common vertex,
//!          beyond it. `wide` leaves some out and lists them.
//!          With `ONLY_CROSSING`: those that cross ([`crate::prim::crossing`]).
//! Room     contacts, uncertain: counted past the end, grown, run again.
//! Cost     a sign takes `wide` some 60 operations in f64, `exact` thousands on integers.

use super::discrete::{Frame, corners};
use super::{Entries, append_each, sort_out, stride};
use crate::abi::{DiscreteArgs, DiscreteFlags, Pair};
use crate::exec::{Block, Lane, Slot};
use crate::math::{Real, Vec3};
use crate::prim::adjacent::{Shared, meets_beyond_shared};
use crate::prim::crossing::crosses;
use crate::prim::tri_tri::{Certain, SIGNS, Signs, Wide, decided, meets, points_of_sign};

/// Few pairs: at most so many. More have a lane a pair, and fill the machine.
const FEW: u32 = 1 << 14;
/// So many of few pairs a block tests together.
const TOGETHER: u32 = 4;
/// Lanes of one of few pairs: one a sign, and one idle.
pub const LANES_A_PAIR: u32 = SIGNS.next_power_of_two();
/// Shared memory of a block: signs.
pub const SHARED: u32 = 4 * TOGETHER * LANES_A_PAIR;
/// A sign that is not known; others are one more than they are.
const UNKNOWN: u32 = 3;

/// Signs in f64, for pairs that f32 left uncertain.
pub fn wide<F: Frame<f32>, B: Block>(block: &mut B, args: &F::Args) {
    let lists = F::lists(args);
    let count = lists.pairs.listed(block);
    if are_few(lists, count) {
        return of_few::<f32, F, Wide, B>(block, args, count, |lane, pair, verdict| match verdict {
            Some(true) => lists.contacts.push(lane, F::contact(lane, args, pair)),
            Some(false) => {}
            None => lists.uncertain.push(lane, pair),
        });
    }
    let mut verdicts = block.slot((Pair::default(), Some(false)));
    let mut entries = Entries::new(block);
    stride(block, count, |block, base| {
        block.phase(|lane| {
            let i = base + lane.lane();
            *verdicts.of(lane) = if i < count {
                let (pair, [x, y], shared) = given::<f32, F, _>(lane, args, i);
                let is_only_crossing = lists.flags.has(DiscreteFlags::ONLY_CROSSING);
                let verdict = match shared {
                    _ if is_only_crossing => cross::<f32, Wide>(x, y),
                    Shared::Nothing => meets::<f32, Wide>(&x, &y),
                    shared => beyond(x, y, shared),
                };
                (pair, verdict)
            } else {
                (Pair::default(), Some(false))
            };
            lane.meet();
        });
        sort_out(block, lists, &mut entries, |lane, is_meeting| {
            let (pair, found) = *verdicts.of(lane);
            let is_mine = found == is_meeting.then_some(true);
            is_mine.then(|| if is_meeting { F::contact(lane, args, pair) } else { pair })
        });
    });
}

/// Tests a pair that shares corners. By value and out of line: such pairs are few, and the others
/// keep their registers.
#[inline(never)]
fn beyond(p: [Vec3<f32>; 3], q: [Vec3<f32>; 3], shared: Shared) -> Option<bool> {
    meets_beyond_shared::<f32, Wide>(&p, &q, shared)
}

/// Tests whether a pair crosses. By value and out of line, as [`beyond`].
#[inline(never)]
fn cross<R: Real, S: Signs<R>>(p: [Vec3<R>; 3], q: [Vec3<R>; 3]) -> Option<bool> {
    crosses::<R, S>(&p, &q)
}

/// Exact signs, for the pairs that the filters left uncertain: some thousand operations each.
pub fn exact<R: Real, F: Frame<R>, B: Block>(block: &mut B, args: &F::Args) {
    let lists = F::lists(args);
    let count = lists.pairs.listed(block);
    // `Certain` always answers; were it not to, the pair stays.
    if are_few(lists, count) {
        return of_few::<R, F, Certain, B>(block, args, count, |lane, pair, verdict| {
            if verdict != Some(false) {
                lists.contacts.push(lane, F::contact(lane, args, pair));
            }
        });
    }
    append_each(block, count, lists.contacts, |lane, i| {
        let (pair, [p, q], shared) = given::<R, F, _>(lane, args, i);
        let verdict = if lists.flags.has(DiscreteFlags::ONLY_CROSSING) {
            cross::<R, Certain>(p, q)
        } else {
            meets_beyond_shared::<R, Certain>(&p, &q, shared)
        };
        (verdict != Some(false)).then(|| F::contact(lane, args, pair))
    });
}

/// Whether there are so few pairs that each lane takes a sign. None of them may share vertices, and
/// these signs do not show what crosses.
fn are_few<R: Real>(args: &DiscreteArgs<R>, count: u32) -> bool {
    !args.flags.has(DiscreteFlags::KEEP_ADJACENT | DiscreteFlags::ONLY_CROSSING) && count <= FEW
}

/// Few pairs: a lane computes one sign. One lane of each pair takes the verdict. It computes more
/// signs if one is not known, or if the triangles are coplanar: so the verdict is that of
/// [`meets`].
#[inline(always)]
fn of_few<R: Real, F: Frame<R>, S: Signs<R>, B: Block>(
    block: &mut B,
    args: &F::Args,
    count: u32,
    take: impl Fn(&B::Lane, Pair, Option<bool>),
) {
    let (lanes, pairs) = (block.lanes(), F::lists(args).pairs);
    let signs = block.shared::<u32>(TOGETHER * LANES_A_PAIR);
    let mut base = block.block() * TOGETHER;
    while base < count {
        let some = TOGETHER.min(count - base);
        block.phase(|lane| {
            let mut i = lane.lane();
            while i < some * LANES_A_PAIR {
                let which = i % LANES_A_PAIR;
                if which < SIGNS {
                    let pair = pairs.get(lane, base + i / LANES_A_PAIR);
                    let [p, q] = F::triangles(lane, args, pair);
                    let [a, b, c, d] = points_of_sign(p, q, which);
                    let at = |vertex| F::at(lane, args, vertex);
                    let sign = S::orient3d(at(a), at(b), at(c), at(d));
                    lane.put(signs, i, sign.map_or(UNKNOWN, |sign| (sign + 1) as u32));
                }
                i += lanes;
            }
            lane.meet();
        });
        block.phase(|lane| {
            let mut i = lane.lane();
            while i < some {
                let sign = |k: usize| lane.get(signs, i * LANES_A_PAIR + k as u32);
                let all: [u32; SIGNS as usize] = core::array::from_fn(sign);
                let pair = pairs.get(lane, base + i);
                let known =
                    if all.contains(&UNKNOWN) { None } else { decided(&all.map(|sign| sign as i32 - 1)) };
                take(
                    lane,
                    pair,
                    known.or_else(|| {
                        let [p, q] =
                            F::triangles(lane, args, pair).map(|face| corners::<R, F, _>(lane, args, face));
                        one_by_one::<R, S>(p, q)
                    }),
                );
                i += lanes;
            }
            lane.meet();
        });
        base += block.blocks() * TOGETHER;
    }
}

/// [`meets`], by value and out of line: few lanes come here.
#[inline(never)]
fn one_by_one<R: Real, S: Signs<R>>(p: [Vec3<R>; 3], q: [Vec3<R>; 3]) -> Option<bool> {
    meets::<R, S>(&p, &q)
}

/// A pair, its corners, and their shared vertices.
#[inline(always)]
fn given<R: Real, F: Frame<R>, L: Lane>(
    lane: &L,
    args: &F::Args,
    i: u32,
) -> (Pair, [[Vec3<R>; 3]; 2], Shared) {
    let pair = F::lists(args).pairs.get(lane, i);
    let [p, q] = F::triangles(lane, args, pair);
    (pair, [corners::<R, F, _>(lane, args, p), corners::<R, F, _>(lane, args, q)], F::shared(p, q))
}
