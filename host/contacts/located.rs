//! Rows of feature pairs, which have a geometry.

use super::geometry::Named;
use super::{Contact, NearPair, RowList, Rows};
use crate::error::Error;

/// Rows of feature pairs: see [`Detector::geometry`](crate::Detector::geometry).
pub trait Located: sealed::Rows {}

impl<T: sealed::Rows> Located for T {}

mod sealed {
    use super::{Error, Named};

    pub trait Rows {
        /// Returns the number of rows.
        ///
        /// # Errors
        /// [`Error::InvalidArgument`] for rows without feature pairs.
        fn count(&self) -> Result<usize, Error>;
        /// Returns the features of each row.
        fn named(&self) -> Vec<Named>;
    }
}

impl sealed::Rows for RowList<Contact> {
    fn count(&self) -> Result<usize, Error> {
        Ok(self.len())
    }

    fn named(&self) -> Vec<Named> {
        self.iter().map(Named::from).collect()
    }
}

impl sealed::Rows for RowList<NearPair> {
    fn count(&self) -> Result<usize, Error> {
        Ok(self.len())
    }

    fn named(&self) -> Vec<Named> {
        self.iter().map(Named::from).collect()
    }
}

impl sealed::Rows for Rows {
    fn count(&self) -> Result<usize, Error> {
        let (query, advice) = match self {
            Rows::Contacts(_) | Rows::Near(_) => return Ok(self.len()),
            Rows::Pairs(_) => {
                ("a discrete", "use a near or a continuous query; this answer has only triangle pairs")
            }
            Rows::Earliest(_) => ("an earliest", "use a continuous query; this answer has only a time"),
            Rows::Distance(_) => {
                ("a distance", "read `points` and `weights` of this answer's nearest triangles")
            }
        };
        let what = format!("geometry of the answer to {query} query, which has no pairs of features");
        Err(Error::InvalidArgument { what, advice: advice.into() })
    }

    fn named(&self) -> Vec<Named> {
        match self {
            Rows::Contacts(contacts) => contacts.named(),
            Rows::Near(pairs) => pairs.named(),
            Rows::Pairs(_) | Rows::Earliest(_) | Rows::Distance(_) => Vec::new(),
        }
    }
}
