//! A body, as the caller describes it.

use crate::error::refused;
use crate::rows::{NearmissNumber, NearmissRows, items, text};
use nearmiss::mesh::Problem;
use nearmiss::scene::CollisionFilter;
use nearmiss::{Body, Error, Mesh};
use std::ffi::c_char;
use std::ptr::null;

/// What a body does from frame to frame.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissBodyKind {
    /// It stands where it was made: built once, costs nothing a frame, and is never tested against what is static too.
    NEARMISS_FIXED = 0,
    /// It moves as one, by poses.
    NEARMISS_RIGID = 1,
    /// Each vertex moves by itself.
    NEARMISS_DEFORMABLE = 2,
}

/// Whether a body is tested against itself. Deformable bodies are by default, rigid bodies if it is
/// on, static bodies never.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissSelfCollision {
    /// The default of its kind, also of a struct of zeros.
    NEARMISS_SELF_COLLISION_DEFAULT = 0,
    /// It is; refused for static bodies.
    NEARMISS_SELF_COLLISION_ON = 1,
    /// It is not.
    NEARMISS_SELF_COLLISION_OFF = 2,
}

/// A body to be added to a scene: its mesh, what it does, and which bodies it may meet. Begin with `nearmiss_body()`. All that it points to
/// is copied by the call that takes it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissBody {
    /// What messages call it, in UTF-8; NULL for "a body".
    pub name: *const c_char,
    /// A point a vertex, in memory of the host.
    pub positions: NearmissRows,
    /// Three indices of vertices a triangle, without gaps.
    pub triangles: *const u32,
    /// How many triangles, at least 1.
    pub triangle_count: usize,
    /// A `NearmissBodyKind`.
    pub kind: u32,
    /// A `NearmissSelfCollision`. Deformable bodies are tested against themselves by default, rigid
    /// bodies if it is on, static bodies never.
    pub self_collision: u32,
    /// Bodies of different environments never meet.
    pub environment: u32,
    /// Whether it is in every environment, and `environment` is 0: 0 or 1.
    pub everywhere: u32,
    /// Bits of the groups that it is in, at least one: two bodies meet if each is in a group that
    /// the other one's mask has.
    pub group: u32,
    /// Bits of the groups that it meets; 0 for a body that meets no other.
    pub mask: u32,
}

/// A deformable body without a mesh, in environment 0, that meets all others and itself.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_body() -> NearmissBody {
    let CollisionFilter { group, mask, .. } = CollisionFilter::default();
    NearmissBody {
        name: null(),
        positions: NearmissRows {
            data: null(),
            count: 0,
            stride: 0,
            number: NearmissNumber::NEARMISS_F32 as u32,
        },
        triangles: null(),
        triangle_count: 0,
        kind: NearmissBodyKind::NEARMISS_DEFORMABLE as u32,
        self_collision: NearmissSelfCollision::NEARMISS_SELF_COLLISION_DEFAULT as u32,
        environment: 0,
        everywhere: 0,
        group,
        mask,
    }
}

/// A flag of the caller.
pub(crate) fn flag(value: u32, what: &str) -> Result<bool, Error> {
    match value {
        0 => Ok(false),
        1 => Ok(true),
        other => Err(refused(format!("{other} for {what}"), "give 0 or 1")),
    }
}

impl NearmissBody {
    /// The library's body. Copies.
    ///
    /// # Safety
    /// Its pointers point to what the header says.
    pub(crate) unsafe fn body(&self) -> Result<Body, Error> {
        // SAFETY: the caller's promise, of all three.
        let (name, positions, corners) = unsafe {
            let name = text(self.name).unwrap_or_else(|| "a body".to_owned());
            let count = self.triangle_count.saturating_mul(3);
            let positions = self.positions.positions(&format!("positions of {name}"))?;
            (name, positions, items(self.triangles, count, "indices of triangles")?)
        };
        let make = match self.kind {
            0 => Body::fixed,
            1 => Body::rigid,
            2 => Body::deformable,
            other => {
                let advice = "choose NEARMISS_FIXED, NEARMISS_RIGID or NEARMISS_DEFORMABLE";
                return Err(refused(format!("a body of kind {other}"), advice));
            }
        };
        if self.triangle_count == 0 {
            return Err(Error::Input { file: name, problem: Problem::NoTriangles });
        }
        if self.group == 0 {
            let what = format!("group is 0: {name} is in no group and meets no other body");
            let advice = "begin with nearmiss_body(), which is in all groups; set mask to 0 for a body that meets no other";
            return Err(refused(what, advice));
        }
        let everywhere = flag(self.everywhere, "everywhere")?;
        if everywhere && self.environment != 0 {
            let what = format!("environment {} of {name}, which is in every one", self.environment);
            return Err(refused(what, "set environment or everywhere, not both"));
        }
        let meets = CollisionFilter {
            environment: (!everywhere).then_some(self.environment),
            group: self.group,
            mask: self.mask,
            self_collision: match self.self_collision {
                0 => None,
                1 => Some(true),
                2 => Some(false),
                other => {
                    let advice = "choose NEARMISS_SELF_COLLISION_DEFAULT, NEARMISS_SELF_COLLISION_ON or \
                                  NEARMISS_SELF_COLLISION_OFF";
                    return Err(refused(format!("{other} for self_collision"), advice));
                }
            },
        };
        nearmiss::memory::require("triangles", size_of_val(corners) as u64)?;
        let faces = corners.as_chunks::<3>().0.to_vec();
        let body = make(Mesh::new(name, positions, faces)?).with_filter(meets);
        body.check_filter()?;
        Ok(body)
    }
}
