//! Queries of what approaches.

use super::Detector;
use crate::error::Error;
use crate::query::Query;

impl Detector {
    /// Checks that a query of what approaches has an answer in this step.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if a rigid body may turn.
    pub(super) fn may_approach(&self, query: &Query) -> Result<(), Error> {
        let is_of_this = query.certified().is_some_and(|certified| certified.approaching);
        match self.scene.bodies().iter().find(|body| is_of_this && body.may_turn()) {
            Some(body) => Err(Error::InvalidArgument {
                what: format!("approaching cannot be tested in this step: {} may turn", body.name()),
                advice: "give rigid bodies straight steps, or leave out approaching".into(),
            }),
            None => Ok(()),
        }
    }
}
