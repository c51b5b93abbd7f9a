//! Frames that are waited for.

use crate::answer::NearmissAnswer;
use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given};
use crate::input::{Held, NearmissInput, body};
use crate::rows::items;
use nearmiss::scene::{BodyId, Motion};
use nearmiss::{Contacts, Error};
use std::mem::MaybeUninit;

impl NearmissDetector {
    /// Asks, and makes a handle of the answer.
    pub(crate) fn asked(
        detector: Option<&mut NearmissDetector>,
        answer: Option<&mut MaybeUninit<*mut NearmissAnswer>>,
        error: Option<&mut MaybeUninit<NearmissError>>,
        ask: impl FnOnce(&mut NearmissDetector) -> Result<Contacts, Error>,
    ) -> NearmissCode {
        // Also where there is no detector.
        let mut answer = answer;
        if let Some(answer) = &mut answer {
            answer.write(std::ptr::null_mut());
        }
        NearmissDetector::work(detector, error, |own| {
            let answer = given(answer, "the answer")?;
            let found = ask(own)?;
            let made = NearmissAnswer::new(found, own.device.bytes().1)?;
            answer.write(Box::into_raw(Box::new(made)));
            Ok(())
        })
    }

    /// What inputs say, each as `take` takes it, with its body.
    ///
    /// # Safety
    /// So many inputs lie there.
    pub(crate) unsafe fn inputs<T>(
        &self,
        inputs: *const NearmissInput,
        count: usize,
        take: impl Fn(&NearmissInput) -> Result<T, Error>,
    ) -> Result<Vec<(BodyId, T)>, Error> {
        // SAFETY: the caller's promise.
        let inputs = unsafe { items(inputs, count, "inputs") }?;
        inputs.iter().map(|input| Ok((body(&self.ids, input.body)?, take(input)?))).collect()
    }

    /// What a frame tells, copied.
    ///
    /// # Safety
    /// So many inputs lie there, and what they name.
    unsafe fn held(&self, inputs: *const NearmissInput, count: usize) -> Result<Vec<(BodyId, Held)>, Error> {
        // SAFETY: the caller's promise, twice.
        unsafe { self.inputs(inputs, count, |input| input.held()) }
    }
}

fn borrowed(held: &[(BodyId, Held)]) -> Vec<(BodyId, Motion<'_>)> {
    held.iter().map(|(id, held)| (*id, held.input())).collect()
}

/// Moves bodies to where the inputs say, and answers. A body that is not named rests where it was, or where its step ended. Cost: one
/// submission whatever the number of bodies, and a copy of what the host has.
///
/// Fails with `NEARMISS_INVALID_ARGUMENT` for a body that is not there, or named twice, or given what its kind does not take; with `NEARMISS_INPUT` for
/// positions that no mesh may have: then nothing has moved. There is no partial answer.
///
/// # Safety
/// So many inputs are there, and what they point to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_frame(
    detector: Option<&mut NearmissDetector>,
    inputs: *const NearmissInput,
    count: usize,
    answer: Option<&mut MaybeUninit<*mut NearmissAnswer>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::asked(detector, answer, error, |own| {
        // SAFETY: the caller's promise.
        let held = unsafe { own.held(inputs, count) }?;
        own.detector.step(&borrowed(&held), &own.query)
    })
}

/// Moves bodies as `nearmiss_detector_frame` does, without a query.
///
/// # Safety
/// So many inputs are there, and what they point to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_place(
    detector: Option<&mut NearmissDetector>,
    inputs: *const NearmissInput,
    count: usize,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        // SAFETY: the caller's promise.
        let held = unsafe { own.held(inputs, count) }?;
        own.detector.update(&borrowed(&held))
    })
}

/// Answers with the bodies where they are.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_detect(
    detector: Option<&mut NearmissDetector>,
    answer: Option<&mut MaybeUninit<*mut NearmissAnswer>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::asked(detector, answer, error, |own| own.detector.query(&own.query))
}
