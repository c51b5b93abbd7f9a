//! The answer to a query over ranks.

use nearmiss::Query;
use nearmiss::contacts::{Contacts, Rows};

/// The answer to a query over ranks. Numbers of bodies and features are those of the whole scene.
#[derive(Clone, Debug)]
pub struct RankAnswer {
    /// Rows that this rank found, in canonical order; after
    /// [`RankDetector::gather`](crate::RankDetector::gather) those of all ranks. An earliest time is
    /// that of all ranks, on each.
    pub rows: Rows,
    /// The query.
    pub query: Query,
    /// Number of rows of all ranks.
    pub count: u64,
    /// Triangle pairs of all ranks that share a point at the start of the step: see
    /// [`nearmiss::Answer::starts_crossing`].
    pub starts_crossing: Option<u64>,
    /// Undecided rows of all ranks, for queries in motion; 0 for others. For an earliest time 1 if it
    /// is that of an undecided pair and of no contact.
    pub undecided: u64,
}

impl RankAnswer {
    /// Whether the answer proves that nothing touches, on any rank: see
    /// [`nearmiss::Answer::is_free`].
    pub fn is_free(&self) -> bool {
        match &self.query {
            Query::Discrete(query) => self.count == 0 && !query.is_only_crossing(),
            Query::Continuous(_) | Query::Earliest(_) => self.count == 0 && self.starts_crossing == Some(0),
            _ => false,
        }
    }

    /// Hash of the rows. If they are those of all ranks, it is the hash of one machine:
    /// [`nearmiss::contacts::Contacts::hash`].
    pub fn hash(&self) -> u64 {
        let mut contacts = Contacts::none(self.query);
        contacts.rows = self.rows.clone();
        contacts.hash()
    }
}
