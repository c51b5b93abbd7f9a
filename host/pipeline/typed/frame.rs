//! All that a frame launches, and when its stages were over.

use super::TypedPipeline;
use crate::device::{Device, Marks, Replay};
use crate::error::Error;
use crate::pipeline::broad::{Candidates, Which};
use crate::pipeline::precision::Precision;
use crate::stages::{Stage, Stages};
use nearmiss_kernels::abi::TraverseFlags;
use std::time::Instant;

/// The marks of a frame.
#[derive(Clone, Copy)]
enum Mark {
    Begun,
    Fitted,
    Refitted,
    Walks,
    Walked,
    Found,
    Ordered,
}

/// What frames launch, with their marks; nothing yet.
///
/// # Errors
/// Those of the device.
pub fn replay(device: &Device) -> Result<Replay, Error> {
    Replay::new(device, Mark::Ordered as usize + 1)
}

impl<R: Precision> TypedPipeline<R> {
    /// Starts all of a frame, with what it marks; the volumes are fitted, or were in this frame.
    pub(super) fn launch(&mut self, fits: bool) -> Result<(), Error> {
        let (device, mut replay) = (self.device.clone(), std::mem::take(&mut self.replay));
        let start = Instant::now();
        let is_listed = self.settled && self.broad.without_host().is_ok();
        let frame = |marks: &mut Marks| self.stages(fits, marks);
        let done = if is_listed {
            // SAFETY: settled stages launch and clear; what memory they hold they keep.
            unsafe { replay.run(&device, frame) }
        } else {
            replay.straight(&device, frame)
        };
        self.replay = replay;
        self.launch_ms += start.elapsed().as_secs_f64() * 1e3;
        done
    }

    /// Starts the walk.
    pub(super) fn traverse(&mut self, which: Which) -> Result<(), Error> {
        let counters = self.counters.counters();
        let candidates = Candidates {
            pairs: self.pairs.output(counters),
            counters,
            flags: TraverseFlags::KEEP_ADJACENT.when(self.query.keeps_adjacent()),
            which,
            share: self.share,
        };
        self.broadly(|broad, given, _| broad.traverse(given, &candidates))
    }

    fn stages(&mut self, fits: bool, marks: &mut Marks) -> Result<(), Error> {
        let mut pass = |mark: Mark| marks.pass(mark as usize);
        if fits {
            pass(Mark::Begun)?;
            self.run(Stage::Fit)?;
            pass(Mark::Fitted)?;
            self.run(Stage::Refit)?;
            pass(Mark::Refitted)?;
        }
        self.counters.clear()?;
        pass(Mark::Walks)?;
        self.run(Stage::Traverse)?;
        pass(Mark::Walked)?;
        self.run(Stage::Narrow)?;
        pass(Mark::Found)?;
        self.run(Stage::Order)?;
        pass(Mark::Ordered)
    }

    /// How long the stages took, by their marks; waits for them.
    pub(super) fn marked(&mut self) -> Result<Stages, Error> {
        let balance = self.broad.balance_ms()?;
        let placing = self.placing.take();
        let ms = |from: Mark, to: Mark| self.replay.ms(from as usize, to as usize);
        Ok(Stages {
            place: placing.map_or(Ok(0.0), |[start, end]| start.to(&end))?,
            construct: 0.0,
            fit: ms(Mark::Begun, Mark::Fitted)?,
            refit: ms(Mark::Fitted, Mark::Refitted)?,
            traverse: ms(Mark::Walks, Mark::Walked)? - balance,
            balance,
            narrow: ms(Mark::Walked, Mark::Found)?,
            order: if self.narrow.ordered().is_some() { ms(Mark::Found, Mark::Ordered)? } else { 0.0 },
            total: ms(Mark::Begun, Mark::Found)?,
            launch: if self.device.is_gpu() { self.launch_ms } else { 0.0 },
            wall: 0.0,
        })
    }
}
