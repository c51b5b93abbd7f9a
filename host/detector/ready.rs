//! Prepares the engine: memory for the bodies and for a query or its slice, and tiles or trees.

use super::Detector;
use super::question::Question;
use crate::device::emulator::start_threads;
use crate::error::Error;
use crate::pipeline::Layout;
#[cfg(doc)]
use crate::query::Rebuild;
use crate::query::{BroadPhase, Query};
use nearmiss_kernels::bvh::tiles::TILE;
use std::sync::Arc;

impl Detector {
    /// Takes the memory that a query needs and builds its tiles or trees, ahead of the first
    /// [`Detector::query`].
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for invalid numbers; those of the device.
    pub fn begin(&mut self, query: &Query) -> Result<(), Error> {
        let question = self.question(self.query_of_frame(query))?;
        let begun = self.begun(&question).map(drop);
        self.ended(begun)
    }

    /// Rebuilds tiles and trees over moving bodies. It pays when bodies have moved far since the
    /// last build. With [`Rebuild::Auto`], the default, queries rebuild when it pays.
    ///
    /// # Errors
    /// Those of the device.
    pub fn rebuild(&mut self) -> Result<(), Error> {
        self.device.work();
        let rebuilt = self.rebuild_all();
        self.ended(rebuilt)?;
        self.engine.build_work = self.device.work();
        Ok(())
    }

    fn rebuild_all(&mut self) -> Result<(), Error> {
        start_threads()?;
        self.read_again(false);
        self.none_lost()?;
        let Some(pipeline) = &mut self.engine.pipeline else { return Ok(()) };
        let built = pipeline.construct_all()?;
        built.into_iter().for_each(|ms| self.engine.count_build(ms));
        Ok(())
    }

    /// Number of builds of tiles or trees. They are built for the first query that needs them, on
    /// request, and after memory was taken again. With [`Rebuild::Auto`] they are also built if it
    /// pays.
    pub fn builds(&self) -> u64 {
        self.engine.builds
    }

    /// Prepares the engine for a frame at the current positions, all of which are known.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a body with an unknown position; those of the device.
    pub(super) fn ready(&mut self, query: &Query) -> Result<Arc<Layout>, Error> {
        self.engine.answered = None;
        self.read_again(false);
        self.none_lost()?;
        self.layout(query)
    }

    /// Returns the layout of a query: the place of every body in the shared memory. Every call
    /// begins here, so a forked process is refused here.
    pub(super) fn layout(&mut self, query: &Query) -> Result<Arc<Layout>, Error> {
        start_threads()?;
        self.engine.layouts.of(&self.device, &self.scene, query)
    }

    /// Returns a layout of the current bodies by which something may meet, if there is one. A query
    /// can see less than others: a distance query does not test a body against itself. A discrete
    /// query sees all that may meet.
    pub(super) fn any_layout(&mut self) -> Result<Arc<Layout>, Error> {
        match self.engine.layouts.meeting() {
            Some(layout) => Ok(layout.clone()),
            None => self.layout(&Query::discrete()),
        }
    }

    /// Returns the place of a query in the pipeline, and makes one if there is none. It has memory
    /// for a slice if all does not fit. `None` if nothing can meet: that costs no memory and no
    /// launch.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`] if a single tile does not fit; those of the device.
    pub(super) fn begun(&mut self, question: &Question) -> Result<Option<usize>, Error> {
        loop {
            match self.begin_query(question) {
                Ok(place) => return Ok(place),
                Err(error) => self.slice_finer(error, &question.query)?,
            }
        }
    }

    fn begin_query(&mut self, question: &Question) -> Result<Option<usize>, Error> {
        let layout = self.layout(&question.query)?;
        if !layout.may_meet() {
            return Ok(None);
        }
        let in_motion = !question.query.kind().is_at_rest();
        if in_motion && !self.engine.has_ends {
            // A pipeline of queries at rest has no room for the end of the step.
            self.leave_pipeline()?;
            self.engine.has_ends = true;
        }
        let is_of_instances = self.reads_instances(&question.query)?;
        self.begin_scene()?;
        let (bodies, slice) = (self.scene.bodies(), self.portion.first_slice(&question.query));
        let Some(pipeline) = &mut self.engine.pipeline else { return Ok(None) };
        let moving = layout.moving_triangles();
        let at = pipeline.take_query(&question.parts(layout, slice, is_of_instances))?;
        let is_first = pipeline.ready(at, bodies)?;
        let is_worn = question.query.search().rebuilds() && pipeline.wear(at).is_worn(moving);
        if is_first || is_worn {
            let ms = pipeline.construct(at)?;
            self.engine.count_build(ms);
        }
        if is_first {
            self.engine.build_work = self.device.work();
        }
        Ok(Some(at))
    }

    /// Drops the pipeline. Positions that only the device has are downloaded before its memory is freed.
    ///
    /// # Errors
    /// As of [`Detector::download_positions`].
    pub(super) fn leave_pipeline(&mut self) -> Result<(), Error> {
        self.download_positions()?;
        self.engine.drop_pipeline();
        Ok(())
    }

    /// Takes the memory of the scene, if there is none and something may meet.
    pub(super) fn begin_scene(&mut self) -> Result<(), Error> {
        let layout = self.any_layout()?;
        if self.engine.pipeline.is_some() || !layout.may_meet() {
            return Ok(());
        }
        self.all_known()?;
        self.choose_instances();
        self.engine.begin(&self.device, &self.scene, layout)
    }

    /// Doubles the slices of a query, with memory for one of them, if memory is short.
    ///
    /// # Errors
    /// The given error, if it is another, or if work cannot be divided further; those of the
    /// device.
    pub(super) fn slice_finer(&mut self, error: Error, query: &Query) -> Result<(), Error> {
        let tiles = self.layout(query)?.moving_triangles().div_ceil(TILE as usize) as u64;
        let by_tiles = query.broad_phase_on(self.device.is_gpu()) == BroadPhase::Tiles;
        let is_short = matches!(error, Error::OutOfMemory { .. });
        if !is_short
            || !by_tiles
            || query.kind().is_of_bodies()
            || u64::from(self.portion.slices(query)) >= tiles
        {
            if is_short {
                // Some lists have grown and others have not.
                self.begin_again();
            }
            return Err(error);
        }
        if self.engine.pipeline.is_some() {
            self.leave_pipeline()?;
        }
        self.portion.slice_finer(query);
        Ok(())
    }
}
