//! The first contact of a step, and the contacts at its time.

use super::{Answer, Caveat, Contact, Contacts, RowList, Rows, Status};
use crate::error::Error;
use crate::query::Query;

/// First contact of a step: the answer to an earliest query.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FirstContact {
    /// Time, in \[0, 1\] of the step. A certified solver's time is never later than the first
    /// contact.
    pub toi: f64,
    /// Whether the pair at that time is undecided and no contact begins then.
    pub is_undecided: bool,
}

mod sealed {
    pub trait Sealed {}
}

impl sealed::Sealed for Option<FirstContact> {}
impl sealed::Sealed for Rows {}

/// Rows of an earliest query: see [`Detector::first_contacts`](crate::Detector::first_contacts).
pub trait First: sealed::Sealed {
    /// The earliest time.
    #[doc(hidden)]
    fn toi(&self) -> Option<f64>;
}

impl First for Option<FirstContact> {
    fn toi(&self) -> Option<f64> {
        self.map(|first| first.toi)
    }
}

impl First for Rows {
    fn toi(&self) -> Option<f64> {
        self.earliest_toi()
    }
}

impl From<Answer<RowList<Contact>>> for Contacts {
    fn from(answer: Answer<RowList<Contact>>) -> Contacts {
        answer.with_rows(Rows::Contacts)
    }
}

impl<T: First> Answer<T> {
    /// Returns the contacts that begin at the earliest time. `ask` answers the query of those that
    /// begin by it.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for an answer to another query, and if nothing begins at that time:
    /// bodies have moved since. Those of `ask`.
    pub(crate) fn first_contacts(
        &self,
        ask: impl FnOnce(&Query) -> Result<Contacts, Error>,
    ) -> Result<Answer<RowList<Contact>>, Error> {
        let Query::Earliest(earliest) = &self.query else {
            return Err(Error::InvalidArgument {
                what: format!("first contacts of the answer to a {} query", self.query.kind()),
                advice: "give the answer to an earliest query".into(),
            });
        };
        let query = earliest.contacts().into();
        let Some(toi) = self.rows.toi() else {
            let (stats, caveats) = (self.stats.clone(), self.caveats.clone());
            return Ok(self.with(Vec::new(), Contacts { stats, caveats, ..Contacts::none(query) }));
        };
        let all = ask(&earliest.contacts_until(toi).into())?;
        let first: Vec<Contact> = all.contacts().iter().filter(|row| row.toi == toi).copied().collect();
        if first.is_empty() {
            return Err(Error::InvalidArgument {
                what: format!(
                    "first contacts at t = {toi}, where the bodies are now, of which there are none"
                ),
                advice: "call it before the bodies move".into(),
            });
        }
        Ok(self.with(first, Contacts { query, ..all }))
    }

    /// Returns an answer with these rows, which are a part of all. The start is as this answer has it.
    fn with(&self, rows: Vec<Contact>, all: Contacts) -> Answer<RowList<Contact>> {
        let undecided = rows.iter().filter(|row| row.status == Status::Undecided).count() as u64;
        // Counts of caveats are of all that were tested.
        let mut caveats = all.caveats;
        caveats.retain(|caveat| !matches!(caveat, Caveat::Undecided { .. } | Caveat::Iterations { .. }));
        for caveat in &mut caveats {
            if let Caveat::ToleranceBelowPrecision { pairs } = caveat {
                *pairs = None;
            }
        }
        caveats.extend((undecided > 0).then_some(Caveat::Undecided { pairs: undecided }));
        Answer {
            rows: rows.into(),
            query: all.query,
            starts_crossing: self.starts_crossing,
            undecided,
            stats: all.stats,
            caveats,
            is_free: self.is_free,
        }
    }
}
