//! Repeats one stage on the results of the last frame: for profilers and for timings of one stage.

use super::query::QueryMemory;
use super::scene::SceneMemory;
use super::{Pipeline, Step, TypedPipeline};
use crate::error::Error;
use crate::pipeline::counts::Counts;
use crate::pipeline::precision::Precision;
use crate::stages::Stage;

/// Repetition of stages on the results of the last frame.
pub trait Again {
    /// Returns the milliseconds of each of `times` runs of a stage. Its input must exist: volumes
    /// of the leaves for `Refit`; a whole frame of the query, the last one, for `Traverse`,
    /// `Narrow` and `Order`. See [`crate::research::DetectorExt::repeat_stage`].
    ///
    /// # Errors
    /// Device errors.
    fn repeat(&mut self, query: usize, stage: Stage, times: u32) -> Result<Vec<f64>, Error>;
    /// Repeats the narrow stage, step by step; returns names and milliseconds. See
    /// [`crate::Detector::narrow_steps`].
    ///
    /// # Errors
    /// Device errors.
    fn narrow_steps(&mut self, query: usize) -> Result<Vec<(&'static str, f64)>, Error>;
}

impl<R: Precision> Again for TypedPipeline<R> {
    fn repeat(&mut self, query: usize, stage: Stage, times: u32) -> Result<Vec<f64>, Error> {
        self.submission = None;
        if stage == Stage::Construct {
            return (0..times).map(|_| self.construct(query)).collect();
        }
        self.queries[query].repeat(&mut self.scene, stage, times)
    }

    fn narrow_steps(&mut self, query: usize) -> Result<Vec<(&'static str, f64)>, Error> {
        let (own, scene) = (&mut self.queries[query], &mut self.scene);
        let counters = own.counters_before(scene, Stage::Narrow);
        own.counters.write(&counters)?;
        let mut all = Vec::new();
        for (at, name) in own.narrow.steps().into_iter().enumerate() {
            let start = scene.device.event()?;
            own.step(scene, Step::Narrow(at, false))?;
            all.push((name, start.to(&scene.device.event()?)?));
        }
        Ok(all)
    }
}

impl<R: Precision> QueryMemory<R> {
    fn repeat(&mut self, scene: &mut SceneMemory<R>, stage: Stage, times: u32) -> Result<Vec<f64>, Error> {
        if stage == Stage::Order && self.narrow.ordered().is_empty() {
            return Ok(Vec::new());
        }
        let counters = self.counters_before(scene, stage);
        if stage == Stage::Traverse {
            // A walk that continues from the frame's own end may need other lists: they grow before
            // the timing.
            self.settled = false;
            self.counters.write(&counters)?;
            self.run(scene, stage)?;
            self.settled = true;
        }
        let mut ms = Vec::new();
        for _ in 0..times {
            if matches!(stage, Stage::Traverse | Stage::Narrow | Stage::Order) {
                self.counters.write(&counters)?;
            }
            if stage == Stage::Order {
                self.clear_order(scene)?;
            }
            let start = scene.device.event()?;
            self.run(scene, stage)?;
            ms.push(start.to(&scene.device.event()?)?);
        }
        Ok(ms)
    }

    /// Returns the counters at the start of a stage: those of the last frame, without the stage's
    /// own counts.
    fn counters_before(&mut self, scene: &mut SceneMemory<R>, stage: Stage) -> Counts {
        let mut counters = Counts::default();
        if matches!(stage, Stage::Narrow | Stage::Order) {
            counters.clone_from(&self.last);
            let steps = if stage == Stage::Order { 0..0 } else { self.narrow_steps_at() };
            for at in steps {
                let lists = self.narrow.lists(at, &mut scene.features);
                lists.iter().for_each(|list| counters[list.counter()] = 0);
            }
            self.narrow.ordered().iter().for_each(|list| counters[list.counter()] = 0);
        }
        counters
    }
}
