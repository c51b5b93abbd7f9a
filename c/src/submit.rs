//! Submissions that the host does not wait for.

use crate::answer::NearmissAnswer;
use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given};
use crate::motion::NearmissMotion;
use crate::query::NearmissQuery;
use crate::rows::items;
use nearmiss::contacts::DeviceExtras;
use nearmiss::{Error, Query};
use std::mem::MaybeUninit;

/// Prepares submissions of several queries. Each motion is in memory of the device (`on_device` is
/// 1); write new positions there between submissions. Bodies that are not named rest. The call
/// runs the queries and takes all memory. `nearmiss_detector_submit` then allocates nothing and
/// waits for nothing. Any other call that changes the detector ends the preparation.
///
/// Fails with `NEARMISS_INVALID_ARGUMENT` for no query, and for two queries that differ in numbers
/// alone.
///
/// # Safety
/// So many motions and queries are there. Memory of the motions stays until the next update or the
/// end of the detector. The names of the queries are texts or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_prepare(
    detector: Option<&mut NearmissDetector>,
    motions: *const NearmissMotion,
    motion_count: usize,
    queries: *const NearmissQuery,
    query_count: usize,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        // SAFETY: the caller's promise.
        unsafe {
            own.prepared_with((motions, motion_count), (queries, query_count), &DeviceExtras::default())
        }
    })
}

impl NearmissDetector {
    /// Prepares submissions.
    ///
    /// # Safety
    /// As of [`nearmiss_detector_prepare`].
    pub(crate) unsafe fn prepared_with(
        &mut self,
        (motions, motion_count): (*const NearmissMotion, usize),
        (queries, query_count): (*const NearmissQuery, usize),
        extras: &DeviceExtras,
    ) -> Result<(), Error> {
        // SAFETY: the caller's promise.
        let queries = unsafe { items(queries, query_count, "queries") }?;
        // SAFETY: the caller's promise.
        let queries = queries.iter().map(|query| unsafe { query.query() });
        let queries = queries.collect::<Result<Vec<Query>, Error>>()?;
        // SAFETY: the caller's promise, twice.
        let motions = unsafe { self.motions(motions, motion_count, |motion| motion.device_motion()) }?;
        let prepared = self.detector.prepare(&motions, &queries, extras);
        // A call that was refused before it changed anything leaves the earlier preparation.
        if prepared.is_ok() || !self.detector.is_prepared() {
            (self.prepared, self.starts) = (Vec::new(), Vec::new());
        }
        prepared?;
        self.prepared = queries;
        Ok(())
    }
}

/// Whether the detector is prepared: `nearmiss_detector_submit` may be called, and a recording of
/// it may be launched again. Nothing has changed the detector since `nearmiss_detector_prepare`.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_is_prepared(
    detector: Option<&mut NearmissDetector>,
    is_prepared: Option<&mut MaybeUninit<bool>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        given(is_prepared, "is_prepared")?.write(own.detector.is_prepared());
        Ok(())
    })
}

/// Submits the prepared queries to the stream of the device. Positions are read there when its turn
/// comes. The call launches kernels and does nothing else, so a CUDA graph may capture it and be
/// launched any number of times. On a CPU the work is done when the call returns.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_submit(
    detector: Option<&mut NearmissDetector>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| own.detector.submit())
}

/// Waits for the last submission, or for the last launch of its recording, and copies the answer to
/// one of its queries. If a list was too short it grows and the query runs again: the answer is
/// whole, and the detector is no longer prepared. A query that was not prepared with these numbers
/// runs too, with the bodies where they are.
///
/// # Safety
/// The names of the query are texts or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_collect(
    detector: Option<&mut NearmissDetector>,
    query: Option<&NearmissQuery>,
    answer: Option<&mut MaybeUninit<*mut NearmissAnswer>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::answer(detector, answer, error, |own| {
        // SAFETY: the caller's promise.
        let query = unsafe { given(query, "query")?.query() }?;
        own.detector.collect(&query)
    })
}
