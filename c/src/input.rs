//! Where a body is at a frame.

use crate::body::flag;
use crate::error::refused;
use crate::rows::{NearmissNumber, NearmissRows};
use nearmiss::Error;
use nearmiss::mesh::Positions;
use nearmiss::scene::{BodyId, DeviceMotion, DevicePose, Motion, Pose};
use std::ptr::null;

/// What an input says.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissInputKind {
    /// A deformable body stands at `positions[0]`.
    NEARMISS_AT = 0,
    /// A deformable body moves from `positions[0]` to `positions[1]`, each vertex in a straight
    /// line. Discrete, near and distance queries test it at `positions[0]`; it rests at
    /// `positions[1]` if the next frame does not name it. So of poses.
    NEARMISS_STEP = 1,
    /// A rigid body stands in `poses[0]`.
    NEARMISS_POSE = 2,
    /// A rigid body moves from `poses[0]` to `poses[1]`, each vertex in a straight line: give steps in which it turns little.
    NEARMISS_POSES = 3,
}

/// A rigid motion of the points of a body's mesh: turned first, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissPose {
    /// A unit quaternion: x, y, z, w. It may be off unit length by up to 1.2e-4 (2^-13) and is
    /// normalised.
    pub rotation: [f64; 4],
    /// What is added, in the unit of the positions.
    pub translation: [f64; 3],
}

/// Where a body is at a frame, or at the two ends of a step. Of its parts those are read that `kind` names.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissInput {
    /// The number of the body.
    pub body: u32,
    /// A `NearmissInputKind`.
    pub kind: u32,
    /// 0: all is in memory of the host, and copied. 1: it is in memory of the detector's device (on a CPU the host's), is read there,
    /// behind all that is on its stream, and must stay until the frame is answered; of a prepared frame until the next input. Poses are then
    /// a row of three numbers in `positions` and a row of four in `rotations`.
    pub on_device: u32,
    /// A row a vertex; of a pose on the device its translation.
    pub positions: [NearmissRows; 2],
    /// Of a pose on the device: a unit quaternion x, y, z, w, off unit length by at most 1.2e-4.
    pub rotations: [NearmissRows; 2],
    /// Of a rigid body whose poses the host has.
    pub poses: [NearmissPose; 2],
}

const NONE: NearmissRows =
    NearmissRows { data: null(), count: 0, stride: 0, number: NearmissNumber::NEARMISS_F32 as u32 };

const UNMOVED: NearmissPose = NearmissPose { rotation: [0.0, 0.0, 0.0, 1.0], translation: [0.0; 3] };

fn input(body: u32, kind: NearmissInputKind) -> NearmissInput {
    let (positions, rotations, poses) = ([NONE; 2], [NONE; 2], [UNMOVED; 2]);
    NearmissInput { body, kind: kind as u32, on_device: 0, positions, rotations, poses }
}

/// A deformable body stands there. For memory of the device set `on_device` then.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_at(body: u32, positions: NearmissRows) -> NearmissInput {
    NearmissInput { positions: [positions, NONE], ..input(body, NearmissInputKind::NEARMISS_AT) }
}

/// A deformable body moves from here to there. For memory of the device set `on_device` then.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_step(body: u32, from: NearmissRows, to: NearmissRows) -> NearmissInput {
    NearmissInput { positions: [from, to], ..input(body, NearmissInputKind::NEARMISS_STEP) }
}

/// A rigid body stands in that pose.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_pose(body: u32, pose: NearmissPose) -> NearmissInput {
    NearmissInput { poses: [pose, UNMOVED], ..input(body, NearmissInputKind::NEARMISS_POSE) }
}

/// A rigid body moves from one pose to another.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_poses(body: u32, from: NearmissPose, to: NearmissPose) -> NearmissInput {
    NearmissInput { poses: [from, to], ..input(body, NearmissInputKind::NEARMISS_POSES) }
}

impl From<NearmissPose> for Pose {
    fn from(NearmissPose { rotation, translation }: NearmissPose) -> Pose {
        Pose { rotation, translation }
    }
}

/// An input with its own copy of what the host has.
pub(crate) enum Held {
    At(Positions),
    Step([Positions; 2]),
    Other(Motion<'static>),
}

impl Held {
    pub(crate) fn input(&self) -> Motion<'_> {
        match self {
            Held::At(positions) => Motion::positions(positions),
            Held::Step([from, to]) => Motion::step(from, to),
            Held::Other(input) => *input,
        }
    }
}

/// The body of a number.
pub(crate) fn body(ids: &[BodyId], number: u32) -> Result<BodyId, Error> {
    ids.get(number as usize).copied().ok_or_else(|| {
        let advice = "name a body by what adding it gave, until it is removed";
        refused(format!("there is no body {number} in the scene"), advice)
    })
}

impl NearmissInput {
    fn no_such_kind(&self) -> Error {
        let advice = "choose NEARMISS_AT, NEARMISS_STEP, NEARMISS_POSE or NEARMISS_POSES";
        refused(format!("an input of kind {}", self.kind), advice)
    }

    /// Refuses rows that `kind` does not read.
    fn check_idle(&self) -> Result<(), Error> {
        let on_device = flag(self.on_device, "on_device")?;
        let (positions, rotations) = match (self.kind, on_device) {
            (0, _) => (1, 0),
            (1, _) => (2, 0),
            (2, true) => (1, 1),
            (3, true) => (2, 2),
            (2 | 3, false) => (0, 0),
            _ => return Err(self.no_such_kind()),
        };
        for (name, rows, read) in
            [("positions", &self.positions, positions), ("rotations", &self.rotations, rotations)]
        {
            if let Some(end) = (read..2).find(|&end| !rows[end].data.is_null() || rows[end].count > 0) {
                let what = format!(
                    "{name}[{end}] of body {}, which an input of kind {} does not read",
                    self.body, self.kind
                );
                return Err(refused(what, "choose the kind that reads it, or leave it empty"));
            }
        }
        Ok(())
    }

    /// The library's input, wherever it lies.
    ///
    /// # Safety
    /// What `kind` names is there, and stays as long as the header says.
    pub(crate) unsafe fn held(&self) -> Result<Held, Error> {
        self.check_idle()?;
        if flag(self.on_device, "on_device")? {
            // SAFETY: the caller's promise.
            return Ok(Held::Other(Motion::OnDevice(unsafe { self.on_device() }?)));
        }
        let what = || format!("positions of body {}", self.body);
        // SAFETY: the caller's promise.
        let at = |end: usize| unsafe { self.positions[end].positions(&what()) };
        Ok(match self.kind {
            0 => Held::At(at(0)?),
            1 => Held::Step([at(0)?, at(1)?]),
            2 => Held::Other(Motion::Pose(self.poses[0].into())),
            3 => Held::Other(Motion::PoseStep(self.poses.map(Pose::from))),
            _ => return Err(self.no_such_kind()),
        })
    }

    /// What lies in the device's memory.
    ///
    /// # Safety
    /// As there.
    pub(crate) unsafe fn on_device(&self) -> Result<DeviceMotion, Error> {
        if !flag(self.on_device, "on_device")? {
            let what = format!("memory of the host for body {}", self.body);
            return Err(refused(what, "prepare frames with what lies on the device, and set `on_device`"));
        }
        self.check_idle()?;
        let rows = |rows: &NearmissRows, width| {
            // SAFETY: the caller's promise.
            unsafe { rows.on_device(&format!("rows of body {}", self.body), width) }
        };
        let at = |end: usize| rows(&self.positions[end], 3);
        let pose = |end: usize| {
            Ok::<_, Error>(DevicePose { translation: at(end)?, rotation: rows(&self.rotations[end], 4)? })
        };
        Ok(match self.kind {
            0 => DeviceMotion::Positions(at(0)?),
            1 => DeviceMotion::Step([at(0)?, at(1)?]),
            2 => DeviceMotion::Pose(pose(0)?),
            3 => DeviceMotion::PoseStep([pose(0)?, pose(1)?]),
            _ => return Err(self.no_such_kind()),
        })
    }
}
