//! Oriented boxes of tiles: whether the triangles of two tiles are certainly apart.
//!
//! A box holds `{p : |a_i . (p - c)| <= h_i}` for stored numbers, in the frame of its mesh. `a_2` is
//! the rounded cross product of `a_0` and `a_1`. Axes are nearly orthonormal: `A A^T = I + E` with
//! `|E_ij| <= 16u` ([`crate::bv::Obb`] uses the same). `u` and `U` are the unit roundoffs of f32 and
//! f64.
//!
//! # The bound of a gap
//!
//! Let `T`, `m` be the stored turn and shift of a relation, and `rho`, `s` its radii and slack.
//! Suppose that two placed triangles share a point. Then there is a `P` in the hull of the stored
//! corners of the first tile, and a `Q` in that of the second. Each coordinate of `e = P - (T Q + m)`
//! is at most the error of a vertex of each: [`super::relation`] derives it. Without the evaluation in
//! f32 it is `u rho_A + 2.1u rho_B + 1.1u |m|`, and `14U` of far coordinates.
//!
//! The test takes a direction `L` of about unit length, an axis of the first box or `T b_j`.
//!
//! - **The error of a point.** `|L . e|` is at most the root of 3 times the largest coordinate of `e`.
//!   The centre `T c_B + m` is computed with `4u |T| |c_B| + u |m|`, and `|c_B|` is at most the root
//!   of 3 times `rho_B`. The sum of both in direction `L` is below `2u rho_A + 16u rho_B + 4u |m|`,
//!   and `25U` of far coordinates. [`TILE_SLACK`]` s` is more: `56u` and `28U`.
//! - **Radii.** Let `S` be the sum of all six half extents. A box reaches along `L` at most
//!   `sum h_i |L . a_i| + 28u sum h_i` (see [`crate::bv::Obb`]: "a child in its parent"). Computed
//!   `T b_j` err by `5.3u`, products `L . a_i` by `3.1u`, and sums of radii by `4.1u S`. Together
//!   `41u S`.
//! - **Centres.** `|c'_B - c_A|` is at most `1.01 S` and an error of points, whose share here is of
//!   second order. The difference rounds by `u` of it, the product with `L` by `3.1u`, and with a
//!   computed `T b_j` by `5.3u` more. Together `9.6u S`.
//! - **Axes of the second.** `(T b_j) . T (Q - c_B)` differs from `b_j . (Q - c_B)` by
//!   `|T^T T - I| <= 3.5u`: entries of `T` are rounded once. That is `3.6u S`.
//!
//! The sum is below `55u S`. Half extents are stored with [`TILE_BOX`] of the sum of their box, `64u`.
//! A stored radius along `L` has that part of both boxes: the `|L . a_i|` of one box have a sum of at
//! least `1 - 40u`. Products that underflow lose less than the smallest normal number, which is part
//! of `s`.
//!
//! Comparisons with NaN are false. So a box of everything is apart from none.
//!
//! # In a step
//!
//! A face normal of the first box stands still in the frame of its body, one of the second in that of the
//! other. In these frames points of the other body leave the chords between both ends by at most a part of
//! the slack of a [`MovingRelation`]: see [`super::motion`]. So if boxes are apart on one side of one normal
//! at both ends, their distance is linear in time but for that, and they are apart in the whole step. `T b_j` at
//! either end is that normal at this end.

use super::relation::Related;
use crate::abi::{MovingRelation, Relation, TileBox};
use crate::bv::{Frame, WORLD, frame, three};
use crate::exec::RowMap;
use crate::math::tolerance::{BOX_LIMIT, TILE_BOX, TILE_EXTENT, TILE_SLACK};
use crate::math::{Real, Vec3, round};

/// Result for tiles that are apart.
pub const APART: u32 = 1;

impl TileBox {
    /// Around everything.
    pub const EVERYTHING: TileBox =
        TileBox { centre: [0.0; 3], axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], half: [f32::INFINITY; 3] };

    /// Around points, with the first axis along `v` and the second towards `w`; with the axes of the
    /// mesh if these are none. Components of `v` should be about 1 in size.
    ///
    /// Around everything for a point that is not finite or is too large.
    pub fn around(points: &[[f32; 3]], [v, w]: [[f32; 3]; 2]) -> TileBox {
        let fits = points.iter().flatten().all(|x| x.abs() <= BOX_LIMIT);
        if points.is_empty() | !fits {
            return TileBox::EVERYTHING;
        }
        let frame: Frame = frame(Vec3(v), Vec3(w)).unwrap_or(WORLD);
        let axes = three(frame).map(|a| a.wide());
        let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &p in points {
            for k in 0..3 {
                let s = axes[k].dot(Vec3(p).wide());
                (lo[k], hi[k]) = (lo[k].lesser(s), hi[k].greater(s));
            }
        }
        let middle = |k: usize| axes[k] * (0.5 * lo[k] + 0.5 * hi[k]);
        let centre = (middle(0) + middle(1) + middle(2)).narrow();
        let mut half = [0.0_f64; 3];
        for &p in points {
            // A difference, a product and two sums round, and the sum with the part of all below.
            let d = Vec3(p).wide() - centre.wide();
            let by = TILE_EXTENT * (d[0].abs() + d[1].abs() + d[2].abs());
            for k in 0..3 {
                half[k] = half[k].greater(axes[k].dot(d).abs() + by);
            }
        }
        let part = TILE_BOX * (half[0] + half[1] + half[2]);
        let half = half.map(|h| round::up(h + part));
        TileBox { centre: centre.0, axes: frame.map(|a| a.0), half }
    }

    /// Whether it holds a point with three quarters of the roundings of a test to spare: the judge of
    /// [`TileBox::around`].
    pub fn holds(&self, p: [f32; 3]) -> bool {
        let sum: f64 = self.half.iter().map(|h| h.wide()).sum();
        let spare = 0.75 * TILE_BOX * sum;
        let d = Vec3(p).wide() - Vec3(self.centre).wide();
        let along = three(self.axes.map(Vec3)).map(|a| a.wide().dot(d).abs());
        self.half[0] == f32::INFINITY || (0..3).all(|k| along[k] + spare <= self.half[k].wide())
    }
}

/// A distance of the centres of two boxes along a direction, and how far both boxes reach along it.
type Along = (f32, f32);

/// The distances and radii along the six face normals of a tile's box of each body.
#[inline(always)]
fn along(relation: &Relation, a: &TileBox, b: &TileBox) -> [Along; 6] {
    let turn = [Vec3(relation.turn[0]), Vec3(relation.turn[1]), Vec3(relation.turn[2])];
    let turned = |v: Vec3<f32>| Vec3([turn[0].dot(v), turn[1].dot(v), turn[2].dot(v)]);
    let x = three([Vec3(a.axes[0]), Vec3(a.axes[1])]);
    let [y0, y1, y2] = three([Vec3(b.axes[0]), Vec3(b.axes[1])]);
    let y = [turned(y0), turned(y1), turned(y2)];
    let t = turned(Vec3(b.centre)) + Vec3(relation.shift) - Vec3(a.centre);
    let (g, h) = (Vec3(a.half), Vec3(b.half));
    let row = |i: usize| Vec3([x[i].dot(y[0]), x[i].dot(y[1]), x[i].dot(y[2])]).map(Real::abs);
    let r = [row(0), row(1), row(2)];
    let column = |i: usize| Vec3([r[0][i], r[1][i], r[2][i]]);
    let of_first = |i: usize| (x[i].dot(t), g[i] + h.dot(r[i]));
    let of_second = |i: usize| (y[i].dot(t), h[i] + g.dot(column(i)));
    [of_first(0), of_first(1), of_first(2), of_second(0), of_second(1), of_second(2)]
}

/// Whether on one side of one face normal the distance less the radii is more than `least` at all of
/// these places of two bodies.
#[inline(always)]
fn are_apart<const N: usize>(places: [&Relation; N], [a, b]: [&TileBox; 2], least: f32) -> bool {
    let mut sides = [[true; 6]; 2];
    for place in places {
        let along = along(place, a, b);
        for k in 0..6 {
            let (distance, radii) = along[k];
            sides[0][k] &= distance - radii > least;
            sides[1][k] &= -distance - radii > least;
        }
    }
    let any = |s: [bool; 6]| s[0] | s[1] | s[2] | s[3] | s[4] | s[5];
    any(sides[0]) | any(sides[1])
}

/// Two bodies whose tiles have oriented boxes.
pub trait Oriented: Related {
    /// Whether two boxes are certainly apart, at rest or for the whole step.
    fn are_tiles_apart(&self, boxes: [&TileBox; 2]) -> bool;
}

impl Oriented for Relation {
    #[inline(always)]
    fn are_tiles_apart(&self, boxes: [&TileBox; 2]) -> bool {
        are_apart([self], boxes, TILE_SLACK * self.slack)
    }
}

impl Oriented for MovingRelation {
    #[inline(always)]
    fn are_tiles_apart(&self, boxes: [&TileBox; 2]) -> bool {
        are_apart([&self.start, &self.end], boxes, TILE_SLACK * self.slack())
    }
}

/// Whether the oriented boxes of two tiles are certainly apart: [`APART`], or 0.
pub struct TilesApart<Q> {
    /// The relation of the bodies.
    pub relation: Q,
}

impl<Q: Oriented> RowMap for TilesApart<Q> {
    type Number = f32;
    type Row = [TileBox; 2];
    #[inline(always)]
    fn at_once(&self, [a, b]: [TileBox; 2]) -> u32 {
        if self.relation.are_tiles_apart([&a, &b]) { APART } else { 0 }
    }
}

#[cfg(test)]
mod tests;
