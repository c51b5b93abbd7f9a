//! Rows that have a geometry, and its type.

use super::geometry::Named;
use super::{Contact, ContactGeometry, NearPair, PairGeometry, RowList, Rows, TrianglePair};
use crate::error::Error;
use sealed::{Computed, Inputs};

/// Rows that have a geometry: see [`Detector::geometry`](crate::Detector::geometry).
pub trait Located: sealed::Rows {
    /// Geometry of all rows, in their order.
    type Geometry: Computed;
}

/// Geometry of the rows of an answer to any query.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// Geometry of contacts or near pairs.
    Contacts(Vec<ContactGeometry>),
    /// Geometry of triangle pairs.
    Pairs(Vec<PairGeometry>),
}

impl Default for Geometry {
    fn default() -> Self {
        Geometry::Contacts(Vec::new())
    }
}

impl Geometry {
    /// Number of rows.
    pub fn len(&self) -> usize {
        match self {
            Geometry::Contacts(contacts) => contacts.len(),
            Geometry::Pairs(pairs) => pairs.len(),
        }
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Geometry of contacts or near pairs; empty for triangle pairs.
    pub fn contacts(&self) -> &[ContactGeometry] {
        if let Geometry::Contacts(contacts) = self { contacts } else { &[] }
    }

    /// Geometry of triangle pairs; empty for contacts and near pairs.
    pub fn pairs(&self) -> &[PairGeometry] {
        if let Geometry::Pairs(pairs) = self { pairs } else { &[] }
    }
}

impl Located for RowList<Contact> {
    type Geometry = Vec<ContactGeometry>;
}

impl Located for RowList<NearPair> {
    type Geometry = Vec<ContactGeometry>;
}

impl Located for RowList<TrianglePair> {
    type Geometry = Vec<PairGeometry>;
}

impl Located for Rows {
    type Geometry = Geometry;
}

pub(crate) mod sealed {
    use super::{ContactGeometry, Error, Geometry, Named, PairGeometry, TrianglePair};

    /// Rows in the form from which a geometry is computed.
    pub enum Inputs<'a> {
        Features(Vec<Named>),
        Triangles(&'a [TrianglePair]),
    }

    pub trait Rows {
        /// Returns the rows.
        ///
        /// # Errors
        /// [`Error::InvalidArgument`] for answers without rows that have a geometry.
        fn inputs(&self) -> Result<Inputs<'_>, Error>;
    }

    /// A geometry of all rows.
    pub trait Computed {
        fn of(geometry: Geometry) -> Self;
    }

    impl Computed for Vec<ContactGeometry> {
        fn of(geometry: Geometry) -> Self {
            if let Geometry::Contacts(contacts) = geometry { contacts } else { Vec::new() }
        }
    }

    impl Computed for Vec<PairGeometry> {
        fn of(geometry: Geometry) -> Self {
            if let Geometry::Pairs(pairs) = geometry { pairs } else { Vec::new() }
        }
    }

    impl Computed for Geometry {
        fn of(geometry: Geometry) -> Self {
            geometry
        }
    }
}

impl sealed::Rows for RowList<Contact> {
    fn inputs(&self) -> Result<Inputs<'_>, Error> {
        Ok(Inputs::Features(self.iter().map(Named::from).collect()))
    }
}

impl sealed::Rows for RowList<NearPair> {
    fn inputs(&self) -> Result<Inputs<'_>, Error> {
        Ok(Inputs::Features(self.iter().map(Named::from).collect()))
    }
}

impl sealed::Rows for RowList<TrianglePair> {
    fn inputs(&self) -> Result<Inputs<'_>, Error> {
        Ok(Inputs::Triangles(self))
    }
}

impl sealed::Rows for Rows {
    fn inputs(&self) -> Result<Inputs<'_>, Error> {
        let (query, advice) = match self {
            Rows::Contacts(contacts) => return contacts.inputs(),
            Rows::Near(pairs) => return pairs.inputs(),
            Rows::Pairs(pairs) => return pairs.inputs(),
            Rows::Earliest(_) => {
                ("an earliest", "use an answer of `first_contacts`; this one has only a time")
            }
            Rows::Distance(_) => {
                ("a distance", "read `points` and `weights` of this answer's nearest triangles")
            }
            Rows::BodyPairs(_) => {
                ("a body-pairs", "use a discrete query: its pairs of triangles have geometry")
            }
            Rows::BodyDistances(_) => {
                ("a body-distances", "read `points` and `weights` of this answer's nearest triangles")
            }
        };
        let what = format!("answer to {query} query has no pairs of features or triangles");
        Err(Error::InvalidArgument { what, advice: advice.into() })
    }
}
