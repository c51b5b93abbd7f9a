//! Submitted frames, for which the host does not wait.

use super::Detector;
use super::frame::Answered;
use super::question::Question;
use crate::contacts::{Answer, Contacts, DeviceAnswer, DeviceExtras};
use crate::device::emulator::start_threads;
use crate::error::Error;
use crate::pipeline::collect::collect;
use crate::pipeline::not_prepared;
use crate::query::{Query, TypedQuery};
use crate::scene::{BodyId, DeviceMotion, Motion};
use std::time::Instant;

/// Most rounds of a preparation. A round has a frame of each query, and a submission that may find
/// lists too short. Each short submission lengthens something:
///
/// - it doubles the list of a queue, which 32 bits number;
/// - or it doubles a plan of at most 128 launches;
/// - or it lengthens a list whose entries the candidates bound; such a list doubles within 6
///   rounds.
const PREPARING_ROUNDS: u32 = 64;

/// Runs rounds until one had enough room.
///
/// # Errors
/// [`Error::InvalidArgument`] if none had; the error of a round.
fn until_whole(mut round: impl FnMut() -> Result<bool, Error>) -> Result<(), Error> {
    for _ in 0..PREPARING_ROUNDS {
        if round()? {
            return Ok(());
        }
    }
    Err(Error::InvalidArgument {
        what: format!("lists of a submission are too short after {PREPARING_ROUNDS} rounds of `prepare`"),
        advice: "do not change positions during `prepare`, use another traversal, or query frame by frame"
            .into(),
    })
}

/// Checks that there is a query, that each can be submitted, and that no two have one shape.
///
/// # Errors
/// [`Error::InvalidArgument`].
pub(crate) fn check_submission(queries: &[Query]) -> Result<(), Error> {
    if queries.is_empty() {
        return Err(Error::InvalidArgument {
            what: "a submission must have at least one query, got none".into(),
            advice: "pass the queries that will be submitted".into(),
        });
    }
    for (at, query) in queries.iter().enumerate() {
        if queries[..at].iter().any(|other| other.shape() == query.shape()) {
            return Err(Error::InvalidArgument {
                what: format!(
                    "queries of a submission must differ in more than numbers, got two {} queries",
                    query.kind()
                ),
                advice: "prepare only the one that includes the other, or use two detectors".into(),
            });
        }
    }
    queries.iter().try_for_each(Query::check)
}

/// Motions from memory of the caller.
fn on_device<'a>(motions: &[(BodyId, DeviceMotion)]) -> Vec<(BodyId, Motion<'a>)> {
    motions.iter().map(|&(id, motion)| (id, Motion::OnDevice(motion))).collect()
}

impl Detector {
    /// Prepares submissions, for which the host does not wait.
    ///
    /// It runs the queries with positions from the memory of `motions`, loads every kernel and
    /// allocates all memory. It repeats this until a submission has enough room. After `Ok` the
    /// detector [is prepared](Detector::is_prepared), and [`Detector::collect`] returns the answer.
    /// [`Detector::submit`] then allocates nothing and does not wait. Bodies without a motion rest.
    /// Any other call that changes the detector ends the preparation.
    ///
    /// The memory of the caller must not change during the call.
    ///
    /// # Errors
    /// As for [`Detector::step`]. [`Error::OutOfMemory`] if a submission's lists do not fit.
    /// [`Error::InvalidArgument`]:
    ///
    /// - if there is no query, or two differ in numbers alone;
    /// - if a traversal needs the host;
    /// - if the lists are still too short after more rounds than any schedule needs.
    pub fn prepare(&mut self, motions: &[(BodyId, DeviceMotion)], queries: &[Query]) -> Result<(), Error> {
        self.prepare_with(motions, queries, &DeviceExtras::default())
    }

    pub(super) fn prepared(
        &mut self,
        motions: &[(BodyId, DeviceMotion)],
        queries: &[Query],
        extras: &DeviceExtras,
    ) -> Result<(), Error> {
        check_submission(queries)?;
        Detector::has_first_contacts(queries, extras)?;
        let given = on_device(motions);
        let in_motion = queries.iter().find(|query| !query.kind().is_at_rest());
        // If any query will read the end of the step, positions have room for it from the first on.
        self.engine.has_ends |= in_motion.is_some() && self.engine.pipeline.is_none();
        self.apply(&given, in_motion)?;
        self.has_geometry_on_device(in_motion, extras)?;
        let questions = queries.iter().map(|&query| self.question(query)).collect::<Result<Vec<_>, _>>()?;
        // Once before the rounds. Then lists that queries share have the longest length, and there
        // is a front that a submission can continue from.
        self.answer_whole(&questions)?;
        until_whole(|| {
            self.answer_whole(&questions)?;
            self.try_submission(&given, queries, extras)
        })?;
        self.placed.submit(motions, queries);
        self.engine.submits_alone = self.engine.pipeline.is_none();
        Ok(())
    }

    /// Answers each query in one slice.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if one needs more slices; those of a frame.
    fn answer_whole(&mut self, questions: &[Question]) -> Result<(), Error> {
        for question in questions {
            self.answer_once(question, Instant::now())?;
            let slices = self.portion.slices(&question.query);
            if slices > 1 {
                return Err(Error::InvalidArgument {
                    what: format!("a submission must fit device memory in one slice, got {slices} slices"),
                    advice: "use a device with more memory, or query frame by frame".into(),
                });
            }
        }
        Ok(())
    }

    /// Places bodies from the caller's memory, and submits the queries once. Returns whether there
    /// was enough room.
    fn try_submission(
        &mut self,
        given: &[(BodyId, Motion)],
        queries: &[Query],
        extras: &DeviceExtras,
    ) -> Result<bool, Error> {
        // Only from the caller's memory: a query may have downloaded positions to the host.
        self.apply(given, None)?;
        let Some(pipeline) = &mut self.engine.pipeline else { return Ok(true) };
        if given.is_empty() {
            pipeline.place(self.scene.bodies(), &[])?;
        }
        let places: Vec<usize> = queries.iter().filter_map(|query| pipeline.place_of(query)).collect();
        pipeline.prepare(&places, extras)
    }

    /// Returns whether [`Detector::submit`] may be called, and a recording of it launched again. It
    /// is true after [`Detector::prepare`], until a call changes the detector.
    pub fn is_prepared(&self) -> bool {
        let pipeline = self.engine.pipeline.as_ref();
        pipeline.map_or(self.engine.submits_alone, |pipeline| pipeline.is_prepared())
    }

    /// Submits the prepared queries to the device's stream. It only launches kernels, which read
    /// positions from the caller's memory in the order of the stream.
    ///
    /// So it may be called while that stream is captured. The graph can be launched any number of
    /// times while the detector [is prepared](Detector::is_prepared). [`Detector::on_device`]
    /// returns the addresses of the answers; [`Detector::collect`] waits for one.
    ///
    /// Stages are not timed. On a CPU the frame is complete when this returns.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if the detector is not prepared; those of the device.
    pub fn submit(&mut self) -> Result<(), Error> {
        start_threads()?;
        self.engine.answered = None;
        self.read_again(true);
        let submitted = match &mut self.engine.pipeline {
            Some(pipeline) => pipeline.submit(),
            None => self.place_alone(),
        };
        self.ended(submitted)
    }

    /// Places bodies of which none may meet, without a pipeline: the host reads their memory if it
    /// can. On a GPU only the caller knows where they are: a later edit needs their positions again.
    fn place_alone(&mut self) -> Result<(), Error> {
        if !self.engine.submits_alone {
            return Err(not_prepared());
        }
        if !self.device.is_gpu() {
            self.apply(&on_device(&self.placed.submitted), None)?;
        }
        self.engine.submits_alone = true;
        Ok(())
    }

    /// Ends the preparation, if there is one: no later call reads the arrays that it named. Work that
    /// was submitted before may still read them. Bodies are where the last submission placed them.
    pub fn unprepare(&mut self) {
        self.read_again(false);
        (self.engine.answered, self.engine.submits_alone) = (None, false);
        if let Some(pipeline) = self.engine.pipeline.as_mut().filter(|pipeline| pipeline.is_prepared()) {
            // Nothing moves. An error of the device comes again with the next call, and the
            // preparation has ended all the same.
            let _ = pipeline.place(self.scene.bodies(), &[]);
        }
    }

    /// Returns the addresses of the answer to a submitted query, for the caller's kernels that
    /// follow on the stream. `None` if the query is not prepared, or if nothing can meet.
    pub fn on_device(&self, query: &Query) -> Option<DeviceAnswer> {
        let pipeline = self.engine.pipeline.as_ref().filter(|_| self.placed.answers(query))?;
        pipeline.place_of(query).and_then(|at| pipeline.answer(at))
    }

    /// Waits for the last submission, or for the last launch of its recording. Returns the answer to
    /// one of its queries.
    ///
    /// If a list was too short, it grows, and the query runs again with the same positions. Then
    /// the answer is complete, and the detector is no longer [prepared](Detector::is_prepared). A
    /// query that was not prepared with these numbers runs in the same way.
    ///
    /// # Errors
    /// [`Error::Input`] and [`Error::InvalidArgument`] for invalid positions and poses of the
    /// caller; those of the device.
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
            collect(found, &question.query, &layout, &self.device.looks())
                .map(|contacts| Answered { contacts, seen })
        });
        match whole.transpose()? {
            Some(answered) if self.check_seen(answered.seen)? => {
                self.collect_answer(&question, answered, start)
            }
            _ => self.answer(&question, start),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::Backend;
    use crate::samples::level;
    use crate::scene::{CollisionFilter, DeviceRows, Number};
    use crate::{Body, Device, Near};
    use std::cell::Cell;

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

    /// A submission moves bodies of which none may meet: those that come later meet them there.
    #[test]
    fn bodies_that_meet_none_are_where_they_were_submitted() {
        let alone = |z| Body::deformable(level(z)).with_filter(CollisionFilter::without_self_collision());
        let device = Device::open(Backend::Cpu, Some(1)).expect("a thread");
        let mut detector = Detector::new(device, alone(0.0)).expect("a detector");
        let id = detector.scene().ids().next().expect("a body");
        let array: Vec<Cell<f32>> =
            level(0.0).positions().to_f64().iter().flatten().map(|&x| Cell::new(x as f32)).collect();
        // SAFETY: three vertices, which this test alone writes, between calls.
        let rows = unsafe { DeviceRows::new(array.as_ptr() as u64, 3, 12, Number::F32) }.expect("rows");
        let (near, motion) = (Near::within(1.0), DeviceMotion::Positions(rows));
        let set = |height: f32| array.iter().skip(2).step_by(3).for_each(|z| z.set(height));
        assert!(!detector.is_prepared() && detector.submit().is_err());
        detector.prepare(&[(id, motion)], &[near.into()]).expect("prepared");
        for height in [5.0, 9.0] {
            set(height);
            detector.submit().expect("submitted");
            assert!(detector.is_prepared() && detector.collect(&near).expect("an answer").is_empty());
        }
        // Positions are checked when they are read.
        set(f32::NAN);
        assert!(matches!(detector.submit(), Err(Error::Input { .. })));
        detector.prepare(&[(id, motion)], &[near.into()]).expect_err("they still are wrong");
        set(9.0);
        detector.prepare(&[(id, motion)], &[near.into()]).expect("prepared");
        detector.submit().expect("submitted");
        detector.add(Body::fixed(level(9.5))).expect("a body");
        assert!(!detector.is_prepared() && detector.submit().is_err());
        assert!(!detector.query(&near).expect("an answer").is_empty());
    }

    #[test]
    fn arrays_of_an_ended_preparation_are_not_read() {
        let body = |z| Body::deformable(level(z));
        let device = Device::open(Backend::Cpu, Some(1)).expect("a thread");
        let mut detector = Detector::new(device, vec![body(3.0), body(0.0)]).expect("a detector");
        let id = detector.scene().ids().next().expect("a body");
        let array: Vec<Cell<f32>> =
            level(2.0).positions().to_f64().iter().flatten().map(|&x| Cell::new(x as f32)).collect();
        // SAFETY: three vertices, which this test alone writes, between calls.
        let rows = unsafe { DeviceRows::new(array.as_ptr() as u64, 3, 12, Number::F32) }.expect("rows");
        let near = Near::within(1.5);
        detector.prepare(&[(id, DeviceMotion::Positions(rows))], &[near.into()]).expect("prepared");
        array.iter().skip(2).step_by(3).for_each(|z| z.set(1.0));
        detector.submit().expect("submitted");
        detector.unprepare();
        array.iter().for_each(|x| x.set(f32::NAN));
        assert!(!detector.is_prepared() && detector.submit().is_err());
        assert!(!detector.query(&near).expect("an answer").is_empty());
        detector.unprepare();
        assert!(!detector.query(&near).expect("the same answer").is_empty());
    }
}
