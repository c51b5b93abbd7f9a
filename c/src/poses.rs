//! Poses of bodies: many at once, and back.

use crate::body::flag;
use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given, refused};
use crate::motion::NearmissPose;
use crate::rows::{HostPoints, NearmissRows, items};
use nearmiss::Error;
use nearmiss::mesh::{Points, Positions};
use nearmiss::scene::{Body, BodyId, BodyKind, Pose, Poses};
use std::mem::MaybeUninit;

/// Poses of many bodies, one row a body. Begin with `nearmiss_pose_rows()`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissPoseRows {
    /// Translations, three numbers a row.
    pub positions: NearmissRows,
    /// Unit quaternions x, y, z, w, four numbers a row.
    pub quaternions: NearmissRows,
    /// 0: memory of the host. 1: memory of the detector's device; see `NearmissMotion`.
    pub on_device: u32,
}

/// Poses of many bodies in memory of the host. If they are in memory of the device, set `on_device`
/// then.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_pose_rows(positions: NearmissRows, quaternions: NearmissRows) -> NearmissPoseRows {
    NearmissPoseRows { positions, quaternions, on_device: 0 }
}

/// Poses in memory of the host, in doubles.
struct HostPoses {
    positions: Vec<[f64; 3]>,
    quaternions: Vec<[f64; 4]>,
}

impl NearmissPoseRows {
    /// Copies poses in memory of the host; `None` on the device.
    ///
    /// # Safety
    /// The rows are there.
    unsafe fn host(&self) -> Result<Option<HostPoses>, Error> {
        if flag(self.on_device, "on_device")? {
            return Ok(None);
        }
        // SAFETY: the caller's promise.
        let positions = match unsafe { self.positions.points("positions of poses") }? {
            HostPoints::Borrowed(Points::F64(points)) => points.to_vec(),
            HostPoints::Borrowed(Points::F32(points)) => Positions::F32(points.to_vec()).to_f64(),
            HostPoints::Copied(points) => points.to_f64(),
        };
        // SAFETY: the caller's promise.
        let quaternions = unsafe { self.quaternions.quaternions("quaternions of poses") }?;
        Ok(Some(HostPoses { positions, quaternions }))
    }

    /// The poses as the library takes them; `copied` is what [`NearmissPoseRows::host`] returned.
    ///
    /// # Safety
    /// The rows are there, as long as the header says.
    unsafe fn poses<'a>(&self, copied: &'a Option<HostPoses>) -> Result<Poses<'a>, Error> {
        if let Some(HostPoses { positions, quaternions }) = copied {
            return Ok(Poses::new(positions, quaternions));
        }
        // SAFETY: the caller's promise.
        unsafe {
            let positions = self.positions.on_device("positions of poses", 3)?;
            Ok(Poses::on_device(positions, self.quaternions.on_device("quaternions of poses", 4)?))
        }
    }
}

/// Moves many rigid bodies at once: `bodies[k]` to row `k` of the poses. As
/// `nearmiss_detector_update` with a pose for each, or with a pose step if `end` is not NULL. Bodies
/// that are not named rest.
///
/// Fails with `NEARMISS_INVALID_ARGUMENT` for other numbers of rows, and for a body that is not
/// there, named twice or not rigid. Fails with `NEARMISS_INPUT` for an invalid pose. The message
/// names the row and the body, and nothing has moved. Poses in memory of a GPU are checked when a
/// query reads them.
///
/// # Safety
/// So many numbers of bodies are there, and the rows.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_update_poses(
    detector: Option<&mut NearmissDetector>,
    bodies: *const u32,
    body_count: usize,
    start: Option<&NearmissPoseRows>,
    end: Option<&NearmissPoseRows>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let start = given(start, "start")?;
        // SAFETY: the caller's promise.
        let numbers = unsafe { items(bodies, body_count, "bodies") }?;
        let row_of = |(row, number): (usize, &u32)| {
            own.detector.scene().id(*number as usize).ok_or_else(|| {
                let what = format!("row {row} names body {number}, which is not in the scene");
                refused(what, "pass the number that adding it returned, until it is removed")
            })
        };
        let ids = numbers.iter().enumerate().map(row_of).collect::<Result<Vec<BodyId>, Error>>()?;
        let detector = own.detector.one("arrays of poses")?;
        // SAFETY: the caller's promise, for all rows.
        unsafe {
            let here = start.host()?;
            let from = start.poses(&here)?;
            match end {
                None => detector.update_poses(&ids, from),
                Some(end) => {
                    let there = end.host()?;
                    detector.update_pose_steps(&ids, from, end.poses(&there)?)
                }
            }
        }
    })
}

/// Poses of a rigid body at the start and at the end of its step, equal if it rests. Either may be
/// NULL. Cost: if a body was moved from memory of the device, a copy of all vertices, and a wait.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_body_poses(
    detector: Option<&mut NearmissDetector>,
    body: u32,
    start: Option<&mut MaybeUninit<NearmissPose>>,
    end: Option<&mut MaybeUninit<NearmissPose>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let there = own.downloaded(body)?;
        check_rigid(body, there)?;
        for (to, Pose { rotation, translation }) in [start, end].into_iter().zip(there.poses()) {
            if let Some(to) = to {
                to.write(NearmissPose { rotation, translation });
            }
        }
        Ok(())
    })
}

fn check_rigid(number: u32, body: &Body) -> Result<(), Error> {
    if body.kind() == BodyKind::Rigid {
        return Ok(());
    }
    let what = format!("body {number}, {}, is not rigid and has no pose", body.name());
    Err(refused(what, "read its positions by nearmiss_detector_download_positions"))
}
