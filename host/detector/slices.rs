//! A frame in slices, where the lists of a whole one would outgrow the memory: share after share of the tiles, on one device.

use super::{Detector, contacts};
use crate::contacts::Contacts;
use crate::error::Error;
use crate::pipeline::{Layout, Pipeline, Seen, Share};
use crate::query::Broad;
use nearmiss_kernels::bvh::tiles::TILE;

/// What a frame came to, and what was seen of positions in memory of the caller.
type Answered = (Contacts, Option<Seen>);

impl Detector {
    /// The pipeline, with memory for a slice where there is none for all; see [`Detector::one_pipeline`].
    ///
    /// # Errors
    /// [`Error::OutOfMemory`] where there is none for a tile at once; those of the device.
    pub(super) fn begun(&mut self) -> Result<Option<&mut Box<dyn Pipeline>>, Error> {
        while let Err(error) = self.one_pipeline() {
            self.slice_finer(error)?;
        }
        Ok(self.pipeline.as_mut())
    }

    /// The share that is asked at once, first.
    pub(super) fn first_slice(&self) -> Share {
        self.share.slice(0, self.slices)
    }

    /// A frame, slice after slice; `None` where nothing can meet.
    ///
    /// # Errors
    /// As of [`Detector::begun`].
    pub(super) fn ask(&mut self, layout: &Layout) -> Result<Option<Answered>, Error> {
        loop {
            if self.begun()?.is_none() {
                return Ok(None);
            }
            match self.every_slice(layout) {
                Ok(answered) => return answered,
                Err(error) => self.slice_finer(error)?,
            }
        }
    }

    /// All slices; the outer error is the device's, the inner that of bringing the answer.
    fn every_slice(&mut self, layout: &Layout) -> Result<Result<Option<Answered>, Error>, Error> {
        let (mut all, mut seen) = (Vec::new(), None);
        let device = self.device.clone();
        let looks = device.looks();
        self.work_of_tiles.clear();
        for k in 0..self.slices {
            let Some(pipeline) = &mut self.pipeline else { return Ok(Ok(None)) };
            if self.slices > 1 {
                pipeline.take(self.share.slice(k, self.slices))?;
            }
            pipeline.after(all.iter().map(|slice: &Contacts| slice.len() as u64).sum());
            let (found, stages) = pipeline.frame()?;
            seen = found.seen;
            match contacts(found, stages, layout, &looks) {
                Ok(found) => all.push(found),
                Err(error) => return Ok(Err(error)),
            }
            if self.slices > 1 && self.share != Share::WHOLE {
                let work = pipeline.work()?;
                self.work_of_tiles.resize(work.len(), 0);
                self.work_of_tiles.iter_mut().zip(work).for_each(|(all, slice)| *all += slice);
            }
        }
        let whole = Contacts::merged(all, |a, b| a + b, &looks);
        if looks.ended() {
            return Ok(Err(Error::Interrupted));
        }
        Ok(Ok(whole.map(|whole| (Contacts { slices: self.slices, ..whole }, seen))))
    }

    /// Twice as many slices, with memory for one of them, if that is what is short.
    ///
    /// # Errors
    /// The one before, where it is another, and where work cannot be divided further; those of the device.
    fn slice_finer(&mut self, error: Error) -> Result<(), Error> {
        let tiles = self.layout()?.moving_triangles().div_ceil(TILE as usize) as u64;
        let by_tiles = self.query.broad_on(self.device.is_gpu()) == Broad::Tiles;
        let is_short = matches!(error, Error::OutOfMemory { .. });
        if !is_short || !by_tiles || u64::from(self.slices) >= tiles {
            return Err(error);
        }
        if self.pipeline.is_some() {
            // What only the device knows comes back before its memory goes.
            self.fetch()?;
            self.pipeline = None;
        }
        self.slices *= 2;
        Ok(())
    }
}
