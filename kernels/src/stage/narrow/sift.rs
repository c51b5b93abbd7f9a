//! # Sift: triangle pairs → vertex/face and edge/edge pairs that may meet
//! Paper    section 6.2.5, "each of the 15 elementary vertex/face and edge/edge tests".
//! Launch   [`sift`], or with a separation [`sift_near`]; a lane a triangle pair, then a lane a pair of features; a grid of any
//!          size strides.
//! Reads    candidates (pairs that share a vertex among them), facets, positions of both frames.
//! Writes   `sift`: those vertex/face and edge/edge pairs that may meet, each once. `sift_near`: those whose swept boxes come
//!          within the separation. How many pairs of features had boxes that meet is counted.
//! Before   every pair of triangles that come within the separation is listed, adjacent ones too.
//! After    every vertex/face and edge/edge pair without a common vertex that comes within the separation is listed.
//!          Why once: each vertex and each edge is owned by one of its triangles, and a pair of features is tested only
//!          where owners meet. Why none is lost: a feature lies in its owner, so what comes within the separation of
//!          another brings the owners as near, and that pair of triangles, adjacent or not, is in the list. Of these
//!          `sift` leaves out only what certainly does not meet ([`rejected`]: boxes that move, then signs), asked
//!          always of the same numbers in the same order, whichever triangles found the pair.
//! Room     vf, ee: counted past the end, grown, run again.
//! Departs  the paper tests all 15 for every pair; owners (representative triangles: Curtis, Tamstorf, Manocha, "Fast
//!          collision detection for deformable models using representative-triangles", 2008) leave about 3. A pair of
//!          triangles has none of them or many, so a block's pairs of features wait in shared memory and its lanes share them.
//! Cost     8 B pair, 64 B facets, 192 B positions (gathered); 6 comparisons a test. A pair of features: the same again, from
//!          the nearest cache, and 100 to 300 operations.

use super::{listed, moving};
use crate::abi::{Facet, Pair, SiftArgs, counter};
use crate::exec::{Block, Lane, Shared, Slot};
use crate::math::{Real, Vec3};
use crate::prim::cubic::Moving;
use crate::prim::isolate::ladder::rejected;
use crate::prim::isolate::{Edges, Face};

/// A closed box in the precision of the positions: exact.
#[derive(Clone, Copy)]
struct Swept<R> {
    lo: Vec3<R>,
    hi: Vec3<R>,
}

impl<R: Real> Swept<R> {
    fn merge(self, o: Self) -> Self {
        Swept { lo: self.lo.min(o.lo), hi: self.hi.max(o.hi) }
    }
    /// Around what is within `gap` of it. A difference is rounded by at most u of the bound and of what is taken away;
    /// `INCLUSION_INPUT` of the bound and what [`gap`] has to spare make up for it.
    fn grown(self, gap: R) -> Self {
        let out = |x: R| gap + x.abs() * R::INCLUSION_INPUT;
        Swept { lo: self.lo.map(|x| x - out(x)), hi: self.hi.map(|x| x + out(x)) }
    }
    fn overlaps(&self, o: &Self) -> bool {
        let axis = |k: usize| (self.lo[k] <= o.hi[k]) & (o.lo[k] <= self.hi[k]);
        axis(0) & axis(1) & axis(2)
    }
}

/// A triangle with all that a test needs.
struct Triangle<R> {
    facet: Facet,
    boxes: [Swept<R>; 3],
}

impl<R: Real> Triangle<R> {
    /// `gap` as by [`gap`], or 0.
    fn read<L: Lane>(l: &L, a: &SiftArgs<R>, index: u32, gap: R) -> Self {
        let facet = l.read(a.facets, index);
        let boxes = facet.corners.map(|v| {
            let Moving { t0, t1 } = moving(l, &a.frames, v);
            let swept = Swept { lo: t0.min(t1), hi: t0.max(t1) };
            if gap > R::ZERO { swept.grown(gap) } else { swept }
        });
        Triangle { facet, boxes }
    }
    fn hull(&self) -> Swept<R> {
        self.boxes[0].merge(self.boxes[1]).merge(self.boxes[2])
    }
    fn owns_vertex(&self, k: usize) -> bool {
        self.facet.owned >> k & 1 != 0
    }
    fn owns_edge(&self, k: usize) -> bool {
        self.facet.owned >> (k + 3) & 1 != 0
    }
    fn edge_box(&self, k: usize) -> Swept<R> {
        self.boxes[k].merge(self.boxes[(k + 1) % 3])
    }
    fn has(&self, vertex: u32) -> bool {
        self.facet.corners.contains(&vertex)
    }
}

/// By how much the boxes of one of two triangles grow: a little more than the separation, or not at all.
fn gap<R: Real>(separation: f64) -> R {
    if separation > 0.0 { R::of(separation) * R::INCLUSION_UP + R::INCLUSION_UNDERFLOW } else { R::ZERO }
}

/// Bits of the tests to make: 0 to 2 a vertex of p and q, 3 to 5 a vertex of q and p, 6 + 3 i + j edge i of p and j of q.
fn wanted<R: Real>(p: &Triangle<R>, q: &Triangle<R>) -> u32 {
    let mut mask = 0;
    let (of_p, of_q) = (p.hull(), q.hull());
    for k in 0..3 {
        if p.owns_vertex(k) && p.boxes[k].overlaps(&of_q) && !q.has(p.facet.corners[k]) {
            mask |= 1 << k;
        }
        if q.owns_vertex(k) && q.boxes[k].overlaps(&of_p) && !p.has(q.facet.corners[k]) {
            mask |= 8 << k;
        }
    }
    for i in 0..3 {
        let edge = p.edge_box(i);
        if !p.owns_edge(i) || !edge.overlaps(&of_q) {
            continue;
        }
        let [from, to] = [p.facet.corners[i], p.facet.corners[(i + 1) % 3]];
        for j in 0..3 {
            let ends = [q.facet.corners[j], q.facet.corners[(j + 1) % 3]];
            if q.owns_edge(j) && !ends.contains(&from) && !ends.contains(&to) && edge.overlaps(&q.edge_box(j))
            {
                mask |= 1 << (6 + 3 * i + j);
            }
        }
    }
    mask
}

/// Bits of [`wanted`] that are vertices and faces.
const VERTICES: u32 = 63;
/// The most pairs of features of a pair of triangles.
const MOST: u32 = 15;

/// Bytes of shared memory: the pairs of features of a block of `lanes`, in words of lane and bit.
pub const fn shared_bytes(lanes: u32) -> u32 {
    4 * MOST * lanes
}

/// Pairs of features that may meet.
pub fn sift<R: Real, B: Block>(b: &mut B, a: &SiftArgs<R>) {
    features(b, a, R::ZERO, (counter::VF_SURVIVORS, counter::EE_SURVIVORS), |l, features| match *features {
        Features::Vf { vertex, corners, .. } => {
            let face = corners.map(|v| moving(l, &a.frames, v));
            !rejected(&Face::new(moving(l, &a.frames, vertex), face, &a.params))
        }
        Features::Ee { ends, .. } => {
            let [x, y] = ends.map(|ends| ends.map(|v| moving(l, &a.frames, v)));
            !rejected(&Edges::new(x, y, &a.params))
        }
    });
}

/// Pairs of features whose boxes come within a gap.
pub fn sift_near<R: Real, B: Block>(b: &mut B, a: &SiftArgs<R>) {
    features(b, a, gap(a.gap), (counter::VF, counter::EE), |_, _| true);
}

/// Two features, found by their triangles.
enum Features {
    Vf { vertex: u32, face: u32, corners: [u32; 3] },
    Ee { edges: [u32; 2], ends: [[u32; 2]; 2] },
}

impl Features {
    /// Bit `k` of [`wanted`] of a pair of triangles.
    #[inline(always)]
    fn read<R: Real, L: Lane>(l: &L, a: &SiftArgs<R>, pair: Pair, k: u32) -> Self {
        let (p, q) = (l.read(a.facets, pair.a), l.read(a.facets, pair.b));
        if k < 6 {
            let (of, face, corners) = if k < 3 { (&p, pair.b, q.corners) } else { (&q, pair.a, p.corners) };
            return Features::Vf { vertex: pick(of.corners, k % 3), face, corners };
        }
        let (i, j) = ((k - 6) / 3, (k - 6) % 3);
        // As the list of edges has them: the larger vertex first, the smaller number first.
        let ends = |of: &Facet, k: u32| {
            let [x, y] = [pick(of.corners, k), pick(of.corners, (k + 1) % 3)];
            [x.max(y), x.min(y)]
        };
        let (x, y) = ((pick(p.edges, i), ends(&p, i)), (pick(q.edges, j), ends(&q, j)));
        let (x, y) = if x.0 < y.0 { (x, y) } else { (y, x) };
        Features::Ee { edges: [x.0, y.0], ends: [x.1, y.1] }
    }

    #[inline(always)]
    fn pair(&self) -> Pair {
        match *self {
            Features::Vf { vertex, face, .. } => Pair { a: vertex, b: face },
            Features::Ee { edges: [a, b], .. } => Pair { a, b },
        }
    }
}

/// One of three, without memory.
#[inline(always)]
fn pick([x, y, z]: [u32; 3], k: u32) -> u32 {
    if k == 0 {
        x
    } else if k == 1 {
        y
    } else {
        z
    }
}

/// Counts of both kinds in one word: at most [`MOST`] a lane, so blocks of up to 1,024 lanes stay within 16 bits.
const EE: u32 = 1 << 16;

/// Finds pairs of features, shares them among the lanes of the block, and lists those that `keep` keeps.
#[inline(always)]
fn features<R: Real, B: Block>(
    b: &mut B,
    a: &SiftArgs<R>,
    gap: R,
    (vf_at, ee_at): (u32, u32),
    keep: impl Fn(&B::Lane, &Features) -> bool,
) {
    let count = listed(b, a.pairs, a.counters, counter::PAIRS);
    let lanes = b.lanes();
    let queue = b.shared::<u32>(MOST * lanes);
    let mut masks = b.slot(0u32);
    let mut places = b.slot(0u32);
    let mut base = b.block() * lanes;
    while base < count {
        b.phase(|l| {
            let i = base + l.lane();
            let mut mask = 0;
            if i < count {
                let pair = l.read(a.pairs, i);
                let (p, q) = (Triangle::read(l, a, pair.a, gap), Triangle::read(l, a, pair.b, R::ZERO));
                mask = wanted(&p, &q);
            }
            *masks.of(l) = mask;
            *places.of(l) = (mask & VERTICES).count_ones() + EE * (mask & !VERTICES).count_ones();
        });
        let total = b.scan(&mut places);
        let (vf, all) = (total % EE, total % EE + total / EE);
        b.phase(|l| {
            let (mut mask, before) = (*masks.of(l), *places.of(l));
            let (mut place_vf, mut place_ee) = (before % EE, vf + before / EE);
            while mask != 0 {
                let k = mask.trailing_zeros();
                mask &= mask - 1;
                let place = if k < 6 { &mut place_vf } else { &mut place_ee };
                l.put(queue, *place, l.lane() << 4 | k);
                *place += 1;
            }
            if vf_at != counter::VF && l.lane() == 0 && all > 0 {
                l.fetch_add(a.counters, counter::VF, vf as u64);
                l.fetch_add(a.counters, counter::EE, (all - vf) as u64);
            }
        });
        share(b, a, (queue, base, [vf, all]), (vf_at, ee_at), &keep);
        base += b.blocks() * lanes;
    }
}

/// The lanes of the block share what waits in its queue: vertices and faces to `[0]`, edges to `[1]`.
#[inline(always)]
fn share<R: Real, B: Block>(
    b: &mut B,
    a: &SiftArgs<R>,
    (queue, base, [vf, all]): (Shared<u32>, u32, [u32; 2]),
    (vf_at, ee_at): (u32, u32),
    keep: &impl Fn(&B::Lane, &Features) -> bool,
) {
    let mut wishes = b.slot(0u32);
    let mut places = b.slot(0u32);
    let mut pairs = b.slot(Pair::default());
    let mut first = 0;
    while first < all {
        b.phase(|l| {
            let at = first + l.lane();
            let mut wish = 0;
            if at < all {
                let word = l.get(queue, at);
                let features = Features::read(l, a, l.read(a.pairs, base + (word >> 4)), word & 15);
                *pairs.of(l) = features.pair();
                wish = keep(l, &features) as u32 * if at < vf { 1 } else { EE };
            }
            *wishes.of(l) = wish;
            *places.of(l) = wish;
        });
        let total = b.scan(&mut places);
        let vf_start = b.reserve(a.counters, vf_at, (total % EE) as u64);
        let ee_start = b.reserve(a.counters, ee_at, (total / EE) as u64);
        b.phase(|l| {
            let (wish, before) = (*wishes.of(l), *places.of(l));
            let (list, place) = if wish == EE {
                (a.ee, ee_start + (before / EE) as u64)
            } else {
                (a.vf, vf_start + (before % EE) as u64)
            };
            if wish != 0 && place < list.len {
                l.write(list, place as u32, *pairs.of(l));
            }
        });
        first += b.lanes();
    }
}
