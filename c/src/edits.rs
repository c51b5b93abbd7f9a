//! Bodies that come, go and change.

use crate::body::NearmissBody;
use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given};
use std::mem::MaybeUninit;

/// Adds a body, and writes its number to `id`, which may be NULL. Numbers of removed bodies are
/// used again. The next query rebuilds.
///
/// # Safety
/// Memory that the body points to is there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_add(
    detector: Option<&mut NearmissDetector>,
    body: Option<&NearmissBody>,
    id: Option<&mut MaybeUninit<u32>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        // SAFETY: the caller's promise.
        let body = unsafe { given(body, "body")?.body() }?;
        let added = own.detector.add(body)?;
        if let Some(id) = id {
            id.write(added.index() as u32);
        }
        Ok(())
    })
}

/// Replaces a body by another, of any mesh, under the same number. The next query rebuilds.
///
/// # Safety
/// Memory that the body points to is there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_replace(
    detector: Option<&mut NearmissDetector>,
    id: u32,
    body: Option<&NearmissBody>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        // SAFETY: the caller's promise.
        let body = unsafe { given(body, "body")?.body() }?;
        own.detector.replace(own.body(id)?, body)
    })
}

/// Removes a body. The others keep their numbers. The next query rebuilds.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_remove(
    detector: Option<&mut NearmissDetector>,
    id: u32,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| own.detector.remove(own.body(id)?).map(drop))
}
