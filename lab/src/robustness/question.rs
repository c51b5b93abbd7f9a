//! One question of the catalogue, and the judge of what is said to it.

use crate::case::{Case, Features};
use nearmiss_kernels::prim::inclusion::{Params, Verdict};

/// What must be said of a question by a solver that is certain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expect {
    /// They are apart, and by more than tolerance and rounding: it must be known.
    Apart,
    /// They do not meet, but nearly: anything but a certificate.
    Near,
    /// They meet first at that time: not separated, not late, early by [`Question::early`] at most.
    CollisionFilter(f64),
    /// The same, and a search in f64 must be certain of it.
    Sure(f64),
}

/// A question with its answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Question {
    /// Its name in `docs/internals/robustness.md`.
    pub id: &'static str,
    /// What is extreme about it.
    pub what: &'static str,
    /// The features.
    pub case: Case,
    /// How near may count as contact, a length.
    pub tolerance: f64,
    /// Features this near are in contact, a length.
    pub separation: f64,
    /// The end of the step, in (0, 1].
    pub end: f64,
    /// The answer.
    pub expect: Expect,
    /// By how much a time may be early, in parts of the step.
    pub early: f64,
    /// By how much the answer's own time may be wrong: decimals of it are rounded.
    pub blur: f64,
    /// f32 alone need not tell: only that nothing is missed, late or falsely certain is asked of it.
    pub is_fine: bool,
}

/// The most boxes that any question of the catalogue may take, in any precision.
pub const MOST_BOXES: u32 = 100;

/// What is wrong with an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A contact is called separated.
    Missed,
    /// The time is after the contact.
    Late,
    /// A contact is certified that there is none of, or not where it is.
    FalseCertificate,
    /// Nothing of these, but not what was expected: a false alarm, too early, no certificate, too dear.
    Unexpected,
}

impl Question {
    /// A question about features that touch within the whole step, at a tolerance of 1e-5.
    pub fn new(
        (id, what): (&'static str, &'static str),
        features: Features,
        [positions_t0, positions_t1]: [[[f64; 3]; 4]; 2],
        expect: Expect,
    ) -> Question {
        Question {
            id,
            what,
            case: Case { features, positions_t0, positions_t1 },
            tolerance: 1e-5,
            separation: 0.0,
            end: 1.0,
            expect,
            early: 1e-3,
            blur: 0.0,
            is_fine: false,
        }
    }

    /// What a certified test is asked.
    pub fn params(&self) -> Params {
        Params { min_separation: self.separation, end: self.end, ..Params::new(self.tolerance) }
    }

    /// What is wrong with an answer; `narrow`: it was made in f32 alone.
    pub fn judge(&self, said: &Verdict, narrow: bool) -> Option<Fault> {
        let lenient = narrow && self.is_fine;
        let unexpected = |bad: bool| (bad && !lenient).then_some(Fault::Unexpected);
        match self.expect {
            Expect::Apart | Expect::Near if said.is_contact() => Some(Fault::FalseCertificate),
            Expect::Apart => unexpected(!said.is_separated() || said.boxes > MOST_BOXES),
            Expect::Near => None,
            Expect::CollisionFilter(t) | Expect::Sure(t) => {
                let unsure = matches!(self.expect, Expect::Sure(_)) && !narrow && !said.is_contact();
                let early = said.toi < t - self.early || said.exhausted();
                if said.is_separated() {
                    Some(Fault::Missed)
                } else if said.toi > t + self.blur {
                    Some(Fault::Late)
                } else if said.is_contact() && said.toi_upper < t - self.blur {
                    Some(Fault::FalseCertificate)
                } else {
                    unexpected(unsure || early || said.boxes > MOST_BOXES)
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_fault_is_named() {
        let of = |expect| Question::new(("X", "planted"), Features::EdgeEdge, [[[0.0; 3]; 4]; 2], expect);
        let apart = Verdict::separated(1.0, 3);
        let contact = |toi, toi_upper| Verdict::contact(toi, toi_upper, 3, false);
        let unsure = |toi| Verdict::undecided(toi, 1.0, 3, false);
        let judged = |expect, said: Verdict| of(expect).judge(&said, false);
        assert_eq!(judged(Expect::Sure(0.5), contact(0.4999, 0.5)), None);
        assert_eq!(judged(Expect::Sure(0.5), unsure(0.4999)), Some(Fault::Unexpected));
        assert_eq!(of(Expect::Sure(0.5)).judge(&unsure(0.4999), true), None);
        for expect in [Expect::Sure(0.5), Expect::CollisionFilter(0.5)] {
            assert_eq!(judged(expect, apart), Some(Fault::Missed));
            assert_eq!(judged(expect, contact(0.51, 0.6)), Some(Fault::Late));
            assert_eq!(judged(expect, contact(0.4999, 0.49995)), Some(Fault::FalseCertificate));
            assert_eq!(judged(expect, contact(0.4, 0.6)), Some(Fault::Unexpected));
            let many = Verdict { boxes: MOST_BOXES + 1, ..contact(0.4999, 0.5) };
            assert_eq!(judged(expect, many), Some(Fault::Unexpected));
            let ended = Verdict::contact(0.4999, 0.5, 3, true);
            assert_eq!(judged(expect, ended), Some(Fault::Unexpected));
        }
        assert_eq!(judged(Expect::Apart, apart), None);
        assert_eq!(judged(Expect::Apart, unsure(0.1)), Some(Fault::Unexpected));
        assert_eq!(Question { is_fine: true, ..of(Expect::Apart) }.judge(&unsure(0.1), true), None);
        assert_eq!((judged(Expect::Near, apart), judged(Expect::Near, unsure(0.0))), (None, None));
        for expect in [Expect::Apart, Expect::Near] {
            assert_eq!(judged(expect, contact(0.1, 0.2)), Some(Fault::FalseCertificate));
        }
    }
}
