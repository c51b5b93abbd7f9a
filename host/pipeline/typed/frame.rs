//! All launches of a frame, and the times of its stages.

use super::Found;
use super::query::QueryMemory;
use super::scene::SceneMemory;
use crate::device::{Device, Marks, Replay};
use crate::error::Error;
use crate::pipeline::broad::Which;
use crate::pipeline::precision::Precision;
use crate::stages::{Stage, Stages};
use std::time::Instant;

/// The time marks of a frame.
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

impl Mark {
    /// Returns whether every frame passes it; others are for the times of stages.
    fn is_always_passed(self) -> bool {
        matches!(self, Mark::Begun | Mark::Found | Mark::Ordered)
    }
}

/// Returns an empty record of launches, with the marks of a frame.
///
/// # Errors
/// Device errors.
pub fn replay(device: &Device) -> Result<Replay, Error> {
    Replay::new(device, Mark::Ordered as usize + 1)
}

impl<R: Precision> QueryMemory<R> {
    /// Runs one frame: see [`Pipeline::frame`](super::Pipeline::frame).
    ///
    /// # Errors
    /// Device errors.
    pub(super) fn frame<'a>(&'a mut self, scene: &mut SceneMemory<R>) -> Result<(Found<'a>, Stages), Error> {
        let reruns = self.reruns;
        self.launch_ms = 0.0;
        let mut fits = true;
        loop {
            scene.device.goes_on()?;
            self.launch(scene, fits)?;
            fits = false;
            self.read_ahead(scene)?;
            let counters = self.counters.read()?;
            self.demand.counted(&counters, &scene.device)?;
            if self.has_overflowed(scene, &counters) {
                // Some list is too short: run step by step to find it.
                self.settled = false;
                self.reruns += 1;
                continue;
            }
            self.settled = true;
            scene.broads[self.broad].phase.finish(&counters)?;
            let stages = self.marked(scene)?;
            self.last.clone_from(&counters);
            return Ok((self.gather(scene, counters, self.reruns - reruns)?, stages));
        }
    }

    /// Launches a frame, with its marks. Unless `fits`, the volumes were already fitted in this
    /// frame.
    fn launch(&mut self, scene: &mut SceneMemory<R>, fits: bool) -> Result<(), Error> {
        let (device, mut replay) = (scene.device.clone(), std::mem::take(&mut self.replay));
        let start = Instant::now();
        let is_listed = self.settled && scene.broads[self.broad].phase.without_host().is_ok();
        let frame = |marks: &mut Marks| self.stages(scene, fits, marks);
        device.wake();
        let done = if is_listed {
            // SAFETY: settled stages launch and clear; they keep the memory that they hold.
            unsafe { replay.run(&device, frame) }
        } else {
            replay.straight(&device, frame)
        };
        self.replay = replay;
        self.launch_ms += start.elapsed().as_secs_f64() * 1e3;
        done
    }

    /// Launches the traversal.
    ///
    /// # Errors
    /// Device errors.
    pub(super) fn traverse(&mut self, scene: &mut SceneMemory<R>, which: Which) -> Result<(), Error> {
        scene.traverse(self, (which, self.counters.counters()))
    }

    fn stages(&mut self, scene: &mut SceneMemory<R>, fits: bool, marks: &mut Marks) -> Result<(), Error> {
        let times_stages = scene.device.times_stages();
        let mut pass = |mark: Mark| {
            if times_stages || mark.is_always_passed() { marks.pass(mark as usize) } else { Ok(()) }
        };
        scene.device.beside(|| self.counters.clear())?;
        if fits {
            pass(Mark::Begun)?;
            self.run(scene, Stage::Fit)?;
            pass(Mark::Fitted)?;
            self.run(scene, Stage::Refit)?;
            pass(Mark::Refitted)?;
        }
        scene.device.join();
        self.clear_order(scene)?;
        pass(Mark::Walks)?;
        self.run(scene, Stage::Traverse)?;
        pass(Mark::Walked)?;
        self.run(scene, Stage::Narrow)?;
        pass(Mark::Found)?;
        scene.device.join();
        self.run(scene, Stage::Order)?;
        pass(Mark::Ordered)
    }

    /// Returns the times of the stages, from their marks; waits for them.
    fn marked(&mut self, scene: &mut SceneMemory<R>) -> Result<Stages, Error> {
        let balance = scene.broads[self.broad].phase.balance_ms()?;
        let mut place = 0.0;
        for [start, end] in scene.placing.drain(..) {
            place += start.to(&end)?;
        }
        let ms = |from: Mark, to: Mark| self.replay.ms(from as usize, to as usize);
        let times_stages = scene.device.times_stages();
        let of = |from: Mark, to: Mark| if times_stages { ms(from, to) } else { Ok(0.0) };
        Ok(Stages {
            place,
            construct: 0.0,
            fit: of(Mark::Begun, Mark::Fitted)?,
            refit: of(Mark::Fitted, Mark::Refitted)?,
            traverse: (of(Mark::Walks, Mark::Walked)? - balance).max(0.0),
            balance,
            narrow: of(Mark::Walked, Mark::Found)?,
            order: if self.narrow.ordered().is_empty() { 0.0 } else { ms(Mark::Found, Mark::Ordered)? },
            total: ms(Mark::Begun, Mark::Found)?,
            launch: if scene.device.is_gpu() { self.launch_ms } else { 0.0 },
            wall: 0.0,
        })
    }
}
