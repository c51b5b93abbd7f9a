//! Scenes: bodies, their kinds, and the filters that decide which of them may meet.
//!
//! A [`Scene`] is made on the host, once. A [`Detector`](crate::Detector) puts it on a device and
//! queries it frame after frame.

mod body;
mod device_motion;
mod exclusions;
mod left_out;
mod matrix;
mod motion;
mod names;
mod place;
mod pose;
mod pose_step;
pub(crate) mod poses;
mod sides;
mod thickness;

pub use body::Body;
pub use device_motion::{DeviceMotion, DevicePose, DeviceRows, Number};
pub(crate) use exclusions::Excluded;
pub use exclusions::{Exclusions, RestShape};
pub use motion::Motion;
pub(crate) use place::{Bounds, NOTHING, union};
pub use pose::Pose;
pub use pose_step::{PosePath, PoseStep};
pub use poses::Poses;
#[doc(hidden)]
pub use sides::{mean_side, of_edges, of_mean_side};
pub use thickness::Thickness;

use std::fmt;

/// Number of a body in a scene; it stays with the body until that is removed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(transparent))]
#[repr(transparent)]
pub struct BodyId(pub(crate) u32);

impl BodyId {
    /// Index of the body. Bodies of a new scene are counted from 0, in the order in which they were
    /// added.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl fmt::Display for BodyId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// Motion of a body from frame to frame. A scene costs only the motions of its bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum BodyKind {
    /// It never moves. Its tree is built and fitted once, and it is never tested against fixed
    /// bodies.
    Fixed,
    /// It moves as a whole: 7 numbers for a frame or an end of a step, applied on the device.
    Rigid,
    /// Each vertex moves by itself.
    #[default]
    Deformable,
}

/// Bodies that a body may meet: see [`Body::with_filter`].
///
/// Two bodies are tested against each other if environments and groups allow it. Environments allow
/// it if they are equal or one is `None`. Groups allow it if each body is in a group that the
/// other's mask has. Deformable bodies are tested against themselves by default, rigid bodies if
/// `self_collision` is true, fixed bodies never. [`Scene::leave_out`] leaves out pairs by a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CollisionFilter {
    /// Environment; `None` for a body that is in every one. Bodies of different environments never
    /// meet.
    pub environment: Option<u32>,
    /// Bits of the groups that the body is in.
    pub group: u32,
    /// Bits of the groups that the body meets.
    pub mask: u32,
    /// Whether the body is tested against itself; `None` for the default of its kind: see
    /// [`CollisionFilter::self_collides`].
    pub self_collision: Option<bool>,
}

impl CollisionFilter {
    /// All other bodies, and the body itself.
    pub fn with_self_collision() -> CollisionFilter {
        CollisionFilter { self_collision: Some(true), ..CollisionFilter::default() }
    }

    /// All other bodies, not the body itself.
    pub fn without_self_collision() -> CollisionFilter {
        CollisionFilter { self_collision: Some(false), ..CollisionFilter::default() }
    }

    /// All other bodies of an environment.
    pub fn in_environment(environment: u32) -> CollisionFilter {
        CollisionFilter { environment: Some(environment), ..CollisionFilter::default() }
    }

    /// Whether environments and groups allow two different bodies to meet.
    pub fn allows(&self, other: &CollisionFilter) -> bool {
        let is_everywhere = self.environment.is_none() || other.environment.is_none();
        let is_together = is_everywhere || self.environment == other.environment;
        is_together && self.group & other.mask != 0 && other.group & self.mask != 0
    }

    /// Whether a body of this kind is tested against itself. Deformable bodies are by default,
    /// rigid bodies if `self_collision` is true, fixed bodies never.
    pub fn self_collides(&self, kind: BodyKind) -> bool {
        match kind {
            BodyKind::Fixed => false,
            BodyKind::Rigid => self.self_collision == Some(true),
            BodyKind::Deformable => self.self_collision != Some(false),
        }
    }
}

impl Default for CollisionFilter {
    /// All other bodies in environment 0; the body itself if it is deformable.
    fn default() -> CollisionFilter {
        CollisionFilter { environment: Some(0), group: u32::MAX, mask: u32::MAX, self_collision: None }
    }
}

/// Bodies, by number.
///
/// ```
/// use nearmiss::scene::Scene;
/// use nearmiss::{Body, Mesh, mesh::Positions};
///
/// let triangle = |z: f32| {
///     let corners = vec![[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
///     Mesh::new("a triangle", Positions::F32(corners), vec![[0, 1, 2]])
/// };
/// let mut scene = Scene::new();
/// let cloth = scene.add(Body::deformable(triangle(1.0)?));
/// let ball = scene.add(Body::rigid(triangle(0.5)?));
/// let ground = scene.add(Body::fixed(triangle(0.0)?));
/// assert_eq!([cloth, ball, ground].map(|body| body.index()), [0, 1, 2]);
/// # Ok::<(), nearmiss::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Scene {
    bodies: Vec<Body>,
    /// Whether the body of each number was removed.
    removed: Vec<bool>,
    /// Numbers of removed bodies.
    free: Vec<u32>,
    /// Pairs of bodies that are left out: the smaller number first, ascending.
    pub(crate) left_out: Vec<[BodyId; 2]>,
    /// Pairs of features that are left out.
    pub(crate) excluded: Excluded,
}

impl Scene {
    /// A scene without bodies.
    pub fn new() -> Scene {
        Scene::default()
    }

    /// Adds a body, under the number of a removed one if there is one.
    pub fn add(&mut self, body: Body) -> BodyId {
        match self.free.pop() {
            Some(id) => {
                self.bodies[id as usize] = body;
                self.removed[id as usize] = false;
                BodyId(id)
            }
            None => {
                self.bodies.push(body);
                self.removed.push(false);
                BodyId(self.bodies.len() as u32 - 1)
            }
        }
    }

    /// Removes a body, its pairs in the list of those that are left out, and its exclusions. `None` if there is
    /// none of that number.
    pub fn remove(&mut self, id: BodyId) -> Option<Body> {
        self.get(id)?;
        self.free.push(id.0);
        self.forget_pairs(id);
        self.excluded.forget(id);
        self.removed[id.index()] = true;
        Some(std::mem::replace(&mut self.bodies[id.index()], Body::none()))
    }

    /// Body of a number; `None` if it was removed or never existed.
    pub fn get(&self, id: BodyId) -> Option<&Body> {
        self.bodies.get(id.index()).filter(|_| !self.removed[id.index()])
    }

    /// Body of a number, to be changed.
    pub(crate) fn get_mut(&mut self, id: BodyId) -> Option<&mut Body> {
        self.bodies.get_mut(id.index()).filter(|_| !self.removed[id.index()])
    }

    /// Number of the body at an index; `None` if it was removed or never existed.
    pub fn id(&self, index: usize) -> Option<BodyId> {
        let id = BodyId(u32::try_from(index).ok()?);
        self.get(id).map(|_| id)
    }

    /// All bodies by number; removed ones have no vertices.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    pub(crate) fn bodies_mut(&mut self) -> &mut [Body] {
        &mut self.bodies
    }

    /// Numbers of all bodies, ascending.
    pub fn ids(&self) -> impl Iterator<Item = BodyId> + '_ {
        (0..self.bodies.len() as u32).map(BodyId).filter(|id| !self.removed[id.index()])
    }
}

impl From<Vec<Body>> for Scene {
    /// Numbers bodies in their order.
    fn from(bodies: Vec<Body>) -> Scene {
        Scene { removed: vec![false; bodies.len()], bodies, ..Scene::default() }
    }
}

impl From<Body> for Scene {
    /// A scene of one body.
    fn from(body: Body) -> Scene {
        Scene::from(vec![body])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::soup;

    #[test]
    fn numbers_stay_with_their_bodies() {
        let mut scene = Scene::new();
        let [a, b, c] = [1, 2, 3].map(|seed| scene.add(soup(3, seed, false)));
        assert_eq!(scene.ids().collect::<Vec<_>>(), [a, b, c]);
        assert!(scene.remove(b).is_some() && scene.remove(b).is_none() && scene.get(b).is_none());
        assert_eq!(scene.ids().collect::<Vec<_>>(), [a, c]);
        assert_eq!((scene.bodies().len(), scene.bodies()[1].vertex_count()), (3, 0));
        assert_eq!(scene.add(soup(4, 4, false)), b);
        assert_eq!(scene.get(b).map(Body::face_count), Some(4));
        assert!(scene.get(BodyId(9)).is_none() && scene.remove(BodyId(9)).is_none());
        assert_eq!([0, 9, usize::MAX].map(|index| scene.id(index)), [Some(a), None, None]);
    }

    #[test]
    fn self_contact_is_the_default_of_deformable_bodies_alone_and_among_others() {
        let mesh = || soup(3, 1, false).frames().remove(0);
        let kinds = [Body::deformable(mesh()), Body::rigid(mesh()), Body::fixed(mesh())];
        for (filter, own) in [
            (CollisionFilter::default(), [true, false, false]),
            (CollisionFilter::in_environment(7), [true, false, false]),
            (CollisionFilter::with_self_collision(), [true, true, false]),
            (CollisionFilter::without_self_collision(), [false; 3]),
        ] {
            let of = |scene: Scene| scene.bodies().iter().map(Body::self_collides).collect::<Vec<_>>();
            let bodies = kinds.clone().map(|body| body.with_filter(filter));
            assert_eq!(of(bodies.to_vec().into()), own, "{filter:?}");
            for (body, own) in bodies.into_iter().zip(own) {
                assert_eq!(of(body.into()), [own], "alone, {filter:?}");
            }
        }
    }

    #[test]
    fn self_collision_of_a_fixed_body_is_refused_by_name() {
        let body = |filter| Body::fixed(soup(3, 1, false).frames().remove(0)).with_filter(filter);
        let text = body(CollisionFilter::with_self_collision()).validate().expect_err("refused").to_string();
        assert!(text.contains("self-collision of") && text.contains("fixed"), "{text}");
        assert!(
            body(CollisionFilter::without_self_collision()).validate().is_ok()
                && body(CollisionFilter::default()).validate().is_ok()
        );
    }
}
