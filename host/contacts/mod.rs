//! Results: contacts in canonical order, and their hash.

mod bodies;
mod caveats;
mod curves;
mod first;
pub(crate) mod geometry;
mod grouped;
mod hash;
pub(crate) mod located;
mod merge;
mod near;
mod nearest;
mod notes;
pub mod on_device;
mod pairs;
mod rows;
pub(crate) mod sort;
mod stats;
pub(crate) mod summary;
mod triangles;
pub(crate) mod work;

pub use bodies::BodyPair;
pub use caveats::{Caveat, TURN_DEGREES};
pub use curves::{Curve, Curves, crossing_curves};
pub use first::{First, FirstContact};
pub use geometry::ContactGeometry;
pub use grouped::{GroupBy, Grouped};
pub use located::{Geometry, Located};
pub use near::{Closest, NearPair};
pub use nearest::NearestTriangles;
pub use notes::Note;
pub use on_device::{DeviceAnswer, DeviceExtras, DeviceGroups, DeviceList, Entries};
pub use pairs::{END_ERROR, PairGeometry, PairKind, Part};
pub use rows::RowList;
pub(crate) use rows::{Keep, Row};
pub use stats::Stats;
pub(crate) use summary::Summary;
pub use triangles::{TriangleContact, triangle_contacts};
pub(crate) use work::{Front, Queues};

use crate::query::{Query, TypedQuery};
use crate::scene::BodyId;
use nearmiss_kernels::prim::inclusion::Verdict;

/// Kind of a pair of features. Its number (`as u8`) is used in files and in other languages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
#[repr(u8)]
pub enum Kind {
    /// A vertex and a face. The vertex is `feature_a`, whichever body has it.
    Vf = 0,
    /// Two edges, numbered by (larger vertex, smaller vertex), ascending; or as
    /// [given](crate::Mesh::with_edges).
    Ee = 1,
    /// An edge of no face and a vertex. The edge is `feature_a`, whichever body has it.
    Ev = 2,
    /// Two vertices, one of them a point: of no face and no edge.
    Vv = 3,
}

impl Kind {
    /// Number of vertices of `feature_a`: the first ones of [`ContactGeometry`].
    pub const fn vertices_of_a(self) -> usize {
        match self {
            Kind::Vf | Kind::Vv => 1,
            Kind::Ee | Kind::Ev => 2,
        }
    }

    /// Its name: `vf`, `ee`, `ev`, `vv`.
    pub const fn name(self) -> &'static str {
        match self {
            Kind::Vf => "vf",
            Kind::Ee => "ee",
            Kind::Ev => "ev",
            Kind::Vv => "vv",
        }
    }
}

/// Certainty of a contact. Its number (`as u8`) is used in the hash, in files and in other
/// languages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
#[repr(u8)]
pub enum Status {
    /// Found by a solver that can be wrong.
    Unverified = 0,
    /// Contact proven, first in `[toi, toi_upper]`.
    Certified = 1,
    /// The pair comes nearer than the tolerance, or its iterations ended. Proven: no contact before
    /// `toi`.
    Undecided = 2,
}

impl Status {
    /// Returns the status of a pair listed by a solver, certified or not.
    #[doc(hidden)]
    pub fn of(certified: bool, verdict: &Verdict) -> Status {
        match (certified, verdict.is_contact()) {
            (_, false) => Status::Undecided,
            (false, true) => Status::Unverified,
            (true, true) => Status::Certified,
        }
    }
}

/// Two features that meet within the step, or come as near as the minimum separation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[repr(C)]
pub struct Contact {
    /// Bodies of both features, in their order. Between two edges, or two points, the smaller number
    /// comes first.
    pub bodies: [BodyId; 2],
    /// Index of the first feature of the [kind](Kind) in its body.
    pub feature_a: u32,
    /// Index of the second feature in its body.
    pub feature_b: u32,
    /// First time of contact, or of reaching the minimum separation, in [0, 1]. A certified
    /// solver's time is never later.
    pub toi: f64,
    /// Time by which the features have met, in [toi, 1]; the end of the step for an undecided pair.
    pub toi_upper: f64,
    /// Kind of the pair.
    pub kind: Kind,
    /// Certainty of the contact.
    pub status: Status,
}

/// Two triangles that share a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[repr(C)]
pub struct TrianglePair {
    /// Bodies of the triangles, the smaller number first.
    pub bodies: [BodyId; 2],
    /// Indices of the triangles in their bodies, or of other
    /// [elements](crate::Body::elements); within one body the smaller first.
    pub triangles: [u32; 2],
}

/// Compares indices, not bodies.
impl PartialEq<[u32; 2]> for TrianglePair {
    fn eq(&self, triangles: &[u32; 2]) -> bool {
        self.triangles == *triangles
    }
}

impl PartialEq<TrianglePair> for [u32; 2] {
    fn eq(&self, pair: &TrianglePair) -> bool {
        pair == self
    }
}

/// Rows of the answer to any [`Query`]. Each type of query has rows of its own type.
#[derive(Clone, Debug, PartialEq)]
pub enum Rows {
    /// Triangle pairs that share a point, ascending by the first triangle and its body, then by the
    /// second.
    Pairs(RowList<TrianglePair>),
    /// Feature pairs that meet, ascending by kind, then by the first feature and its body, then by
    /// the second.
    Contacts(RowList<Contact>),
    /// Smallest time of contact; `None` if nothing meets.
    Earliest(Option<f64>),
    /// Feature pairs within the distance, in the order of contacts.
    Near(RowList<NearPair>),
    /// Nearest triangles of different bodies; `None` if no two bodies may meet.
    Distance(Option<NearestTriangles>),
    /// Pairs of bodies that share a point, ascending by the first body, then by the second.
    BodyPairs(RowList<BodyPair>),
    /// Nearest triangles of each pair of bodies within the distance, in the order of the bodies.
    BodyDistances(RowList<NearestTriangles>),
}

/// Answer to any query: see [`Answer`].
pub type Contacts = Answer<Rows>;

/// Answer to a query: its rows, caveats and statistics. It dereferences to its rows:
///
/// ```
/// use nearmiss::{Body, Detector, Device, Discrete, Mesh, device::Backend, mesh::Positions};
///
/// let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, -1.0], [1.0, 2.0, 1.0], [9.0, 1.0, 9.0]];
/// let mesh = Mesh::new("two triangles", Positions::F32(corners), vec![[0, 1, 2], [3, 4, 5]])?;
/// let mut detector = Detector::new(Device::open(Backend::Cpu, None)?, Body::deformable(mesh))?;
/// let pairs = detector.query(&Discrete::default())?;
/// assert_eq!(pairs.len(), 1);
/// for pair in pairs.iter() {
///     println!("{:?}", pair.triangles);
/// }
/// # Ok::<(), nearmiss::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Answer<T> {
    /// Rows of the answer.
    pub rows: T,
    /// Query of the answer.
    pub query: Query,
    /// Triangle pairs that share a point at the start of the step, by the exact signs of a discrete
    /// query. [`Query::discrete`] lists as many at t = 0. Such a pair need not have a time of
    /// contact: an edge that crosses a face stays there. `None` if the start was not checked: for
    /// queries at rest, and for those that assume a free start.
    pub starts_crossing: Option<u64>,
    /// Number of undecided rows. Contacts: those with [`Status::Undecided`]. Near pairs: those that
    /// may exceed the distance by rounding. Earliest: 1 if its time is that of an undecided pair
    /// and of no contact, else 0.
    pub undecided: u64,
    /// Statistics of the computation.
    pub stats: Stats,
    pub(crate) caveats: Vec<Caveat>,
    pub(crate) is_free: bool,
}

impl<T> std::ops::Deref for Answer<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.rows
    }
}

impl<T> Answer<T> {
    /// Limits that affected the answer or its cost; empty if there were none.
    pub fn caveats(&self) -> &[Caveat] {
        &self.caveats
    }

    /// Whether the answer proves that nothing touches. It is as certain as the solver: see
    /// [`Solver::is_certain`](crate::research::Solver::is_certain).
    ///
    /// - Continuous and earliest: the start was checked, no triangles share a point there, and
    ///   nothing meets within the step.
    /// - Discrete: no pair of triangles shares a point. Pairs with a common vertex are not tested.
    ///   False for a query of [crossing triangles alone](crate::Discrete::with_only_crossing), which
    ///   does not show what touches.
    /// - Distance: it exceeds 0, or no two bodies may meet.
    /// - Pairs of bodies: none shares a point. Distances of bodies: all exceed 0. Contacts within a
    ///   body are not tested.
    /// - Near: always false, since features within a distance do not show if anything crosses.
    ///
    /// ```
    /// use nearmiss::{Body, Detector, Device, Earliest, Mesh, device::Backend, mesh::Positions};
    ///
    /// // The second triangle crosses the first and both rest: no pair of features ever meets.
    /// let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]];
    /// let mesh = Mesh::new("two triangles", Positions::F32(corners), vec![[0, 1, 2], [3, 4, 5]])?;
    /// let mut detector = Detector::new(Device::open(Backend::Cpu, None)?, Body::deformable(mesh))?;
    /// let first = detector.query(&Earliest::default())?;
    /// assert_eq!((first.rows, first.starts_crossing, first.is_free()), (None, Some(1), false));
    /// # Ok::<(), nearmiss::Error>(())
    /// ```
    pub fn is_free(&self) -> bool {
        self.is_free
    }

    /// Converts the rows; all else stays.
    pub(crate) fn with_rows<U>(self, rows: impl FnOnce(T) -> U) -> Answer<U> {
        let Answer { rows: own, query, starts_crossing, undecided, stats, caveats, is_free } = self;
        Answer { rows: rows(own), query, starts_crossing, undecided, stats, caveats, is_free }
    }
}

impl Contacts {
    /// Converts the rows to the type of the query.
    pub(crate) fn typed<Q: TypedQuery>(self) -> Answer<Q::Rows> {
        let is_undecided = self.undecided > 0;
        self.with_rows(|rows| Q::rows(rows, is_undecided))
    }

    /// Makes an answer with these rows.
    pub(crate) fn new(rows: Rows, query: Query, starts_crossing: Option<u64>) -> Contacts {
        let is_free = rows.is_free(starts_crossing) && !query.is_only_crossing();
        Answer {
            rows,
            query,
            starts_crossing,
            undecided: 0,
            stats: Stats { slices: 1, ..Stats::default() },
            caveats: Vec::new(),
            is_free,
        }
    }

    /// Answer without contacts, for bodies of which no two may meet.
    pub fn none(query: Query) -> Contacts {
        let rows = match query {
            Query::Discrete(_) => Rows::Pairs(RowList::default()),
            Query::Continuous(_) => Rows::Contacts(RowList::default()),
            Query::Earliest(_) => Rows::Earliest(None),
            Query::Near(_) => Rows::Near(RowList::default()),
            Query::Distance(_) => Rows::Distance(None),
            Query::BodyPairs(_) => Rows::BodyPairs(RowList::default()),
            Query::BodyDistances(_) => Rows::BodyDistances(RowList::default()),
        };
        Contacts::new(rows, query, query.checks_start().then_some(0))
    }
}

impl Rows {
    fn is_free(&self, starts_crossing: Option<u64>) -> bool {
        match self {
            Rows::Pairs(pairs) => pairs.is_empty(),
            Rows::Contacts(_) | Rows::Earliest(_) => starts_crossing == Some(0) && self.is_empty(),
            Rows::Near(_) => false,
            Rows::Distance(nearest) => nearest.is_none_or(|nearest| nearest.distance > 0.0),
            Rows::BodyPairs(pairs) => pairs.is_empty(),
            Rows::BodyDistances(all) => all.iter().all(|nearest| nearest.distance > 0.0),
        }
    }

    /// Number of rows; at most 1 for earliest and distance queries.
    pub fn len(&self) -> usize {
        match self {
            Rows::Pairs(pairs) => pairs.len(),
            Rows::Contacts(contacts) => contacts.len(),
            Rows::Earliest(toi) => toi.iter().len(),
            Rows::Near(near) => near.len(),
            Rows::Distance(nearest) => nearest.iter().len(),
            Rows::BodyPairs(pairs) => pairs.len(),
            Rows::BodyDistances(all) => all.len(),
        }
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Triangle pairs of a discrete query; empty for other queries.
    pub fn pairs(&self) -> &[TrianglePair] {
        if let Rows::Pairs(pairs) = self { pairs } else { &[] }
    }

    /// Triangle pairs without their bodies: for one body, or two bodies without self-collision.
    pub fn triangles(&self) -> Vec<[u32; 2]> {
        self.pairs().iter().map(|pair| pair.triangles).collect()
    }

    /// Contacts of a continuous query; empty for other queries.
    pub fn contacts(&self) -> &[Contact] {
        if let Rows::Contacts(contacts) = self { contacts } else { &[] }
    }

    /// Pairs of a near query; empty for other queries.
    pub fn near(&self) -> &[NearPair] {
        if let Rows::Near(near) = self { near } else { &[] }
    }

    /// Nearest triangles of a distance query; `None` for other queries, or if no two bodies may
    /// meet.
    pub fn nearest(&self) -> Option<&NearestTriangles> {
        if let Rows::Distance(nearest) = self { nearest.as_ref() } else { None }
    }

    /// Pairs of bodies that share a point; empty for other queries.
    pub fn body_pairs(&self) -> &[BodyPair] {
        if let Rows::BodyPairs(pairs) = self { pairs } else { &[] }
    }

    /// Nearest triangles of each pair of bodies within a distance; empty for other queries.
    pub fn body_distances(&self) -> &[NearestTriangles] {
        if let Rows::BodyDistances(all) = self { all } else { &[] }
    }

    /// Distance of the nearest triangles, in scene units: 0 if and only if they share a point.
    pub fn distance(&self) -> Option<f64> {
        self.nearest().map(|nearest| nearest.distance)
    }

    /// Smallest time of contact of a continuous or earliest query.
    pub fn earliest_toi(&self) -> Option<f64> {
        match self {
            Rows::Pairs(_)
            | Rows::Near(_)
            | Rows::Distance(_)
            | Rows::BodyPairs(_)
            | Rows::BodyDistances(_) => None,
            Rows::Contacts(contacts) => contacts.iter().map(|c| c.toi).min_by(f64::total_cmp),
            Rows::Earliest(toi) => *toi,
        }
    }
}

impl TrianglePair {
    /// Sort key of pairs.
    pub(crate) fn key(&self) -> [(BodyId, u32); 2] {
        [0, 1].map(|k| (self.bodies[k], self.triangles[k]))
    }
}

impl Contact {
    /// Sort key of contacts.
    pub(crate) fn key(&self) -> (Kind, [(BodyId, u32); 2]) {
        (self.kind, [(self.bodies[0], self.feature_a), (self.bodies[1], self.feature_b)])
    }
}
