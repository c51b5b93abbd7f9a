//! Triangles in motion and at rest, for [`crate::stage::narrow::features`]: the part of a vertex that
//! it reads, and the tests of it.

use crate::abi::Positions;
use crate::exec::Lane;
use crate::math::{Real, Vec3};
use crate::prim::cubic::Moving;
use crate::prim::sweep::{meeting, meeting_at_rest, more};
use bytemuck::Pod;

/// [`more`] than the gap of a query, in the precision of positions and in f32.
#[derive(Clone, Copy)]
pub struct Gap<R> {
    /// In that of positions.
    pub own: R,
    /// In f32.
    pub single: f32,
}

impl<R: Real> Gap<R> {
    /// A gap of that length.
    pub fn of(gap: f64) -> Self {
        Gap { own: more(gap), single: more(gap) }
    }
}

/// Whether triangles move, and the part of a vertex that the test of their boxes reads.
pub trait Course<R: Real> {
    /// The part of a vertex that it reads.
    type Corner: Pod;
    /// It will be read soon.
    fn expect<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32);
    /// Reads it.
    fn corner<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) -> Self::Corner;
    /// A corner of which all numbers are this one.
    fn filled(number: R) -> Self::Corner;
    /// Where it is at both ends of the step.
    fn ends(corner: Self::Corner) -> Moving<R>;
    /// The tests whose features' boxes come within a gap, and not first behind the horizon.
    fn meeting(p: &[Self::Corner; 3], q: &[Self::Corner; 3], gap: Gap<R>, horizon: f32) -> u32;
    /// Whether all its numbers are [`Real::is_single`].
    fn is_single(corner: &Self::Corner) -> bool;
    /// [`Course::meeting`] of such, in f32.
    fn meeting_single(p: &[Self::Corner; 3], q: &[Self::Corner; 3], gap: f32, horizon: f32) -> u32;
}

/// A vertex in motion.
#[inline(always)]
pub fn moving<R: Real, L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) -> Moving<R> {
    let vertex = lane.read(frames.moving, vertex);
    Moving { t0: vertex.t0.at, t1: vertex.t1.at }
}

/// Vertices move over a step.
pub struct Moves;

impl<R: Real> Course<R> for Moves {
    type Corner = Moving<R>;
    #[inline(always)]
    fn expect<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) {
        lane.expect(frames.moving, vertex);
    }
    #[inline(always)]
    fn corner<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) -> Moving<R> {
        moving(lane, frames, vertex)
    }
    #[inline(always)]
    fn filled(number: R) -> Moving<R> {
        Moving { t0: Vec3([number; 3]), t1: Vec3([number; 3]) }
    }
    #[inline(always)]
    fn ends(corner: Moving<R>) -> Moving<R> {
        corner
    }
    #[inline(always)]
    fn meeting(p: &[Moving<R>; 3], q: &[Moving<R>; 3], gap: Gap<R>, horizon: f32) -> u32 {
        meeting(p, q, gap.single, horizon)
    }
    #[inline(always)]
    fn is_single(corner: &Moving<R>) -> bool {
        corner.is_single()
    }
    #[inline(always)]
    fn meeting_single(p: &[Moving<R>; 3], q: &[Moving<R>; 3], gap: f32, horizon: f32) -> u32 {
        let narrow = |[x, y, z]: &[Moving<R>; 3]| [x.narrow(), y.narrow(), z.narrow()];
        meeting(&narrow(p), &narrow(q), gap, horizon)
    }
}

/// Nothing moves; the gap is above 0.
pub struct Rests;

impl<R: Real> Course<R> for Rests {
    type Corner = Vec3<R>;
    #[inline(always)]
    fn expect<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) {
        lane.expect(frames.still, vertex);
    }
    #[inline(always)]
    fn corner<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) -> Vec3<R> {
        lane.read(frames.still, vertex).at
    }
    #[inline(always)]
    fn filled(number: R) -> Vec3<R> {
        Vec3([number; 3])
    }
    #[inline(always)]
    fn ends(corner: Vec3<R>) -> Moving<R> {
        Moving { t0: corner, t1: corner }
    }
    #[inline(always)]
    fn meeting(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3], gap: Gap<R>, _: f32) -> u32 {
        meeting_at_rest(p, q, gap.own)
    }
    #[inline(always)]
    fn is_single(corner: &Vec3<R>) -> bool {
        corner.is_single()
    }
    #[inline(always)]
    fn meeting_single(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3], gap: f32, _: f32) -> u32 {
        let narrow = |[x, y, z]: &[Vec3<R>; 3]| [x.narrow(), y.narrow(), z.narrow()];
        meeting_at_rest(&narrow(p), &narrow(q), gap)
    }
}
