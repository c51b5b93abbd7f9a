//! Part of the work, if other devices do the rest.

use super::Detector;
use crate::error::Error;
use crate::pipeline::Share;
use crate::query::Query;

/// A detector's part of the work, and the number of slices of each query.
pub struct Portion {
    /// Share of the tiles, if other devices do the rest.
    pub share: Share,
    /// Slices of a frame, for shapes of queries that need more than one.
    slices: Vec<(Query, u32)>,
    /// Cost of each tile in the last frame in several slices, if there are several shares.
    pub work_of_tiles: Vec<u64>,
    /// Whether a [`MultiDetector`](crate::MultiDetector) runs it.
    pub is_part: bool,
}

impl Portion {
    /// A share without slices.
    pub fn new(share: Share) -> Portion {
        Portion { share, slices: Vec::new(), work_of_tiles: Vec::new(), is_part: false }
    }

    /// Number of slices of a query's frame.
    pub fn slices(&self, query: &Query) -> u32 {
        let shape = query.shape();
        self.slices.iter().find(|(own, _)| *own == shape).map_or(1, |(_, slices)| *slices)
    }

    /// Doubles the number of slices of a query.
    pub fn slice_finer(&mut self, query: &Query) {
        let (shape, slices) = (query.shape(), 2 * self.slices(query));
        self.slices.retain(|(own, _)| *own != shape);
        self.slices.push((shape, slices));
    }

    /// Whether a query has more than one slice.
    pub fn has_slices(&self) -> bool {
        !self.slices.is_empty()
    }

    /// Forgets all slices, after the bodies changed.
    pub fn forget_slices(&mut self) {
        self.slices.clear();
    }

    /// Share of a query's first slice.
    pub fn first_slice(&self, query: &Query) -> Share {
        self.slice(query, 0)
    }

    /// Share of a slice.
    pub fn slice(&self, query: &Query, slice: u32) -> Share {
        self.share.slice(slice, self.slices(query))
    }

    /// Adds the costs of a slice's tiles.
    pub fn add_work(&mut self, work: Vec<u64>) {
        self.work_of_tiles.resize(work.len(), 0);
        self.work_of_tiles.iter_mut().zip(work).for_each(|(all, slice)| *all += slice);
    }
}

impl Detector {
    /// Sets the share that the next frames find.
    pub(crate) fn take(&mut self, share: Share) {
        if self.portion.share != share {
            (self.portion.share, self.engine.answered) = (share, None);
        }
    }

    /// Returns the cost of each tile of its share in a query's last frame; empty if nothing can
    /// meet.
    ///
    /// # Errors
    /// Those of the device.
    pub(crate) fn tile_work(&mut self, query: &Query) -> Result<Vec<u64>, Error> {
        if self.portion.slices(query) > 1 {
            return Ok(self.portion.work_of_tiles.clone());
        }
        self.of_query(query, Vec::new(), |pipeline, at| pipeline.work(at))
    }

    /// Returns the number of tiles beyond its share that it met in a query's last frame, in one
    /// slice.
    ///
    /// # Errors
    /// Those of the device.
    pub(crate) fn met_beyond(&mut self, query: &Query) -> Result<u64, Error> {
        self.of_query(query, 0, |pipeline, at| pipeline.met_beyond(at))
    }

    /// Number of triangles of bodies that move.
    pub(crate) fn moving_triangles(&self) -> usize {
        self.engine.layouts.any().map_or(0, |layout| layout.moving_triangles())
    }

    /// Name of its machine.
    pub(crate) fn machine(&self) -> String {
        self.device.name()
    }
}
