//! A query with the tolerances and the thickness of its pairs.

use crate::pipeline::{Layout, QueryParts, Share, Tolerances};
use crate::query::Query;
use std::sync::Arc;

/// A query with the tolerances of a certified solver for the bodies of a scene, and their thickness.
#[derive(Clone)]
pub struct Question {
    pub query: Query,
    /// `None` without a certified solver.
    pub tolerances: Option<Arc<Tolerances>>,
    /// The radius of each body, for a certified solver; empty without a thickness.
    pub radii: Arc<Vec<f64>>,
}

impl Question {
    /// Returns the part of a share, for the bodies of a layout.
    pub fn parts(&self, layout: Arc<Layout>, share: Share, is_of_instances: bool) -> QueryParts {
        let tolerances = self.tolerances.as_ref();
        let of = |tolerances: &Arc<Tolerances>| tolerances.records(&layout.starts, &self.radii);
        let records = tolerances.map_or_else(Vec::new, of);
        let query = self.with_largest_tolerance();
        QueryParts { query, tolerances: records, layout, share, is_of_instances }
    }

    /// Returns the query with the largest tolerance of its pairs: volumes grow by it.
    fn with_largest_tolerance(&self) -> Query {
        let mut query = self.query;
        if let (Some(certified), Some(tolerances)) = (query.certified_mut(), &self.tolerances) {
            certified.tolerance = Some(tolerances.largest);
        }
        query
    }
}
