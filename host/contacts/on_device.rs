//! Addresses of a submitted frame's answer on the device.

use super::GroupBy;

pub use nearmiss_kernels::abi::{FrameStatus, Hit, NearHit, NearestHit, Pair, RowGeometry};

/// Type of the entries of a list on the device, each 8, 32 or 96 bytes: little-endian, without
/// padding. Vertices, triangles and edges are numbered through all bodies: see
/// [`DeviceAnswer::starts`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Entries {
    /// [`Pair`]: two triangles.
    TrianglePairs,
    /// [`Hit`]: a vertex and an [element](crate::Body::elements), or two edges, and their first time
    /// of contact. An earliest query has none, unless [`DeviceExtras::with_first_contacts`] wants
    /// those at its time.
    Contacts,
    /// [`NearHit`]: a vertex and an [element](crate::Body::elements), or two edges, their squared
    /// distance and nearest points.
    NearPairs,
    /// [`NearestHit`]: two triangles, their distance and nearest points. Distances of bodies have
    /// an entry for each pair of bodies, in no order.
    Nearest,
    /// [`Pair`]: two bodies that share a point, by their places in the scene, the smaller first, in no
    /// order. [`BodyPairs::first`](crate::BodyPairs::first) may leave more here than it wants.
    BodyPairs,
}

/// List in device memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceList {
    /// Address of the first entry.
    pub address: u64,
    /// Number of entries that fit.
    pub room: usize,
}

/// Parts of an answer that a submission makes in device memory, on request: see
/// [`Detector::prepare_with`](crate::Detector::prepare_with).
///
/// Rows are numbered through both [lists](DeviceAnswer::lists), features through all bodies. An
/// answer has the parts that it can have. Continuous and near answers have all. Discrete answers are
/// grouped by face and by corner. Earliest answers have the contacts at their time, and then all
/// parts of these. Others have none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DeviceExtras {
    pub(crate) geometry: bool,
    pub(crate) least: bool,
    pub(crate) groups: Vec<GroupBy>,
    pub(crate) first_contacts: bool,
}

impl DeviceExtras {
    /// Adds a [`RowGeometry`] for each row. Cost: 128 bytes a row that there is room for.
    #[must_use]
    pub fn with_geometry(self) -> DeviceExtras {
        DeviceExtras { geometry: true, ..self }
    }

    /// Adds the least time of contact, or the least distance, of each vertex, as of
    /// [`Detector::least_by_vertex`](crate::Detector::least_by_vertex). Cost: 8 bytes a vertex.
    #[must_use]
    pub fn with_least_by_vertex(self) -> DeviceExtras {
        DeviceExtras { least: true, ..self }
    }

    /// Adds the rows of each feature, as of [`Detector::grouped`](crate::Detector::grouped). Cost: a
    /// sort, and 20 bytes for each feature of a row: of [`GroupBy::Corner`] four, or six of two
    /// triangles.
    #[must_use]
    pub fn grouped_by(mut self, by: GroupBy) -> DeviceExtras {
        if !self.groups.contains(&by) {
            self.groups.push(by);
        }
        self
    }

    /// Adds the contacts at the time of an earliest query, as of
    /// [`Detector::first_contacts`](crate::Detector::first_contacts): `lists` of its answer have them,
    /// in no order, and the status counts them. Other parts are then of these rows too. Cost: some
    /// ten launches, which test the pairs that may begin at that time. With a minimum separation or a
    /// cubic solver these are all pairs.
    #[must_use]
    pub fn with_first_contacts(self) -> DeviceExtras {
        DeviceExtras { first_contacts: true, ..self }
    }

    /// The parts that rows of features can have, or rows of triangles.
    pub(crate) fn of(&self, of_features: bool) -> DeviceExtras {
        let of_triangles = |by: &GroupBy| matches!(by, GroupBy::Face | GroupBy::Corner);
        let groups = self.groups.iter().copied().filter(|by| of_features || of_triangles(by));
        let (geometry, least) = (self.geometry && of_features, self.least && of_features);
        DeviceExtras { geometry, least, groups: groups.collect(), first_contacts: false }
    }

    /// Whether there are none.
    pub(crate) fn is_empty(&self) -> bool {
        *self == DeviceExtras::default()
    }
}

/// Rows by feature in device memory, as in [`Grouped`](super::Grouped).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DeviceGroups {
    /// Features by which they are grouped.
    pub by: GroupBy,
    /// First row of each feature of all bodies, and the end: u32.
    pub starts: DeviceList,
    /// Numbers of rows: u32. All bits of an unused one are set.
    pub rows: DeviceList,
}

/// Addresses of a submitted frame's answer in device memory. They are valid until another call on
/// the detector: see [`Detector::submit`](crate::Detector::submit).
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DeviceAnswer {
    /// Type of the entries.
    pub entries: Entries,
    /// One list of triangle pairs. Feature pairs have one list, vertex/face pairs first, if the
    /// device has put them [in order](DeviceAnswer::is_ordered). Otherwise they have two:
    /// vertex/face pairs, then edge/edge pairs.
    pub lists: Vec<DeviceList>,
    /// Whether entries are in canonical order: on a GPU, if there are any rows. Feature pairs are not
    /// if a body has edges of no face or points.
    pub is_ordered: bool,
    /// Address of the [`FrameStatus`]: the number of entries, and whether the answer is complete. Its
    /// counts, those of crossings included, are usable only if `short` and `invalid` are 0.
    pub status: u64,
    /// Address of an earliest query's time: an f64, all bits set if nothing meets. The next 8 bytes
    /// are twice those bits, plus 1 if only an undecided pair has that time.
    pub earliest: Option<u64>,
    /// The two vertices of every edge, 8 bytes each; none for a discrete query.
    pub edges: DeviceList,
    /// First vertex, triangle and edge of each body; the last entry has the totals.
    pub starts: Vec<[u32; 3]>,
    /// A [`RowGeometry`] for each row, on request. Unused rows are zeros, of weight 0.
    pub geometry: Option<DeviceList>,
    /// Least time or distance of each vertex, on request: f64, infinity without a row.
    pub least_by_vertex: Option<DeviceList>,
    /// Rows by feature, on request, in the order of the request.
    pub grouped: Vec<DeviceGroups>,
}
