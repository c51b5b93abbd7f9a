//! Stages of a frame that run again alone, for profilers.

use super::Detector;
use super::question::Question;
use crate::device::emulator::start_threads;
use crate::error::Error;
use crate::pipeline::{Pipeline, Stage};
use crate::query::Query;
use std::time::Instant;

impl Detector {
    /// Makes frames on this device mark the time of each stage, or not.
    pub(crate) fn time_stages(&mut self, are_timed: bool) {
        self.device.time_stages(are_timed);
    }

    /// Runs one stage of a query's frame `times` times on the device, for profilers and for figures
    /// of one stage. Returns the milliseconds of each run. Inputs of the stage are computed first,
    /// once, if they are missing. [`Stage::Refit`] needs the leaves' volumes; [`Stage::Traverse`],
    /// [`Stage::Narrow`] and [`Stage::Order`] need a whole frame. No answer changes. There are no
    /// runs if nothing can meet, and none of ordering on a CPU.
    ///
    /// # Errors
    /// Those of the device.
    pub(crate) fn repeat_stage(
        &mut self,
        query: &Query,
        stage: Stage,
        times: u32,
    ) -> Result<Vec<f64>, Error> {
        let milliseconds = self.repeated(query, stage, times);
        self.ended(milliseconds)
    }

    fn repeated(&mut self, query: &Query, stage: Stage, times: u32) -> Result<Vec<f64>, Error> {
        let query = self.query_of_answer(query)?;
        let question = self.question(query)?;
        if matches!(stage, Stage::Traverse | Stage::Narrow | Stage::Order) {
            self.have_answered(&question)?;
        }
        let is_answered = self.engine.answered == Some(question.query);
        let Some(at) = self.begun(&question)? else { return Ok(Vec::new()) };
        let Some(pipeline) = &mut self.engine.pipeline else { return Ok(Vec::new()) };
        if !is_answered && stage == Stage::Refit {
            pipeline.repeat(at, Stage::Fit, 1)?;
        }
        let milliseconds = pipeline.repeat(at, stage, times)?;
        if stage == Stage::Construct {
            self.engine.count_build(milliseconds.last().copied().unwrap_or(self.engine.construct_ms));
        }
        Ok(milliseconds)
    }

    /// Runs the narrow stage of a query's frame again, step by step. Returns each step's name and
    /// milliseconds by the device's clock; no steps if nothing can meet.
    ///
    /// # Errors
    /// Those of the device.
    pub(crate) fn narrow_steps(&mut self, query: &Query) -> Result<Vec<(&'static str, f64)>, Error> {
        let of_answer = self.query_of_answer(query);
        let query = self.ended(of_answer)?;
        let question = self.question(query)?;
        let steps = self
            .have_answered(&question)
            .and_then(|()| self.of_query(&query, Vec::new(), |pipeline, at| pipeline.narrow_steps(at)));
        self.ended(steps)
    }

    /// Runs a frame of a query, unless the device holds its answer.
    fn have_answered(&mut self, question: &Question) -> Result<(), Error> {
        if self.engine.answered == Some(question.query) {
            return Ok(());
        }
        self.answer_once(question, Instant::now()).map(drop)
    }

    /// Calls a function with a query's place in the pipeline; returns `none` if it has no place.
    pub(super) fn of_query<T>(
        &mut self,
        query: &Query,
        none: T,
        what: impl FnOnce(&mut dyn Pipeline, usize) -> Result<T, Error>,
    ) -> Result<T, Error> {
        start_threads()?;
        let query = self.query_of_frame(query);
        let Some(pipeline) = &mut self.engine.pipeline else { return Ok(none) };
        match pipeline.place_of(&query) {
            Some(at) => what(&mut **pipeline, at),
            None => Ok(none),
        }
    }
}
