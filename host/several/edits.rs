//! Bodies of several devices are added, replaced and removed, on all of them alike.

use super::MultiDetector;
#[cfg(doc)]
use crate::detector::Detector;
use crate::error::Error;
use crate::scene::{Body, BodyId, Thickness};

impl MultiDetector {
    /// As [`Detector::add`].
    ///
    /// # Errors
    /// As there.
    pub fn add(&mut self, body: &Body) -> Result<BodyId, Error> {
        // All scenes number their bodies in the same way.
        let ids = self.each(|detector| detector.add(body.clone()))?;
        self.divisions.clear();
        Ok(ids[0])
    }

    /// As [`Detector::remove`].
    ///
    /// # Errors
    /// As there.
    pub fn remove(&mut self, id: BodyId) -> Result<Body, Error> {
        let mut bodies = self.each(|detector| detector.remove(id))?;
        self.divisions.clear();
        Ok(bodies.swap_remove(0))
    }

    /// As [`Detector::replace`].
    ///
    /// # Errors
    /// As there.
    pub fn replace(&mut self, id: BodyId, body: &Body) -> Result<(), Error> {
        self.each(|detector| detector.replace(id, body.clone()))?;
        self.divisions.clear();
        Ok(())
    }

    /// As [`Detector::set_thickness`].
    ///
    /// # Errors
    /// As there.
    pub fn set_thickness(&mut self, id: BodyId, thickness: impl Into<Thickness>) -> Result<(), Error> {
        let thickness = thickness.into();
        self.each(|detector| detector.set_thickness(id, thickness.clone()))?;
        self.divisions.clear();
        Ok(())
    }
}
