//! The second pass of a submission, for the contacts at the earliest time. Its lists have counters of
//! their own, and grow as those of the frame do.

use super::query::QueryMemory;
use super::scene::SceneMemory;
use crate::error::Error;
use crate::pipeline::counts::Counts;
use crate::pipeline::list::GrowableOutput;
use crate::pipeline::precision::Precision;
use crate::pipeline::purpose;
use nearmiss_kernels::abi::Room;

/// Returns the room of a list.
pub(super) fn room(list: &&mut dyn GrowableOutput) -> Room {
    Room { entries: list.room(), counter: list.counter(), pad: 0 }
}

impl<R: Precision> QueryMemory<R> {
    /// Returns the room of every list that the second pass fills.
    pub(super) fn rooms_of_second(&mut self) -> Vec<Room> {
        self.narrow.lists_of_second().iter().map(room).collect()
    }

    /// Launches the second pass; nothing without one.
    ///
    /// # Errors
    /// Device errors.
    pub(super) fn second(&mut self, scene: &SceneMemory<R>) -> Result<(), Error> {
        let given = self.given(scene, false);
        self.narrow.second(&given)
    }

    /// Returns the counters of the second pass if one of its lists was too short. Waits.
    ///
    /// # Errors
    /// Device errors.
    pub(super) fn short_of_second(&mut self) -> Result<Option<Counts>, Error> {
        let Some(counters) = self.narrow.counters_of_second() else { return Ok(None) };
        let counts = counters.read()?;
        let is_short = self.narrow.lists_of_second().iter().any(|list| list.has_overflowed(&counts));
        Ok(is_short.then_some(counts))
    }

    /// Grows the lists of the second pass by their demand.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`] of the first list without room.
    pub(super) fn grow_second(&mut self, scene: &SceneMemory<R>, counts: &Counts) -> Result<(), Error> {
        let device = scene.device.of(purpose::WALK);
        self.narrow.lists_of_second().into_iter().try_for_each(|list| list.grow(&device, counts).map(drop))
    }
}
