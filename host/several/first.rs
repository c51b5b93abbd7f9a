//! The contacts at the earliest time, by several devices.

use super::MultiDetector;
#[cfg(doc)]
use crate::Detector;
use crate::contacts::{Answer, Contact, Contacts, First, RowList};
use crate::error::Error;
use crate::query::{Continuous, Query};

impl MultiDetector {
    /// As [`Detector::first_contacts`].
    ///
    /// # Errors
    /// As there.
    pub fn first_contacts<T: First>(&mut self, first: &Answer<T>) -> Result<Answer<RowList<Contact>>, Error> {
        match first.query_of_first()? {
            Some(query) => {
                let all = self.query(&Query::from(query))?;
                first.first_of(all)
            }
            None => first.first_of(Contacts::none(Continuous::default().into())),
        }
    }
}
