//! Positions as the checkers of volumes read them, after download.

use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::{Growth, Point, TurnRecord};
use nearmiss_kernels::bvh::turns::swell_of;
use nearmiss_kernels::entry::Kernels;
use nearmiss_kernels::math::Vec3;

/// Positions at t = 0 or at both ends of the step, and the bodies that turn.
pub struct Checked<R> {
    ends: Vec<Vec<Vec3<R>>>,
    turns: Vec<TurnRecord>,
    /// The thickness of every vertex, rounded up; empty in a scene without.
    radii: Vec<R>,
}

impl<R: Precision> Checked<R> {
    /// Returns positions, and the bodies that may turn.
    pub fn new(ends: Vec<Vec<Vec3<R>>>, turns: Vec<TurnRecord>) -> Self {
        Checked { ends, turns, radii: Vec::new() }
    }

    /// The same of vertices with a thickness.
    pub fn with_radii(self, radii: Vec<R>) -> Self {
        Checked { radii, ..self }
    }

    /// Returns how far a triangle may leave its straight lines.
    pub fn swell(&self, face: [u32; 3]) -> f32 {
        let ([t0, t1], false) = (&self.ends[..], self.turns.is_empty()) else { return 0.0 };
        let of = |record: &&TurnRecord| (record.vertex..record.end).contains(&face[0]) && record.turns();
        let record = self.turns.iter().find(of).copied().unwrap_or_default();
        swell_of(&record, face.map(|v| [t0, t1].map(|end| end[v as usize].wide())))
    }

    /// Returns how much the volume of a triangle grows.
    pub fn grown(&self, face: [u32; 3], growth: Growth) -> f32 {
        let radius = |v: u32| self.radii.get(v as usize).copied().unwrap_or(R::ZERO);
        growth.of(&face.map(|v| Point { at: self.ends[0][v as usize], radius: radius(v) }))
    }

    /// Returns the volume around a triangle and everything within a margin.
    pub fn leaf<V: Kernels>(&self, face: [u32; 3], margin: f32) -> V {
        let corners = |end: &Vec<Vec3<R>>| face.map(|v| end[v as usize]);
        let volume = match &self.ends[..] {
            [t0, t1] => V::moving(corners(t0), corners(t1)),
            ends => V::still(corners(&ends[0])),
        };
        volume.near(margin)
    }
}

impl<R> std::ops::Deref for Checked<R> {
    type Target = [Vec<Vec3<R>>];

    fn deref(&self) -> &[Vec<Vec3<R>>] {
        &self.ends
    }
}
