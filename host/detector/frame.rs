//! A frame, from motions to answer.
//!
//! | step | does | in |
//! | --- | --- | --- |
//! | `apply` | checks the motions, moves bodies on the host and on the device | `moves.rs` |
//! | `nearest_instances` | for the distance of rigid bodies, frames of pairs of bodies | `nearest.rs` |
//! | `ready` | checks that all positions are known; topology of the query | `ready.rs` |
//! | `run` | memory, tiles or trees, and the stages; in slices if memory is short | `slices.rs` |
//! | `check_seen` | finds invalid coordinates in memory of the caller | `resident.rs` |
//! | `collect_answer` | caveats (`caveats.rs`) and times | here |
//! | `ended` | leaves no answer after an interrupt | `interrupted.rs` |

use super::Detector;
use super::question::Question;
use crate::contacts::{Answer, Contacts};
use crate::error::Error;
use crate::pipeline::{Seen, Stages};
use crate::query::{Query, TypedQuery};
use crate::scene::{BodyId, Motion};
use std::time::Instant;

/// The answer of a frame, and the placing's checks of positions in memory of the caller.
pub struct Answered {
    pub contacts: Contacts,
    pub seen: Option<Seen>,
}

impl Detector {
    /// Moves bodies for the next queries. A body that is not named rests where it is, or where its
    /// step ended. Cost: an upload of the named positions, and one launch that places them.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a body that is missing from the scene or named twice, and for
    /// a motion of another kind. [`Error::Input`] for positions that no mesh may have. On these
    /// errors nothing has moved. Others are those of the device.
    ///
    /// Positions in device memory are checked when a query reads them. If the query refuses them,
    /// their earlier positions are gone: the next update must name the same bodies.
    pub fn update(&mut self, motions: &[(BodyId, Motion)]) -> Result<(), Error> {
        self.device.work();
        let applied = self.apply(motions, None);
        self.ended(applied)
    }

    /// Queries the bodies at their current positions. The answer has all rows, in canonical order,
    /// and depends only on the query and on positions. If the lists of a frame exceed the memory or
    /// an index, candidates of tiles are found slice by slice. The answer is the same;
    /// [`Stats::slices`](crate::contacts::Stats::slices) counts the slices.
    ///
    /// The first query of a kind takes memory; another one of its kind with other numbers uses the
    /// same.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for invalid numbers. Also for a query in motion if the last
    /// update named bodies, but none with two ends. [`Error::OutOfMemory`] if slices do not fit
    /// either. Others are those of the device. There is no partial answer.
    pub fn query<Q: TypedQuery>(&mut self, query: &Q) -> Result<Answer<Q::Rows>, Error> {
        self.device.work();
        let answered =
            self.question((*query).into()).and_then(|question| self.answer(&question, Instant::now()));
        self.ended(answered).map(Contacts::typed::<Q>)
    }

    /// [Moves](Detector::update) bodies and [queries](Detector::query) them, in one submission.
    ///
    /// # Errors
    /// As of both. On an error of the motions or of the query's numbers nothing has moved.
    pub fn step<Q: TypedQuery>(
        &mut self,
        motions: &[(BodyId, Motion)],
        query: &Q,
    ) -> Result<Answer<Q::Rows>, Error> {
        let start = Instant::now();
        self.device.work();
        let answered = self.answer_step(motions, (*query).into(), start);
        self.ended(answered).map(Contacts::typed::<Q>)
    }

    pub(super) fn answer_step(
        &mut self,
        motions: &[(BodyId, Motion)],
        query: Query,
        start: Instant,
    ) -> Result<Contacts, Error> {
        query.check()?;
        if !query.kind().is_at_rest() && self.engine.pipeline.is_none() {
            self.engine.has_ends = true;
        }
        self.apply(motions, Some(&query))?;
        let question = self.question(query)?;
        self.answer(&question, start)
    }

    /// Answers a query at the current positions; `start` is when the call began.
    pub(super) fn answer(&mut self, question: &Question, start: Instant) -> Result<Contacts, Error> {
        if !self.is_of_nearest_instances(&question.query) {
            return self.answer_once(question, start);
        }
        match self.nearest_instances(question, start) {
            // A limit lists pairs beyond the nearest. Trees of all triangles list none.
            Err(Error::AnswerTooLarge { .. } | Error::OutOfMemory { .. }) => {
                self.answer_once(question, start)
            }
            answered => answered,
        }
    }

    /// Answers by one frame. One that needs f64 and had f32 runs again.
    pub(super) fn answer_once(&mut self, question: &Question, start: Instant) -> Result<Contacts, Error> {
        self.placed.check_ends(&question.query)?;
        loop {
            let layout = self.ready(&question.query)?;
            let Some(answered) = self.run(question, &layout)? else {
                return Ok(Contacts::none(question.query));
            };
            if self.check_seen(answered.seen)? {
                return self.collect_answer(question, answered, start);
            }
        }
    }

    /// Completes an answer with its caveats and times.
    pub(super) fn collect_answer(
        &mut self,
        question: &Question,
        answered: Answered,
        start: Instant,
    ) -> Result<Contacts, Error> {
        let Answered { mut contacts, seen } = answered;
        self.engine.answered = Some(question.query);
        if let Some(pipeline) = &mut self.engine.pipeline
            && let Some(at) = pipeline.place_of(&question.query)
        {
            pipeline.wear(at).add(contacts.stats.steps);
        }
        self.resident.saw(seen);
        self.tell_below_precision(question, &mut contacts)?;
        self.tell_turns(&question.query, &mut contacts)?;
        let wall = start.elapsed().as_secs_f64() * 1e3;
        contacts.stats.stages = Stages { construct: self.engine.construct_ms, wall, ..contacts.stats.stages };
        Ok(contacts)
    }
}

/// Error for a query in motion after an update without two ends.
pub fn without_ends(query: &Query) -> Error {
    Error::InvalidArgument {
        what: format!("no body of the frame has two ends, and the query is {}", query.kind()),
        advice: "give each body that moves both ends of the step: two arrays of positions, or two poses"
            .into(),
    }
}
