//! # Features: triangle pairs → vertex/face and edge/edge candidates
//! Paper    the thesis, section 6.2.5: "each of the 15 elementary vertex/face and edge/edge tests".
//! Launch   a warp a block, as many blocks as are resident; they stride over runs of the list.
//!          [`Moves`](crate::bvh::course::Moves) over a step, [`Rests`](crate::bvh::course::Rests) at
//!          rest; each is a kernel of its own.
//! Reads    candidates (pairs that share a vertex among them), facets, positions of both frames, or
//!          of one.
//! Writes   those vertex/face and edge/edge pairs whose boxes come within the gap, each once.
//! Before   pairs ⊇ {triangle pairs that come within the gap}, adjacent ones too.
//! After    vf ∪ ee ⊇ {feature pairs : no common vertex, within the gap}, each pair once.
//!          Once: each vertex and each edge has one owner, a triangle. A pair of features is tested
//!          only at its two owners.
//!          None is lost: a feature is part of its owner. So features within the gap bring their
//!          owners within the gap.
//!          An edge of no face, and a point, are triangles too. Two points are tested once.
//!          That pair of triangles, adjacent or not, is in the list.
//!          Boxes are those of the time in which the boxes around the two triangles, moving with
//!          them, overlap.
//!          Outside of it no feature of one can meet one of the other.
//!          A direction that parts two triangles throughout the step parts their features: such
//!          pairs are left out ([`crate::prim::direction`]).
//!          With a known earliest time most pairs are left out whose boxes first come within the gap
//!          behind the horizon.
//!          A pair that never comes within the gap may be listed or not, as its owners are parted.
//! Room     vf, ee: counted past the end, grown, run again.
//! Departs  the paper runs all 15 tests for every pair. Half of the pairs of cloth in motion own a
//!          test, five each on average; directions leave 0.44 of those.
//!          Owners are the representative triangles of Curtis, Tamstorf, Manocha, "Fast collision
//!          detection for deformable models using representative-triangles", 2008.
//! Cost     8 B pair, 64 B facets. For pairs that own a test again 64 B and 192 B positions
//!          (gathered; at rest 96 B), and directions of some 280 operations. For those that these
//!          leave the same bytes again, and the 15 tests of some 500 (at rest 300).
//!          Each step waits on chip until it has a pair a lane. No branches; on a CPU in vectors.
//!          Output is numbered in shared memory first, so that all lanes write.

use super::expect;
use crate::abi::{Facet, FeaturesArgs, Pair};
use crate::bvh::course::{Course, Gap};
use crate::bvh::horizon::Horizon;
use crate::exec::{Block, Lane, RowMap, WARP};
use crate::math::{Real, pick};
use crate::prim::direction::parted;
use crate::queue::listing::{FeatureLists, Listing, listing_bytes};
use crate::queue::waiting::{Waiting, waiting_bytes};
use core::marker::PhantomData;

/// The common corners of two triangles. Bit j of row i: corner i of p is corner j of q.
#[inline(always)]
fn common(p: &Facet, q: &Facet) -> [u32; 3] {
    let row = |i: usize| {
        let same = |j: usize| ((p.corners[i] == q.corners[j]) as u32) << j;
        same(0) | same(1) | same(2)
    };
    [row(0), row(1), row(2)]
}

/// Bits of the tests that two triangles own. 0 to 2: a vertex of p and q. 3 to 5: a vertex of q and
/// p. 6 + 3 i + j: edge i of p and edge j of q. Features that share a vertex have no bit.
#[inline(always)]
pub(super) fn owned(p: &Facet, q: &Facet) -> u32 {
    let rows = common(p, q);
    let (mut of_p, mut of_q) = (p.owned, q.owned);
    if of_p & of_q & Facet::POINT != 0 {
        // Two points are tested once.
        let of_later = if p.corners[0] < q.corners[0] { &mut of_q } else { &mut of_p };
        *of_later &= !7;
    }
    let mut mask = of_q & 7 & !(rows[0] | rows[1] | rows[2]);
    mask <<= 3;
    for i in 0..3 {
        mask |= if rows[i] == 0 { of_p & 1 << i } else { 0 };
        // Corners of q on edge i of p; edge j of q joins corners j and j + 1.
        let on = rows[i] | rows[(i + 1) % 3];
        let free = of_q >> 3 & !(on | on >> 1 | on << 2) & 7;
        mask |= if of_p >> (3 + i) & 1 == 1 { free << (6 + 3 * i) } else { 0 };
    }
    mask
}

/// The tests whose features' boxes come within a gap, and not first behind the horizon.
struct Meeting<R, C, const HORIZON: bool> {
    gap: Gap<R>,
    horizon: f32,
    course: PhantomData<C>,
}

impl<R, C, const HORIZON: bool> Meeting<R, C, HORIZON> {
    /// The end of the step if no time is known: then the compiler knows it, too.
    #[inline(always)]
    fn horizon(&self) -> f32 {
        if HORIZON { self.horizon } else { 1.0 }
    }
}

impl<R: Real, C: Course<R>, const HORIZON: bool> RowMap for Meeting<R, C, HORIZON> {
    type Number = R;
    type Row = [[C::Corner; 3]; 2];
    #[inline(always)]
    fn at_once(&self, [p, q]: Self::Row) -> u32 {
        C::meeting(&p, &q, self.gap, self.horizon())
    }
    // Which boxes meet depends on roundings, and what a solver without a proof finds on that. So
    // numbers of f32 are computed as in a scene of f32, whatever else is in the scene.
    const HAS_SINGLES: bool = R::WIDE;
    #[inline(always)]
    fn is_single(&self, [[p, q, r], [s, t, u]]: &Self::Row) -> bool {
        let both = C::is_single(p) && C::is_single(s);
        both && C::is_single(q) && C::is_single(t) && C::is_single(r) && C::is_single(u)
    }
    #[inline(always)]
    fn single_at_once(&self, [p, q]: Self::Row) -> u32 {
        C::meeting_single(&p, &q, self.gap.single, self.horizon())
    }
}

/// Whether a direction parts two triangles: [`APART`] or [`LEFT`].
struct Parted<R, C> {
    gap: f32,
    course: PhantomData<(R, C)>,
}

/// Result of [`Parted`] for triangles that are parted.
const APART: u32 = 0;
/// For others.
const LEFT: u32 = 1;

impl<R: Real, C: Course<R>> RowMap for Parted<R, C> {
    type Number = R;
    /// The corners of both triangles. The numbers of the last one are 1 if the first corners of
    /// both are one vertex, 0 if no corners are.
    type Row = [C::Corner; 7];
    #[inline(always)]
    fn at_once(&self, row: Self::Row) -> u32 {
        let [a, b, c, d, e, f, common] = row;
        let gap = C::gap(&[a, b, c], &[d, e, f], self.gap);
        let (p, q) = ([C::ends(a), C::ends(b), C::ends(c)], [C::ends(d), C::ends(e), C::ends(f)]);
        if parted(&p, &q, gap, C::ends(common).t0[0] > R::ZERO) { APART } else { LEFT }
    }
}

/// The corners of two triangles, and whether the first ones are one vertex; `None` if more are.
/// A common corner comes first.
#[inline(always)]
fn turned(p: &Facet, q: &Facet) -> Option<([u32; 3], [u32; 3], bool)> {
    let rows = common(p, q);
    let bits = rows[0] | rows[1] << 3 | rows[2] << 6;
    if bits & bits.wrapping_sub(1) != 0 {
        return None;
    }
    let turn = |[x, y, z]: [u32; 3], k: u32| [pick([x, y, z], k), pick([y, z, x], k), pick([z, x, y], k)];
    let of_p = (rows[1] != 0) as u32 + 2 * (rows[2] != 0) as u32;
    let of_q = (rows[0] | rows[1] | rows[2]) >> 1;
    Some((turn(p.corners, of_p), turn(q.corners, of_q), bits != 0))
}

/// Lanes of a block: one warp, whose barriers and numbering cost next to nothing.
pub const LANES: u32 = WARP;

/// Bytes of shared memory of a block: pairs that wait, and a number of each test that is to be
/// listed.
pub const fn shared_bytes(lanes: u32) -> u32 {
    2 * waiting_bytes(lanes) + listing_bytes(lanes)
}

/// Two triangles of a pair.
#[derive(Clone, Copy)]
struct Two {
    pair: Pair,
    p: Facet,
    q: Facet,
}

impl Two {
    #[inline(always)]
    fn of<R: Real, L: Lane>(lane: &L, args: &FeaturesArgs<R>, pair: Pair) -> Self {
        Two { pair, p: lane.read(args.facets, pair.a), q: lane.read(args.facets, pair.b) }
    }
    /// The row of [`Parted`]; `None` if they share more than a corner.
    #[inline(always)]
    fn parted<R: Real, C: Course<R>, L: Lane>(
        &self,
        lane: &L,
        args: &FeaturesArgs<R>,
    ) -> Option<[C::Corner; 7]> {
        let at = |vertex| C::corner(lane, &args.frames, vertex);
        let ([a, b, c], [d, e, f], has_common) = turned(&self.p, &self.q)?;
        let common = C::filled(if has_common { R::ONE } else { R::ZERO });
        Some([at(a), at(b), at(c), at(d), at(e), at(f), common])
    }
    /// The row of [`Meeting`].
    #[inline(always)]
    fn meeting<R: Real, C: Course<R>, L: Lane>(
        &self,
        lane: &L,
        args: &FeaturesArgs<R>,
    ) -> [[C::Corner; 3]; 2] {
        let at = |vertex| C::corner(lane, &args.frames, vertex);
        let corners = |[x, y, z]: [u32; 3]| [at(x), at(y), at(z)];
        [corners(self.p.corners), corners(self.q.corners)]
    }
}

/// Vertex/face and edge/edge candidates of each triangle pair. Pairs that own no test are left out
/// first, then those that a direction parts: pairs wait on chip, so that each step has full warps.
///
/// Each step has one place in the code, or the compiler puts it out of line: so the last turns have
/// no new pairs.
#[inline(always)]
pub fn features<R: Real, C: Course<R>, const HORIZON: bool, B: Block>(block: &mut B, args: &FeaturesArgs<R>) {
    let count = args.pairs.listed(block);
    let (mut owners, mut left) = (Waiting::new(block), Waiting::new(block));
    let (gap, horizon) = (Gap::of(args.gap), Horizon::of(block, args.known).time());
    let directions = Parted::<R, C> { gap: gap.single, course: PhantomData };
    let mut tests = Tests::<R, C, B, HORIZON>::new(block, Meeting { gap, horizon, course: PhantomData });
    let mut turn = 0;
    loop {
        let (base, later) = (stretch(block, turn), stretch(block, turn + 1));
        let is_end = base >= count as u64;
        block.phase(|lane| {
            let [i, later] = [base, later].map(|from| from + lane.lane() as u64);
            let is_there = i < count as u64;
            owners.set(lane, if is_there { owner(lane, args, i as u32, later, count) } else { None });
        });
        owners.add(block);
        let (from, some) = owners.take(block, is_end);
        if some > 0 {
            block.map_rows(
                &directions,
                |lane| {
                    let is_mine = lane.lane() < some;
                    let two = is_mine.then(|| Two::of(lane, args, owners.get(lane, from + lane.lane())))?;
                    [two.p, two.q]
                        .iter()
                        .flat_map(|facet| facet.corners)
                        .for_each(|vertex| C::expect(lane, &args.frames, vertex));
                    Some(two)
                },
                |lane, two| two.parted::<R, C, _>(lane, args),
                |lane, result| {
                    let is_left = result.and_then(|(two, verdict)| (verdict != APART).then_some(two.pair));
                    left.set(lane, is_left);
                },
            );
            left.add(block);
        }
        let (from, some) = left.take(block, is_end);
        if some > 0 {
            tests.run(block, args, &left, from, some);
        }
        if is_end & left.is_empty() {
            break;
        }
        turn += 1;
    }
}

/// Stretches of neighbours that a block takes in sequence: pairs of neighbours share triangles. Few,
/// since some parts of the list have more work than others.
const RUN: u32 = 4;

/// The first pair of a block's stretch.
#[inline(always)]
fn stretch<B: Block>(block: &B, turn: u32) -> u64 {
    let run = (turn / RUN) as u64 * block.blocks() as u64 + block.block() as u64;
    (run * RUN as u64 + (turn % RUN) as u64) * block.lanes() as u64
}

/// Pair `i`, if it owns a test; `later` is the place of the lane's next one.
#[inline(always)]
fn owner<R: Real, L: Lane>(lane: &L, args: &FeaturesArgs<R>, i: u32, later: u64, count: u32) -> Option<Pair> {
    let two = Two::of(lane, args, args.pairs.get(lane, i));
    let later = later.min(count as u64) as u32;
    expect(lane, &args.pairs, later, count, |pair| {
        lane.expect(args.facets, pair.a);
        lane.expect(args.facets, pair.b);
    });
    (owned(&two.p, &two.q) != 0).then_some(two.pair)
}

/// The 15 tests of the pairs that wait.
struct Tests<R, C, B: Block, const HORIZON: bool> {
    boxes: Meeting<R, C, HORIZON>,
    listing: Listing<B>,
}

impl<R: Real, C: Course<R>, B: Block, const HORIZON: bool> Tests<R, C, B, HORIZON> {
    #[inline(always)]
    fn new(block: &mut B, boxes: Meeting<R, C, HORIZON>) -> Self {
        Tests { boxes, listing: Listing::new(block) }
    }

    /// Lists the candidates of `some` of the pairs that wait, from the one at `from`; one a lane.
    #[inline(always)]
    fn run(&mut self, block: &mut B, args: &FeaturesArgs<R>, waiting: &Waiting<B>, from: u32, some: u32) {
        let pair_of = |lane: &B::Lane, i: u32| waiting.get(lane, from + i);
        block.map_rows(
            &self.boxes,
            |lane| (lane.lane() < some).then(|| Two::of(lane, args, pair_of(lane, lane.lane()))),
            |lane, two| Some(two.meeting::<R, C, _>(lane, args)),
            |lane, result| {
                let mask = result.map_or(0, |(two, meeting)| owned(&two.p, &two.q) & meeting);
                self.listing.set(lane, mask);
            },
        );
        let lists = FeatureLists { facets: args.facets, vf: args.vf, ee: args.ee };
        self.listing.put(block, &lists, pair_of);
    }
}
