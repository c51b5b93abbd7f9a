//! Results: contacts in canonical order, and their hash.

mod degraded;
mod features;
pub(crate) mod geometry;
mod hash;
mod merge;
mod near;
mod nearest;
mod notes;
pub mod on_device;
mod sort;
mod summary;
mod triangles;
mod work;

pub use degraded::{Degraded, TURN_DEGREES};
pub use geometry::ContactGeometry;
pub use near::{Closest, NearPair};
pub use nearest::NearestTriangles;
pub use notes::Note;
pub use on_device::{DeviceAnswer, DeviceList, Entries};
pub use summary::Summary;
pub use triangles::{TriangleContact, triangle_contacts};
pub use work::{Front, Queues};

use crate::pipeline::{Found, Layout, Listed, Stages};
use crate::query::Query;
use crate::scene::BodyId;
use features::{Features, edge_edge, vertex_face};
use nearmiss_emulator::Looks;
use nearmiss_kernels::abi::{Hit, Pair, counter};
use nearmiss_kernels::prim::inclusion::Verdict;

/// Which features meet. Its number (`as u8`) stands for it in the hash, in files and in other languages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
#[repr(u8)]
pub enum Kind {
    /// `a` is a vertex, `b` a face of the same body or of one with a larger number.
    Vf = 0,
    /// `a` is a face, `b` a vertex of a body with a larger number.
    Fv = 1,
    /// Two edges, numbered by (larger vertex, smaller vertex), ascending.
    Ee = 2,
}

/// How sure an answer is. Its number (`as u8`) stands for it in the hash, in files and in other languages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
#[repr(u8)]
pub enum Status {
    /// A solver that can be wrong says so.
    Contact = 0,
    /// They meet, proven, first in `[toi, toi_hi]`.
    Certified = 1,
    /// They come nearer than the tolerance, or the budget ended; if they meet, not before `toi`. Proven as well.
    Unresolved = 2,
}

impl Status {
    /// Of what a solver listed, certified or not.
    #[doc(hidden)]
    pub fn of(certified: bool, verdict: &Verdict) -> Status {
        match (certified, verdict.is_contact()) {
            (_, false) => Status::Unresolved,
            (false, true) => Status::Contact,
            (true, true) => Status::Certified,
        }
    }
}

/// Two features that meet within the step, or, of a query with a separation, that come so near.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Contact {
    /// Which features.
    pub kind: Kind,
    /// The bodies of both, the smaller number first.
    pub bodies: [BodyId; 2],
    /// The first feature's index in its body.
    pub a: u32,
    /// The second feature's index in its body.
    pub b: u32,
    /// First time of contact, or of coming as near as the separation, in [0, 1]; by a certified solver not after it.
    pub toi: f64,
    /// The time by which they have met, in [toi, 1]; of an unresolved pair the end of the step.
    pub toi_hi: f64,
    /// How sure that is.
    pub status: Status,
}

/// Two triangles that share a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct TrianglePair {
    /// Their bodies, the smaller number first.
    pub bodies: [BodyId; 2],
    /// Their indices in those; of one body the smaller first.
    pub triangles: [u32; 2],
}

/// By indices alone.
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

/// The answer to a query.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// Triangle pairs that share a point, ascending by the first triangle and its body, then by the second.
    Pairs(Vec<TrianglePair>),
    /// Feature pairs that meet, ascending by kind, then by the first feature and its body, then by the second.
    Contacts(Vec<Contact>),
    /// The smallest time of contact.
    Earliest(Option<f64>),
    /// Feature pairs within the distance, ascending by kind, a, b.
    Near(Vec<NearPair>),
    /// The nearest triangles of different bodies; none where no two may meet.
    Distance(Option<NearestTriangles>),
}

/// An answer with the figures of its making.
#[derive(Clone, Debug)]
pub struct Contacts {
    /// The answer.
    pub answer: Answer,
    /// Milliseconds by stage.
    pub stages: Stages,
    /// Triangle pairs that share a point at the start of the step, by the exact signs of a discrete
    /// query: as many as
    /// [`Query::discrete`] lists at t = 0. Such a pair need not have a time of contact: an edge
    /// that is through a face stays there. `None` if the start was not checked: of a query at rest,
    /// and of one that assumes a free start.
    pub starts_crossing: Option<u64>,
    /// Triangle pairs that the volumes let through.
    pub triangle_pairs: u64,
    /// Pairs that the narrow test was asked: triangle pairs (discrete), vertex/face and edge/edge pairs (continuous).
    pub candidates: u64,
    /// Candidates by kind: vertex/face, edge/edge. Zero for discrete queries.
    pub candidates_vf_ee: [u64; 2],
    /// Candidates that signs alone could not reject, and the solver was asked: vertex/face, edge/edge.
    pub survivors_vf_ee: [u64; 2],
    /// Candidates that f32 left to f64: vertex/face, edge/edge.
    pub escalated_vf_ee: [u64; 2],
    /// Candidates whose roots could not be isolated; with a separation, those that the first step did not decide: vertex/face,
    /// edge/edge.
    pub open_vf_ee: [u64; 2],
    /// Of these, those that were cut into slices: vertex/face, edge/edge.
    pub sliced_vf_ee: [u64; 2],
    /// How many contacts are [`Status::Unresolved`]; of a near query, how many of the listed pairs rounding cannot tell from such
    /// that are farther apart; of an earliest query 1 if its time is that of such a pair and of no
    /// contact, else 0. The counts by rung of an earliest query may differ from run to run: pairs
    /// that cannot be earlier are skipped, and the order decides which.
    pub unresolved: u64,
    /// Triangle pairs that the filter in the precision of the positions left undecided; of a query
    /// in motion, at the start of the step.
    pub undecided: u64,
    /// Those of them that f64 left undecided too; none of f64 positions, which go straight to exact signs.
    pub undecided_wide: u64,
    /// Pairs of sibling nodes that the traversal tested.
    pub steps: u64,
    /// Work units that long walks gave away.
    pub spilled: u64,
    /// How often a list was too short and grew, and a part of the frame ran again: it took longer, and the answer is whole.
    pub reruns: u64,
    /// In how many slices the frame was asked: 1, but where the lists of a whole one would outgrow the memory.
    pub slices: u32,
    /// What the work queues did.
    pub queues: Queues,
    /// What the front saved or cost.
    pub front: Front,
    pub(crate) degraded: Vec<Degraded>,
}

impl Contacts {
    /// No contacts, of bodies without triangles.
    pub fn none(query: Query) -> Contacts {
        let answer = match query {
            Query::Discrete(_) => Answer::Pairs(Vec::new()),
            Query::Continuous(_) => Answer::Contacts(Vec::new()),
            Query::Earliest(_) => Answer::Earliest(None),
            Query::Near(_) => Answer::Near(Vec::new()),
            Query::Distance(_) => Answer::Distance(None),
        };
        Contacts {
            answer,
            stages: Stages::default(),
            starts_crossing: query.checks_start().then_some(0),
            triangle_pairs: 0,
            candidates: 0,
            candidates_vf_ee: [0; 2],
            survivors_vf_ee: [0; 2],
            escalated_vf_ee: [0; 2],
            open_vf_ee: [0; 2],
            sliced_vf_ee: [0; 2],
            unresolved: 0,
            undecided: 0,
            undecided_wide: 0,
            steps: 0,
            spilled: 0,
            reruns: 0,
            slices: 1,
            queues: Queues::default(),
            front: Front::default(),
            degraded: Vec::new(),
        }
    }

    /// Puts what the kernels found into canonical order and into the numbering of the bodies. No
    /// answer if a look ends it.
    #[doc(hidden)]
    pub fn new(
        found: Found,
        layout: &Layout,
        (stages, degraded): (Stages, Vec<Degraded>),
        looks: &Looks,
    ) -> Contacts {
        let answer = match &found.listed {
            Listed::Earliest { toi, .. } => Answer::Earliest(*toi),
            Listed::Near(hits) => Answer::Near(near::pairs(hits, found.ordered, layout, looks)),
            Listed::Nearest(nearest) => {
                Answer::Distance(nearest.first().map(|hit| NearestTriangles::new(hit, layout)))
            }
            Listed::Pairs(listed) => {
                let pair = |p: &Pair| {
                    let [(a, p), (b, q)] = [p.a, p.b].map(|t| layout.locate(t, |at| at.triangle));
                    TrianglePair { bodies: [a, b], triangles: [p, q] }
                };
                let mut pairs = Vec::new();
                sort::extend(&mut pairs, listed, pair, looks);
                if !found.ordered {
                    sort::sort(&mut pairs, TrianglePair::key, looks);
                }
                Answer::Pairs(pairs)
            }
            Listed::Hits { hits, certified } => {
                let contact = |(kind, bodies, [a, b]): Features, verdict: &Verdict| {
                    let status = Status::of(*certified, verdict);
                    Contact { kind, bodies, a, b, toi: verdict.toi, toi_hi: verdict.toi_hi, status }
                };
                let [of_vf, of_ee] = hits.each();
                let vf = |hit: &Hit| contact(vertex_face(layout, [hit.a, hit.b]), &hit.verdict);
                let ee = |hit: &Hit| contact(edge_edge(layout, [hit.a, hit.b]), &hit.verdict);
                let mut contacts = Vec::with_capacity(of_vf.len() + of_ee.len());
                sort::extend(&mut contacts, of_vf, vf, looks);
                sort::extend(&mut contacts, of_ee, ee, looks);
                if !found.ordered {
                    sort::sort(&mut contacts, Contact::key, looks);
                }
                Answer::Contacts(contacts)
            }
        };
        let count = |which| found.counters[which];
        let vf_ee = [count(counter::VF), count(counter::EE)];
        let of_triangles = matches!(found.listed, Listed::Pairs(_) | Listed::Nearest(_));
        Contacts {
            answer,
            stages,
            starts_crossing: found.is_start_checked.then(|| count(counter::STARTS_CROSSING)),
            triangle_pairs: count(counter::PAIRS),
            candidates: if of_triangles { count(counter::PAIRS) } else { vf_ee[0] + vf_ee[1] },
            candidates_vf_ee: vf_ee,
            survivors_vf_ee: [count(counter::VF_SURVIVORS), count(counter::EE_SURVIVORS)],
            escalated_vf_ee: [count(counter::VF_ESCALATED), count(counter::EE_ESCALATED)],
            open_vf_ee: [count(counter::VF_OPEN), count(counter::EE_OPEN)],
            sliced_vf_ee: [count(counter::VF_HARD), count(counter::EE_HARD)],
            unresolved: match found.listed {
                Listed::Earliest { unresolved, .. } => unresolved.into(),
                Listed::Pairs(_) | Listed::Hits { .. } | Listed::Near(_) | Listed::Nearest(_) => {
                    count(counter::UNRESOLVED)
                }
            },
            undecided: count(counter::UNDECIDED),
            undecided_wide: count(counter::UNDECIDED_WIDE),
            steps: count(counter::STEPS),
            spilled: counter::SPILLED.map(count).iter().sum(),
            reruns: found.reruns,
            slices: 1,
            queues: Queues::new(&found.counters),
            front: Front::new(&found.counters),
            degraded,
        }
    }

    /// How many contacts there are; of an earliest query, and of a distance, 1 or 0.
    pub fn len(&self) -> usize {
        match &self.answer {
            Answer::Pairs(pairs) => pairs.len(),
            Answer::Contacts(contacts) => contacts.len(),
            Answer::Earliest(toi) => toi.iter().len(),
            Answer::Near(near) => near.len(),
            Answer::Distance(nearest) => nearest.iter().len(),
        }
    }

    /// Overlap tests of two volumes: two a step, and those of the front.
    pub fn overlap_tests(&self) -> u64 {
        2 * self.steps + self.front.tests
    }

    /// In what the frame came to less than all that was asked, each by its reason; empty where nothing did.
    pub fn degraded(&self) -> &[Degraded] {
        &self.degraded
    }

    /// Whether nothing meets.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the answer proves that nothing touches. Continuous and earliest: the start was
    /// checked, no triangles share a point there, and nothing meets within the step. Discrete: no
    /// pair of triangles shares a point; pairs with a common vertex are not tested. Distance: it is
    /// above 0, or no two bodies may meet. Near: always false, since features within a distance do
    /// not say what crosses. As certain as the solver: see
    /// [`Solver::is_certain`](crate::query::Solver::is_certain).
    ///
    /// ```
    /// use nearmiss::{Body, Detector, Device, Mesh, Query, device::Backend, mesh::Positions};
    ///
    /// // The second triangle is through the first, and both rest: no pair of features ever meets.
    /// let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]];
    /// let mesh = Mesh::new("two triangles", Positions::F32(corners), vec![[0, 1, 2], [3, 4, 5]])?;
    /// let device = Device::open(Backend::Cpu, None)?;
    /// let found = Detector::new(device, Body::still(mesh), Query::earliest())?.detect()?;
    /// assert_eq!((found.earliest_toi(), found.starts_crossing, found.is_free()), (None, Some(1), false));
    /// # Ok::<(), nearmiss::Error>(())
    /// ```
    pub fn is_free(&self) -> bool {
        match &self.answer {
            Answer::Pairs(pairs) => pairs.is_empty(),
            Answer::Contacts(_) | Answer::Earliest(_) => self.starts_crossing == Some(0) && self.is_empty(),
            Answer::Near(_) => false,
            Answer::Distance(nearest) => nearest.is_none_or(|nearest| nearest.distance > 0.0),
        }
    }

    /// Triangle pairs, if that was asked.
    pub fn pairs(&self) -> &[TrianglePair] {
        if let Answer::Pairs(pairs) = &self.answer { pairs } else { &[] }
    }

    /// The triangle pairs without their bodies: for a scene of one body, or of two of which neither is tested against itself.
    pub fn triangles(&self) -> Vec<[u32; 2]> {
        self.pairs().iter().map(|pair| pair.triangles).collect()
    }

    /// Feature pairs, if that was asked.
    pub fn contacts(&self) -> &[Contact] {
        if let Answer::Contacts(contacts) = &self.answer { contacts } else { &[] }
    }

    /// Feature pairs within a distance, if that was asked.
    pub fn near(&self) -> &[NearPair] {
        if let Answer::Near(near) = &self.answer { near } else { &[] }
    }

    /// The nearest triangles of different bodies, if that was asked and any two may meet.
    pub fn nearest(&self) -> Option<&NearestTriangles> {
        if let Answer::Distance(nearest) = &self.answer { nearest.as_ref() } else { None }
    }

    /// How far apart those are: 0 if and only if they share a point.
    pub fn distance(&self) -> Option<f64> {
        self.nearest().map(|nearest| nearest.distance)
    }

    /// The smallest time of contact of a continuous or earliest query.
    pub fn earliest_toi(&self) -> Option<f64> {
        match &self.answer {
            Answer::Pairs(_) | Answer::Near(_) | Answer::Distance(_) => None,
            Answer::Contacts(contacts) => contacts.iter().map(|c| c.toi).min_by(f64::total_cmp),
            Answer::Earliest(toi) => *toi,
        }
    }
}

impl TrianglePair {
    /// What pairs are ordered by.
    fn key(&self) -> [(BodyId, u32); 2] {
        [0, 1].map(|k| (self.bodies[k], self.triangles[k]))
    }
}

impl Contact {
    /// What contacts are ordered by.
    fn key(&self) -> (Kind, [(BodyId, u32); 2]) {
        (self.kind, [(self.bodies[0], self.a), (self.bodies[1], self.b)])
    }
}
