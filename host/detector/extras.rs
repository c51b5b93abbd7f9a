//! Submissions that make parts of their answers on the device.

use super::Detector;
use crate::contacts::DeviceExtras;
use crate::error::Error;
use crate::query::{Query, QueryKind};
use crate::scene::{BodyId, DeviceMotion};

impl Detector {
    /// As [`Detector::prepare`], with parts of the answers that submissions also make on the device:
    /// geometry of rows, rows by feature, the least time or distance of each vertex, the contacts at
    /// the earliest time.
    /// [`Detector::on_device`] returns their addresses.
    ///
    /// ```
    /// use nearmiss::{Body, Detector, Device, Mesh, Near, contacts::DeviceExtras, device::Backend, mesh::Positions};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 0.1], [1.0, 1.0, 5.0], [2.0, 2.0, 5.0]];
    /// let mesh = Mesh::new("two triangles", Positions::F32(corners), vec![[0, 1, 2], [3, 4, 5]])?;
    /// let mut detector = Detector::new(Device::open(Backend::Cpu, None)?, Body::deformable(mesh))?;
    /// let near = Near::within(0.5);
    /// detector.prepare_with(&[], &[near.into()], &DeviceExtras::default().with_geometry())?;
    /// detector.submit()?;
    /// let answer = detector.on_device(&near.into()).expect("prepared");
    /// println!("geometry of rows at {:#x}", answer.geometry.expect("wanted").address);
    /// # Ok::<(), nearmiss::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`Detector::prepare`]. [`Error::InvalidArgument`] if no answer can have a part, and for
    /// geometry of a step in which a rigid body may turn.
    pub fn prepare_with(
        &mut self,
        motions: &[(BodyId, DeviceMotion)],
        queries: &[Query],
        extras: &DeviceExtras,
    ) -> Result<(), Error> {
        let prepared = self.prepared(motions, queries, extras);
        self.ended(prepared)
    }

    /// Refuses the contacts at the earliest time of queries of which none has such a time.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`].
    pub(super) fn has_first_contacts(queries: &[Query], extras: &DeviceExtras) -> Result<(), Error> {
        let is_earliest = |query: &Query| query.kind() == QueryKind::Earliest;
        if !extras.first_contacts || queries.iter().any(is_earliest) {
            return Ok(());
        }
        let kinds: Vec<String> = queries.iter().map(|query| query.kind().to_string()).collect();
        Err(Error::InvalidArgument {
            what: format!("contacts at the earliest time need an earliest query, got {}", kinds.join(", ")),
            advice: "prepare an earliest query too, or leave out the first contacts".into(),
        })
    }

    /// Refuses geometry of a step in which a rigid body may turn: its points move on arcs.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`].
    pub(super) fn has_geometry_on_device(
        &self,
        in_motion: Option<&Query>,
        extras: &DeviceExtras,
    ) -> Result<(), Error> {
        let certified = in_motion.filter(|query| extras.geometry && query.certified().is_some());
        match self.scene.bodies().iter().find(|body| certified.is_some() && body.may_turn()) {
            Some(body) => Err(Error::InvalidArgument {
                what: format!("geometry in device memory is not made in this step: {} may turn", body.name()),
                advice:
                    "give rigid bodies straight steps, or use `Detector::geometry` of the collected answer"
                        .into(),
            }),
            None => Ok(()),
        }
    }
}
