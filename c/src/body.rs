//! A body, as the caller describes it.

use crate::error::refused;
use crate::motion::{NearmissPose, UNMOVED};
use crate::rows::{NearmissNumber, NearmissRows, items, text};
use nearmiss::mesh::Problem;
use nearmiss::scene::{CollisionFilter, Pose};
use nearmiss::{Body, Error, Mesh, Thickness};
use std::ffi::c_char;
use std::ptr::null;

/// Kinds of bodies.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissBodyKind {
    /// It never moves. It is built once, costs nothing in later steps, and is not tested against
    /// other fixed bodies.
    NEARMISS_BODY_FIXED = 0,
    /// It moves by poses.
    NEARMISS_BODY_RIGID = 1,
    /// Each vertex moves by itself.
    NEARMISS_BODY_DEFORMABLE = 2,
}

/// Whether a body is tested against itself.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissSelfCollision {
    /// Deformable bodies are, rigid and fixed bodies are not. A struct of zeros has this.
    NEARMISS_SELF_COLLISION_DEFAULT = 0,
    /// It is. Refused for fixed bodies.
    NEARMISS_SELF_COLLISION_ON = 1,
    /// It is not.
    NEARMISS_SELF_COLLISION_OFF = 2,
}

/// A body to add to a scene: mesh, kind, and collision filter. Begin with `nearmiss_body()`. Calls
/// copy everything that it points to.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissBody {
    /// The name in messages, in UTF-8. NULL: "a body".
    pub name: *const c_char,
    /// One point a vertex, in memory of the host.
    pub positions: NearmissRows,
    /// Three indices of vertices a triangle, without gaps.
    pub triangles: *const u32,
    /// Number of triangles. A body needs a triangle, an edge or a point.
    pub triangle_count: usize,
    /// A `NearmissBodyKind`.
    pub kind: u32,
    /// A `NearmissSelfCollision`.
    pub self_collision: u32,
    /// Bodies of different environments do not collide.
    pub environment: u32,
    /// 1: the body is in every environment, and `environment` must be 0. 0: only in `environment`.
    pub everywhere: u32,
    /// Bits of the groups of the body, at least one. Two bodies collide if each is in a group of
    /// the other's mask.
    pub group: u32,
    /// Bits of the groups that it collides with. 0: it collides with no other body.
    pub mask: u32,
    /// The pose of a rigid body at the start.
    pub pose: NearmissPose,
    /// Thickness: radii around the surface that belong to the body, lengths of at least 0. Near
    /// queries and queries in motion add those of both bodies to their distance. All others ignore
    /// them.
    pub radii: *const f64,
    /// How many radii there are: 0 for none, 1 for all vertices, or one for each.
    pub radius_count: usize,
    /// Two indices of vertices an edge, without gaps. Edges of no triangle take part by themselves.
    /// They also number the edges of answers: those of triangles that are not listed come behind.
    pub edges: *const u32,
    /// Number of edges.
    pub edge_count: usize,
    /// Vertices of no triangle and no edge that take part by themselves.
    pub points: *const u32,
    /// Number of points.
    pub point_count: usize,
}

/// A deformable body without a mesh, in environment 0, that collides with all others and itself.
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
        kind: NearmissBodyKind::NEARMISS_BODY_DEFORMABLE as u32,
        self_collision: NearmissSelfCollision::NEARMISS_SELF_COLLISION_DEFAULT as u32,
        environment: 0,
        everywhere: 0,
        group,
        mask,
        pose: UNMOVED,
        radii: null(),
        radius_count: 0,
        edges: null(),
        edge_count: 0,
        points: null(),
        point_count: 0,
    }
}

/// A thickness of so many radii.
pub(crate) fn thickness(radii: &[f64]) -> Result<Thickness, Error> {
    nearmiss::memory::require("radii", size_of_val(radii) as u64)?;
    Ok(match radii {
        [] => Thickness::default(),
        [one] => Thickness::Same(*one),
        each => Thickness::Each(each.to_vec()),
    })
}

/// A flag of the caller.
pub(crate) fn flag(value: u32, name: &str) -> Result<bool, Error> {
    match value {
        0 => Ok(false),
        1 => Ok(true),
        other => Err(refused(format!("{name} is no flag, got {other}"), "set it to 0 or 1")),
    }
}

impl NearmissBody {
    /// The library's body. Copies.
    ///
    /// # Safety
    /// Its pointers point to what the header says.
    pub(crate) unsafe fn body(&self) -> Result<Body, Error> {
        // SAFETY: the caller's promise, of all six.
        let (name, positions, corners, radii, edges, points) = unsafe {
            let name = text(self.name).unwrap_or_else(|| "a body".to_owned());
            let positions = self.positions.points(&format!("positions of {name}"))?;
            let corners: &[[u32; 3]] =
                items(self.triangles.cast(), self.triangle_count, &format!("triangles of {name}"))?;
            let radii = items(self.radii, self.radius_count, &format!("radii of {name}"))?;
            let edges: &[[u32; 2]] = items(self.edges.cast(), self.edge_count, &format!("edges of {name}"))?;
            let points = items(self.points, self.point_count, &format!("points of {name}"))?;
            (name, positions, corners, radii, edges, points)
        };
        let make = match self.kind {
            0 => Body::fixed,
            1 => Body::rigid,
            2 => Body::deformable,
            other => {
                return Err(refused(
                    format!("kind of {name} is unknown, got {other}"),
                    "choose NEARMISS_BODY_FIXED, NEARMISS_BODY_RIGID or NEARMISS_BODY_DEFORMABLE",
                ));
            }
        };
        if self.triangle_count == 0 && self.edge_count == 0 && self.point_count == 0 {
            return Err(Error::Input { file: name, problem: Problem::NoElements });
        }
        let is_rigid = self.kind == NearmissBodyKind::NEARMISS_BODY_RIGID as u32;
        if !is_rigid && self.pose != UNMOVED {
            return Err(refused(
                format!("pose of {name} is set, which is not rigid"),
                "make it NEARMISS_BODY_RIGID, or keep the pose of nearmiss_body()",
            ));
        }
        let filter = self.filter(&name)?;
        let bytes = size_of_val(corners) + size_of_val(edges) + size_of_val(points);
        nearmiss::memory::require("triangles, edges and points", bytes as u64)?;
        let mesh = Mesh::new(name, positions.positions()?, corners.to_vec())?;
        let mesh = mesh.with_edges(edges.to_vec())?.with_points(points.to_vec())?;
        let body = make(mesh).with_filter(filter);
        let body = body.with_thickness(thickness(radii)?);
        body.validate()?;
        if is_rigid { body.at(Pose::from(self.pose)) } else { Ok(body) }
    }

    fn filter(&self, name: &str) -> Result<CollisionFilter, Error> {
        if self.group == 0 {
            let advice = "begin with nearmiss_body(), which is in all groups; \
                          set mask to 0 for a body that collides with no other";
            return Err(refused(format!("group of {name} is 0: it is in no group"), advice));
        }
        let everywhere = flag(self.everywhere, "everywhere")?;
        if everywhere && self.environment != 0 {
            let what = format!("environment of {name} is {}, and everywhere is 1", self.environment);
            return Err(refused(what, "set one of them to 0"));
        }
        let self_collision = match self.self_collision {
            0 => None,
            1 => Some(true),
            2 => Some(false),
            other => {
                return Err(refused(
                    format!("self_collision of {name} is unknown, got {other}"),
                    "choose a NearmissSelfCollision, such as NEARMISS_SELF_COLLISION_ON",
                ));
            }
        };
        Ok(CollisionFilter {
            environment: (!everywhere).then_some(self.environment),
            group: self.group,
            mask: self.mask,
            self_collision,
        })
    }
}
