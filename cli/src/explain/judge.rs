//! A solver's answer, judged by the exact one.

use nearmiss_kernels::prim::inclusion::{Answer, Verdict};
use nearmiss_lab::oracle::Toi;
use serde::Serialize;

/// The answer of a solver.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "says", rename_all = "kebab-case")]
pub enum Said {
    /// They do not meet.
    Apart,
    /// They meet, first at that time.
    Meet {
        /// The time.
        toi: f64,
    },
    /// They meet, first within these bounds, certainly.
    Certified {
        /// Not before.
        toi: f64,
        /// Not after.
        toi_upper: f64,
    },
    /// They come near; if they meet, not before that time, certainly.
    Undecided {
        /// Not before.
        toi: f64,
    },
}

/// How that compares with the exact answer. Times are in parts of the step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "judgement", rename_all = "kebab-case")]
pub enum Judgement {
    /// Apart and they are, or the time is the exact one to the last bit.
    Right,
    /// They meet and it says that they do not.
    Missed,
    /// Its time is after the contact.
    Late {
        /// By that.
        by: f64,
    },
    /// Its time is before the contact: safe.
    Early {
        /// By that.
        by: f64,
    },
    /// They do not meet and it says that they do.
    FalseAlarm,
    /// It certifies a contact that there is not, or one before the first.
    FalseCertificate,
    /// They do not meet, and it cannot decide.
    UndecidedApart,
    /// They meet; it cannot decide, but its time is safe.
    UndecidedEarly {
        /// By that.
        by: f64,
    },
}

impl From<Verdict> for Said {
    fn from(verdict: Verdict) -> Said {
        match verdict.answer() {
            Answer::Separated => Said::Apart,
            Answer::Contact { toi, toi_upper } => Said::Certified { toi, toi_upper },
            Answer::Undecided { toi, .. } => Said::Undecided { toi },
        }
    }
}

impl Said {
    /// From the time of a solver that knows no bounds.
    pub fn of(toi: Option<f64>) -> Said {
        toi.map_or(Said::Apart, |toi| Said::Meet { toi })
    }

    /// Its time, if it has one.
    pub fn toi(&self) -> Option<f64> {
        match *self {
            Said::Apart => None,
            Said::Meet { toi } | Said::Certified { toi, .. } | Said::Undecided { toi } => Some(toi),
        }
    }
}

/// Compares an answer with the exact one.
pub fn judge(said: &Said, exact: Option<&Toi>) -> Judgement {
    let (toi, exact) = match (said.toi(), exact) {
        (None, None) => return Judgement::Right,
        (None, Some(_)) => return Judgement::Missed,
        (Some(_), None) => {
            return match said {
                Said::Certified { .. } => Judgement::FalseCertificate,
                Said::Undecided { .. } => Judgement::UndecidedApart,
                _ => Judgement::FalseAlarm,
            };
        }
        (Some(toi), Some(exact)) => (toi, exact),
    };
    if toi.is_nan() {
        return Judgement::Missed;
    }
    // A time between two numbers has no better answer than either; only what is proven must be the lower.
    let (below, above) = exact.bracket();
    let by = exact.lateness(toi);
    match said {
        Said::Meet { .. } if toi == below || toi == above => Judgement::Right,
        _ if by > 0.0 => Judgement::Late { by },
        Said::Certified { toi_upper, .. } if exact.cmp_f64(*toi_upper).is_gt() => Judgement::FalseCertificate,
        Said::Undecided { .. } => Judgement::UndecidedEarly { by: -by },
        _ if toi == below => Judgement::Right,
        _ => Judgement::Early { by: -by },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearmiss_lab::case::{Case, Features};
    use nearmiss_lab::oracle::first_contact;

    /// A vertex that falls on a face: at a third of the step, or never.
    fn exact(meets: bool) -> Option<Toi> {
        let [a, b, c] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let to = if meets { -2.0 } else { 0.5 };
        first_contact(&Case {
            features: Features::VertexFace,
            positions_t0: [[0.25, 0.25, 1.0], a, b, c],
            positions_t1: [[0.25, 0.25, to], a, b, c],
        })
    }

    #[test]
    fn every_kind_of_answer_has_its_name() {
        let (hit, none) = (exact(true), exact(false));
        let third: f64 = 1.0 / 3.0;
        let meet = |toi| Said::Meet { toi };
        let sure = |toi, toi_upper| Said::Certified { toi, toi_upper };
        let open = |toi| Said::Undecided { toi };
        assert!(none.is_none());
        for (said, expected) in [
            (Said::Apart, Judgement::Missed),
            (meet(third), Judgement::Right),
            (meet(third.next_up()), Judgement::Right),
            (meet(f64::NAN), Judgement::Missed),
            (sure(third, third.next_up()), Judgement::Right),
            (sure(third, third), Judgement::FalseCertificate),
        ] {
            assert_eq!(judge(&said, hit.as_ref()), expected, "{said:?}");
        }
        for (said, expected) in [
            (Said::Apart, Judgement::Right),
            (meet(0.5), Judgement::FalseAlarm),
            (sure(0.5, 1.0), Judgement::FalseCertificate),
            (open(0.5), Judgement::UndecidedApart),
        ] {
            assert_eq!(judge(&said, none.as_ref()), expected, "{said:?}");
        }
        let off = |said: Said| match judge(&said, hit.as_ref()) {
            Judgement::Late { by } => ("late", by),
            Judgement::Early { by } => ("early", by),
            Judgement::UndecidedEarly { by } => ("undecided", by),
            other => panic!("{said:?}: {other:?}"),
        };
        for (said, name, by) in [
            (meet(0.5), "late", 1.0 / 6.0),
            (sure(0.5, 1.0), "late", 1.0 / 6.0),
            (open(0.5), "late", 1.0 / 6.0),
            (meet(0.25), "early", 1.0 / 12.0),
            (sure(0.25, 0.5), "early", 1.0 / 12.0),
            (open(0.25), "undecided", 1.0 / 12.0),
        ] {
            let found = off(said);
            assert!(found.0 == name && (found.1 - by).abs() < 1e-15, "{said:?}: {found:?}");
        }
        // A proven time may not be late by one unit in the last place.
        assert_eq!(off(sure(third.next_up(), 1.0)).0, "late");
    }
}
