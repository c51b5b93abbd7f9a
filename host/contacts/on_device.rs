//! Addresses of a submitted frame's answer on the device.

pub use nearmiss_kernels::abi::{FrameStatus, Hit, NearHit, NearestHit, Pair};

/// Type of the entries of a list on the device, each 8, 32 or 96 bytes: little-endian, without
/// padding. Vertices, triangles and edges are numbered through all bodies: see
/// [`DeviceAnswer::starts`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Entries {
    /// [`Pair`]: two triangles.
    TrianglePairs,
    /// [`Hit`]: a vertex and an [element](crate::Body::elements), or two edges, and their first time
    /// of contact. An earliest query has none.
    Contacts,
    /// [`NearHit`]: a vertex and an [element](crate::Body::elements), or two edges, their squared
    /// distance and nearest points.
    NearPairs,
    /// [`NearestHit`]: two triangles, their distance and nearest points.
    Nearest,
}

/// List in device memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceList {
    /// Address of the first entry.
    pub address: u64,
    /// Number of entries that fit.
    pub room: usize,
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
}
