//! Answers to parts of one question, by several devices or one after another, as one.

use super::{Answer, Contact, Contacts, Degraded, TrianglePair, near, sort};
use crate::stages::Stages;
use nearmiss_emulator::Looks;

impl Contacts {
    /// The answer to the whole, of those to its shares, of which there is at least one: lists together in canonical order, counts
    /// added, and of each stage what `of` makes of two: the longer of those at the same time, the sum of those one after another.
    /// No answer if a look ends it.
    pub(crate) fn merged(
        shares: Vec<Contacts>,
        of: impl Fn(f64, f64) -> f64,
        looks: &Looks,
    ) -> Option<Contacts> {
        let ordered = shares.len() < 2;
        let mut all = shares.into_iter();
        let mut whole = all.next()?;
        for share in all {
            let (own, other) = (whole.stages, share.stages);
            whole.stages = Stages::each(|stage| of(stage(&own), stage(&other)));
            whole.add(share);
        }
        if !ordered {
            // Each share is in order: a sort that merges.
            match &mut whole.answer {
                Answer::Pairs(pairs) => sort::merge(pairs, TrianglePair::key, looks),
                Answer::Contacts(contacts) => sort::merge(contacts, Contact::key, looks),
                Answer::Near(pairs) => sort::merge(pairs, near::NearPair::key, looks),
                Answer::Earliest(_) | Answer::Distance(_) => {}
            }
        }
        Some(whole)
    }

    /// What another share found, behind this one.
    fn add(&mut self, mut share: Contacts) {
        match (&mut self.answer, share.answer) {
            (Answer::Pairs(own), Answer::Pairs(other)) => own.extend(other),
            (Answer::Contacts(own), Answer::Contacts(other)) => own.extend(other),
            (Answer::Near(own), Answer::Near(other)) => own.extend(other),
            (Answer::Earliest(own), Answer::Earliest(other)) => {
                let first = |toi: Option<f64>, unresolved: u64| toi.map(|toi| (toi, unresolved));
                let both = [first(*own, self.unresolved), first(other, share.unresolved)];
                let least = both.into_iter().flatten().min_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
                *own = least.map(|(toi, _)| toi);
                // Of the earliest time alone.
                (self.unresolved, share.unresolved) = (least.map_or(0, |(_, unresolved)| unresolved), 0);
                let of_the_other = |reason: &Degraded| *reason != Degraded::EarliestUnresolved;
                self.degraded.retain(of_the_other);
                share.degraded.retain(of_the_other);
                self.degraded.extend((self.unresolved > 0).then_some(Degraded::EarliestUnresolved));
            }
            (Answer::Distance(own), Answer::Distance(other)) => {
                let nearer =
                    |a: &super::NearestTriangles, b: &super::NearestTriangles| a.distance <= b.distance;
                *own = match (*own, other) {
                    (Some(a), Some(b)) => Some(if nearer(&a, &b) { a } else { b }),
                    (a, b) => a.or(b),
                };
            }
            // One question has answers of one kind.
            (
                Answer::Pairs(_)
                | Answer::Contacts(_)
                | Answer::Near(_)
                | Answer::Earliest(_)
                | Answer::Distance(_),
                _,
            ) => {}
        }
        let pairs =
            |own: &mut [u64; 2], other: [u64; 2]| own.iter_mut().zip(other).for_each(|(own, n)| *own += n);
        pairs(&mut self.candidates_vf_ee, share.candidates_vf_ee);
        pairs(&mut self.survivors_vf_ee, share.survivors_vf_ee);
        pairs(&mut self.escalated_vf_ee, share.escalated_vf_ee);
        pairs(&mut self.open_vf_ee, share.open_vf_ee);
        pairs(&mut self.sliced_vf_ee, share.sliced_vf_ee);
        self.starts_crossing =
            self.starts_crossing.zip(share.starts_crossing).map(|(own, other)| own + other);
        self.triangle_pairs += share.triangle_pairs;
        self.candidates += share.candidates;
        self.unresolved += share.unresolved;
        self.undecided += share.undecided;
        self.undecided_wide += share.undecided_wide;
        self.steps += share.steps;
        self.spilled += share.spilled;
        self.reruns += share.reruns;
        self.slices = self.slices.max(share.slices);
        share.degraded.into_iter().for_each(|reason| self.degrade(reason));
    }

    fn degrade(&mut self, reason: Degraded) {
        match self.degraded.iter_mut().find_map(|own| own.and(reason).map(|both| (own, both))) {
            Some((own, both)) => *own = both,
            None => self.degraded.push(reason),
        }
    }
}
