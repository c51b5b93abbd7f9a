//! A part of the work, where other devices do the rest.

use super::Detector;
use crate::error::Error;
use crate::pipeline::Share;

impl Detector {
    /// From the next frame on it finds what is its share.
    ///
    /// # Errors
    /// [`Error::Choice`] where work cannot be divided; those of the device.
    pub(crate) fn take(&mut self, share: Share) -> Result<(), Error> {
        (self.share, self.answered) = (share, false);
        let slice = self.first_slice();
        self.pipeline.as_mut().map_or(Ok(()), |pipeline| pipeline.take(slice))
    }

    /// What each tile of its share cost in the last frame, of all tiles; nothing where nothing can meet.
    ///
    /// # Errors
    /// Those of the device.
    pub(crate) fn tile_work(&self) -> Result<Vec<u64>, Error> {
        match &self.pipeline {
            Some(pipeline) if self.slices == 1 => pipeline.work(),
            _ => Ok(self.work_of_tiles.clone()),
        }
    }

    /// How many tiles beyond its share it met in the last frame, asked at once.
    ///
    /// # Errors
    /// Those of the device.
    pub(crate) fn met_beyond(&self) -> Result<u64, Error> {
        self.pipeline.as_ref().map_or(Ok(0), |pipeline| pipeline.met_beyond())
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
        self.layout.as_ref().map_or(0, |layout| layout.moving_triangles())
    }

    /// What its machine calls itself.
    pub(crate) fn machine(&self) -> String {
        self.device.name()
    }
}
