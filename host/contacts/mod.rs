//! Results: contacts in canonical order, and their hash.

mod degraded;
mod near;
mod summary;
mod triangles;

pub use degraded::Degraded;
pub use near::{Closest, NearPair};
pub use summary::Summary;
pub use triangles::{TriangleContact, triangle_contacts};

use crate::pipeline::{Found, Hits, Layout, Stages};
use crate::query::{Motion, Query};
use nearmiss_kernels::abi::{Pair, ROUNDS, counter};
use nearmiss_kernels::prim::inclusion::Verdict;
use rayon::prelude::*;

/// Which features meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
pub enum Kind {
    /// `a` is a vertex (of the first body), `b` a face (of the second, or of the same).
    Vf,
    /// Between two bodies: `a` is a face of the first, `b` a vertex of the second.
    Fv,
    /// Two edges, numbered by (larger vertex, smaller vertex), ascending.
    Ee,
}

/// How sure an answer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
pub enum Status {
    /// A solver that can be wrong says so.
    Contact,
    /// They meet, proven, first in `[toi, toi_hi]`.
    Certified,
    /// They come nearer than the tolerance, or the budget ended; if they meet, not before `toi`. Proven as well.
    Unresolved,
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

/// The answer to a query.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// Triangle pairs that share a point: (a, b) with a < b in one body, or a of the first body and b of the second.
    /// Ascending.
    Pairs(Vec<[u32; 2]>),
    /// Feature pairs that meet, ascending by kind, a, b.
    Contacts(Vec<Contact>),
    /// The smallest time of contact.
    Earliest(Option<f64>),
    /// Feature pairs within the distance, ascending by kind, a, b.
    Near(Vec<NearPair>),
}

/// An answer with the figures of its making.
#[derive(Clone, Debug)]
pub struct Contacts {
    /// The answer.
    pub answer: Answer,
    /// Milliseconds by stage.
    pub stages: Stages,
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
    /// that are farther apart; of an earliest query, how many of the pairs that were asked: which of those
    /// that cannot be earlier are asked anyway is a matter of order, so this and the counts by rung may differ from run to run.
    pub unresolved: u64,
    /// Pairs that the filter in the precision of the positions left undecided.
    pub undecided: u64,
    /// Those of them that f64 left undecided too; none of f64 positions, which go straight to exact signs.
    pub undecided_wide: u64,
    /// Pairs of sibling nodes that the traversal tested.
    pub steps: u64,
    /// Work units that long walks gave away.
    pub spilled: u64,
    /// How often a list was too short and grew, and a part of the frame ran again: it took longer, and the answer is whole.
    pub reruns: u64,
    /// What the work queues did.
    pub queues: Queues,
    /// What the front saved or cost.
    pub front: Front,
    degraded: Vec<Degraded>,
}

/// The front of a frame. All zero where there was none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Front {
    /// Pairs of nodes at which this frame's descent ended.
    pub pairs: u64,
    /// Overlap tests of the last frame's pairs and, where it was pruned, of their ancestors. Those of the pairs below them
    /// are counted as those of any traversal: two a step.
    pub tests: u64,
    /// Pairs that gave way to an ancestor.
    pub pruned: u64,
}

impl Front {
    fn new(counters: &[u64]) -> Front {
        let of = |at: u32| counters[at as usize];
        Front { pairs: of(counter::ENDS), tests: of(counter::FRONT_TESTS), pruned: of(counter::PRUNED) }
    }
}

/// What the work queues of a traversal did. All zero where it had none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Queues {
    /// Rounds with work: launches.
    pub rounds: u64,
    /// How often a queue ran dry.
    pub idle_exits: u64,
    /// Units that a queue on chip had no room for.
    pub spills: u64,
    /// Units that a balance moved.
    pub moves: u64,
    /// Units that a block took from those that others offered.
    pub stolen: u64,
    /// Most units that waited in a segment, or in the list of all.
    pub longest: u64,
}

impl Queues {
    fn new(counters: &[u64]) -> Queues {
        let of = |at: u32| counters[at as usize];
        Queues {
            rounds: of(counter::QUEUE_ROUNDS),
            idle_exits: of(counter::IDLE_EXITS),
            spills: of(counter::QUEUE_SPILLS),
            moves: of(counter::MOVES),
            stolen: of(counter::STOLEN),
            longest: of(counter::QUEUED),
        }
    }
}

impl Contacts {
    /// No contacts, of bodies without triangles.
    pub fn none(query: Query) -> Contacts {
        let answer = match query.motion {
            Motion::Discrete => Answer::Pairs(Vec::new()),
            Motion::Continuous => Answer::Contacts(Vec::new()),
            Motion::Earliest => Answer::Earliest(None),
            Motion::Near => Answer::Near(Vec::new()),
        };
        Contacts {
            answer,
            stages: Stages::default(),
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
            queues: Queues::default(),
            front: Front::default(),
            degraded: Vec::new(),
        }
    }

    /// Puts what the kernels found into canonical order and into the numbering of the bodies.
    #[doc(hidden)]
    pub fn new(
        found: Found,
        layout: &Layout,
        query: Query,
        (stages, degraded): (Stages, Vec<Degraded>),
    ) -> Contacts {
        let second = if layout.bodies() == 2 { layout.starts[1] } else { Default::default() };
        let answer = match query.motion {
            Motion::Earliest => Answer::Earliest(found.earliest),
            Motion::Near => Answer::Near(near::pairs(&found, layout)),
            Motion::Discrete => {
                let listed: &[Pair] = found.pairs.as_deref().unwrap_or_default();
                let mut pairs: Vec<_> = listed.par_iter().map(|p| [p.a, p.b - second.triangle]).collect();
                if !found.ordered {
                    pairs.par_sort_unstable();
                }
                Answer::Pairs(pairs)
            }
            Motion::Continuous => {
                let certified = query.solver().is_certified();
                let contact = |kind, a, b, verdict: &Verdict| {
                    let status = Status::of(certified, verdict);
                    Contact { kind, a, b, toi: verdict.toi, toi_hi: verdict.toi_hi, status }
                };
                let [of_vf, of_ee] = found.hits.as_ref().map_or([&[][..]; 2], Hits::each);
                let vf = of_vf.par_iter().map(|hit| {
                    if layout.bodies() == 2 && hit.a >= second.vertex {
                        contact(Kind::Fv, hit.b, hit.a - second.vertex, &hit.verdict)
                    } else {
                        contact(Kind::Vf, hit.a, hit.b - second.triangle, &hit.verdict)
                    }
                });
                let ee =
                    of_ee.par_iter().map(|hit| contact(Kind::Ee, hit.a, hit.b - second.edge, &hit.verdict));
                let mut contacts: Vec<_> = vf.chain(ee).collect();
                if !found.ordered {
                    contacts.par_sort_unstable_by_key(|c| (c.kind, c.a, c.b));
                }
                Answer::Contacts(contacts)
            }
        };
        let count = |at: u32| found.counters[at as usize];
        let vf_ee = [count(counter::VF), count(counter::EE)];
        let discrete = query.motion == Motion::Discrete;
        Contacts {
            answer,
            stages,
            triangle_pairs: count(counter::PAIRS),
            candidates: if discrete { count(counter::PAIRS) } else { vf_ee[0] + vf_ee[1] },
            candidates_vf_ee: vf_ee,
            survivors_vf_ee: [count(counter::VF_SURVIVORS), count(counter::EE_SURVIVORS)],
            escalated_vf_ee: [count(counter::VF_ESCALATED), count(counter::EE_ESCALATED)],
            open_vf_ee: [count(counter::VF_OPEN), count(counter::EE_OPEN)],
            sliced_vf_ee: [count(counter::VF_HARD), count(counter::EE_HARD)],
            unresolved: count(counter::UNRESOLVED),
            undecided: count(counter::UNDECIDED),
            undecided_wide: count(counter::UNDECIDED_WIDE),
            steps: count(counter::STEPS),
            spilled: found.counters[counter::SPILLED as usize..][..ROUNDS as usize].iter().sum(),
            reruns: found.reruns,
            queues: Queues::new(&found.counters),
            front: Front::new(&found.counters),
            degraded,
        }
    }

    /// How many contacts there are; of an earliest query, 1 or 0.
    pub fn len(&self) -> usize {
        match &self.answer {
            Answer::Pairs(pairs) => pairs.len(),
            Answer::Contacts(contacts) => contacts.len(),
            Answer::Earliest(toi) => toi.iter().len(),
            Answer::Near(near) => near.len(),
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

    /// Triangle pairs, if that was asked.
    pub fn pairs(&self) -> &[[u32; 2]] {
        if let Answer::Pairs(pairs) = &self.answer { pairs } else { &[] }
    }

    /// Feature pairs, if that was asked.
    pub fn contacts(&self) -> &[Contact] {
        if let Answer::Contacts(contacts) = &self.answer { contacts } else { &[] }
    }

    /// Feature pairs within a distance, if that was asked.
    pub fn near(&self) -> &[NearPair] {
        if let Answer::Near(near) = &self.answer { near } else { &[] }
    }

    /// The smallest time of contact of a continuous or earliest query.
    pub fn earliest_toi(&self) -> Option<f64> {
        match &self.answer {
            Answer::Pairs(_) | Answer::Near(_) => None,
            Answer::Contacts(contacts) => contacts.iter().map(|c| c.toi).min_by(f64::total_cmp),
            Answer::Earliest(toi) => *toi,
        }
    }

    /// xxh3 over the canonical answer: the same for equal answers on every machine. Each contact adds its kind, its
    /// indices and the bits of its times (a near pair of its squared distance and weights), little-endian.
    pub fn hash(&self) -> u64 {
        let mut hash = xxhash_rust::xxh3::Xxh3::new();
        match &self.answer {
            Answer::Pairs(pairs) => pairs.iter().flatten().for_each(|i| hash.update(&i.to_le_bytes())),
            Answer::Contacts(contacts) => contacts.iter().for_each(|c| {
                hash.update(&[c.kind as u8, c.status as u8]);
                hash.update(&c.a.to_le_bytes());
                hash.update(&c.b.to_le_bytes());
                hash.update(&c.toi.to_le_bytes());
                hash.update(&c.toi_hi.to_le_bytes());
            }),
            Answer::Earliest(toi) => toi.iter().for_each(|toi| hash.update(&toi.to_le_bytes())),
            Answer::Near(near) => near.iter().for_each(|pair| hash.update(&pair.bytes())),
        }
        hash.digest()
    }
}
