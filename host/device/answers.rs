//! Room for answers in the host's memory.

use super::Device;
use std::sync::atomic::Ordering;

impl Device {
    /// The same machine, whose answers have at most `bytes` of rows in the host's memory; of its
    /// clones too. A larger answer is
    /// [refused](crate::Error::AnswerTooLarge) as soon as it is counted. Without this the host's
    /// free memory is the limit.
    pub fn limited_answers(self, bytes: u64) -> Device {
        self.usage.answers.store(bytes, Ordering::Relaxed);
        self
    }

    /// Most bytes of the rows of one answer.
    pub(crate) fn answers(&self) -> u64 {
        self.usage.answers.load(Ordering::Relaxed)
    }
}
