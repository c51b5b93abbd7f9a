//! Frames that are submitted and not waited for.

use super::Detector;
use super::frame::Answered;
use super::question::Question;
use crate::contacts::{Answer, Contacts, DeviceAnswer};
use crate::device::emulator::start_threads;
use crate::error::Error;
use crate::pipeline::collect::collect;
use crate::pipeline::not_prepared;
use crate::query::{Query, TypedQuery};
use crate::scene::{BodyId, DeviceMotion, Motion};
use std::time::Instant;

/// Rounds of a preparation: a frame of each query, and a submission that may find lists too short. Each
/// such submission doubles a queue's list, which 32 bits number, or a plan of at most 128 launches; or it
/// lengthens a list whose entries the candidates bound, which doubles such a list in 6.
const PREPARING_ROUNDS: u32 = 64;

/// Runs rounds until one had room for all.
///
/// # Errors
/// [`Error::InvalidArgument`] if none had; that of a round.
fn until_whole(mut round: impl FnMut() -> Result<bool, Error>) -> Result<(), Error> {
    for _ in 0..PREPARING_ROUNDS {
        if round()? {
            return Ok(());
        }
    }
    Err(Error::InvalidArgument {
        what: format!("a submission whose lists were still too short after {PREPARING_ROUNDS} rounds of `prepare`"),
        advice: "leave the memory of positions unchanged during `prepare`, choose another traversal, or query frame by frame"
            .into(),
    })
}

/// Refuses no query, and two of one shape.
///
/// # Errors
/// [`Error::InvalidArgument`].
fn check_shapes(queries: &[Query]) -> Result<(), Error> {
    if queries.is_empty() {
        return Err(Error::InvalidArgument {
            what: "a submission without a query".into(),
            advice: "name the queries that will be submitted".into(),
        });
    }
    for (at, query) in queries.iter().enumerate() {
        if queries[..at].iter().any(|other| other.shape() == query.shape()) {
            return Err(Error::InvalidArgument {
                what: format!("two {} queries that differ in numbers alone, in one submission", query.kind()),
                advice: "prepare the one that includes the other, or use two detectors".into(),
            });
        }
    }
    Ok(())
}

impl Detector {
    /// Prepares submissions that the host does not wait for. It runs the queries with the bodies where their memory says now, loads
    /// every kernel and takes all memory, until a submission has room for all. So after `Ok` the detector
    /// [is prepared](Detector::is_prepared), and [`Detector::collect`] has the answer. [`Detector::submit`] then takes no memory and
    /// waits for nothing. Bodies that are not named rest. Any other call that changes the detector ends it.
    ///
    /// The memory of the caller must not change during the call.
    ///
    /// # Errors
    /// As for [`Detector::step`]; [`Error::InvalidArgument`] for no query, for two that differ in numbers alone, for a traversal that needs
    /// the host, and if the lists have not settled after so many rounds as any schedule needs.
    pub fn prepare(&mut self, motions: &[(BodyId, DeviceMotion)], queries: &[Query]) -> Result<(), Error> {
        let prepared = self.prepared(motions, queries);
        self.ended(prepared)
    }

    fn prepared(&mut self, motions: &[(BodyId, DeviceMotion)], queries: &[Query]) -> Result<(), Error> {
        check_shapes(queries)?;
        queries.iter().try_for_each(Query::check)?;
        let given: Vec<(BodyId, Motion)> =
            motions.iter().map(|&(id, motion)| (id, Motion::OnDevice(motion))).collect();
        let in_motion = queries.iter().find(|query| !query.kind().is_at_rest());
        // Positions with room for the end of the step from the first query on, if any will read it.
        self.engine.has_ends |= in_motion.is_some() && self.engine.pipeline.is_none();
        self.apply(&given, in_motion)?;
        let questions = queries.iter().map(|&query| self.question(query)).collect::<Result<Vec<_>, _>>()?;
        // Once before the rounds: then lists that queries share are as long as the longest needs, and a front is there to be kept.
        self.answer_whole(&questions)?;
        until_whole(|| {
            self.answer_whole(&questions)?;
            self.try_submission(&given, queries)
        })?;
        self.placed.submit(motions, queries);
        Ok(())
    }

    /// Answers each query in one slice.
    fn answer_whole(&mut self, questions: &[Question]) -> Result<(), Error> {
        for question in questions {
            self.answer(question, Instant::now())?;
            let slices = self.portion.slices(&question.query);
            if slices > 1 {
                return Err(Error::InvalidArgument {
                    what: format!("a submission in {slices} slices"),
                    advice: "the lists of a whole frame have no room: give the device more memory, or query frame by frame".into(),
                });
            }
        }
        Ok(())
    }

    /// Places bodies from memory of the caller, and submits the queries once; whether that had room for all.
    fn try_submission(&mut self, given: &[(BodyId, Motion)], queries: &[Query]) -> Result<bool, Error> {
        // From there, and from nowhere else: a query may have brought positions to the host.
        self.apply(given, None)?;
        let Some(pipeline) = &mut self.engine.pipeline else { return Ok(true) };
        if given.is_empty() {
            pipeline.place(self.scene.bodies(), &[])?;
        }
        let places: Vec<usize> = queries.iter().filter_map(|query| pipeline.place_of(query)).collect();
        pipeline.prepare(&places)
    }

    /// Whether [`Detector::submit`] may be called, and a recording of it launched again: [`Detector::prepare`] was called, and
    /// nothing since then that changes the detector.
    pub fn is_prepared(&self) -> bool {
        let pipeline = self.engine.pipeline.as_ref();
        pipeline.map_or_else(|| !self.may_meet(), |pipeline| pipeline.is_prepared())
    }

    /// Submits the prepared queries to the device's stream, with bodies where their memory says when its turn comes: launches alone. So
    /// it may be called while that stream is captured, and the graph launched as often as wanted, as long as the detector
    /// [is prepared](Detector::is_prepared). [`Detector::on_device`] gives the addresses of the answers, [`Detector::collect`] waits
    /// for one.
    ///
    /// Times of its stages are not taken. On a CPU it is done when this returns.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if it is not prepared; those of the device.
    pub fn submit(&mut self) -> Result<(), Error> {
        start_threads()?;
        self.engine.answered = None;
        self.read_again(true);
        let is_empty = self.is_prepared();
        let submitted = match &mut self.engine.pipeline {
            Some(pipeline) => pipeline.submit(),
            None if is_empty => Ok(()),
            None => Err(not_prepared()),
        };
        self.ended(submitted)
    }

    /// Addresses of the answer to a submitted query, for kernels of the caller behind it; `None` if it is not prepared, or nothing can
    /// meet.
    pub fn on_device(&self, query: &Query) -> Option<DeviceAnswer> {
        let pipeline = self.engine.pipeline.as_ref().filter(|_| self.placed.answers(query))?;
        pipeline.place_of(query).and_then(|at| pipeline.answer(at))
    }

    /// Waits for the last submission, or the last launch of its recording, and brings the answer to one of its queries. If a list had too
    /// little room it grows and the query runs again, with bodies where they were placed: the answer is whole, and the detector is no
    /// longer [prepared](Detector::is_prepared). So does a query that was not prepared with these numbers.
    ///
    /// # Errors
    /// [`Error::Input`] and [`Error::InvalidArgument`] for positions and poses of the caller that cannot be computed with; those of the device.
    pub fn collect<Q: TypedQuery>(&mut self, query: &Q) -> Result<Answer<Q::Rows>, Error> {
        let collected = self.collected((*query).into());
        self.ended(collected).map(Contacts::typed::<Q>)
    }

    fn collected(&mut self, query: Query) -> Result<Contacts, Error> {
        let start = Instant::now();
        let question = self.question(query)?;
        let layout = self.layout(&query)?;
        self.read_again(true);
        let answers = self.placed.answers(&query);
        let found = match &mut self.engine.pipeline {
            Some(pipeline) => {
                let place = pipeline.place_of(&query).filter(|_| answers);
                place.map_or(Ok(None), |at| pipeline.collect(at))?
            }
            None => None,
        };
        let whole = found.map(|found| {
            let seen = found.0.seen;
            collect(found, &query, &layout, &self.device.looks()).map(|contacts| Answered { contacts, seen })
        });
        match whole.transpose()? {
            Some(answered) if self.check_seen(answered.seen)? => {
                self.collect_answer(&question, answered, start)
            }
            _ => self.answer(&question, start),
        }
    }

    fn may_meet(&self) -> bool {
        self.engine.layouts.last().is_none_or(|layout| layout.may_meet())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_end_with_the_first_that_is_whole() {
        let mut rounds = 0;
        let done = until_whole(|| {
            rounds += 1;
            Ok(rounds == 3)
        });
        assert!(done.is_ok() && rounds == 3);
        assert!(matches!(until_whole(|| Err(Error::Interrupted)), Err(Error::Interrupted)));
    }

    #[test]
    fn lists_that_never_settle_are_an_error() {
        let mut rounds = 0;
        let error = until_whole(|| {
            rounds += 1;
            Ok(false)
        });
        let error = error.expect_err("no round was whole");
        assert!(matches!(error, Error::InvalidArgument { .. }) && rounds == PREPARING_ROUNDS);
        assert!(error.to_string().contains("64 rounds of `prepare`"), "{error}");
    }
}
