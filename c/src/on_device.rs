//! Answers of a submission, in memory of the device.

use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given, refused};
use crate::query::NearmissQuery;
use nearmiss::contacts::on_device::{self, DeviceAnswer, DeviceList, Entries};
use nearmiss::{Error, Query};
use std::mem::{MaybeUninit, offset_of};

/// Types of entries of a list on the device. Vertices, triangles and edges are numbered through all
/// bodies.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissEntries {
    /// `NearmissDevicePair`: two triangles.
    NEARMISS_TRIANGLE_PAIRS = 0,
    /// `NearmissDeviceHit`: a vertex and a triangle, or two edges, and their times of contact. An
    /// earliest query has none, or on request those at its time: `NearmissDeviceExtras`.
    NEARMISS_CONTACTS = 1,
    /// `NearmissDeviceNearHit`: a vertex and a triangle, or two edges, and their nearest points.
    NEARMISS_NEAR_PAIRS = 2,
    /// `NearmissDeviceNearest`: two triangles, their distance and nearest points.
    NEARMISS_NEAREST = 3,
    /// `NearmissDevicePair`: two bodies that share a point, by their places in the scene. In no
    /// order.
    NEARMISS_PAIRS_OF_BODIES = 4,
}

/// A list in memory of the device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct NearmissDeviceList {
    /// Address of the first entry.
    pub address: u64,
    /// Room, in entries.
    pub room: u64,
}

/// Addresses of the answer to a submitted query, in memory of the device. They hold until the
/// detector is no longer prepared.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissDeviceAnswer {
    /// Type of the entries.
    pub entries: NearmissEntries,
    /// Number of lists, 0 to 2. Ordered feature pairs have one list: vertex/face rows, then
    /// edge/edge rows. Others have a list of vertex/face rows and a list of edge/edge rows.
    pub list_count: u32,
    /// The lists.
    pub lists: [NearmissDeviceList; 2],
    /// Whether entries are in canonical order.
    pub is_ordered: bool,
    /// Whether `earliest` is an address: of an earliest query.
    pub has_earliest: bool,
    /// Address of the `NearmissFrameStatus`.
    pub status: u64,
    /// Address of the earliest time: a double, with all bits set if nothing collides. The next 8
    /// bytes are twice those bits, plus 1 if the time is that of an undecided pair only.
    pub earliest: u64,
    /// The two vertices of every edge, 8 bytes each; none of a discrete query.
    pub edges: NearmissDeviceList,
    /// The first vertex, triangle and edge of each body, and at the end the numbers of all. In
    /// memory of the host, until the next preparation.
    pub starts: *const [u32; 3],
    /// Length of `starts`: the number of bodies, and one more.
    pub start_count: usize,
}

/// Two triangles, or two bodies, in memory of the device.
#[repr(C)]
pub struct NearmissDevicePair {
    /// The triangles, or the bodies.
    pub triangles: [u32; 2],
}

/// Two features that collide, in memory of the device.
#[repr(C)]
pub struct NearmissDeviceHit {
    /// The vertex, or the first edge.
    pub feature_a: u32,
    /// The face, or the second edge.
    pub feature_b: u32,
    /// Time of contact, never late.
    pub toi: f64,
    /// Upper bound of the first contact; undecided: 1.
    pub toi_upper: f64,
    /// 1: contact. 2: undecided. 4 is added if `max_iterations` ended.
    pub state: u32,
    /// Iterations of the solver.
    pub iterations: u32,
}

/// Two features within a distance, in memory of the device.
#[repr(C)]
pub struct NearmissDeviceNearHit {
    /// The vertex, or the first edge.
    pub feature_a: u32,
    /// The face, or the second edge.
    pub feature_b: u32,
    /// Squared distance.
    pub squared_distance: f64,
    /// Nearest points. Vertex/face: weights of the face's corners 1 and 2. Edge/edge: the place on
    /// each edge, from 0 at its larger vertex index to 1.
    pub at: [f64; 2],
}

/// The two nearest triangles, in memory of the device.
#[repr(C)]
pub struct NearmissDeviceNearest {
    /// The triangles, the smaller index first.
    pub triangles: [u32; 2],
    /// Distance; 0 only if they share a point.
    pub distance: f64,
    /// Weights of corners 1 and 2 of each.
    pub at: [[f64; 2]; 2],
    /// The nearest points.
    pub points: [[f64; 3]; 2],
}

/// Counts of a submitted query, in memory of the device.
#[repr(C)]
pub struct NearmissFrameStatus {
    /// Entries of the first list; of an earliest query 0, unless its contacts were prepared.
    pub first: u64,
    /// Entries of the second list. In one ordered list: the number of edge/edge rows.
    pub second: u64,
    /// Number of lists that were too short. Unless it is 0, no part of the answer may be used.
    pub short_of_room: u64,
    /// Not 0 if positions or poses were invalid. Then there is no answer.
    pub invalid: u64,
    /// Triangle pairs that share a point at the start of the step. All bits are set if it was not
    /// checked. Part of the answer: usable only if `short_of_room` and `invalid` are 0.
    pub crossing: u64,
}

// The kernels write these: the header may not differ.
const _: () = {
    assert!(size_of::<NearmissDevicePair>() == size_of::<on_device::Pair>());
    assert!(size_of::<NearmissDeviceHit>() == size_of::<on_device::Hit>());
    assert!(offset_of!(NearmissDeviceHit, toi) == offset_of!(on_device::Hit, verdict));
    assert!(size_of::<NearmissDeviceNearHit>() == size_of::<on_device::NearHit>());
    assert!(offset_of!(NearmissDeviceNearHit, at) == offset_of!(on_device::NearHit, at));
    assert!(size_of::<NearmissDeviceNearest>() == size_of::<on_device::NearestHit>());
    assert!(offset_of!(NearmissDeviceNearest, points) == offset_of!(on_device::NearestHit, points));
    assert!(size_of::<NearmissFrameStatus>() == size_of::<on_device::FrameStatus>());
    assert!(offset_of!(NearmissFrameStatus, crossing) == offset_of!(on_device::FrameStatus, crossing));
    assert!(offset_of!(NearmissFrameStatus, short_of_room) == offset_of!(on_device::FrameStatus, short));
};

impl From<DeviceList> for NearmissDeviceList {
    fn from(DeviceList { address, room }: DeviceList) -> NearmissDeviceList {
        NearmissDeviceList { address, room: room as u64 }
    }
}

impl NearmissDetector {
    /// Why a query has no answer on the device.
    fn not_on_device(&self, query: &Query) -> Error {
        let kind = query.kind();
        if !self.detector.is_prepared() {
            return refused("detector is not prepared", "call nearmiss_detector_prepare");
        }
        if !self.prepared.contains(query) {
            let what = format!("this {kind} query is not prepared with these numbers");
            return refused(what, "pass it to nearmiss_detector_prepare");
        }
        let what = format!("this {kind} query has no answer on the device: no two bodies may collide");
        refused(what, "call nearmiss_detector_collect, or change groups and masks")
    }

    /// The answer to a query on the only device.
    pub(crate) fn found_on_device(&mut self, query: &Query) -> Result<DeviceAnswer, Error> {
        let found = self.detector.one("one answer in device memory")?.on_device(query);
        found.ok_or_else(|| self.not_on_device(query))
    }

    /// An answer as C sees it.
    fn shown(&mut self, found: DeviceAnswer) -> Result<NearmissDeviceAnswer, Error> {
        let DeviceAnswer { entries, lists, is_ordered, status, earliest, edges, starts, .. } = found;
        let entries = match entries {
            Entries::TrianglePairs => NearmissEntries::NEARMISS_TRIANGLE_PAIRS,
            Entries::Contacts => NearmissEntries::NEARMISS_CONTACTS,
            Entries::NearPairs => NearmissEntries::NEARMISS_NEAR_PAIRS,
            Entries::Nearest => NearmissEntries::NEARMISS_NEAREST,
            Entries::BodyPairs => NearmissEntries::NEARMISS_PAIRS_OF_BODIES,
            other => return Err(Error::Bug { what: format!("entries {other:?} without a name in C") }),
        };
        let mut both = [NearmissDeviceList::default(); 2];
        both.iter_mut().zip(&lists).for_each(|(to, list)| *to = (*list).into());
        let starts = self.keep(starts);
        Ok(NearmissDeviceAnswer {
            entries,
            list_count: lists.len().min(2) as u32,
            lists: both,
            is_ordered,
            has_earliest: earliest.is_some(),
            status,
            earliest: earliest.unwrap_or(0),
            edges: edges.into(),
            starts: starts.as_ptr(),
            start_count: starts.len(),
        })
    }

    /// Keeps a list that the caller reads until the next preparation.
    fn keep(&mut self, starts: Vec<[u32; 3]>) -> &[[u32; 3]] {
        let at = self.starts.iter().position(|kept| *kept == starts).unwrap_or_else(|| {
            self.starts.push(starts);
            self.starts.len() - 1
        });
        &self.starts[at]
    }
}

/// Addresses of the answer to a prepared query, for kernels of the caller on the same stream. Call
/// it after each `nearmiss_detector_prepare`. Fails with `NEARMISS_INVALID_ARGUMENT` if the query is
/// not prepared with these numbers, or no two bodies may collide.
///
/// # Safety
/// The names of the query are texts or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_on_device(
    detector: Option<&mut NearmissDetector>,
    query: Option<&NearmissQuery>,
    answer: Option<&mut MaybeUninit<NearmissDeviceAnswer>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let to = given(answer, "answer")?;
        // SAFETY: the caller's promise.
        let query = unsafe { given(query, "query")?.query() }?;
        let found = own.found_on_device(&query)?;
        to.write(own.shown(found)?);
        Ok(())
    })
}

/// The same for a detector on several devices: the answer of each to its share, in its memory, and
/// behind the work of its stream. An earliest query has the time of each share. There are as many
/// answers as devices, in their order. A detector on one device has one.
///
/// Fails as `nearmiss_detector_on_device` does, and for another number of answers.
///
/// # Safety
/// There is room for so many answers. The names of the query are texts or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_on_each_device(
    detector: Option<&mut NearmissDetector>,
    query: Option<&NearmissQuery>,
    answers: *mut NearmissDeviceAnswer,
    answer_count: usize,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        // SAFETY: the caller's promise.
        let query = unsafe { given(query, "query")?.query() }?;
        own.one_a_device(answer_count, "answers", answers.is_null())?;
        let found = own.detector.on_device(&query).ok_or_else(|| own.not_on_device(&query))?;
        for (at, found) in found.into_iter().enumerate() {
            let shown = own.shown(found)?;
            // SAFETY: there is room for so many, as the caller promises.
            unsafe { answers.add(at).write(shown) };
        }
        Ok(())
    })
}
