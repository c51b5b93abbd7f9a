//! Where the answer of a submitted frame lies.

use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given};
use nearmiss::Error;
use nearmiss::contacts::on_device::{self, DeviceAnswer, DeviceList, Entries};
use std::mem::{MaybeUninit, offset_of};

/// What the entries of a list on the device are. Vertices, triangles and edges are numbered through all bodies.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissEntries {
    /// `NearmissDevicePair`: two triangles.
    NEARMISS_TRIANGLE_PAIRS = 0,
    /// `NearmissDeviceHit`: a vertex and a face, or two edges, and when they first meet. None of an earliest query.
    NEARMISS_CONTACTS = 1,
    /// `NearmissDeviceNearHit`: a vertex and a face, or two edges, and where they are nearest.
    NEARMISS_NEAR_PAIRS = 2,
    /// `NearmissDeviceNearest`: two triangles, how far apart they are, and where.
    NEARMISS_NEAREST = 3,
}

/// A list in the device's memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct NearmissDeviceList {
    /// Where the first entry lies.
    pub address: u64,
    /// How many entries there is room for.
    pub room: u64,
}

/// Where the answer of a submitted frame lies in the device's memory, until the detector is asked anything else.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissDeviceAnswer {
    /// What the entries are.
    pub entries: NearmissEntries,
    /// How many lists there are, 0 to 2. Of features one, in which those of vertices and faces come first, if they are in order; else one
    /// of those and one of edges.
    pub list_count: u32,
    /// They.
    pub lists: [NearmissDeviceList; 2],
    /// Whether entries are in canonical order.
    pub is_ordered: bool,
    /// Whether `earliest` is an address: of an earliest query.
    pub has_earliest: bool,
    /// Where the `NearmissFrameStatus` lies.
    pub status: u64,
    /// Where the earliest time lies: a double, all bits set where nothing meets. The next 8 bytes
    /// are twice those bits, plus 1 if the time is that of an undecided pair and of no contact.
    pub earliest: u64,
    /// The two vertices of every edge, 8 bytes each; none of a discrete query.
    pub edges: NearmissDeviceList,
    /// In memory of the host, until the next call with the detector: the first vertex, triangle and edge of each body, and at the end how
    /// many there are in all.
    pub starts: *const [u32; 3],
    /// How many of them: one more than bodies.
    pub start_count: usize,
}

/// Two triangles, as they lie on the device.
#[repr(C)]
pub struct NearmissDevicePair {
    /// The first of the two.
    pub a: u32,
    /// The second.
    pub b: u32,
}

/// Two features that meet, as they lie on the device.
#[repr(C)]
pub struct NearmissDeviceHit {
    /// The vertex, or the first edge.
    pub a: u32,
    /// The face, or the second edge.
    pub b: u32,
    /// No contact before.
    pub toi: f64,
    /// The first contact is not after; the end of the step, where there need be none.
    pub toi_upper: f64,
    /// 1 contact, 2 undecided; and 4 where the budget ended.
    pub state: u32,
    /// Boxes looked at.
    pub boxes: u32,
}

/// Two features within a distance, as they lie on the device.
#[repr(C)]
pub struct NearmissDeviceNearHit {
    /// The vertex, or the first edge.
    pub a: u32,
    /// The face, or the second edge.
    pub b: u32,
    /// Their squared distance.
    pub squared: f64,
    /// Where they are nearest: the weights of the face's corners 1 and 2; or how far along both edges.
    pub at: [f64; 2],
}

/// The two nearest triangles, as they lie on the device.
#[repr(C)]
pub struct NearmissDeviceNearest {
    /// The triangle of the smaller index.
    pub a: u32,
    /// The other.
    pub b: u32,
    /// How far they are apart: 0 only if they share a point.
    pub distance: f64,
    /// Of each the weights of corners 1 and 2.
    pub at: [[f64; 2]; 2],
    /// The nearest points.
    pub points: [[f64; 3]; 2],
}

/// What a submitted frame came to, as it lies on the device.
#[repr(C)]
pub struct NearmissFrameStatus {
    /// Entries of the first list; of an earliest query 0.
    pub first: u64,
    /// Entries of the second list. Where one list has both kinds in order, how many of the second kind follow.
    pub second: u64,
    /// How many lists had too little room. Unless this is 0 no part of the answer may be used.
    pub short_of_room: u64,
    /// Not 0 where positions or poses of the caller cannot be computed with: then there is no answer.
    pub invalid: u64,
    /// Triangle pairs that share a point at the start of the step; all bits set if the start is not
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

/// Where the answer of what is submitted will lie, for kernels of the caller behind it. Fails with `NEARMISS_INVALID_ARGUMENT` where the detector is
/// not prepared, or no two of its bodies can meet.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_on_device(
    detector: Option<&mut NearmissDetector>,
    answer: Option<&mut MaybeUninit<NearmissDeviceAnswer>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let to = given(answer, "the answer")?;
        let found = own.detector.on_device(&own.query).ok_or_else(|| Error::InvalidArgument {
            what: "an answer on the device of a detector that is not prepared, or in which nothing can meet"
                .into(),
            advice: "prepare it, or ask by nearmiss_detector_frame".into(),
        })?;
        let DeviceAnswer { entries, lists, is_ordered, status, earliest, edges, starts, .. } = found;
        own.starts = starts;
        let mut both = [NearmissDeviceList::default(); 2];
        both.iter_mut().zip(&lists).for_each(|(to, list)| *to = (*list).into());
        let entries = match entries {
            Entries::TrianglePairs => NearmissEntries::NEARMISS_TRIANGLE_PAIRS,
            Entries::Contacts => NearmissEntries::NEARMISS_CONTACTS,
            Entries::NearPairs => NearmissEntries::NEARMISS_NEAR_PAIRS,
            Entries::Nearest => NearmissEntries::NEARMISS_NEAREST,
            other => return Err(Error::Bug { what: format!("entries {other:?} without a name in C") }),
        };
        to.write(NearmissDeviceAnswer {
            entries,
            list_count: lists.len().min(2) as u32,
            lists: both,
            is_ordered,
            has_earliest: earliest.is_some(),
            status,
            earliest: earliest.unwrap_or(0),
            edges: edges.into(),
            starts: own.starts.as_ptr(),
            start_count: own.starts.len(),
        });
        Ok(())
    })
}
