//! How much volumes grow.

use bytemuck::{Pod, Zeroable};

/// Growth of every volume of a search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Growth {
    /// Half of the distance within which pairs are listed, rounded up; 0 for touching alone. Length.
    pub margin: f32,
    /// 1 if volumes also grow by the thickness of their vertices.
    pub is_thick: u32,
}
const _: () = assert!(size_of::<Growth>() == 8);

impl Growth {
    /// That of volumes without a thickness.
    pub const fn margin(margin: f32) -> Growth {
        Growth { margin, is_thick: 0 }
    }
    /// Whether volumes of this growth hold all that is within another.
    pub fn serves(self, other: Growth) -> bool {
        other.margin <= self.margin && other.is_thick <= self.is_thick
    }
    /// The least that serves both.
    pub fn or(self, other: Growth) -> Growth {
        Growth { margin: self.margin.max(other.margin), is_thick: self.is_thick | other.is_thick }
    }
}
