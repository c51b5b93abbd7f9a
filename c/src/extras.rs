//! Parts of an answer that submissions make in memory of the device, on request.

use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given};
use crate::grouped::by_of;
use crate::motion::NearmissMotion;
use crate::on_device::NearmissDeviceList;
use crate::query::NearmissQuery;
use crate::rows::items;
use nearmiss::contacts::on_device::{DeviceExtras, RowGeometry};
use nearmiss::contacts::{DeviceAnswer, DeviceList};
use std::mem::{MaybeUninit, offset_of};

/// Parts of answers that submissions also make on the device. Begin by `nearmiss_device_extras()`.
///
/// Answers to continuous and near queries have all parts. Those of discrete queries have groups by
/// face and by corner. Those of earliest queries have the contacts at their time, and then all parts
/// of these. Others have none.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissDeviceExtras {
    /// 1: a `NearmissDeviceRowGeometry` for each row. Cost: 128 bytes a row that there is room for.
    pub geometry: u32,
    /// 1: the least time or distance of each vertex. Cost: 8 bytes a vertex.
    pub least_by_vertex: u32,
    /// Features by which rows are grouped: each a `NearmissGroupBy`. NULL for none. Cost of each: a
    /// sort, and 20 bytes for each feature of a row.
    pub grouped_by: *const u32,
    /// How many there are.
    pub group_count: usize,
    /// 1: the contacts at the time of an earliest query, in the lists of its answer, in no order.
    /// The status counts them, and other parts are of these rows too.
    pub first_contacts: u32,
}

/// Geometry of a row, in memory of the device. Unused rows are zeros, so they weigh nothing.
#[repr(C)]
pub struct NearmissDeviceRowGeometry {
    /// Distance of the nearest points.
    pub distance: f64,
    /// Unit vector from the second feature towards the first; zeros if no direction is defined.
    pub normal: [f64; 3],
    /// Weight of each vertex in the nearest point of its feature, negative for the second feature.
    pub signed_weights: [f64; 4],
    /// Nearest points of both features at the time of contact.
    pub points: [[f64; 3]; 2],
    /// The vertices, numbered through all bodies: a vertex and the face's corners, or the ends of
    /// two edges. With fewer, the last one is repeated.
    pub vertices: [u32; 4],
}

/// Addresses of the parts of an answer, in memory of the device. A part that was not prepared has
/// address 0. Rows are numbered through both lists, features through all bodies.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissExtrasOnDevice {
    /// A `NearmissDeviceRowGeometry` for each row.
    pub geometry: NearmissDeviceList,
    /// A double for each vertex: its least time or distance, infinity without a row.
    pub least_by_vertex: NearmissDeviceList,
    /// For each `NearmissGroupBy`: a uint32_t for each feature, and the end. The rows of feature i
    /// are `rows[starts[i]]` to `rows[starts[i + 1] - 1]`, ascending.
    pub starts: [NearmissDeviceList; 4],
    /// For each `NearmissGroupBy`: numbers of rows, uint32_t. All bits of an unused one are set.
    pub rows: [NearmissDeviceList; 4],
}

// The kernels write it: the header may not differ.
const _: () = {
    assert!(size_of::<NearmissDeviceRowGeometry>() == size_of::<RowGeometry>());
    assert!(offset_of!(NearmissDeviceRowGeometry, normal) == offset_of!(RowGeometry, normal));
    assert!(offset_of!(NearmissDeviceRowGeometry, signed_weights) == offset_of!(RowGeometry, signed_weights));
    assert!(offset_of!(NearmissDeviceRowGeometry, points) == offset_of!(RowGeometry, points));
    assert!(offset_of!(NearmissDeviceRowGeometry, vertices) == offset_of!(RowGeometry, vertices));
};

/// No parts.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_extras() -> NearmissDeviceExtras {
    NearmissDeviceExtras {
        geometry: 0,
        least_by_vertex: 0,
        grouped_by: std::ptr::null(),
        group_count: 0,
        first_contacts: 0,
    }
}

/// As `nearmiss_detector_prepare`, with parts of the answers that submissions also make on the
/// device: geometry of rows, rows by feature, the least time or distance of each vertex.
/// `nearmiss_detector_extras_on_device` returns their addresses. Contacts at the earliest time are
/// in the lists of `nearmiss_detector_on_device`.
///
/// Fails as there; with `NEARMISS_INVALID_ARGUMENT` if no query can have a part, and for geometry of
/// a step in which a rigid body may turn. Several devices have no contacts at the earliest time.
///
/// # Safety
/// As of `nearmiss_detector_prepare`. So many numbers are in `grouped_by`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_prepare_with(
    detector: Option<&mut NearmissDetector>,
    motions: *const NearmissMotion,
    motion_count: usize,
    queries: *const NearmissQuery,
    query_count: usize,
    extras: Option<&NearmissDeviceExtras>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let wanted = given(extras, "extras")?;
        let mut extras = DeviceExtras::default();
        if wanted.geometry != 0 {
            extras = extras.with_geometry();
        }
        if wanted.least_by_vertex != 0 {
            extras = extras.with_least_by_vertex();
        }
        if wanted.first_contacts != 0 {
            extras = extras.with_first_contacts();
        }
        // SAFETY: the caller's promise.
        for by in unsafe { items(wanted.grouped_by, wanted.group_count, "grouped_by") }? {
            extras = extras.grouped_by(by_of(*by)?);
        }
        // SAFETY: the caller's promise.
        unsafe { own.prepared_with((motions, motion_count), (queries, query_count), &extras) }
    })
}

/// Addresses of the parts of the answer to a prepared query, for kernels of the caller on the same
/// stream. Call it after each `nearmiss_detector_prepare_with`. Fails as
/// `nearmiss_detector_on_device`.
///
/// # Safety
/// The names of the query are texts or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_extras_on_device(
    detector: Option<&mut NearmissDetector>,
    query: Option<&NearmissQuery>,
    extras: Option<&mut MaybeUninit<NearmissExtrasOnDevice>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let to = given(extras, "extras")?;
        // SAFETY: the caller's promise.
        let query = unsafe { given(query, "query")?.query() }?;
        let DeviceAnswer { geometry, least_by_vertex, grouped, .. } = own.found_on_device(&query)?;
        let list = |list: Option<DeviceList>| list.map_or_else(NearmissDeviceList::default, Into::into);
        let mut shown = NearmissExtrasOnDevice {
            geometry: list(geometry),
            least_by_vertex: list(least_by_vertex),
            starts: [NearmissDeviceList::default(); 4],
            rows: [NearmissDeviceList::default(); 4],
        };
        for groups in grouped {
            let at = groups.by as usize;
            (shown.starts[at], shown.rows[at]) = (groups.starts.into(), groups.rows.into());
        }
        to.write(shown);
        Ok(())
    })
}
