//! Launches, memory and transfers of a query.

use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given};
use crate::query::NearmissQuery;
use nearmiss::Error;
use std::ffi::{CString, c_char};
use std::mem::MaybeUninit;

/// The plan of the last frame of a query, as JSON: launches (`build`, `frame`), memory by its use
/// (`buffers`), bytes copied to the device and back (`transfers`), and stages that the scene does
/// not need (`left_out`). All are the device's own counts. The text lives until the next plan of
/// the detector. If the last two frames were not of this query, the call runs it.
///
/// # Safety
/// The names of the query are texts or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_plan(
    detector: Option<&mut NearmissDetector>,
    query: Option<&NearmissQuery>,
    json: Option<&mut MaybeUninit<*const c_char>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let to = given(json, "json")?;
        // SAFETY: the caller's promise.
        let query = unsafe { given(query, "query")?.query() }?;
        let bug = |what: String| Error::Bug { what: format!("the plan as JSON: {what}") };
        let text = serde_json::to_string(&own.detector.one("a plan")?.plan(&query)?)
            .map_err(|e| bug(e.to_string()))?;
        own.plan = CString::new(text).map_err(|e| bug(e.to_string()))?;
        to.write(own.plan.as_ptr());
        Ok(())
    })
}
