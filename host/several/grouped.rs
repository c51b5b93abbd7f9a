//! Rows of an answer by features of a body, for several devices.

use super::MultiDetector;
#[cfg(doc)]
use crate::Detector;
use crate::contacts::{Answer, GroupBy, Grouped, Located};
use crate::error::Error;
use crate::scene::BodyId;

impl MultiDetector {
    /// As [`Detector::grouped`].
    ///
    /// # Errors
    /// As there.
    pub fn grouped<T: Located>(
        &mut self,
        found: &Answer<T>,
        body: BodyId,
        by: GroupBy,
    ) -> Result<Grouped, Error> {
        self.parts[0].grouped(found, body, by)
    }

    /// As [`Detector::least_by_vertex`].
    ///
    /// # Errors
    /// As there.
    pub fn least_by_vertex<T: Located>(
        &mut self,
        found: &Answer<T>,
        body: BodyId,
    ) -> Result<Vec<f64>, Error> {
        self.parts[0].least_by_vertex(found, body)
    }
}
