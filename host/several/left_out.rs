//! Pairs of bodies, and of their features, that are left out.

use super::MultiDetector;
#[cfg(doc)]
use crate::Detector;
use crate::error::Error;
use crate::scene::{BodyId, Exclusions};

impl MultiDetector {
    /// As [`Detector::leave_out`].
    ///
    /// # Errors
    /// As there.
    pub fn leave_out(&mut self, pairs: &[[BodyId; 2]]) -> Result<(), Error> {
        self.each(|detector| detector.leave_out(pairs))?;
        self.divisions.clear();
        Ok(())
    }

    /// As [`Detector::left_out`].
    pub fn left_out(&self) -> &[[BodyId; 2]] {
        self.parts[0].left_out()
    }

    /// As [`Detector::exclude`].
    ///
    /// # Errors
    /// As there.
    pub fn exclude(&mut self, id: BodyId, exclusions: &Exclusions) -> Result<(), Error> {
        self.each(|detector| detector.exclude(id, exclusions.clone()))?;
        self.divisions.clear();
        Ok(())
    }

    /// As [`Detector::exclude_pairs`].
    ///
    /// # Errors
    /// As there.
    pub fn exclude_pairs(&mut self, bodies: [BodyId; 2], pairs: &[[u32; 2]]) -> Result<(), Error> {
        self.each(|detector| detector.exclude_pairs(bodies, pairs))?;
        self.divisions.clear();
        Ok(())
    }
}
