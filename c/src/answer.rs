//! Answers, and what they show.

use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, call, free, given, refused};
use crate::records::{
    NearmissContact, NearmissGeometry, NearmissNearPair, NearmissNearest, NearmissStages,
    NearmissTrianglePair,
};
use nearmiss::{Contacts, Error, Rows};
use std::ffi::{CString, c_char};
use std::mem::MaybeUninit;

/// The answer to a frame, with the figures of its making. It changes no more, and needs neither detector nor device.
pub struct NearmissAnswer {
    found: Contacts,
    shown: Shown,
    geometry: Vec<NearmissGeometry>,
    caveats: Vec<CString>,
    notes: Vec<CString>,
    peak: u64,
}

/// What was found, as C sees it.
enum Shown {
    Pairs(Vec<NearmissTrianglePair>),
    Contacts(Vec<NearmissContact>),
    Near(Vec<NearmissNearPair>),
    Earliest,
    Nearest,
}

/// Figures of an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissSummary {
    /// How many contacts or pairs there are; of an earliest query, and of a distance, 1 or 0.
    pub contacts: u64,
    /// Triangle pairs that the volumes let through.
    pub triangle_pairs: u64,
    /// Pairs that the narrow test was asked.
    pub candidates: u64,
    /// How many are neither confirmed nor refuted; of an earliest query 1 if its time is that of
    /// such a pair, else 0.
    pub undecided: u64,
    /// How often a list was too short and a part of the frame ran again. The answer is whole.
    pub reruns: u64,
    /// In how many slices the frame was asked, for want of memory; 1 is the whole at once.
    pub slices: u64,
    /// Most bytes of the device's memory held at once, until then, by all detectors of the device.
    pub bytes: u64,
    /// Of the canonical answer: the same for equal answers on every machine.
    pub hash: u64,
    /// Triangle pairs that share a point at the start of the step; 0 if `is_start_checked` is
    /// false.
    pub starts_crossing: u64,
    /// Whether the start was checked: of a continuous and an earliest query, unless it assumes a
    /// free start.
    pub is_start_checked: bool,
    /// How many sentences `nearmiss_answer_caveats` has.
    pub caveats: u64,
    /// Times.
    pub ms: NearmissStages,
}

impl NearmissAnswer {
    pub(crate) fn new(found: Contacts, peak: u64) -> Result<NearmissAnswer, Error> {
        let bytes = found.len() as u64 * size_of::<NearmissNearPair>() as u64;
        nearmiss::memory::require("the answer", bytes)?;
        let shown = match &found.rows {
            Rows::Pairs(pairs) => Shown::Pairs(pairs.iter().map(Into::into).collect()),
            Rows::Contacts(contacts) => Shown::Contacts(contacts.iter().map(Into::into).collect()),
            Rows::Near(pairs) => Shown::Near(pairs.iter().map(Into::into).collect()),
            Rows::Earliest(_) => Shown::Earliest,
            Rows::Distance(_) => Shown::Nearest,
        };
        let caveats = found.caveats().iter().map(sentence).collect();
        Ok(NearmissAnswer { found, shown, geometry: Vec::new(), caveats, notes: Vec::new(), peak })
    }

    /// It does not have what was asked for.
    fn without(&self, what: &str) -> Error {
        let advice = match self.shown {
            Shown::Pairs(_) => "this is the answer to a discrete query: ask it for triangle pairs",
            Shown::Contacts(_) => "this is the answer to a continuous query: ask it for contacts",
            Shown::Near(_) => "this is the answer to a near query: ask it for near pairs",
            Shown::Earliest => "this is the answer to an earliest query: ask it for the earliest time",
            Shown::Nearest => "this is the answer to a distance query: ask it for the nearest triangles",
        };
        refused(what, advice)
    }
}

/// A sentence, as C sees it.
fn sentence(told: impl ToString) -> CString {
    CString::new(told.to_string()).unwrap_or_default()
}

/// Shows a list. It lives as long as its handle.
fn show<T>(
    list: &[T],
    items: Option<&mut MaybeUninit<*const T>>,
    count: Option<&mut MaybeUninit<usize>>,
) -> Result<(), Error> {
    let (items, count) = (given(items, "the items")?, given(count, "their count")?);
    items.write(list.as_ptr());
    count.write(list.len());
    Ok(())
}

/// The triangle pairs of a discrete query, ascending by the first triangle and its body, then by the second. The list lives as long as the
/// answer.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_triangle_pairs(
    answer: Option<&NearmissAnswer>,
    items: Option<&mut MaybeUninit<*const NearmissTrianglePair>>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let answer = given(answer, "the answer")?;
        let Shown::Pairs(list) = &answer.shown else { return Err(answer.without("triangle pairs")) };
        show(list, items, count)
    })
}

/// The contacts of a continuous query, ascending by kind, then by the first feature and its body, then by the second. The list lives as long
/// as the answer.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_contacts(
    answer: Option<&NearmissAnswer>,
    items: Option<&mut MaybeUninit<*const NearmissContact>>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let answer = given(answer, "the answer")?;
        let Shown::Contacts(list) = &answer.shown else { return Err(answer.without("contacts")) };
        show(list, items, count)
    })
}

/// The feature pairs of a near query, in the order of contacts. The list lives as long as the answer.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_near_pairs(
    answer: Option<&NearmissAnswer>,
    items: Option<&mut MaybeUninit<*const NearmissNearPair>>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let answer = given(answer, "the answer")?;
        let Shown::Near(list) = &answer.shown else { return Err(answer.without("near pairs")) };
        show(list, items, count)
    })
}

/// The nearest triangles of a distance query. `is_any` is false, and nothing else written, where no two bodies may meet.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_nearest(
    answer: Option<&NearmissAnswer>,
    is_any: Option<&mut MaybeUninit<bool>>,
    nearest: Option<&mut MaybeUninit<NearmissNearest>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let answer = given(answer, "the answer")?;
        let Shown::Nearest = answer.shown else { return Err(answer.without("the nearest triangles")) };
        let (is_any, to) = (given(is_any, "whether there are any")?, given(nearest, "the nearest")?);
        let found = answer.found.nearest();
        is_any.write(found.is_some());
        if let Some(found) = found {
            to.write(found.into());
        }
        Ok(())
    })
}

/// The smallest time of contact of an earliest or a continuous query, in [0, 1]: no contact is before it. `is_any` is false, and the time 1,
/// if nothing meets. Triangles that cross at the start need not meet again:
/// `nearmiss_answer_is_free` says whether the step is free.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_earliest(
    answer: Option<&NearmissAnswer>,
    is_any: Option<&mut MaybeUninit<bool>>,
    toi: Option<&mut MaybeUninit<f64>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let answer = given(answer, "the answer")?;
        if !matches!(answer.shown, Shown::Earliest | Shown::Contacts(_)) {
            return Err(answer.without("the earliest time"));
        }
        let (is_any, to) = (given(is_any, "whether there is any")?, given(toi, "the time")?);
        let found = answer.found.earliest_toi();
        is_any.write(found.is_some());
        to.write(found.unwrap_or(1.0));
        Ok(())
    })
}

/// Whether the answer proves that nothing touches. Continuous and earliest: the start was checked,
/// no triangles share a point there, and nothing meets within the step. Discrete: no pair of
/// triangles shares a point. Distance: it is above 0, or no two bodies may meet. Near: always
/// false.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_is_free(
    answer: Option<&NearmissAnswer>,
    is_free: Option<&mut MaybeUninit<bool>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        given(is_free, "whether it is free")?.write(given(answer, "the answer")?.found.is_free());
        Ok(())
    })
}

/// Figures: how much was found, of how many candidates, and how long it took. Cost: a pass over the answer, for its hash.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_summary(
    answer: Option<&NearmissAnswer>,
    summary: Option<&mut MaybeUninit<NearmissSummary>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let answer = given(answer, "the answer")?;
        let found = &answer.found;
        given(summary, "the summary")?.write(NearmissSummary {
            contacts: found.len() as u64,
            triangle_pairs: found.stats.triangle_pairs,
            candidates: found.stats.candidates,
            undecided: found.undecided,
            reruns: found.stats.reruns,
            slices: u64::from(found.stats.slices),
            bytes: answer.peak,
            hash: found.hash(),
            starts_crossing: found.starts_crossing.unwrap_or(0),
            is_start_checked: found.starts_crossing.is_some(),
            caveats: answer.caveats.len() as u64,
            ms: found.stats.stages.into(),
        });
        Ok(())
    })
}

/// In what the frame came to less than all that was asked: a sentence each, by its index. Nothing is ever missed for any of them. The text
/// lives as long as the answer.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_caveats(
    answer: Option<&NearmissAnswer>,
    index: usize,
    sentence: Option<&mut MaybeUninit<*const c_char>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let all = &given(answer, "the answer")?.caveats;
        let one = all.get(index).ok_or_else(|| {
            refused(format!("sentence {index} of {}", all.len()), "count them from 0, as the summary tells")
        })?;
        given(sentence, "the sentence")?.write(one.as_ptr());
        Ok(())
    })
}

/// Makes the notes beside an answer, as the command line prints them, and counts them; mostly there
/// are none. `nearmiss_answer_note` returns each. The bodies must be where they were at the frame.
/// Cost: a comparison of both ends of the step if nothing moves; a sort of all vertices if there
/// are 1,000 contacts.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_notes(
    detector: Option<&mut NearmissDetector>,
    answer: Option<&mut NearmissAnswer>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let (answer, count) = (given(answer, "the answer")?, given(count, "their count")?);
        answer.notes = own.detector.notes(&answer.found).into_iter().map(sentence).collect();
        count.write(answer.notes.len());
        Ok(())
    })
}

/// A note that `nearmiss_detector_notes` made, by its index. The text lives until they are made
/// again, and no longer than the answer.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_note(
    answer: Option<&NearmissAnswer>,
    index: usize,
    note: Option<&mut MaybeUninit<*const c_char>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let all = &given(answer, "the answer")?.notes;
        let one = all.get(index).ok_or_else(|| {
            refused(
                format!("note {index} of {}", all.len()),
                "count them from 0, as nearmiss_detector_notes does",
            )
        })?;
        given(note, "the note")?.write(one.as_ptr());
        Ok(())
    })
}

/// Vertices, weights, points and normal of every contact, or of every pair within a distance, in their order. The bodies must be where they were
/// at the frame. The list lives until this is asked of the answer again. Cost: a copy of all vertices from the device, and a wait; 300 operations a contact.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_geometry(
    detector: Option<&mut NearmissDetector>,
    answer: Option<&mut NearmissAnswer>,
    items: Option<&mut MaybeUninit<*const NearmissGeometry>>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let answer = given(answer, "the answer")?;
        // What was shown before makes room first.
        answer.geometry = Vec::new();
        let found = own.detector.geometry(&answer.found)?;
        nearmiss::memory::require("the geometry", (found.len() * size_of::<NearmissGeometry>()) as u64)?;
        answer.geometry = found.iter().map(Into::into).collect();
        show(&answer.geometry, items, count)
    })
}

/// Frees the answer, with all that it showed.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_free(answer: Option<Box<NearmissAnswer>>) {
    free(answer);
}
