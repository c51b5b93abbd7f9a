//! Merges the answers to parts of a query, from several devices or slices.

use super::{Caveat, Contact, Contacts, Keep, NearPair, RowList, Rows, TrianglePair};
use crate::error::Error;
use crate::stages::Stages;
use nearmiss_emulator::Looks;

impl Contacts {
    /// Merges the answers of shares: lists in canonical order, counts added. `combine` makes one
    /// time of two: the longer for concurrent shares, the sum for sequential ones. Lists that devices
    /// have written become one in memory from `keep`.
    ///
    /// # Errors
    /// [`Error::Interrupted`] if `looks` ends the work; those of `keep`; [`Error::Bug`] without shares.
    pub(crate) fn merged(
        shares: Vec<Contacts>,
        combine: impl Fn(f64, f64) -> f64,
        keep: Keep,
        looks: &Looks,
    ) -> Result<Contacts, Error> {
        let rows = if shares.len() > 1 { merged_rows(&shares, keep, looks)? } else { None };
        let mut all = shares.into_iter();
        let mut whole = all.next().ok_or_else(|| Error::Bug { what: "an answer of no share".into() })?;
        whole.rows = rows.unwrap_or(whole.rows);
        for share in all {
            let (own, other) = (whole.stats.stages, share.stats.stages);
            whole.stats.stages = Stages::each(|stage| combine(stage(&own), stage(&other)));
            whole.add(share);
        }
        Ok(whole)
    }

    /// Adds the counts of another share, and its time or distance. Lists are those of all shares.
    fn add(&mut self, mut share: Contacts) {
        match (&mut self.rows, share.rows) {
            (Rows::Earliest(own), Rows::Earliest(other)) => {
                let first = |toi: Option<f64>, undecided: u64| toi.map(|toi| (toi, undecided));
                let both = [first(*own, self.undecided), first(other, share.undecided)];
                let least = both.into_iter().flatten().min_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
                *own = least.map(|(toi, _)| toi);
                // The count and the caveat are those of the earliest time alone.
                (self.undecided, share.undecided) = (least.map_or(0, |(_, undecided)| undecided), 0);
                let is_other = |reason: &Caveat| *reason != Caveat::EarliestUndecided;
                self.caveats.retain(is_other);
                share.caveats.retain(is_other);
                self.caveats.extend((self.undecided > 0).then_some(Caveat::EarliestUndecided));
            }
            (Rows::Distance(own), Rows::Distance(other)) => {
                let nearer =
                    |a: &super::NearestTriangles, b: &super::NearestTriangles| a.distance <= b.distance;
                *own = match (*own, other) {
                    (Some(a), Some(b)) => Some(if nearer(&a, &b) { a } else { b }),
                    (a, b) => a.or(b),
                };
            }
            // All shares answer the same query, so their rows have the same kind.
            (
                Rows::Pairs(_)
                | Rows::Contacts(_)
                | Rows::Near(_)
                | Rows::Earliest(_)
                | Rows::Distance(_)
                | Rows::BodyPairs(_)
                | Rows::BodyDistances(_),
                _,
            ) => {}
        }
        self.starts_crossing =
            self.starts_crossing.zip(share.starts_crossing).map(|(own, other)| own + other);
        self.is_free = self.rows.is_free(self.starts_crossing) && !self.query.is_only_crossing();
        self.stats.add(&share.stats);
        self.undecided += share.undecided;
        share.caveats.into_iter().for_each(|reason| self.add_caveat(reason));
    }

    fn add_caveat(&mut self, reason: Caveat) {
        match self.caveats.iter_mut().find_map(|own| own.and(reason).map(|both| (own, both))) {
            Some((own, both)) => *own = both,
            None => self.caveats.push(reason),
        }
    }
}

/// Returns the lists of all shares as one; `None` if their rows are no lists.
fn merged_rows(shares: &[Contacts], keep: Keep, looks: &Looks) -> Result<Option<Rows>, Error> {
    /// One list of those of one kind: all shares answer the same query.
    macro_rules! one_list {
        ($kind:ident, $row:ty) => {{
            let of = |share| match share {
                &Contacts { rows: Rows::$kind(ref list), .. } => Some(list),
                _ => None,
            };
            let lists: Vec<_> = shares.iter().filter_map(of).collect();
            Rows::$kind(RowList::merged(&lists, <$row>::key, keep, looks)?)
        }};
    }
    Ok(Some(match &shares[0].rows {
        Rows::Pairs(_) => one_list!(Pairs, TrianglePair),
        Rows::Contacts(_) => one_list!(Contacts, Contact),
        Rows::Near(_) => one_list!(Near, NearPair),
        // Queries of bodies have one share.
        Rows::Earliest(_) | Rows::Distance(_) | Rows::BodyPairs(_) | Rows::BodyDistances(_) => {
            return Ok(None);
        }
    }))
}
