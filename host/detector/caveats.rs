//! Caveats that follow from positions: a turn too far for straight lines, a tolerance below the
//! precision.

use super::Detector;
use super::question::Question;
use crate::contacts::{Caveat, Contacts, TURN_DEGREES};
use crate::error::Error;
use crate::pipeline::below_precision::BelowPrecision;
use crate::query::{Certified, Query};
use crate::scene::{Body, BodyKind};

impl Detector {
    /// Adds a caveat for each rigid body that turns far in the step while its vertices go straight:
    /// [`Caveat::Turned`]. They do so on a straight path, and for a solver without a proof. Poses
    /// that only the device has are copied from it.
    ///
    /// # Errors
    /// Those of the device.
    pub(super) fn tell_turns(&self, query: &Query, contacts: &mut Contacts) -> Result<(), Error> {
        if query.kind().is_at_rest() {
            return Ok(());
        }
        let is_certified = query.certified().is_some();
        let goes_straight = |body: &Body| !is_certified || body.is_straight();
        let is_posed_there =
            |body: &Body| body.kind() == BodyKind::Rigid && body.is_device_resident() && body.is_moving();
        let mut bodies = self.scene.bodies().iter();
        let found = match &self.engine.pipeline {
            Some(pipeline) if bodies.any(|body| goes_straight(body) && is_posed_there(body)) => {
                pipeline.poses()?
            }
            _ => Vec::new(),
        };
        for id in self.scene.ids() {
            let Some(body) = self.scene.get(id).filter(|body| goes_straight(body)) else { continue };
            let Some(step) = body.step_among(id.index(), &found) else { continue };
            if let Some([degrees, bulge]) = body.turn_beyond(TURN_DEGREES, [step.start(), step.end()]) {
                contacts.caveats.push(Caveat::Turned { body: id, degrees, bulge });
            }
        }
        Ok(())
    }

    /// Adds the caveat of a tolerance below the precision to an earliest query. Such a query lists
    /// no pairs, so positions decide. For device-resident bodies the largest coordinate may
    /// suffice; if not, their positions are downloaded.
    pub(super) fn tell_below_precision(
        &mut self,
        question: &Question,
        contacts: &mut Contacts,
    ) -> Result<(), Error> {
        let (Query::Earliest(_), Some(certified), Some(tolerances)) =
            (question.query, question.query.certified().copied(), &question.tolerances)
        else {
            return Ok(());
        };
        let finest = Certified { tolerance: Some(tolerances.finest), ..certified };
        let own = tolerances.least < tolerances.largest;
        let certified = Certified { tolerance: Some(tolerances.largest), ..certified };
        let unlisted = Caveat::ToleranceBelowPrecision { pairs: None };
        // If no body came from memory of the caller, the pipeline has examined all.
        let is_looked_at =
            self.resident.largest == 0.0 && !self.scene.bodies().iter().any(Body::is_device_resident);
        if is_looked_at || contacts.caveats.contains(&unlisted) {
            return Ok(());
        }
        let largest = self.resident.largest.max(BelowPrecision::largest(self.scene.bodies()));
        if !BelowPrecision::may_be(&finest, 2.0 * largest) {
            return Ok(());
        }
        self.download_positions()?;
        let layout = self.layout(&question.query)?;
        let below = BelowPrecision::of_earliest((self.scene.bodies(), &layout), &certified, own);
        if below == Some(BelowPrecision::Unlisted) {
            contacts.caveats.push(unlisted);
        }
        Ok(())
    }
}
