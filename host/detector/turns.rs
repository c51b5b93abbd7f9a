//! Rigid bodies that turn so far in a step that straight lines are no picture of it.

use super::Detector;
use crate::contacts::{Contacts, Degraded};
use crate::error::Error;
use crate::mesh::Body;
use crate::scene::BodyKind;

impl Detector {
    /// Adds a caveat for each rigid body that turns far in the step: [`Degraded::Turned`]. Poses that only the device knows are copied
    /// from it, if there are any.
    ///
    /// # Errors
    /// Those of the device.
    pub(super) fn tell_turns(&self, contacts: &mut Contacts) -> Result<(), Error> {
        if self.query.kind().is_at_rest() {
            return Ok(());
        }
        let is_rigid = |body: &&Body| body.kind() == BodyKind::Rigid && body.face_count() > 0;
        let is_away = |body: &Body| body.is_away() && body.is_moving();
        let bodies = self.scene.bodies();
        let found = match &self.pipeline {
            Some(pipeline) if bodies.iter().filter(is_rigid).any(is_away) => pipeline.poses()?,
            _ => Vec::new(),
        };
        for id in self.scene.ids() {
            let Some(body) = self.scene.get(id).filter(is_rigid) else { continue };
            let poses = match found.get(2 * id.index()..2 * id.index() + 2) {
                Some(&[start, end]) if is_away(body) => [start, end],
                _ if body.is_away() => continue,
                _ => body.poses(),
            };
            if let Some([degrees, bulge]) = body.turn(poses) {
                contacts.degraded.push(Degraded::Turned { body: id, degrees, bulge });
            }
        }
        Ok(())
    }
}
