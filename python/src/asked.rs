//! A detector as one thread at a time asks it, and when what was answered.

use crate::lent::Held;
use nearmiss::Error;
use std::sync::atomic::{AtomicU64, Ordering};

/// When contacts were answered: by which detector, and how often it had moved its bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    detector: u64,
    moves: u64,
}

/// What a question does besides being answered.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Does {
    /// The bodies may be elsewhere then, and so may be the answer on the device.
    Moves,
    /// The answer on the device may be elsewhere then.
    AsksAnew,
    /// Bodies may be elsewhere; the answer stays where it is on the device.
    Submits,
}

/// What one thread at a time asks.
pub struct Asked {
    pub detector: nearmiss::Detector,
    /// No other detector of the program has it.
    number: u64,
    /// Counts what may move the answer that lies on the device.
    pub asked: u64,
    /// Counts what may move bodies.
    pub moves: u64,
    /// What holds the arrays that submissions read. Dropped behind the detector, which reads them no longer then.
    pub held: Vec<Held>,
}

/// How many detectors were made.
static MADE: AtomicU64 = AtomicU64::new(0);

impl Asked {
    pub fn new(detector: nearmiss::Detector) -> Asked {
        let number = MADE.fetch_add(1, Ordering::Relaxed);
        Asked { detector, number, asked: 0, moves: 0, held: Vec::new() }
    }

    /// What nobody reads any longer.
    pub fn unread(&mut self) -> Vec<Held> {
        if self.detector.is_prepared() { Vec::new() } else { std::mem::take(&mut self.held) }
    }

    /// Counts a question.
    pub fn count(&mut self, does: Does) {
        self.asked += u64::from(matches!(does, Does::Moves | Does::AsksAnew));
        self.moves += u64::from(matches!(does, Does::Moves | Does::Submits));
    }

    /// Of what is answered now.
    pub fn stamp(&self) -> Stamp {
        Stamp { detector: self.number, moves: self.moves }
    }

    /// Refuses contacts of another detector, and of where bodies no longer are.
    pub fn check(&self, of: Stamp) -> Result<(), Error> {
        let what = match of {
            stamp if stamp == self.stamp() => return Ok(()),
            Stamp { detector, .. } if detector == self.number => {
                "contacts that were found before the detector was asked to move, add, remove or replace bodies"
            }
            _ => "contacts of another detector",
        };
        let advice = "ask about contacts before the next `frame`, and the detector that found them";
        Err(Error::InvalidArgument { what: what.into(), advice: advice.into() })
    }
}
