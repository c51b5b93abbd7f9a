//! One case of the catalogue, and the judge of its answers.

use crate::case::{Case, Features};
use nearmiss_kernels::prim::inclusion::{Params, Verdict};

/// The required answer of a certified solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expect {
    /// The features are apart, by more than tolerance and rounding: the answer must be separated.
    Apart,
    /// The features do not meet, but nearly do: any answer except a certificate.
    Near,
    /// The features first meet at this time. The answer must be neither separated nor late, and
    /// early by at most [`Question::early`].
    Meets(f64),
    /// The same, and a solver in f64 must be certain of it.
    Sure(f64),
}

/// A case with its answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Question {
    /// Its id in `docs/internals/robustness.md`.
    pub id: &'static str,
    /// Description of its extreme.
    pub what: &'static str,
    /// The features.
    pub case: Case,
    /// Tolerance, a length.
    pub tolerance: f64,
    /// Minimum separation, a length.
    pub separation: f64,
    /// The end of the step, in (0, 1].
    pub end: f64,
    /// The required answer.
    pub expect: Expect,
    /// Largest allowed earliness, as a fraction of the step.
    pub early: f64,
    /// Error of the expected time itself, which has rounded decimals.
    pub blur: f64,
    /// Whether the case is too fine for f32 alone, which then only must not miss, be late or
    /// certify falsely.
    pub is_fine: bool,
}

/// Most boxes that any case of the catalogue may take, in any precision.
pub const MOST_BOXES: u32 = 100;

/// Fault of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A contact was called separated.
    Missed,
    /// The time is after the contact.
    Late,
    /// A certificate without a contact, or with a wrong time.
    FalseCertificate,
    /// Another unexpected answer: a false alarm, too early, no certificate, too many boxes.
    Unexpected,
}

impl Question {
    /// Makes a case of features that touch within the whole step, at a tolerance of 1e-5.
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

    /// Returns the parameters of a certified test.
    pub fn params(&self) -> Params {
        Params { min_separation: self.separation, end: self.end, ..Params::new(self.tolerance) }
    }

    /// Returns the fault of an answer; `narrow` if it was computed in f32 alone.
    pub fn judge(&self, said: &Verdict, narrow: bool) -> Option<Fault> {
        let lenient = narrow && self.is_fine;
        let unexpected = |bad: bool| (bad && !lenient).then_some(Fault::Unexpected);
        match self.expect {
            Expect::Apart | Expect::Near if said.is_contact() => Some(Fault::FalseCertificate),
            Expect::Apart => unexpected(!said.is_separated() || said.boxes > MOST_BOXES),
            Expect::Near => None,
            Expect::Meets(t) | Expect::Sure(t) => {
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
        for expect in [Expect::Sure(0.5), Expect::Meets(0.5)] {
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
