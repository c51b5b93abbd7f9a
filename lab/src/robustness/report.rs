//! Report of a suite.

use super::question::Fault;
use nearmiss::words::counted;
use std::fmt;

/// A suite's counts and its failures by id. Without failures every answer is right.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// The suite.
    pub suite: &'static str,
    /// Number of answers that were judged.
    pub asked: u64,
    /// Contacts that were not found.
    pub missed: u64,
    /// Times after the contact.
    pub late: u64,
    /// Certificates without a contact, or with a wrong time.
    pub false_certificates: u64,
    /// Answers without a certificate either way.
    pub undecided: u64,
    /// Id and description of each failure; at most [`Report::SHOWN`].
    pub failures: Vec<String>,
    /// Number of failures.
    pub failed: u64,
}

impl Report {
    /// Number of failures whose description is kept.
    pub const SHOWN: usize = 20;

    /// Returns an empty report.
    pub fn new(suite: &'static str) -> Report {
        Report { suite, ..Report::default() }
    }

    /// Returns whether no answer failed, and at least one was judged.
    pub fn is_right(&self) -> bool {
        self.failed == 0 && self.asked > 0
    }

    /// Notes a failure.
    pub fn fail(&mut self, text: impl FnOnce() -> String) {
        self.failed += 1;
        if self.failures.len() < Report::SHOWN {
            self.failures.push(text());
        }
    }

    /// Notes an answer and its fault, if it has one.
    pub fn note(&mut self, fault: Option<Fault>, text: impl FnOnce() -> String) {
        self.asked += 1;
        let Some(fault) = fault else { return };
        match fault {
            Fault::Missed => self.missed += 1,
            Fault::Late => self.late += 1,
            Fault::FalseCertificate => self.false_certificates += 1,
            Fault::Unexpected => {}
        }
        self.fail(|| format!("{fault:?}: {}", text()));
    }
}

/// One line, and one for each failure.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Report { suite, asked, missed, late, false_certificates, undecided, failed, .. } = self;
        write!(
            f,
            "{suite:<20} {asked:>9} tested, {missed} missed, {late} late, {false_certificates} falsely certain, \
             {undecided} undecided, {}",
            counted(*failed, "failure", "failures")
        )?;
        self.failures.iter().try_for_each(|failure| write!(f, "\n    {failure}"))
    }
}
