//! The motion of a body in a step.

use crate::body::flag;
use crate::error::refused;
use crate::rows::{HostPoints, NearmissNumber, NearmissRows};
use nearmiss::Error;
use nearmiss::scene::{DeviceMotion, DevicePose, Motion, Pose, PoseStep};
use std::ptr::null;

/// Kinds of motions.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissMotionKind {
    /// A deformable body rests at `positions[0]`.
    NEARMISS_MOTION_POSITIONS = 0,
    /// A deformable body moves from `positions[0]` to `positions[1]`, each vertex in a straight
    /// line. Discrete, near and distance queries test it at `positions[0]`. It rests at
    /// `positions[1]` if the next update does not name it.
    NEARMISS_MOTION_STEP = 1,
    /// A rigid body rests in `poses[0]`.
    NEARMISS_MOTION_POSE = 2,
    /// A rigid body moves from `poses[0]` to `poses[1]`. It turns at a constant rate by the shorter
    /// arc, about `pivot`, which moves in a straight line. At exactly 180 degrees the axis is that
    /// with a positive first coordinate; if this is 0, a positive second or third one. If `straight`
    /// is 1, each vertex moves in a straight line, and the body is not rigid on the way.
    NEARMISS_MOTION_POSE_STEP = 3,
    /// A rigid body moves from `poses[0]`. It turns at a constant rate by the rotation vector `turn`
    /// about `pivot`, which moves by `travel` in a straight line.
    NEARMISS_MOTION_TURNING = 4,
}

/// A rigid motion of the points of a body's mesh: a rotation, then a translation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissPose {
    /// A unit quaternion: x, y, z, w. Its length may differ from 1 by up to 1.19e-4; it is
    /// normalised.
    pub rotation: [f64; 4],
    /// Added after the rotation, in the unit of the positions.
    pub translation: [f64; 3],
}

/// The motion of a body in a step, or its place at rest. Make it by `nearmiss_motion_positions`,
/// `_step`, `_pose`, `_pose_step` or `_turning`. Fields that `kind` does not read must be empty.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissMotion {
    /// The number of the body.
    pub body: u32,
    /// A `NearmissMotionKind`.
    pub kind: u32,
    /// 0: memory of the host, read by the call. 1: memory of the detector's device (on a CPU the
    /// host's), read there, after all earlier work of its stream. It must stay until the query is
    /// answered; of a prepared submission until the next update. A pose on the device is a row of
    /// three numbers in `positions` and a row of four in `rotations`.
    pub on_device: u32,
    /// 1: the vertices of a pose step go straight. 0: it turns. Poses on the device always turn.
    pub straight: u32,
    /// One row a vertex. For a pose on the device: its translation.
    pub positions: [NearmissRows; 2],
    /// For a pose on the device: its unit quaternion x, y, z, w.
    pub rotations: [NearmissRows; 2],
    /// Poses in memory of the host.
    pub poses: [NearmissPose; 2],
    /// The point about which the step turns, in the frame of the mesh: a centre of mass, a hinge.
    /// Zeros on the device: poses there turn about the origin of the mesh.
    pub pivot: [f64; 3],
    /// The rotation vector of a turning step, in the axes of the scene and in radians: angular
    /// velocity times the length of the step. At most a whole turn, 2 pi.
    pub turn: [f64; 3],
    /// How far the pivot of a turning step moves.
    pub travel: [f64; 3],
}

const NONE: NearmissRows =
    NearmissRows { data: null(), count: 0, stride: 0, number: NearmissNumber::NEARMISS_F32 as u32 };

pub(crate) const UNMOVED: NearmissPose =
    NearmissPose { rotation: [0.0, 0.0, 0.0, 1.0], translation: [0.0; 3] };

fn motion(body: u32, kind: NearmissMotionKind) -> NearmissMotion {
    NearmissMotion {
        body,
        kind: kind as u32,
        on_device: 0,
        straight: 0,
        positions: [NONE; 2],
        rotations: [NONE; 2],
        poses: [UNMOVED; 2],
        pivot: [0.0; 3],
        turn: [0.0; 3],
        travel: [0.0; 3],
    }
}

/// A deformable body at rest. If the positions are in memory of the device, set `on_device` then.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_motion_positions(body: u32, positions: NearmissRows) -> NearmissMotion {
    let kind = NearmissMotionKind::NEARMISS_MOTION_POSITIONS;
    NearmissMotion { positions: [positions, NONE], ..motion(body, kind) }
}

/// A deformable body that moves, each vertex in a straight line. If the positions are in memory of
/// the device, set `on_device` then.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_motion_step(body: u32, start: NearmissRows, end: NearmissRows) -> NearmissMotion {
    let kind = NearmissMotionKind::NEARMISS_MOTION_STEP;
    NearmissMotion { positions: [start, end], ..motion(body, kind) }
}

/// A rigid body at rest.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_motion_pose(body: u32, pose: NearmissPose) -> NearmissMotion {
    let kind = NearmissMotionKind::NEARMISS_MOTION_POSE;
    NearmissMotion { poses: [pose, UNMOVED], ..motion(body, kind) }
}

/// A rigid body that moves from one pose to another. It turns by the shorter arc about the origin of
/// its mesh. Set `pivot` for another point, or `straight` for straight lines.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_motion_pose_step(
    body: u32,
    start: NearmissPose,
    end: NearmissPose,
) -> NearmissMotion {
    let kind = NearmissMotionKind::NEARMISS_MOTION_POSE_STEP;
    NearmissMotion { poses: [start, end], ..motion(body, kind) }
}

/// A rigid body that begins in a pose and turns by a rotation vector. Set `turn` then, and `travel`
/// and `pivot` unless they are 0. Turns of more than 180 degrees need it: two poses cannot give
/// them.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_motion_turning(body: u32, start: NearmissPose) -> NearmissMotion {
    let kind = NearmissMotionKind::NEARMISS_MOTION_TURNING;
    NearmissMotion { poses: [start, UNMOVED], ..motion(body, kind) }
}

impl From<NearmissPose> for Pose {
    fn from(NearmissPose { rotation, translation }: NearmissPose) -> Pose {
        Pose { rotation, translation }
    }
}

/// A motion as the library takes it, with copies of rows that have gaps.
pub(crate) enum HostMotion<'a> {
    Positions(HostPoints<'a>),
    Step([HostPoints<'a>; 2]),
    Other(Motion<'static>),
}

impl HostMotion<'_> {
    pub(crate) fn motion(&self) -> Motion<'_> {
        match self {
            HostMotion::Positions(positions) => Motion::positions(positions.points()),
            HostMotion::Step([start, end]) => Motion::step(start.points(), end.points()),
            HostMotion::Other(motion) => *motion,
        }
    }
}

impl NearmissMotion {
    fn no_such_kind(&self) -> Error {
        refused(
            format!("kind of the motion of body {} is unknown, got {}", self.body, self.kind),
            "choose a NearmissMotionKind, such as NEARMISS_MOTION_STEP",
        )
    }

    /// Refuses rows that `kind` does not read.
    fn check_idle(&self) -> Result<(), Error> {
        let on_device = flag(self.on_device, "on_device")?;
        let (positions, rotations) = match (self.kind, on_device) {
            (0, _) => (1, 0),
            (1, _) => (2, 0),
            (2, true) => (1, 1),
            (3, true) => (2, 2),
            (2..=4, false) => (0, 0),
            (4, true) => {
                let what = format!("poses of body {} are on the device, and its step has a turn", self.body);
                return Err(refused(what, "give two poses on the device, or a turn in memory of the host"));
            }
            _ => return Err(self.no_such_kind()),
        };
        self.check_path(on_device)?;
        for (name, rows, read) in
            [("positions", &self.positions, positions), ("rotations", &self.rotations, rotations)]
        {
            if let Some(end) = (read..2).find(|&end| !rows[end].data.is_null() || rows[end].count > 0) {
                let what = format!(
                    "{name}[{end}] of body {} is not read by a motion of kind {}",
                    self.body, self.kind
                );
                return Err(refused(what, "choose the kind that reads it, or leave it empty"));
            }
        }
        Ok(())
    }

    /// Refuses a path that `kind` does not read, or that poses on the device do not have.
    fn check_path(&self, on_device: bool) -> Result<(), Error> {
        let is_straight = flag(self.straight, "straight")?;
        let is_step = self.kind == 3 && !on_device;
        let is_turning = self.kind == 4;
        let is_given = |numbers: &[f64; 3]| *numbers != [0.0; 3];
        // One pose for a pose or a turn, two for a step, none for positions and on a device.
        let read = match self.kind {
            2 | 4 if !on_device => 1,
            3 if !on_device => 2,
            _ => 0,
        };
        let unread = [
            ("poses", self.poses[read..].iter().any(|pose| *pose != UNMOVED)),
            ("straight", is_straight && !is_step),
            ("pivot", is_given(&self.pivot) && !(is_step && !is_straight || is_turning)),
            ("turn", is_given(&self.turn) && !is_turning),
            ("travel", is_given(&self.travel) && !is_turning),
        ];
        let Some((name, _)) = unread.into_iter().find(|(_, is_unread)| *is_unread) else { return Ok(()) };
        let motion = match (on_device, is_straight) {
            (true, _) => "poses in memory of the device",
            (_, true) if self.kind == 3 => "a straight step",
            _ => "this kind of motion",
        };
        let what = format!("{name} of body {} is not read by {motion}, kind {}", self.body, self.kind);
        Err(refused(what, "set it to 0, or choose the kind that reads it"))
    }

    /// The step between two poses.
    fn step(&self) -> PoseStep {
        let [start, end] = self.poses.map(Pose::from);
        let step = PoseStep::new(start, end);
        if self.straight == 1 { step.straight() } else { step.about(self.pivot) }
    }

    /// The library's motion, in memory of the host or of the device.
    ///
    /// # Safety
    /// Memory that `kind` names exists and is not written, as long as the header says.
    pub(crate) unsafe fn host_motion<'a>(&self) -> Result<HostMotion<'a>, Error> {
        self.check_idle()?;
        if flag(self.on_device, "on_device")? {
            // SAFETY: the caller's promise.
            return Ok(HostMotion::Other(Motion::OnDevice(unsafe { self.device_motion() }?)));
        }
        let name = format!("positions of body {}", self.body);
        // SAFETY: the caller's promise.
        let points = |end: usize| unsafe { self.positions[end].points(&name) };
        Ok(match self.kind {
            0 => HostMotion::Positions(points(0)?),
            1 => HostMotion::Step([points(0)?, points(1)?]),
            2 => HostMotion::Other(Motion::Pose(self.poses[0].into())),
            3 => HostMotion::Other(Motion::PoseStep(self.step())),
            4 => {
                let turning = PoseStep::turning(self.poses[0], self.turn, self.travel);
                HostMotion::Other(Motion::PoseStep(turning.about(self.pivot)))
            }
            _ => return Err(self.no_such_kind()),
        })
    }

    /// The motion in memory of the device.
    ///
    /// # Safety
    /// As of [`NearmissMotion::host_motion`].
    pub(crate) unsafe fn device_motion(&self) -> Result<DeviceMotion, Error> {
        if !flag(self.on_device, "on_device")? {
            let what = format!("motion of body {} is in memory of the host", self.body);
            return Err(refused(what, "prepare motions in memory of the device, and set on_device to 1"));
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
