//! Limit of the size of answers in host memory.

use super::{Device, Machine};
use std::sync::atomic::Ordering;

impl Device {
    /// The same machine, with at most `bytes` of rows in host memory for each answer. Its clones
    /// have this limit too.
    /// A larger answer is [refused](crate::Error::AnswerTooLarge) as soon as it is counted. Without
    /// this call the host's free memory is the limit.
    pub fn limited_answers(self, bytes: u64) -> Device {
        self.usage.answers.store(bytes, Ordering::Relaxed);
        self
    }

    /// Bytes of page-locked memory of earlier answers, for later ones.
    pub(crate) fn spare_rows(&self) -> u64 {
        match &*self.machine {
            Machine::Emulator(_) => 0,
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.spare(),
        }
    }

    /// Maximum bytes of the rows of one answer.
    pub(crate) fn answers(&self) -> u64 {
        self.usage.answers.load(Ordering::Relaxed)
    }
}
