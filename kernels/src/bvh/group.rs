//! Nodes of few leaves, whose volume is fitted to the points below them instead of merged.

use super::turns::swell;
use crate::abi::{Growth, Link, Positions, Span};
use crate::bv::{Points, Volume};
use crate::exec::Lane;
use crate::math::{Real, Vec3};

/// Whether the volume of an inner node is fitted: then no refit touches it. `firsts` has the first
/// leaf of each pair.
#[inline(always)]
pub fn is_fitted<V: Volume, L: Lane>(lane: &L, firsts: Span<u32>, link: Link) -> bool {
    V::GROUP > 0 && link.last - lane.read(firsts, link.link / 2) < V::GROUP
}

/// The corners of the triangles of neighbouring leaves: leaf by leaf, each corner at t = 0 and,
/// when there are two frames, at t = 1.
pub struct GroupPoints<'a, R: Real, L> {
    /// The lane that reads.
    pub lane: &'a L,
    /// Positions.
    pub frames: Positions<R>,
    /// Vertex indices of every triangle.
    pub faces: Span<[u32; 3]>,
    /// Triangles in leaf order: the lower halves.
    pub triangles: Span<u64>,
    /// The first leaf and the last.
    pub leaves: [u32; 2],
}

impl<R: Real, L: Lane> GroupPoints<'_, R, L> {
    #[inline(always)]
    fn face(&self, leaf: u32) -> [u32; 3] {
        self.lane.read(self.faces, self.lane.read(self.triangles, leaf) as u32)
    }

    /// The largest swell of the triangles: see [`swell`].
    #[inline(always)]
    pub fn swell(&self) -> f32 {
        if !R::WIDE || self.frames.turns.is_empty() {
            return 0.0;
        }
        let [first, last] = self.leaves;
        (first..=last)
            .map(|leaf| swell(self.lane, &self.frames, self.face(leaf)))
            .fold(0.0, |most, own| if own > most { own } else { most })
    }

    /// How much the volume grows: by the thickest triangle.
    #[inline(always)]
    pub fn growth(&self, growth: Growth) -> f32 {
        if growth.is_thick == 0 {
            return growth.margin;
        }
        let [first, last] = self.leaves;
        let of = |v: u32| match self.frames.moving.is_empty() {
            true => self.lane.read(self.frames.still, v),
            false => self.lane.read(self.frames.moving, v).t0,
        };
        (first..=last)
            .map(|leaf| growth.of(&self.face(leaf).map(of)))
            .fold(growth.margin, |most, own| if own > most { own } else { most })
    }
}

impl<R: Real, L: Lane> Points<R> for GroupPoints<'_, R, L> {
    #[inline(always)]
    fn first(&self) -> Vec3<R> {
        let vertex = self.face(self.leaves[0])[0];
        if self.frames.moving.is_empty() {
            self.lane.read(self.frames.still, vertex).at
        } else {
            self.lane.read(self.frames.moving, vertex).t0.at
        }
    }

    /// The face of the next leaf is on its way while the corners of this one are.
    #[inline(always)]
    fn each(&self, mut visit: impl FnMut(Vec3<R>)) {
        let [mut leaf, last] = self.leaves;
        let mut next = self.face(leaf);
        while leaf <= last {
            let face = next;
            leaf += 1;
            next = self.face(leaf.min(last));
            if self.frames.moving.is_empty() {
                let [p, q, r] = face.map(|v| self.lane.read(self.frames.still, v).at);
                visit(p);
                visit(q);
                visit(r);
            } else {
                let [p, q, r] = face.map(|v| self.lane.read(self.frames.moving, v));
                visit(p.t0.at);
                visit(p.t1.at);
                visit(q.t0.at);
                visit(q.t1.at);
                visit(r.t0.at);
                visit(r.t1.at);
            }
        }
    }
}
