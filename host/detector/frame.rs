//! A frame, from motions to answer.
//!
//! | step | does | in |
//! | --- | --- | --- |
//! | `apply` | checks the motions, moves bodies on the host and on the device | `moves.rs` |
//! | `ready` | the place of every body is known; topology of the query | `ready.rs` |
//! | `run` | memory, tiles or trees, and the stages; slice by slice if memory is short | `slices.rs` |
//! | `check_seen` | finds coordinates in memory of the caller that no answer can have | `resident.rs` |
//! | `collect_answer` | caveats (`caveats.rs`) and times | here |
//! | `ended` | a call that was interrupted leaves no answer | `interrupted.rs` |

use super::Detector;
use super::question::Question;
use crate::contacts::{Answer, Contacts};
use crate::error::Error;
use crate::pipeline::{Seen, Stages};
use crate::query::{Query, TypedQuery};
use crate::scene::{BodyId, Motion};
use std::time::Instant;

/// The answer of a frame, and what placing saw of positions in memory of the caller.
pub struct Answered {
    pub contacts: Contacts,
    pub seen: Option<Seen>,
}

impl Detector {
    /// Moves bodies for the next queries. A body that is not named rests where it was, or where its step
    /// ended, wherever its positions came from. Cost: an upload of positions that are named, and one launch that places them.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a body that is not in the scene, or named twice, or given a motion that its kind does not take;
    /// [`Error::Input`] for positions that no mesh may have: then nothing has moved. Positions in a GPU's memory are checked when a query
    /// reads them: after one that is refused for that, the next update must name the same bodies, since their earlier positions are gone.
    /// Those of the device.
    pub fn update(&mut self, motions: &[(BodyId, Motion)]) -> Result<(), Error> {
        self.device.work();
        let applied = self.apply(motions, None);
        self.ended(applied)
    }

    /// Queries the bodies where they are. The answer has all rows, in canonical order, and depends on the query and on positions alone. If
    /// the lists of a frame exceed the memory, or an index, candidates by tiles are found slice by slice, and the answer is the same:
    /// [`Stats::slices`](crate::contacts::Stats::slices) counts them.
    ///
    /// Memory of a query is taken when it is first asked; another query of its kind with other numbers uses it as it is.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for numbers that mean nothing, and for a query in motion if the last update named bodies of which none has two
    /// ends; those of the device: [`Error::OutOfMemory`] if memory ends all the same. There is no partial answer.
    pub fn query<Q: TypedQuery>(&mut self, query: &Q) -> Result<Answer<Q::Rows>, Error> {
        self.device.work();
        let answered =
            self.question((*query).into()).and_then(|question| self.answer(&question, Instant::now()));
        self.ended(answered).map(Contacts::typed::<Q>)
    }

    /// [Moves](Detector::update) bodies and [queries](Detector::query) them, in one submission.
    ///
    /// # Errors
    /// As of both; an error of the motions or of the query's numbers has moved nothing.
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

    /// The answer of a frame that began then, with the bodies where they are. A frame that needs doubles, and had singles, runs again.
    pub(super) fn answer(&mut self, question: &Question, start: Instant) -> Result<Contacts, Error> {
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

    /// The answer, with its caveats and its times.
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

/// No body of the last update has two ends.
pub fn without_ends(query: &Query) -> Error {
    Error::InvalidArgument {
        what: format!("no body of the frame has two ends, and the query is {}", query.kind()),
        advice: "give each body that moves both ends of the step: two arrays of positions, or two poses"
            .into(),
    }
}
