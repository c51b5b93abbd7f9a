//! Triangles in motion and at rest, for [`crate::stage::narrow::features`]: the part of a vertex that
//! it reads, and the tests of it. [`ThickMoves`] and [`ThickRests`] are
//! those with a thickness.

use crate::abi::{Point, Positions, VertexMotion};
use crate::exec::Lane;
use crate::math::{Real, Vec3, round};
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
    /// The gap of two triangles: that of the query, and more by their thickness.
    #[inline(always)]
    fn gap(_: &[Self::Corner; 3], _: &[Self::Corner; 3], gap: f32) -> f32 {
        gap
    }
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

/// The largest radius of each of two triangles, summed and rounded up.
#[inline(always)]
fn thickness<R: Real>(p: [R; 3], q: [R; 3]) -> R {
    let most = |[x, y, z]: [R; 3]| x.greater(y).greater(z);
    (most(p) + most(q)) * R::INCLUSION_UP
}

/// As [`Moves`], of vertices with a thickness, the same at both ends of the step.
pub struct ThickMoves;

impl ThickMoves {
    #[inline(always)]
    fn thickness<R: Real>(p: &[VertexMotion<R>; 3], q: &[VertexMotion<R>; 3]) -> f32 {
        let of = |corners: &[VertexMotion<R>; 3]| corners.map(|v| v.t0.radius);
        up(thickness(of(p), of(q)))
    }
    #[inline(always)]
    fn moving<R: Real>(corners: &[VertexMotion<R>; 3]) -> [Moving<R>; 3] {
        corners.map(|v| Moving { t0: v.t0.at, t1: v.t1.at })
    }
}

/// As f32, rounded up.
#[inline(always)]
fn up<R: Real>(x: R) -> f32 {
    if R::WIDE { round::up(x.wide()) } else { x.wide() as f32 }
}

impl<R: Real> Course<R> for ThickMoves {
    type Corner = VertexMotion<R>;
    #[inline(always)]
    fn expect<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) {
        lane.expect(frames.moving, vertex);
    }
    #[inline(always)]
    fn corner<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) -> VertexMotion<R> {
        lane.read(frames.moving, vertex)
    }
    #[inline(always)]
    fn filled(number: R) -> VertexMotion<R> {
        let point = Point::from(Vec3([number; 3]));
        VertexMotion { t0: point, t1: point }
    }
    #[inline(always)]
    fn ends(corner: VertexMotion<R>) -> Moving<R> {
        Moving { t0: corner.t0.at, t1: corner.t1.at }
    }
    #[inline(always)]
    fn meeting(p: &[VertexMotion<R>; 3], q: &[VertexMotion<R>; 3], gap: Gap<R>, horizon: f32) -> u32 {
        let gap = gap.single + Self::thickness(p, q);
        meeting(&Self::moving(p), &Self::moving(q), gap, horizon)
    }
    #[inline(always)]
    fn gap(p: &[VertexMotion<R>; 3], q: &[VertexMotion<R>; 3], gap: f32) -> f32 {
        gap + Self::thickness(p, q)
    }
    #[inline(always)]
    fn is_single(corner: &VertexMotion<R>) -> bool {
        corner.t0.at.is_single() & corner.t1.at.is_single()
    }
    #[inline(always)]
    fn meeting_single(p: &[VertexMotion<R>; 3], q: &[VertexMotion<R>; 3], gap: f32, horizon: f32) -> u32 {
        let narrow = |corners: &[VertexMotion<R>; 3]| {
            corners.map(|v| Moving { t0: v.t0.at.narrow(), t1: v.t1.at.narrow() })
        };
        meeting(&narrow(p), &narrow(q), gap + Self::thickness(p, q), horizon)
    }
}

/// As [`Rests`], of vertices with a thickness. The gap may be 0.
pub struct ThickRests;

impl ThickRests {
    #[inline(always)]
    fn thickness<R: Real>(p: &[Point<R>; 3], q: &[Point<R>; 3]) -> R {
        thickness(p.map(|v| v.radius), q.map(|v| v.radius))
    }
}

impl<R: Real> Course<R> for ThickRests {
    type Corner = Point<R>;
    #[inline(always)]
    fn expect<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) {
        lane.expect(frames.still, vertex);
    }
    #[inline(always)]
    fn corner<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) -> Point<R> {
        lane.read(frames.still, vertex)
    }
    #[inline(always)]
    fn filled(number: R) -> Point<R> {
        Point::from(Vec3([number; 3]))
    }
    #[inline(always)]
    fn ends(corner: Point<R>) -> Moving<R> {
        Moving { t0: corner.at, t1: corner.at }
    }
    #[inline(always)]
    fn meeting(p: &[Point<R>; 3], q: &[Point<R>; 3], gap: Gap<R>, _: f32) -> u32 {
        let gap = gap.own + Self::thickness(p, q);
        meeting_at_rest(&p.map(|v| v.at), &q.map(|v| v.at), gap)
    }
    #[inline(always)]
    fn gap(p: &[Point<R>; 3], q: &[Point<R>; 3], gap: f32) -> f32 {
        gap + up(Self::thickness(p, q))
    }
    #[inline(always)]
    fn is_single(corner: &Point<R>) -> bool {
        corner.at.is_single()
    }
    #[inline(always)]
    fn meeting_single(p: &[Point<R>; 3], q: &[Point<R>; 3], gap: f32, _: f32) -> u32 {
        let narrow = |corners: &[Point<R>; 3]| corners.map(|v| v.at.narrow());
        meeting_at_rest(&narrow(p), &narrow(q), gap + up(Self::thickness(p, q)))
    }
}
