//! The whole catalogue on one machine.

use super::{
    Crowds, Report, ask_built, ask_crowds, ask_questions, ask_refits, ask_refused, ask_scenes,
    ask_turned_questions, ask_turned_scenes, questions, refused, scenes,
};
use nearmiss::device::Device;
use nearmiss::error::Error;

/// Sizes of the suites that have no natural size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Amount {
    /// Built contacts of each family.
    pub cases: usize,
    /// Frames that a tree is refitted to.
    pub frames: u32,
    /// The crowds.
    pub crowds: Crowds,
}

impl Amount {
    /// Returns an amount that takes a machine about a minute, with so many built contacts per
    /// family.
    pub fn on(is_gpu: bool, cases: usize) -> Amount {
        let (frames, crowds) = if is_gpu { (10_000, Crowds::FULL) } else { (1_000, Crowds::SMALL) };
        Amount { cases, frames, crowds }
    }
}

/// Runs every suite and passes each report on when it ends.
///
/// # Errors
/// Device errors.
pub fn run(device: &Device, amount: Amount, mut ended: impl FnMut(&Report)) -> Result<Vec<Report>, Error> {
    let (questions, scenes) = (questions(), scenes());
    let mut all = Vec::new();
    let mut note = |report: Report| {
        ended(&report);
        all.push(report);
    };
    note(ask_refused(device, &refused())?);
    note(ask_questions(device, &questions)?);
    note(ask_turned_questions(device, &questions)?);
    note(ask_scenes(device, &scenes)?);
    note(ask_turned_scenes(device, &scenes)?);
    note(ask_built(device, amount.cases, |met| met)?);
    note(ask_refits(device, amount.frames)?);
    note(ask_crowds(device, amount.crowds)?);
    Ok(all)
}
