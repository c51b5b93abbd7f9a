//! A detector for one thread at a time, with a count of its answers.

use crate::borrowed::Held;
use nearmiss::{Error, Scene};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// When contacts were answered: by which detector, and how often it had moved its bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    detector: u64,
    moves: u64,
}

/// Effect of a call on what was answered before.
#[derive(Clone, Copy, PartialEq)]
pub enum Does {
    /// Bodies may be elsewhere then, and so may the answers on the device.
    Moves,
    /// Bodies come, go or change.
    Edits,
    /// Answers on the device may be elsewhere then.
    Queries,
    /// All stays as it is.
    Reads,
    /// Bodies may be elsewhere; answers stay where they are on the device.
    Submits,
    /// The answer to one query comes to the host. If it came before, a recording may have moved bodies since.
    Collects(nearmiss::Query),
}

/// State of a scene that its answers are compared with.
pub struct Current {
    /// No other detector of the program has it.
    number: u64,
    /// Counts what may move bodies.
    moves: u64,
    /// Names of all bodies by their numbers, once an answer has them.
    names: Option<Arc<Vec<String>>>,
}

/// How many detectors were made.
static MADE: AtomicU64 = AtomicU64::new(0);

impl Current {
    pub fn new() -> Current {
        Current { number: MADE.fetch_add(1, Ordering::Relaxed), moves: 0, names: None }
    }

    /// Counts a call, and returns whether it may move bodies.
    pub fn count(&mut self, does: Does) -> bool {
        if does == Does::Edits {
            self.names = None;
        }
        let may_move = matches!(does, Does::Moves | Does::Edits | Does::Submits);
        self.moves += u64::from(may_move);
        may_move
    }

    /// Names of all bodies by their numbers.
    pub fn names(&mut self, of: &Scene) -> Arc<Vec<String>> {
        let made = || Arc::new(of.bodies().iter().map(|body| body.name().to_owned()).collect());
        self.names.get_or_insert_with(made).clone()
    }

    /// The stamp of the current answer.
    pub fn stamp(&self) -> Stamp {
        Stamp { detector: self.number, moves: self.moves }
    }

    /// Refuses answers of another detector, and of places where bodies no longer are.
    pub fn check(&self, of: Stamp) -> Result<(), Error> {
        let what = match of {
            stamp if stamp == self.stamp() => return Ok(()),
            Stamp { detector, .. } if detector == self.number => {
                "the answer was found before bodies moved, came or went"
            }
            _ => "the answer is of another detector",
        };
        let advice = "use an answer with the detector that found it, before the next update";
        Err(Error::InvalidArgument { what: what.into(), advice: advice.into() })
    }
}

/// A detector on one device, or on several.
pub trait Detects {
    fn is_prepared(&self) -> bool;
    fn scene(&self) -> &Scene;
}

impl Detects for nearmiss::Detector {
    fn is_prepared(&self) -> bool {
        nearmiss::Detector::is_prepared(self)
    }

    fn scene(&self) -> &Scene {
        nearmiss::Detector::scene(self)
    }
}

impl Detects for nearmiss::MultiDetector {
    fn is_prepared(&self) -> bool {
        nearmiss::MultiDetector::is_prepared(self)
    }

    fn scene(&self) -> &Scene {
        nearmiss::MultiDetector::scene(self)
    }
}

/// A detector that one thread at a time uses.
pub struct Asked<D = nearmiss::Detector> {
    pub detector: D,
    /// Whether the device may still read arrays when a call has ended.
    reads_later: bool,
    current: Current,
    /// Counts what may move the answer that lies on the device.
    pub asked: u64,
    /// Queries that were collected since bodies last moved.
    collected: Vec<nearmiss::Query>,
    /// Keeps the arrays of updates that a GPU may still read, until a call waits.
    pub placing: Vec<Held>,
    /// Arrays that submissions read. Dropped after the detector, which reads them.
    pub held: Vec<Held>,
}

impl<D: Detects> Asked<D> {
    pub fn new(detector: D, reads_later: bool) -> Asked<D> {
        Asked {
            detector,
            reads_later,
            current: Current::new(),
            asked: 0,
            collected: Vec::new(),
            placing: Vec::new(),
            held: Vec::new(),
        }
    }

    /// Arrays that no submission reads any longer.
    pub fn unread(&mut self) -> Vec<Held> {
        if self.detector.is_prepared() { Vec::new() } else { std::mem::take(&mut self.held) }
    }

    /// A call has placed bodies from these arrays, and has waited for the device or not. Returns the arrays that nothing reads any longer.
    ///
    /// A call that failed may have launched work on a GPU. A CPU has read them.
    pub fn read(&mut self, arrays: Vec<Held>, has_waited: bool) -> Vec<Held> {
        let mut unread = self.unread();
        if has_waited || !self.reads_later {
            unread.extend(arrays);
            unread.append(&mut self.placing);
            return unread;
        }
        self.placing.append(&mut unread);
        self.placing.extend(arrays);
        Vec::new()
    }

    /// Prepares submissions that read these arrays. Returns the arrays that nothing reads any longer too.
    pub fn prepare(
        &mut self,
        held: Vec<Held>,
        prepare: impl FnOnce(&mut D) -> Result<(), Error>,
    ) -> (Result<(), Error>, Vec<Held>) {
        self.count(Does::Moves);
        let done = prepare(&mut self.detector);
        // A refusal may leave it as it was prepared before.
        let as_before = done.is_err() && self.detector.is_prepared();
        let unheld = if as_before { held } else { std::mem::replace(&mut self.held, held) };
        let unread = self.read(unheld, done.is_ok());
        (done, unread)
    }

    /// Whether the answer that was on the device after so many calls still is there.
    pub fn has_answer(&self, asked: u64) -> bool {
        self.detector.is_prepared() && self.asked == asked
    }

    /// Counts a call.
    pub fn count(&mut self, does: Does) {
        self.asked += u64::from(matches!(does, Does::Moves | Does::Edits | Does::Queries));
        // A recording may have moved bodies since the query was collected.
        let again = matches!(does, Does::Collects(query) if self.collected.contains(&query));
        if self.current.count(if again { Does::Moves } else { does }) {
            self.collected.clear();
        }
        if let Does::Collects(query) = does {
            self.collected.push(query);
        }
    }

    /// Names of all bodies by their numbers.
    pub fn names(&mut self) -> Arc<Vec<String>> {
        self.current.names(self.detector.scene())
    }

    /// The stamp of the current answer.
    pub fn stamp(&self) -> Stamp {
        self.current.stamp()
    }

    /// As [`Current::check`].
    pub fn check(&self, of: Stamp) -> Result<(), Error> {
        self.current.check(of)
    }
}
