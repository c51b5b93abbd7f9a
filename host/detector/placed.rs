//! Record of the bodies that frames have placed: ever, in the last frame, and in every submission.

use super::Detector;
use super::frame::without_ends;
use crate::error::Error;
use crate::pipeline::Moved;
use crate::query::Query;
use crate::scene::{BodyId, DeviceMotion, Motion};

/// Record of placed bodies.
#[derive(Default)]
pub struct Placed {
    /// Whether a frame has placed each body since it was added.
    ever: Vec<bool>,
    /// Whether the last update named each body.
    pub named: Vec<bool>,
    /// Whether the last update named bodies, but none with two ends.
    lacks_ends: bool,
    /// Motions that a submission reads; up to date while one is prepared.
    pub submitted: Vec<(BodyId, DeviceMotion)>,
    /// Queries of a submission; up to date while one is prepared.
    queries: Vec<Query>,
}

impl Placed {
    /// Records that a frame places these bodies. Returns whether one of them was never placed
    /// before.
    pub fn mark(&mut self, bodies: usize, moved: &[Moved]) -> bool {
        self.ever.resize(bodies, false);
        let mut any_first = false;
        for moved in moved.iter().filter(|moved| !moved.rests) {
            any_first |= !std::mem::replace(&mut self.ever[moved.body], true);
        }
        any_first
    }

    /// Records the bodies that an update names. `has_ends` if one of them has two ends, or none is
    /// named.
    pub fn name(&mut self, named: &[bool], has_ends: bool) {
        (self.named, self.lacks_ends) = (named.to_vec(), !has_ends);
    }

    /// Refuses a query in motion if the last update named bodies, but none with two ends.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`].
    pub fn check_ends(&self, query: &Query) -> Result<(), Error> {
        if self.lacks_ends && !query.kind().is_at_rest() { Err(without_ends(query)) } else { Ok(()) }
    }

    /// Whether a frame has placed the body.
    fn was_placed(&self, body: BodyId) -> bool {
        self.ever.get(body.index()).is_some_and(|was| *was)
    }

    /// Whether the last frame named the body.
    pub fn is_named(&self, body: usize) -> bool {
        self.named.get(body).is_some_and(|is_named| *is_named)
    }

    /// Forgets the placing of a number, which another body has now.
    pub fn forget(&mut self, body: BodyId) {
        if let Some(was_placed) = self.ever.get_mut(body.index()) {
            *was_placed = false;
        }
    }

    /// Whether a submission answers a query with these numbers.
    pub fn answers(&self, query: &Query) -> bool {
        self.queries.contains(query)
    }

    /// Records the bodies and the queries of submissions.
    pub fn submit(&mut self, inputs: &[(BodyId, DeviceMotion)], queries: &[Query]) {
        (self.submitted, self.queries) = (inputs.to_vec(), queries.to_vec());
    }
}

impl Detector {
    /// Whether a frame of these inputs places a body for the first time.
    pub(crate) fn is_first_of(&self, inputs: &[(BodyId, Motion)]) -> bool {
        inputs.iter().any(|&(body, _)| !self.placed.was_placed(body))
    }
}
