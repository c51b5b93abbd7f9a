//! What a frame launches, holds and moves.

use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given};
use nearmiss::Error;
use std::ffi::{CString, c_char};
use std::mem::MaybeUninit;

/// The plan of the last frame that was waited for, as a text of JSON: launches (`build`, `frame`), memory by what it is for (`buffers`), bytes that
/// went to the device and came back (`transfers`), and what the scene does not need (`left_out`). All are the device's own counts. The text
/// lives until this is asked of the detector again. A detector that was asked fewer than two frames asks what is missing.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_plan(
    detector: Option<&mut NearmissDetector>,
    json: Option<&mut MaybeUninit<*const c_char>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let to = given(json, "the text")?;
        let bug = |what: String| Error::Bug { what: format!("the plan as JSON: {what}") };
        let text = serde_json::to_string(&own.detector.plan(&own.query)?).map_err(|e| bug(e.to_string()))?;
        own.plan = CString::new(text).map_err(|e| bug(e.to_string()))?;
        to.write(own.plan.as_ptr());
        Ok(())
    })
}
