//! Notes of an answer.

use crate::answer::{NearmissAnswer, sentence, shown};
use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, call, given};
use std::ffi::c_char;
use std::mem::MaybeUninit;

/// Makes the notes of an answer and counts them. Read each by `nearmiss_answer_note`. The bodies
/// must be where they were at the query. Most answers have none. Cost: a comparison of both ends of
/// the step if nothing moves; a sort of all vertices from 1,000 rows on.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_notes(
    detector: Option<&mut NearmissDetector>,
    answer: Option<&mut NearmissAnswer>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let (answer, count) = (given(answer, "answer")?, given(count, "count")?);
        answer.notes = own.detector.notes(&answer.found).into_iter().map(sentence).collect();
        count.write(answer.notes.len());
        Ok(())
    })
}

/// A note that `nearmiss_detector_notes` made, by its index from 0. The text lives until notes are
/// made again, at most as long as the answer.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_note(
    answer: Option<&NearmissAnswer>,
    index: usize,
    note: Option<&mut MaybeUninit<*const c_char>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let text = shown(&given(answer, "answer")?.notes, index, "note")?;
        given(note, "note")?.write(text);
        Ok(())
    })
}

/// A caveat of an answer, by its index from 0: a limit that was reached, in a sentence. The summary
/// counts them. No collision of the given motions is missed for any of them. The text lives as long
/// as the answer.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_caveat(
    answer: Option<&NearmissAnswer>,
    index: usize,
    caveat: Option<&mut MaybeUninit<*const c_char>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let text = shown(&given(answer, "answer")?.caveats, index, "caveat")?;
        given(caveat, "caveat")?.write(text);
        Ok(())
    })
}
