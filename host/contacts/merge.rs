//! Merges the answers to parts of a query, from several devices or slices.

use super::{Caveat, Contact, Contacts, Rows, TrianglePair, near, sort};
use crate::stages::Stages;
use nearmiss_emulator::Looks;

impl Contacts {
    /// Merges the answers of shares: lists in canonical order, counts added. `combine` makes one
    /// time of two: the longer for concurrent shares, the sum for sequential ones. `None` without
    /// shares, or if an interrupt ends the work.
    pub(crate) fn merged(
        shares: Vec<Contacts>,
        combine: impl Fn(f64, f64) -> f64,
        looks: &Looks,
    ) -> Option<Contacts> {
        let ordered = shares.len() < 2;
        let mut all = shares.into_iter();
        let mut whole = all.next()?;
        for share in all {
            let (own, other) = (whole.stats.stages, share.stats.stages);
            whole.stats.stages = Stages::each(|stage| combine(stage(&own), stage(&other)));
            whole.add(share);
        }
        if !ordered {
            // Each share is sorted, so a merging sort suffices.
            match &mut whole.rows {
                Rows::Pairs(pairs) => sort::merge(pairs.to_mut(), TrianglePair::key, looks),
                Rows::Contacts(contacts) => sort::merge(contacts.to_mut(), Contact::key, looks),
                Rows::Near(pairs) => sort::merge(pairs.to_mut(), near::NearPair::key, looks),
                // Queries of bodies have one share.
                Rows::Earliest(_) | Rows::Distance(_) | Rows::BodyPairs(_) | Rows::BodyDistances(_) => {}
            }
        }
        Some(whole)
    }

    /// Appends the rows and counts of another share.
    fn add(&mut self, mut share: Contacts) {
        match (&mut self.rows, share.rows) {
            (Rows::Pairs(own), Rows::Pairs(other)) => own.to_mut().extend_from_slice(&other),
            (Rows::Contacts(own), Rows::Contacts(other)) => own.to_mut().extend_from_slice(&other),
            (Rows::Near(own), Rows::Near(other)) => own.to_mut().extend_from_slice(&other),
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
