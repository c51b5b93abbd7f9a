//! Narrow: the lists and the launches of the last stage, step by step.

mod continuous;
mod features;
mod near;
mod rungs;

pub use continuous::{Capacities, Continuous};
pub use near::Near;

use super::layout::Layout;
use super::list::{GrowableOutput, List};
use super::order::{Order, Ordered};
use super::precision::Precision;
use crate::contacts::Entries;
use crate::device::Device;
use crate::error::Error;
use crate::mesh::Body;
use crate::pipeline::below_precision::BelowPrecision;
use crate::pipeline::launch;
use crate::query::{Motion, Query, Solver};
use nearmiss_kernels::abi::{BodyRecord, DiscreteArgs, KEEP_ADJACENT, Pair, Positions, Span, counter};

/// A step of a frame that fills lists; each reads what the one before filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Candidate triangle pairs.
    Traverse,
    /// Triangle pairs that meet.
    Decide,
    /// Vertex/face and edge/edge candidates.
    Features,
    /// Those that may meet.
    Cull,
    /// Contacts in motion.
    Solve,
    /// Features at rest within a distance.
    Near,
    /// Contacts in canonical order.
    Order,
}

impl Step {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Step::Traverse => "traverse",
            Step::Decide => "decide",
            Step::Features => "features",
            Step::Cull => "cull",
            Step::Solve => "solve",
            Step::Near => "near",
            Step::Order => "order",
        }
    }
}

/// What every step of the stage is given.
pub struct NarrowContext<'a, R: Precision> {
    /// The machine.
    pub device: &'a Device,
    /// The question.
    pub query: Query,
    /// Positions.
    pub frames: Positions<R>,
    /// Vertex indices of every triangle.
    pub faces: Span<[u32; 3]>,
    /// Candidate triangle pairs.
    pub pairs: Span<Pair>,
    /// What the kernels know of the bodies; empty where there is one alone.
    pub bodies: Span<BodyRecord>,
    /// The frame's counters.
    pub counters: Span<u64>,
}

/// What only one kind of query needs exists only there.
pub enum Narrow {
    /// Triangle pairs at t = 0.
    Discrete {
        /// Pairs that meet.
        contacts: List<Pair>,
        /// Pairs that each filter left to the next, the last one to exact signs; of the exact solver alone.
        undecided: Vec<List<Pair>>,
        /// The contacts in order, where the device orders them.
        ordered: Option<Box<Order<Pair>>>,
    },
    /// Features in motion.
    Continuous(Box<Continuous>),
    /// Features at rest.
    Near(Box<Near>),
}

/// Where a frame's answer lies in the device's memory.
pub struct AnswerLists {
    /// What the entries are.
    pub entries: Entries,
    /// One list in order, or one of each kind: where it begins, and its room.
    pub lists: Vec<(u64, usize)>,
    /// Whether it is the one in order.
    pub is_ordered: bool,
    /// Which counters count each kind.
    pub counters: Vec<u32>,
    /// Where the earliest time is, of such a query.
    pub earliest: Option<u64>,
    /// End points of every edge.
    pub edges: Span<[u32; 2]>,
}

impl AnswerLists {
    fn of<T: Ordered>(entries: Entries, lists: &[&List<T>], order: Option<&Order<T>>) -> AnswerLists {
        let place = |list: &List<T>| (list.span().addr(), list.capacity());
        let order = order.filter(|order| order.fits());
        AnswerLists {
            entries,
            is_ordered: order.is_some(),
            lists: order.map_or_else(
                || lists.iter().map(|list| place(list)).collect(),
                |order| vec![place(&order.list)],
            ),
            counters: lists.iter().map(|list| list.counter()).collect(),
            earliest: None,
            edges: Span::EMPTY,
        }
    }
}

impl Narrow {
    /// Takes the memory that the query of positions of that precision needs: `capacity` entries for candidates, `few` for what is
    /// left of them.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new<R: Precision>(
        device: &Device,
        layout: &Layout,
        query: Query,
        (capacity, few): (usize, usize),
    ) -> Result<Self, Error> {
        if query.motion == Motion::Discrete {
            let contacts = List::new(device, "contacts", counter::CONTACTS, few)?;
            let mut undecided = Vec::new();
            if query.solver() == Solver::Exact {
                undecided.push(List::new(device, "undecided pairs", counter::UNDECIDED, few)?);
                if R::WIDENS {
                    let at = counter::UNDECIDED_WIDE;
                    undecided.push(List::new(device, "pairs undecided in f64", at, few / 4)?);
                }
            }
            let order = || Order::new(device, layout, few / 4).map(Box::new);
            let ordered = device.is_gpu().then(order).transpose()?;
            return Ok(Narrow::Discrete { contacts, undecided, ordered });
        }
        if query.motion == Motion::Near {
            return Ok(Narrow::Near(Box::new(Near::new(device, layout, (capacity, few))?)));
        }
        let capacities = Capacities {
            candidates: [capacity, 2 * capacity],
            survivors: [few, 2 * few],
            hits: [few, few],
            left: [few / 4, few / 4],
        };
        Ok(Narrow::Continuous(Box::new(Continuous::new(device, layout, query, capacities)?)))
    }

    /// The bodies are there now: how large they are may matter.
    pub fn place(&mut self, bodies: &[Body], query: &Query) {
        if let Narrow::Continuous(c) = self {
            c.below_precision = BelowPrecision::of(bodies, query);
        }
    }

    /// The steps of the stage, in their order; [`Step::Order`] is a stage of its own.
    pub fn steps(&self) -> &'static [Step] {
        match self {
            Narrow::Discrete { .. } => &[Step::Decide],
            Narrow::Continuous(c) => c.steps(),
            Narrow::Near(_) => &[Step::Features, Step::Near],
        }
    }

    /// Whether the device puts contacts into order.
    pub fn orders(&self) -> bool {
        match self {
            Narrow::Discrete { ordered, .. } => ordered.is_some(),
            Narrow::Continuous(c) => c.ordered.is_some(),
            Narrow::Near(near) => near.ordered.is_some(),
        }
    }

    /// Where a frame's answer lies.
    pub fn answer(&self) -> AnswerLists {
        match self {
            Narrow::Discrete { contacts, ordered, .. } => {
                AnswerLists::of(Entries::TrianglePairs, &[contacts], ordered.as_deref())
            }
            Narrow::Continuous(c) => {
                let lists = AnswerLists::of(Entries::Contacts, &[&c.vf_hits, &c.ee_hits], c.ordered.as_ref());
                let earliest = c.earliest.as_ref().map(|earliest| earliest.span().addr());
                AnswerLists { earliest, edges: c.edges(), ..lists }
            }
            Narrow::Near(near) => {
                let lists = [&near.vf_hits, &near.ee_hits];
                let lists = AnswerLists::of(Entries::NearPairs, &lists, near.ordered.as_ref());
                AnswerLists { edges: near.edges(), ..lists }
            }
        }
    }

    /// The lists that a step fills.
    pub fn lists(&mut self, step: Step) -> Vec<&mut dyn GrowableOutput> {
        match (self, step) {
            (Narrow::Discrete { contacts, undecided, .. }, Step::Decide) => {
                let undecided = undecided.iter_mut().map(|list| list as &mut dyn GrowableOutput);
                std::iter::once(contacts as &mut dyn GrowableOutput).chain(undecided).collect()
            }
            (Narrow::Discrete { ordered: Some(order), .. }, Step::Order) => vec![&mut order.list],
            (Narrow::Continuous(c), step) => c.lists(step),
            (Narrow::Near(near), step) => near.lists(step),
            _ => Vec::new(),
        }
    }

    /// The lists between candidates and contacts, with names: for comparing machines.
    pub fn between(&self) -> Vec<(&'static str, &List<Pair>)> {
        match self {
            Narrow::Discrete { undecided, .. } => {
                let names = ["narrow: undecided", "narrow: undecided in f64"];
                names.into_iter().zip(undecided).collect()
            }
            Narrow::Continuous(c) => c.between(),
            Narrow::Near(near) => near.between(),
        }
    }

    /// Launches a step.
    ///
    /// # Errors
    /// Those of the device.
    pub fn run<R: Precision>(&mut self, step: Step, given: &NarrowContext<R>) -> Result<(), Error> {
        match (self, step) {
            (Narrow::Discrete { contacts, undecided, .. }, Step::Decide) => {
                decide(contacts, undecided, given)
            }
            (Narrow::Discrete { contacts, ordered: Some(order), .. }, Step::Order) => {
                order.run(given.device, contacts, None, (Span::EMPTY, given.counters))
            }
            (Narrow::Continuous(c), Step::Features | Step::Cull | Step::Solve | Step::Order) => {
                c.run(step, given)
            }
            (Narrow::Near(near), Step::Features | Step::Near | Step::Order) => near.run(step, given),
            _ => Err(Error::Bug { what: format!("the step {step:?} in another kind of query") }),
        }
    }
}

/// Triangle pairs that meet: by floats, or by floats with a bound, in f32 and in f64, and exact signs for what they leave.
fn decide<R: Precision>(
    contacts: &List<Pair>,
    undecided: &[List<Pair>],
    given: &NarrowContext<R>,
) -> Result<(), Error> {
    let args = |pairs: Span<Pair>, pairs_at: u32, undecided: Option<&List<Pair>>| DiscreteArgs {
        positions: given.frames.still,
        faces: given.faces,
        pairs,
        contacts: contacts.span(),
        undecided: undecided.map_or(Span::EMPTY, List::span),
        counters: given.counters,
        pairs_at,
        undecided_at: undecided.map_or(0, List::counter),
        flags: if given.query.adjacent { KEEP_ADJACENT } else { 0 },
        pad: 0,
    };
    let (device, capacity) = (given.device, given.pairs.len() as usize);
    let candidates = args(given.pairs, counter::PAIRS, undecided.first());
    let (first, last) = match undecided {
        [] => return launch::striding::<R::Moller>(device, capacity, &candidates),
        [first, .., last] => (first, Some(last)),
        [first] => (first, None),
    };
    launch::striding::<R::Filter>(device, capacity, &candidates)?;
    let left = args(first.span(), first.counter(), last);
    let Some(last) = last else { return launch::striding::<R::Exact>(device, first.capacity(), &left) };
    launch::striding::<R::Wide>(device, first.capacity(), &left)?;
    launch::striding::<R::Exact>(device, last.capacity(), &args(last.span(), last.counter(), None))
}
