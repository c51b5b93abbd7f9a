//! # Sift: triangle pairs → vertex/face and edge/edge candidates
//! Paper    section 6.2.5, "each of the 15 elementary vertex/face and edge/edge tests".
//! Launch   a lane a triangle pair; a grid of any size strides.
//! Reads    candidates (pairs that share a vertex among them), faces, edges, owners, positions of both frames.
//! Writes   vertex/face and edge/edge candidates whose swept boxes overlap, or come within the separation, each once.
//! Before   every pair of triangles that come within the separation is listed, adjacent ones too.
//! After    every vertex/face and edge/edge pair without a common vertex that comes within the separation is listed;
//!          without one every such pair whose closed swept boxes overlap.
//!          Why once: each vertex and each edge is owned by one of its triangles, and a pair of features is tested only
//!          where owners meet. Why none is lost: a feature lies in its owner, so what comes within the separation of
//!          another brings the owners as near, and that pair of triangles, adjacent or not, is in the list.
//! Room     vf, ee: counted past the end, grown, run again.
//! Departs  the paper tests all 15 for every pair; owners (representative triangles: Curtis, Tamstorf, Manocha, "Fast
//!          collision detection for deformable models using representative-triangles", 2008) leave about 3.
//! Cost     8 B pair, 56 B topology, 192 B positions (gathered); 6 comparisons a test.

use super::{listed, moving};
use crate::abi::{Pair, SiftArgs, Span, counter};
use crate::exec::{Block, Lane, Slot};
use crate::math::{Real, Vec3};
use crate::prim::cubic::Moving;

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
    corners: [u32; 3],
    owned: u32,
    boxes: [Swept<R>; 3],
}

impl<R: Real> Triangle<R> {
    /// `gap` as by [`gap`], or 0.
    fn read<L: Lane>(l: &L, a: &SiftArgs<R>, index: u32, gap: R) -> Self {
        let corners = l.read(a.faces, index);
        let owned = l.read(a.owners, index);
        let boxes = corners.map(|v| {
            let Moving { t0, t1 } = moving(l, &a.frames, v);
            let swept = Swept { lo: t0.min(t1), hi: t0.max(t1) };
            if gap > R::ZERO { swept.grown(gap) } else { swept }
        });
        Triangle { corners, owned, boxes }
    }
    fn hull(&self) -> Swept<R> {
        self.boxes[0].merge(self.boxes[1]).merge(self.boxes[2])
    }
    fn owns_vertex(&self, k: usize) -> bool {
        self.owned >> k & 1 != 0
    }
    fn owns_edge(&self, k: usize) -> bool {
        self.owned >> (k + 3) & 1 != 0
    }
    fn edge_box(&self, k: usize) -> Swept<R> {
        self.boxes[k].merge(self.boxes[(k + 1) % 3])
    }
    fn has(&self, vertex: u32) -> bool {
        self.corners.contains(&vertex)
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
        if p.owns_vertex(k) && p.boxes[k].overlaps(&of_q) && !q.has(p.corners[k]) {
            mask |= 1 << k;
        }
        if q.owns_vertex(k) && q.boxes[k].overlaps(&of_p) && !p.has(q.corners[k]) {
            mask |= 8 << k;
        }
    }
    for i in 0..3 {
        let edge = p.edge_box(i);
        if !p.owns_edge(i) || !edge.overlaps(&of_q) {
            continue;
        }
        let [from, to] = [p.corners[i], p.corners[(i + 1) % 3]];
        for j in 0..3 {
            let ends = [q.corners[j], q.corners[(j + 1) % 3]];
            if q.owns_edge(j) && !ends.contains(&from) && !ends.contains(&to) && edge.overlaps(&q.edge_box(j))
            {
                mask |= 1 << (6 + 3 * i + j);
            }
        }
    }
    mask
}

/// Vertex/face and edge/edge candidates of each triangle pair.
pub fn sift<R: Real, B: Block>(b: &mut B, a: &SiftArgs<R>) {
    let count = listed(b, a.pairs, a.counters, counter::PAIRS);
    let (lanes, gap) = (b.lanes(), gap(a.separation));
    let mut masks = b.slot(0u32);
    let mut pairs = b.slot(Pair::default());
    let mut places = b.slot(0u32);
    let mut base = b.block() * lanes;
    while base < count {
        b.phase(|l| {
            let i = base + l.lane();
            *masks.of(l) = 0;
            if i < count {
                let pair = l.read(a.pairs, i);
                *pairs.of(l) = pair;
                let (p, q) = (Triangle::read(l, a, pair.a, gap), Triangle::read(l, a, pair.b, R::ZERO));
                *masks.of(l) = wanted(&p, &q);
            }
            *places.of(l) = (*masks.of(l) & 63).count_ones();
        });
        let start = b.append(&mut places, a.counters, counter::VF);
        b.phase(|l| {
            let Pair { a: p, b: q } = *pairs.of(l);
            let mut place = start + *places.of(l) as u64;
            let mut mask = *masks.of(l) & 63;
            while mask != 0 {
                let k = mask.trailing_zeros();
                mask &= mask - 1;
                let (of, face) = if k < 3 { (p, q) } else { (q, p) };
                put(l, a.vf, &mut place, l.read(a.faces, of)[k as usize % 3], face);
            }
            *places.of(l) = (*masks.of(l) >> 6).count_ones();
        });
        let start = b.append(&mut places, a.counters, counter::EE);
        b.phase(|l| {
            let Pair { a: p, b: q } = *pairs.of(l);
            let mut place = start + *places.of(l) as u64;
            let mut mask = *masks.of(l) >> 6;
            if mask == 0 {
                return;
            }
            let (of_p, of_q) = (l.read(a.face_edges, p), l.read(a.face_edges, q));
            while mask != 0 {
                let k = mask.trailing_zeros() as usize;
                mask &= mask - 1;
                // k is below 9; `% 3` tells the compiler.
                let (ea, eb) = (of_p[k / 3 % 3], of_q[k % 3]);
                put(l, a.ee, &mut place, ea.min(eb), ea.max(eb));
            }
        });
        base += b.blocks() * lanes;
    }
}

/// Writes one candidate where there is room, and counts it anyway.
fn put<L: Lane>(l: &L, list: Span<Pair>, place: &mut u64, a: u32, b: u32) {
    if *place < list.len {
        l.write(list, *place as u32, Pair { a, b });
    }
    *place += 1;
}
