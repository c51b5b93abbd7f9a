//! Answers and their rows.

use crate::error::{NearmissCode, NearmissError, call, free, given, refused};
use crate::geometry::{NearmissGeometry, NearmissPairGeometry};
use crate::grouped::ShownCurves;
use crate::records::{
    NearmissBodyPair, NearmissContact, NearmissNearPair, NearmissNearest, NearmissTrianglePair,
};
use nearmiss::contacts::Grouped;
use nearmiss::{Contacts, Error, Rows};
use std::ffi::{CString, c_char};
use std::mem::MaybeUninit;

/// The answer to a query. It never changes, and needs neither detector nor device.
pub struct NearmissAnswer {
    pub(crate) found: Contacts,
    shown: Shown,
    pub(crate) geometry: Vec<NearmissGeometry>,
    pub(crate) pairs: Vec<NearmissPairGeometry>,
    pub(crate) grouped: Grouped,
    pub(crate) least: Vec<f64>,
    pub(crate) curves: ShownCurves,
    pub(crate) caveats: Vec<CString>,
    pub(crate) notes: Vec<CString>,
    pub(crate) peak: u64,
}

/// Rows, as C sees them.
enum Shown {
    Pairs(Vec<NearmissTrianglePair>),
    Contacts(Vec<NearmissContact>),
    Near(Vec<NearmissNearPair>),
    Earliest,
    Nearest,
    BodyPairs(Vec<NearmissBodyPair>),
    BodyDistances(Vec<NearmissNearest>),
}

impl NearmissAnswer {
    pub(crate) fn new(found: Contacts, peak: u64) -> Result<NearmissAnswer, Error> {
        let bytes = found.len() as u64 * size_of::<NearmissNearest>() as u64;
        nearmiss::memory::require("the answer", bytes)?;
        let shown = match &found.rows {
            Rows::Pairs(pairs) => Shown::Pairs(pairs.iter().map(Into::into).collect()),
            Rows::Contacts(contacts) => Shown::Contacts(contacts.iter().map(Into::into).collect()),
            Rows::Near(pairs) => Shown::Near(pairs.iter().map(Into::into).collect()),
            Rows::Earliest(_) => Shown::Earliest,
            Rows::Distance(_) => Shown::Nearest,
            Rows::BodyPairs(pairs) => Shown::BodyPairs(pairs.iter().map(Into::into).collect()),
            Rows::BodyDistances(all) => Shown::BodyDistances(all.iter().map(Into::into).collect()),
        };
        let caveats = found.caveats().iter().map(sentence).collect();
        Ok(NearmissAnswer {
            found,
            shown,
            geometry: Vec::new(),
            pairs: Vec::new(),
            grouped: Grouped::default(),
            least: Vec::new(),
            curves: ShownCurves::default(),
            caveats,
            notes: Vec::new(),
            peak,
        })
    }

    /// Refuses answers without triangle pairs.
    pub(crate) fn require_pairs(&self) -> Result<(), Error> {
        if let Rows::Pairs(_) = self.found.rows { Ok(()) } else { Err(self.without("triangle pairs")) }
    }

    /// Rows that the answer does not have.
    pub(crate) fn without(&self, rows: &str) -> Error {
        let (query, call) = match self.shown {
            Shown::Pairs(_) => ("a discrete", "nearmiss_answer_triangle_pairs"),
            Shown::Contacts(_) => ("a continuous", "nearmiss_answer_contacts"),
            Shown::Near(_) => ("a near", "nearmiss_answer_near_pairs"),
            Shown::Earliest => ("an earliest", "nearmiss_answer_earliest"),
            Shown::Nearest => ("a distance", "nearmiss_answer_nearest"),
            Shown::BodyPairs(_) => ("a body-pairs", "nearmiss_answer_body_pairs"),
            Shown::BodyDistances(_) => ("a body-distances", "nearmiss_answer_body_distances"),
        };
        refused(format!("answer to {query} query has no {rows}"), format!("call {call}"))
    }
}

/// A text, as C sees it.
pub(crate) fn sentence(text: impl ToString) -> CString {
    CString::new(text.to_string()).unwrap_or_default()
}

/// A text of a list, by its index.
pub(crate) fn shown(texts: &[CString], index: usize, name: &str) -> Result<*const c_char, Error> {
    texts.get(index).map(|text| text.as_ptr()).ok_or_else(|| {
        let what = format!("{name} {index} does not exist; the answer has {}", texts.len());
        refused(what, "count from 0")
    })
}

/// Shows a list. It lives as long as its handle.
pub(crate) fn show<T>(
    list: &[T],
    items: Option<&mut MaybeUninit<*const T>>,
    count: Option<&mut MaybeUninit<usize>>,
) -> Result<(), Error> {
    let (items, count) = (given(items, "items")?, given(count, "count")?);
    items.write(list.as_ptr());
    count.write(list.len());
    Ok(())
}

/// Triangle pairs of a discrete query, ascending by the first triangle and its body, then by the
/// second. The list lives as long as the answer.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_triangle_pairs(
    answer: Option<&NearmissAnswer>,
    items: Option<&mut MaybeUninit<*const NearmissTrianglePair>>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let answer = given(answer, "answer")?;
        let Shown::Pairs(list) = &answer.shown else { return Err(answer.without("triangle pairs")) };
        show(list, items, count)
    })
}

/// Contacts of a continuous query, in canonical order: the same on every machine. The list lives as
/// long as the answer.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_contacts(
    answer: Option<&NearmissAnswer>,
    items: Option<&mut MaybeUninit<*const NearmissContact>>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let answer = given(answer, "answer")?;
        let Shown::Contacts(list) = &answer.shown else { return Err(answer.without("contacts")) };
        show(list, items, count)
    })
}

/// Feature pairs of a near query, in the order of contacts. The list lives as long as the answer.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_near_pairs(
    answer: Option<&NearmissAnswer>,
    items: Option<&mut MaybeUninit<*const NearmissNearPair>>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let answer = given(answer, "answer")?;
        let Shown::Near(list) = &answer.shown else { return Err(answer.without("near pairs")) };
        show(list, items, count)
    })
}

/// The nearest triangles of a distance query. If no two bodies may collide, `is_any` is false and
/// `nearest` is not written.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_nearest(
    answer: Option<&NearmissAnswer>,
    is_any: Option<&mut MaybeUninit<bool>>,
    nearest: Option<&mut MaybeUninit<NearmissNearest>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let answer = given(answer, "answer")?;
        let Shown::Nearest = answer.shown else { return Err(answer.without("nearest triangles")) };
        let (is_any, to) = (given(is_any, "is_any")?, given(nearest, "nearest")?);
        is_any.write(answer.found.nearest().is_some());
        if let Some(found) = answer.found.nearest() {
            to.write(found.into());
        }
        Ok(())
    })
}

/// Pairs of bodies that share a point, ascending by the first body, then by the second. The list
/// lives as long as the answer.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_body_pairs(
    answer: Option<&NearmissAnswer>,
    items: Option<&mut MaybeUninit<*const NearmissBodyPair>>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let answer = given(answer, "answer")?;
        let Shown::BodyPairs(list) = &answer.shown else { return Err(answer.without("body pairs")) };
        show(list, items, count)
    })
}

/// The nearest triangles of each two bodies within the distance, in the order of the bodies. The
/// list lives as long as the answer.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_body_distances(
    answer: Option<&NearmissAnswer>,
    items: Option<&mut MaybeUninit<*const NearmissNearest>>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let answer = given(answer, "answer")?;
        let Shown::BodyDistances(list) = &answer.shown else {
            return Err(answer.without("distances of bodies"));
        };
        show(list, items, count)
    })
}

/// Earliest time of contact of an earliest or a continuous query, in [0, 1]. No contact is earlier.
/// If nothing collides, `is_any` is false and the time is 1. Triangles that cross at the start need
/// not collide again: see `nearmiss_answer_is_free`.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_earliest(
    answer: Option<&NearmissAnswer>,
    is_any: Option<&mut MaybeUninit<bool>>,
    toi: Option<&mut MaybeUninit<f64>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let answer = given(answer, "answer")?;
        if !matches!(answer.shown, Shown::Earliest | Shown::Contacts(_)) {
            return Err(answer.without("earliest time"));
        }
        let (is_any, to) = (given(is_any, "is_any")?, given(toi, "toi")?);
        let found = answer.found.earliest_toi();
        is_any.write(found.is_some());
        to.write(found.unwrap_or(1.0));
        Ok(())
    })
}

/// Whether the answer proves that nothing touches. Continuous and earliest: the start was checked,
/// no triangles share a point there, and nothing collides within the step. Discrete: no pair of
/// triangles shares a point. Distance: it is above 0, or no two bodies may collide. Pairs of bodies:
/// none shares a point. Distances of bodies: all are above 0. Near: always false.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_is_free(
    answer: Option<&NearmissAnswer>,
    is_free: Option<&mut MaybeUninit<bool>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        given(is_free, "is_free")?.write(given(answer, "answer")?.found.is_free());
        Ok(())
    })
}

/// Frees the answer, with all lists and texts that it showed.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_free(answer: Option<Box<NearmissAnswer>>) {
    free(answer);
}
