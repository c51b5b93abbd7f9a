//! Features within a distance at t = 0.

use super::{ListedRows, Question, Search, Solver};
use crate::contacts::NearPair;
use crate::error::Error;

/// Vertex/face and edge/edge pairs within a distance at t = 0, and their nearest points.
///
/// ```
/// let query = nearmiss::Query::near(0.01);
/// assert!(query.check().is_ok() && nearmiss::Query::near(-1.0).check().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Near {
    /// Largest distance of a pair that is listed: a length above 0, in scene units. If a body has a
    /// [thickness](crate::Thickness) it may be 0.
    pub distance: f64,
    /// How candidates are found.
    pub(crate) search: Search,
}

impl Near {
    /// Distance that [`QueryExt::every`](crate::research::QueryExt::every) has.
    pub const DISTANCE: f64 = 1.0 / 64.0;

    /// Returns a query within a distance, with all other choices at their defaults.
    pub fn within(distance: f64) -> Near {
        Near { distance, search: Search::default() }
    }
}

impl Question for Near {
    fn is_at_rest() -> bool {
        true
    }
    fn every() -> Vec<Near> {
        vec![Near::within(Near::DISTANCE)]
    }
    fn search(&self) -> &Search {
        &self.search
    }
    fn search_mut(&mut self) -> &mut Search {
        &mut self.search
    }
    fn solver(&self) -> Solver {
        Solver::Bounded
    }
    fn listed_within(&self) -> f64 {
        self.distance
    }
    fn rows(&self) -> Option<ListedRows> {
        let advice = "use a smaller distance";
        Some(ListedRows { bytes: size_of::<NearPair>(), within: Some(self.distance), advice })
    }
    fn check(&self) -> Result<(), Error> {
        if self.distance >= 0.0 && self.distance < f64::INFINITY {
            return Ok(());
        }
        Err(Error::InvalidArgument {
            what: format!("distance must be finite and at least 0, got {}", self.distance),
            advice: "give a length in the unit of the scene".into(),
        })
    }
}
