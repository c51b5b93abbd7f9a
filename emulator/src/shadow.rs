//! The shadow of a word of four bytes: its last accesses, which may be unordered with the next one.

use crate::sanitizer::{Access, Fault, Place};

/// Two accesses of a kind. An access that races with any access of that kind races with one of the
/// two. They are of two blocks if there were two, else of two lanes in the last phase.
#[derive(Clone, Copy, Default)]
struct Pair(Option<Place>, Option<Place>);

impl Pair {
    fn note(&mut self, place: Place) {
        match (self.0, self.1) {
            // No access is in the same block as both.
            (Some(first), Some(other)) if first.block != other.block => {}
            (Some(first), _) if first.meets(place) => self.1 = Some(place),
            _ => self.0 = Some(place),
        }
    }
    fn rival(&self, place: Place) -> Option<Place> {
        [self.0, self.1].into_iter().flatten().find(|rival| rival.meets(place))
    }
}

/// The last accesses to a word, in one launch.
#[derive(Clone, Copy, Default)]
pub struct Shadow {
    written: bool,
    launch: u64,
    /// A second, unordered write is a race at once.
    write: Option<Place>,
    read: Pair,
    /// Relaxed stores, and atomics that write.
    stores: Pair,
    /// Relaxed loads, and atomics that read.
    loads: Pair,
}

impl Shadow {
    /// Marks the word as written by the host.
    pub fn host_wrote(&mut self) {
        self.written = true;
    }
    /// Adds an access by a kernel; returns the rule that it broke.
    pub fn see(&mut self, access: Access, launch: u64, place: Place) -> Option<Fault> {
        use Access::*;
        if self.launch != launch {
            *self = Shadow { written: self.written, launch, ..Shadow::default() };
        }
        if !self.written && !matches!(access, Write | StoreRelaxed) {
            return Some(Fault::Unwritten(place));
        }
        let mut rival = self.write.filter(|rival| rival.meets(place));
        match access {
            Read => {
                rival = rival.or(self.stores.rival(place));
                self.read.note(place);
            }
            Look | LoadRelaxed => self.loads.note(place),
            Atomic | Swap | StoreRelaxed => {
                rival = rival.or(self.read.rival(place));
                self.stores.note(place);
                self.written = true;
            }
            Write => {
                let others = [self.stores, self.read, self.loads];
                rival = rival.or_else(|| others.iter().find_map(|pair| pair.rival(place)));
                self.write = Some(place);
                self.written = true;
            }
        }
        rival.map(|rival| Fault::Race(rival, place))
    }
}
