//! Many rigid bodies move by arrays of poses.

use super::Detector;
use crate::error::Error;
use crate::scene::{BodyId, DeviceMotion, Motion, Poses, poses};

impl Detector {
    /// Moves many rigid bodies at once, by a row of each array a body: as [`Detector::update`] with
    /// a [`Motion::Pose`](crate::scene::Motion::Pose) for each. Bodies that are not named rest.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for arrays of other lengths, and for a body that is missing, named
    /// twice or not rigid. [`Error::Input`] for an invalid pose. They name the row and the body, and
    /// nothing has moved. Poses in device memory are checked when a query reads them. Others are
    /// those of the device.
    pub fn update_poses(&mut self, bodies: &[BodyId], poses: Poses) -> Result<(), Error> {
        let motions = poses::motions(&self.scene, bodies, poses, None)?;
        self.update(&motions)
    }

    /// Moves many rigid bodies at once, from the first poses to the second: as [`Detector::update`]
    /// with a [`Motion::pose_step`](crate::scene::Motion::pose_step) for each.
    ///
    /// # Errors
    /// As of [`Detector::update_poses`]. [`Error::InvalidArgument`] also for ends in different
    /// memories.
    pub fn update_pose_steps(&mut self, bodies: &[BodyId], start: Poses, end: Poses) -> Result<(), Error> {
        let motions = poses::motions(&self.scene, bodies, start, Some(end))?;
        self.update(&motions)
    }

    /// Returns the motions of many rigid bodies by arrays in device memory, a row a body, for
    /// [`Detector::prepare`]. With `end` they are steps.
    ///
    /// # Errors
    /// As of [`Detector::update_poses`]. [`Error::InvalidArgument`] also for arrays of the host.
    pub fn device_motions(
        &self,
        bodies: &[BodyId],
        start: Poses,
        end: Option<Poses>,
    ) -> Result<Vec<(BodyId, DeviceMotion)>, Error> {
        let motions = poses::motions(&self.scene, bodies, start, end)?;
        let on_device = |(id, motion)| match motion {
            Motion::OnDevice(motion) => Ok((id, motion)),
            Motion::Positions(_) | Motion::Step(_) | Motion::Pose(_) | Motion::PoseStep(_) => {
                Err(Error::InvalidArgument {
                    what: "a submission cannot read poses of the host".into(),
                    advice: "give arrays in device memory, by `Poses::on_device`".into(),
                })
            }
        };
        motions.into_iter().map(on_device).collect()
    }
}
