//! Two bodies in each other's frames: volumes and vertices of one as the other sees them.
//!
//! # Meaning
//!
//! Let `R`, `t` be the computed rotation and translation of the first body, `o` its placed centre.
//! The frame of the first is `y = R^T (x - o)`. This map is affine and one to one for the computed
//! `R`. So two placed triangles whose images are apart are apart. Nothing rests on `R` being
//! orthogonal. The frame of the second is the same by its own pose.
//!
//! # The bound of [`Relation::slack`]
//!
//! `U` and `u` are the unit roundoffs of f64 and f32. `rho` is a mesh's radius about its centre
//! `c`, `m` the centre of the other body in this frame.
//!
//! - A quaternion that was normalised in f64 has `||q|^2 - 1| <= 8U`. `R` is then `(1 - s) I + s Q`
//!   for a rotation `Q` and `s = |q|^2`, so `|R^T R - I| <= 4 * 8U`. Its entries round by at most
//!   `5U` (diagonal) and `2U`, which adds `18U`: together `50U`.
//! - Placing has six roundings: `|x - (R v + t)| <= U |t| + 7U |v|`.
//! - So a vertex of the first errs in its own frame, against `v - c`, by at most
//!   `2U |t| + 14U |c| + 58U rho`, and by `u rho` as it is rounded to f32.
//! - A vertex of the second errs by the same, without the `50U`. `R_A^T R_B` and `m` are computed in
//!   f64 and rounded once; a coordinate takes three products and three sums in f32. Together
//!   `6u rho_B + 5u |m|`.
//! - A box of the second has corners up to `sqrt 3 rho_B` away. Its centre and half extents round
//!   once each, and its half extents take three products, two sums and two more. Together
//!   `26u rho_B + 7u |m|`.
//!
//! The sum of a vertex of each is below `32u (rho_A + rho_B + |m|_1)` and, of the terms in `|t|` and
//! `|c|`, `14U` of their sums: [`RELATIVE_SLACK`] and [`RELATIVE_FAR`]. Roundings of sums with the
//! slack are `2u` of it, and inside the rest. Products of f32 lose less than the smallest normal
//! number to underflow.

use crate::abi::{InstanceFrame, MeshRecord, Relation};
use crate::bv::FrameBox;
use crate::math::tolerance::{RELATIVE_FAR, RELATIVE_LIMIT, RELATIVE_SLACK};
use crate::math::{Real, Vec3, round};
use crate::prim::planes;
use bytemuck::{Pod, Zeroable};

/// A volume in the frames of both bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Both {
    /// In the frame of the first.
    pub first: FrameBox,
    /// In the frame of the second.
    pub second: FrameBox,
}

impl Both {
    /// Whether they overlap in both frames.
    #[inline(always)]
    pub fn overlaps(&self, other: &Both) -> bool {
        self.first.overlaps(&other.first) & self.second.overlaps(&other.second)
    }
}

/// Two bodies in each other's frames, at rest or in motion: a volume of one as the other sees it.
pub trait Related: Pod {
    /// Corners of a triangle of the second, in the frame of the first.
    type Seen: Pod;
    /// Those of a triangle of the first and of one of the second.
    type Row: Pod;

    /// The bodies, as [`Relation::bodies`].
    fn bodies(&self) -> [u32; 2];
    /// Error of everything of one in the frame of the other. Length.
    fn slack(&self) -> f32;
    /// The same for planes of triangles. If it is infinite, no plane parts two.
    #[inline(always)]
    fn plane_slack(&self) -> f32 {
        self.slack()
    }
    /// A volume of the first in both frames.
    fn first_in_both(&self, volume: &FrameBox) -> Both;
    /// A volume of the second in both frames.
    fn second_in_both(&self, volume: &FrameBox) -> Both;
    /// A triangle of the second in the frame of the first, and around it, its errors included.
    fn seen(&self, corners: &[[f32; 3]; 3]) -> (Self::Seen, FrameBox);
    /// Both triangles in the frame of the first.
    fn row(p: [[f32; 3]; 3], q: Self::Seen) -> Self::Row;
    /// Whether a plane of the two certainly parts them, in the whole step.
    fn are_apart(row: Self::Row, slack: f32) -> bool;
}

impl Related for Relation {
    type Seen = [[f32; 3]; 3];
    type Row = [[[f32; 3]; 3]; 2];

    #[inline(always)]
    fn bodies(&self) -> [u32; 2] {
        self.bodies
    }
    #[inline(always)]
    fn slack(&self) -> f32 {
        self.slack
    }
    #[inline(always)]
    fn first_in_both(&self, volume: &FrameBox) -> Both {
        self.of_first(volume)
    }
    #[inline(always)]
    fn second_in_both(&self, volume: &FrameBox) -> Both {
        self.of_second(volume)
    }
    #[inline(always)]
    fn seen(&self, corners: &[[f32; 3]; 3]) -> (Self::Seen, FrameBox) {
        self.triangle_to_first(corners)
    }
    #[inline(always)]
    fn row(p: [[f32; 3]; 3], q: Self::Seen) -> Self::Row {
        [p, q]
    }
    #[inline(always)]
    fn are_apart([p, q]: Self::Row, slack: f32) -> bool {
        let of = |t: [[f32; 3]; 3]| [Vec3(t[0]), Vec3(t[1]), Vec3(t[2])];
        planes::apart(&of(p), &of(q), slack)
    }
}

/// Around everything.
const EVERYTHING: FrameBox = FrameBox { lo: [f32::NEG_INFINITY; 3], hi: [f32::INFINITY; 3] };

/// `rows^T (p - q)`.
#[inline(always)]
fn into(rows: &[[f64; 3]; 3], p: &[f64; 3], q: &[f64; 3]) -> [f64; 3] {
    let d = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let one = |i: usize| rows[0][i] * d[0] + rows[1][i] * d[1] + rows[2][i] * d[2];
    [one(0), one(1), one(2)]
}

/// The sum of the sizes of coordinates.
#[inline(always)]
pub fn size([x, y, z]: &[f64; 3]) -> f64 {
    x.abs() + y.abs() + z.abs()
}

/// The box of three corners; exact.
#[inline(always)]
pub fn corners_box([p, q, r]: &[[f32; 3]; 3]) -> FrameBox {
    let one = |k: usize| (p[k].lesser(q[k]).lesser(r[k]), p[k].greater(q[k]).greater(r[k]));
    let (x, y, z) = (one(0), one(1), one(2));
    FrameBox { lo: [x.0, y.0, z.0], hi: [x.1, y.1, z.1] }
}

impl Relation {
    /// Two bodies at their places.
    #[inline(always)]
    pub fn of(bodies: [u32; 2], [a, b]: [&InstanceFrame; 2], [of_a, of_b]: [&MeshRecord; 2]) -> Relation {
        let shift = into(&a.rows, &b.origin, &a.origin);
        let back = into(&b.rows, &a.origin, &b.origin);
        let (one, two) = (size(&shift), size(&back));
        let reach = of_a.radius + of_b.radius + if one > two { one } else { two };
        // False for NaN.
        let has_frames = reach <= RELATIVE_LIMIT;
        if !has_frames {
            return Relation { bodies, slack: f32::INFINITY, ..Relation::zeroed() };
        }
        let entry = |i: usize, j: usize| {
            (a.rows[0][i] * b.rows[0][j] + a.rows[1][i] * b.rows[1][j] + a.rows[2][i] * b.rows[2][j]) as f32
        };
        let row = |i: usize| [entry(i, 0), entry(i, 1), entry(i, 2)];
        let slack = RELATIVE_SLACK * reach + RELATIVE_FAR * (a.far + b.far);
        Relation {
            bodies,
            turn: [row(0), row(1), row(2)],
            shift: [shift[0] as f32, shift[1] as f32, shift[2] as f32],
            back: [back[0] as f32, back[1] as f32, back[2] as f32],
            slack: round::up(slack) + f32::MIN_POSITIVE,
            plane_slack: 0.0,
            pad: 0,
        }
    }

    /// A vertex of the second in the frame of the first.
    #[inline(always)]
    pub fn to_first(&self, p: [f32; 3]) -> [f32; 3] {
        let one = |i: usize| {
            let row = &self.turn[i];
            row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + self.shift[i]
        };
        [one(0), one(1), one(2)]
    }

    /// A triangle of the second in the frame of the first, with the bits of [`Relation::to_first`], and
    /// around it, its errors included. In vectors of four.
    #[inline(always)]
    pub fn triangle_to_first(&self, corners: &[[f32; 3]; 3]) -> ([[f32; 3]; 3], FrameBox) {
        let column = |k: usize| [self.turn[0][k], self.turn[1][k], self.turn[2][k], 0.0];
        let (x, y, z) = (column(0), column(1), column(2));
        let shift = [self.shift[0], self.shift[1], self.shift[2], 0.0];
        let moved = |p: &[f32; 3]| {
            let mut at = [0.0; 4];
            for i in 0..4 {
                at[i] = x[i] * p[0] + y[i] * p[1] + z[i] * p[2] + shift[i];
            }
            at
        };
        let (p, q, r) = (moved(&corners[0]), moved(&corners[1]), moved(&corners[2]));
        let (mut lo, mut hi) = ([0.0; 4], [0.0; 4]);
        for i in 0..4 {
            lo[i] = p[i].lesser(q[i]).lesser(r[i]) - self.slack;
            hi[i] = p[i].greater(q[i]).greater(r[i]) + self.slack;
        }
        let three = |[x, y, z, _]: [f32; 4]| [x, y, z];
        let volume =
            if self.slack == f32::INFINITY { EVERYTHING } else { FrameBox { lo: three(lo), hi: three(hi) } };
        ([three(p), three(q), three(r)], volume)
    }

    /// A volume of the first in both frames.
    #[inline(always)]
    pub fn of_first(&self, volume: &FrameBox) -> Both {
        let column = |i: usize| [self.turn[0][i], self.turn[1][i], self.turn[2][i]];
        let turn = [column(0), column(1), column(2)];
        Both { first: *volume, second: self.image(&turn, &self.back, volume) }
    }

    /// A volume of the second in both frames.
    #[inline(always)]
    pub fn of_second(&self, volume: &FrameBox) -> Both {
        Both { first: self.image(&self.turn, &self.shift, volume), second: *volume }
    }

    /// Around a box of one body in the frame of the other.
    #[inline(always)]
    fn image(&self, turn: &[[f32; 3]; 3], shift: &[f32; 3], volume: &FrameBox) -> FrameBox {
        if self.slack == f32::INFINITY {
            return EVERYTHING;
        }
        let middle = |k: usize| 0.5 * volume.lo[k] + 0.5 * volume.hi[k];
        let c = [middle(0), middle(1), middle(2)];
        let half = |k: usize| {
            let (down, up) = (c[k] - volume.lo[k], volume.hi[k] - c[k]);
            if down > up { down } else { up }
        };
        let h = [half(0), half(1), half(2)];
        let mut image = EVERYTHING;
        for k in 0..3 {
            let row = &turn[k];
            let at = row[0] * c[0] + row[1] * c[1] + row[2] * c[2] + shift[k];
            let by = row[0].abs() * h[0] + row[1].abs() * h[1] + row[2].abs() * h[2] + self.slack;
            (image.lo[k], image.hi[k]) = (at - by, at + by);
        }
        image
    }
}
