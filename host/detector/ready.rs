//! The engine is made ready: memory for the bodies where they are, or for a slice, and tiles or trees that are worth keeping.

use super::Detector;
use crate::error::Error;
use crate::pipeline::{Layout, Pieces, Pipeline};
use crate::query::Broad;
#[cfg(doc)]
use crate::query::Rebuild;
use crate::scene::Body;
use nearmiss_kernels::bvh::tiles::TILE;
use std::sync::Arc;

impl Detector {
    /// Makes tiles, or the tree, over what moves anew: pays when bodies have moved far from where they were made. By itself where
    /// [`Rebuild::Auto`] allows it, the default.
    ///
    /// # Errors
    /// Those of the device.
    pub fn rebuild(&mut self) -> Result<(), Error> {
        self.device.work();
        let renewed = self.renew();
        self.ended(renewed)?;
        self.engine.build_work = self.device.work();
        Ok(())
    }

    /// How often tiles or trees were made: when the detector began, when asked, by itself where the query allows it, and whenever memory was
    /// taken anew.
    pub fn builds(&self) -> u64 {
        self.engine.builds
    }

    /// Readies the engine for a frame of the bodies where they are: every body's place is known, and tiles or trees are made anew where
    /// they are worn.
    ///
    /// # Errors
    /// [`Error::Choice`] for a body that nobody can place; those of the device.
    pub(super) fn ready(&mut self) -> Result<Arc<Layout>, Error> {
        self.engine.is_answered = false;
        self.read_again(false);
        self.none_lost()?;
        let layout = self.layout()?;
        let is_worn = self.engine.wear.is_worn(layout.moving_triangles());
        if self.question.query.search().rebuilds() && is_worn {
            self.renew()?;
        }
        Ok(layout)
    }

    /// Makes tiles or trees anew.
    fn renew(&mut self) -> Result<(), Error> {
        let Some(pipeline) = self.begun()? else { return Ok(()) };
        self.engine.construct_ms = pipeline.construct()?;
        self.engine.is_answered = false;
        self.engine.count_build();
        Ok(())
    }

    /// Where every body lies in the memory that all share.
    pub(super) fn layout(&mut self) -> Result<Arc<Layout>, Error> {
        self.engine.layout(&self.device, &self.scene, &self.question)
    }

    /// The pipeline, made where there is none, with memory for a slice where there is none for all. None is made where nothing can
    /// meet: that costs no memory and no launch.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`] where there is none for a tile at once; those of the device.
    pub(super) fn begun(&mut self) -> Result<Option<&mut Box<dyn Pipeline>>, Error> {
        while let Err(error) = self.begin_pipeline() {
            self.slice_finer(error)?;
        }
        Ok(self.engine.pipeline.as_mut())
    }

    fn begin_pipeline(&mut self) -> Result<(), Error> {
        let layout = self.layout()?;
        if self.engine.pipeline.is_some() || !layout.may_meet() {
            return Ok(());
        }
        self.all_known()?;
        let pieces = Pieces {
            layout,
            query: self.question.with_largest_tolerance(),
            share: self.portion.first_slice(),
            holds_f64: self.scene.bodies().iter().any(Body::needs_f64),
        };
        self.engine.begin(&self.device, &self.scene, pieces)
    }

    /// Twice as many slices, with memory for one of them, if that is what is short.
    ///
    /// # Errors
    /// The one before, where it is another, and where work cannot be divided further; those of the device.
    pub(super) fn slice_finer(&mut self, error: Error) -> Result<(), Error> {
        let tiles = self.layout()?.moving_triangles().div_ceil(TILE as usize) as u64;
        let by_tiles = self.question.query.broad_on(self.device.is_gpu()) == Broad::Tiles;
        let is_short = matches!(error, Error::OutOfMemory { .. });
        if !is_short || !by_tiles || u64::from(self.portion.slices) >= tiles {
            return Err(error);
        }
        if self.engine.pipeline.is_some() {
            // What only the device knows comes back before its memory goes.
            self.fetch()?;
            self.engine.pipeline = None;
        }
        self.portion.slices *= 2;
        Ok(())
    }
}
