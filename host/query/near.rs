//! Features at t = 0 within a distance.

use super::{ListedRows, Question, Search, Solver};
use crate::contacts::NearPair;
use crate::error::Error;

/// Which vertex/face and edge/edge pairs are within a distance of each other at t = 0, and where are they nearest?
///
/// ```
/// let query = nearmiss::Query::near(0.01);
/// assert!(query.check().is_ok() && nearmiss::Query::near(0.0).check().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Near {
    /// How far apart two features may be to be listed, a length above 0.
    pub distance: f64,
    /// How candidates are found.
    pub(crate) search: Search,
}

impl Near {
    /// The distance of [`QueryExt::every`](crate::research::QueryExt::every).
    pub const DISTANCE: f64 = 1.0 / 64.0;

    /// Within that distance, all other choices at their defaults.
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
        if self.distance > 0.0 && self.distance < f64::INFINITY {
            return Ok(());
        }
        Err(Error::InvalidArgument {
            what: format!("a distance of {}", self.distance),
            advice: "give a length above 0".into(),
        })
    }
}
