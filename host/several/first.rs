//! The contacts at the earliest time, by several devices.

use super::MultiDetector;
#[cfg(doc)]
use crate::Detector;
use crate::contacts::{Answer, Contact, First, RowList};
use crate::error::Error;

impl MultiDetector {
    /// As [`Detector::first_contacts`].
    ///
    /// # Errors
    /// As there.
    pub fn first_contacts<T: First>(&mut self, first: &Answer<T>) -> Result<Answer<RowList<Contact>>, Error> {
        first.first_contacts(|query| self.query(query))
    }
}
