//! Updates and queries that are waited for.

use crate::answer::NearmissAnswer;
use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given};
use crate::motion::{HostMotion, NearmissMotion};
use crate::query::NearmissQuery;
use crate::rows::items;
use nearmiss::scene::{BodyId, Motion};
use nearmiss::{Contacts, Error};
use std::mem::MaybeUninit;

impl NearmissDetector {
    /// The work of a call that makes an answer: NULL if it fails.
    pub(crate) fn answer(
        detector: Option<&mut NearmissDetector>,
        mut answer: Option<&mut MaybeUninit<*mut NearmissAnswer>>,
        error: Option<&mut MaybeUninit<NearmissError>>,
        query: impl FnOnce(&mut NearmissDetector) -> Result<Contacts, Error>,
    ) -> NearmissCode {
        // Also if there is no detector.
        if let Some(answer) = &mut answer {
            answer.write(std::ptr::null_mut());
        }
        NearmissDetector::work(detector, error, |own| {
            let answer = given(answer, "answer")?;
            let found = query(own)?;
            let made = NearmissAnswer::new(found, own.devices.iter().map(|device| device.bytes().1).sum())?;
            answer.write(Box::into_raw(Box::new(made)));
            Ok(())
        })
    }

    /// Motions of the caller, each as `take` takes it, with its body.
    ///
    /// # Safety
    /// So many motions are there.
    pub(crate) unsafe fn motions<T>(
        &self,
        motions: *const NearmissMotion,
        count: usize,
        take: impl Fn(&NearmissMotion) -> Result<T, Error>,
    ) -> Result<Vec<(BodyId, T)>, Error> {
        // SAFETY: the caller's promise.
        let motions = unsafe { items(motions, count, "motions") }?;
        motions.iter().map(|motion| Ok((self.body(motion.body)?, take(motion)?))).collect()
    }

    /// Motions in memory of the host or of the device.
    ///
    /// # Safety
    /// So many motions are there, and the memory that they name.
    unsafe fn host_motions<'a>(
        &self,
        motions: *const NearmissMotion,
        count: usize,
    ) -> Result<Vec<(BodyId, HostMotion<'a>)>, Error> {
        // SAFETY: the caller's promise, twice.
        unsafe { self.motions(motions, count, |motion| motion.host_motion()) }
    }
}

fn borrowed<'a>(motions: &'a [(BodyId, HostMotion)]) -> Vec<(BodyId, Motion<'a>)> {
    motions.iter().map(|(id, motion)| (*id, motion.motion())).collect()
}

/// Moves bodies for the next queries. Positions are uploaded once, for any number of queries. A
/// body that is not named rests where it was, or where its step ended.
///
/// Fails with `NEARMISS_INVALID_ARGUMENT` for a body that is not there, or named twice, or given a
/// motion that its kind does not take. Fails with `NEARMISS_INPUT` for positions that no mesh may
/// have. Then nothing has moved. Positions in memory of a GPU are checked when a query reads them.
///
/// # Safety
/// So many motions are there, and the memory that they name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_update(
    detector: Option<&mut NearmissDetector>,
    motions: *const NearmissMotion,
    motion_count: usize,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        // SAFETY: the caller's promise.
        let motions = unsafe { own.host_motions(motions, motion_count) }?;
        own.detector.update(&borrowed(&motions))
    })
}

/// Answers a query of the bodies where they are. The answer depends on positions and on the query
/// alone, not on earlier queries. Memory for a kind of query is taken by its first query; other
/// numbers of the same kind rebuild nothing.
///
/// Fails with `NEARMISS_INVALID_ARGUMENT` for numbers without a meaning. A continuous or an
/// earliest query fails so if the last update named bodies and no step. There is no partial answer.
///
/// # Safety
/// The names of the query are texts or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_query(
    detector: Option<&mut NearmissDetector>,
    query: Option<&NearmissQuery>,
    answer: Option<&mut MaybeUninit<*mut NearmissAnswer>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::answer(detector, answer, error, |own| {
        // SAFETY: the caller's promise.
        let query = unsafe { given(query, "query")?.query() }?;
        own.detector.query(&query)
    })
}

/// The contacts at the time of an answer to an earliest query: the rows of the continuous query with
/// the same options whose time it is. Read them by `nearmiss_answer_contacts`. The bodies must be
/// where they were at the query. The step is tested again, up to that time; with a minimum
/// separation, all of it.
///
/// Fails with `NEARMISS_INVALID_ARGUMENT` for an answer to another query, and if nothing begins at
/// that time where the bodies are now.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_first_contacts(
    detector: Option<&mut NearmissDetector>,
    first: Option<&NearmissAnswer>,
    answer: Option<&mut MaybeUninit<*mut NearmissAnswer>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::answer(detector, answer, error, |own| {
        let first = given(first, "first")?;
        own.detector.first_contacts(&first.found).map(Contacts::from)
    })
}

/// Updates and queries in one submission: `nearmiss_detector_update`, then
/// `nearmiss_detector_query`. An error of the motions or of the query's numbers has moved nothing.
///
/// # Safety
/// So many motions are there, and the memory that they name. The names of the query are texts or
/// NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_step(
    detector: Option<&mut NearmissDetector>,
    motions: *const NearmissMotion,
    motion_count: usize,
    query: Option<&NearmissQuery>,
    answer: Option<&mut MaybeUninit<*mut NearmissAnswer>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::answer(detector, answer, error, |own| {
        // SAFETY: the caller's promise.
        let query = unsafe { given(query, "query")?.query() }?;
        // SAFETY: the caller's promise.
        let motions = unsafe { own.host_motions(motions, motion_count) }?;
        own.detector.step(&borrowed(&motions), &query)
    })
}
