//! Stages of a frame that run once more, alone: for profilers.

use super::Detector;
use crate::error::Error;
use crate::pipeline::Stage;

impl Detector {
    /// Runs one stage of this frame `times` times, on the device alone, and gives each run's milliseconds: for profilers,
    /// and for figures of one stage. What the stage needs runs before, once, where it has not yet: the leaves' volumes for
    /// [`Stage::Refit`], a whole frame for [`Stage::Traverse`], [`Stage::Narrow`] and
    /// [`Stage::Order`]. The next [`Detector::detect`] answers as it would have. Where nothing can meet there are no stages, and a CPU orders nothing: no runs.
    ///
    /// # Errors
    /// Those of the device.
    pub fn repeat_stage(&mut self, stage: Stage, times: u32) -> Result<Vec<f64>, Error> {
        let milliseconds = self.repeated(stage, times);
        self.ended(milliseconds)
    }

    fn repeated(&mut self, stage: Stage, times: u32) -> Result<Vec<f64>, Error> {
        let is_answered = self.engine.is_answered;
        if !is_answered && matches!(stage, Stage::Traverse | Stage::Narrow | Stage::Order) {
            self.detect()?;
        }
        let is_answered = self.engine.is_answered;
        let Some(pipeline) = self.begun()? else { return Ok(Vec::new()) };
        if !is_answered && stage == Stage::Refit {
            pipeline.repeat(Stage::Fit, 1)?;
        }
        let milliseconds = pipeline.repeat(stage, times)?;
        if stage == Stage::Construct {
            self.engine.is_answered = false;
            self.engine.construct_ms = milliseconds.last().copied().unwrap_or(self.engine.construct_ms);
            self.engine.count_build();
        }
        Ok(milliseconds)
    }

    /// Runs the narrow stage of this frame once more, step by step: each step's name and milliseconds on the device's own
    /// clock. A frame must have been asked; where nothing can meet there are no steps.
    ///
    /// # Errors
    /// Those of the device.
    pub fn narrow_steps(&mut self) -> Result<Vec<(&'static str, f64)>, Error> {
        if !self.engine.is_answered {
            self.detect()?;
        }
        let pipeline = self.engine.pipeline.as_mut();
        let steps = pipeline.map_or(Ok(Vec::new()), |pipeline| pipeline.narrow_steps());
        self.ended(steps)
    }
}
