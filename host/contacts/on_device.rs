//! Where the answer of a submitted frame lies.

pub use nearmiss_kernels::abi::{FrameStatus, Hit, NearHit, NearestHit, Pair};

/// What the entries of a list on the device are, each 8, 32 or 96 bytes: little-endian, without padding. Vertices, triangles and edges
/// are numbered through all bodies: see [`DeviceAnswer::starts`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Entries {
    /// [`Pair`]: two triangles.
    TrianglePairs,
    /// [`Hit`]: a vertex and a face, or two edges, and when they first meet. None of an earliest query.
    Contacts,
    /// [`NearHit`]: a vertex and a face, or two edges, their squared distance and where they are nearest.
    NearPairs,
    /// [`NearestHit`]: two triangles, how far apart they are, and where.
    Nearest,
}

/// A list in the device's memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceList {
    /// Where the first entry lies.
    pub address: u64,
    /// How many entries there is room for.
    pub room: usize,
}

/// Where the answer of a submitted frame lies in the device's memory, until the detector is asked anything else: see
/// [`Detector::submit`](crate::Detector::submit).
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DeviceAnswer {
    /// What the entries are.
    pub entries: Entries,
    /// One list of triangle pairs. Of features one list, in which those of vertices and faces come first, if the device has put
    /// them [in order](DeviceAnswer::is_ordered); else a list of those and one of edges.
    pub lists: Vec<DeviceList>,
    /// Whether entries are in canonical order: on a GPU, if numbers of 64 bits can tell them apart.
    pub is_ordered: bool,
    /// Where the [`FrameStatus`] lies: how many entries there are, and whether the answer is whole.
    pub status: u64,
    /// Of an earliest query where its time lies: an f64, all bits set where nothing meets. The next
    /// 8 bytes are twice those bits, plus 1 if the time is that of an undecided pair and of no
    /// contact.
    pub earliest: Option<u64>,
    /// The two vertices of every edge, 8 bytes each; none of a discrete query.
    pub edges: DeviceList,
    /// The first vertex, triangle and edge of each body, and at the end how many there are in all.
    pub starts: Vec<[u32; 3]>,
}
