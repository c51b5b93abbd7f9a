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

    /// What its machine calls itself.
    pub(crate) fn machine(&self) -> String {
        self.device.name()
    }
}
