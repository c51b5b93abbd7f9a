//! A part of the work, where other devices do the rest.

use super::Detector;
use crate::error::Error;
use crate::pipeline::Share;

/// A detector's part of the work, and in how many slices it is asked.
pub struct Portion {
    /// Its share, where other devices do the rest.
    pub share: Share,
    /// How many slices a frame has.
    pub slices: u32,
    /// The cost of each tile in the last frame in several slices, where there are several shares.
    pub work_of_tiles: Vec<u64>,
    /// Whether a [`MultiDetector`](crate::MultiDetector) runs it.
    pub is_part: bool,
}

impl Portion {
    /// A share, at once.
    pub fn new(share: Share) -> Portion {
        Portion { share, slices: 1, work_of_tiles: Vec::new(), is_part: false }
    }

    /// The share that is asked at once, first.
    pub fn first_slice(&self) -> Share {
        self.slice(0)
    }

    /// The share of a slice.
    pub fn slice(&self, slice: u32) -> Share {
        self.share.slice(slice, self.slices)
    }

    /// Adds the cost of a slice's tiles.
    pub fn add_work(&mut self, work: Vec<u64>) {
        self.work_of_tiles.resize(work.len(), 0);
        self.work_of_tiles.iter_mut().zip(work).for_each(|(all, slice)| *all += slice);
    }
}

impl Detector {
    /// From the next frame on it finds what is its share.
    ///
    /// # Errors
    /// [`Error::Choice`] where work cannot be divided; those of the device.
    pub(crate) fn take(&mut self, share: Share) -> Result<(), Error> {
        (self.portion.share, self.engine.is_answered) = (share, false);
        let slice = self.portion.first_slice();
        self.engine.pipeline.as_mut().map_or(Ok(()), |pipeline| pipeline.take(slice))
    }

    /// The cost of each tile of its share in the last frame, by tile; empty if nothing can meet.
    ///
    /// # Errors
    /// Those of the device.
    pub(crate) fn tile_work(&self) -> Result<Vec<u64>, Error> {
        match &self.engine.pipeline {
            Some(pipeline) if self.portion.slices == 1 => pipeline.work(),
            _ => Ok(self.portion.work_of_tiles.clone()),
        }
    }

    /// How many tiles beyond its share it met in the last frame, asked at once.
    ///
    /// # Errors
    /// Those of the device.
    pub(crate) fn met_beyond(&self) -> Result<u64, Error> {
        self.engine.pipeline.as_ref().map_or(Ok(0), |pipeline| pipeline.met_beyond())
    }

    /// Makes tiles where there are none.
    ///
    /// # Errors
    /// Those of the device.
    pub(crate) fn begin(&mut self) -> Result<(), Error> {
        let begun = self.begun().map(drop);
        self.ended(begun)
    }

    /// Triangles of what moves.
    pub(crate) fn moving_triangles(&self) -> usize {
        self.engine.last_layout().map_or(0, |layout| layout.moving_triangles())
    }

    /// The name of its machine.
    pub(crate) fn machine(&self) -> String {
        self.device.name()
    }
}
