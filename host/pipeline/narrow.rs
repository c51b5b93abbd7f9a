//! Narrow: the lists and the launches of the last stage, step by step.

mod continuous;
mod rungs;

pub use continuous::{Continuous, Rooms};

use super::layout::Layout;
use super::precision::Precision;
use super::room::{Growing, List};
use crate::device::Device;
use crate::error::Error;
use crate::query::{Motion, Query, Solver};
use nearmiss_kernels::abi::{DiscreteArgs, Frames, KEEP_ADJACENT, Pair, Span, counter};
use nearmiss_kernels::entry::Entry;

/// A step of a frame that fills lists; each reads what the one before filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Candidate triangle pairs.
    Traverse,
    /// Triangle pairs that meet.
    Decide,
    /// Vertex/face and edge/edge pairs that may meet.
    Sift,
    /// Contacts in motion.
    Solve,
}

impl Step {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Step::Traverse => "traverse",
            Step::Decide => "decide",
            Step::Sift => "sift",
            Step::Solve => "solve",
        }
    }
}

/// What every step of the stage is given.
pub struct Given<'a, R: Precision> {
    /// The machine.
    pub device: &'a Device,
    /// The question.
    pub query: Query,
    /// Positions.
    pub frames: Frames<R>,
    /// Vertex indices of every triangle.
    pub faces: Span<[u32; 3]>,
    /// Candidate triangle pairs.
    pub pairs: Span<Pair>,
    /// The frame's counters.
    pub counters: Span<u64>,
}

/// What only one kind of query needs exists only there.
pub enum Narrow {
    /// Triangle pairs at t = 0.
    Discrete {
        /// Pairs that meet.
        contacts: List<Pair>,
        /// Pairs that the filter left to exact signs; of the exact solver alone.
        undecided: Option<List<Pair>>,
    },
    /// Features in motion.
    Continuous(Box<Continuous>),
}

impl Narrow {
    /// Takes the memory that the query needs: `room` entries for candidates, `few` for what is left of them.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(
        device: &Device,
        layout: &Layout,
        query: Query,
        (room, few): (usize, usize),
    ) -> Result<Self, Error> {
        if query.motion == Motion::Discrete {
            let exact = query.solver() == Solver::Exact;
            let undecided = || List::new(device, "undecided pairs", counter::UNDECIDED, few);
            return Ok(Narrow::Discrete {
                contacts: List::new(device, "contacts", counter::CONTACTS, few)?,
                undecided: exact.then(undecided).transpose()?,
            });
        }
        let rooms = Rooms {
            candidates: [room, 2 * room],
            survivors: [few, 2 * few],
            hits: [few, few],
            left: [few / 4, few / 4],
        };
        Ok(Narrow::Continuous(Box::new(Continuous::new(device, layout, query, rooms)?)))
    }

    /// The steps of this query, in their order.
    pub fn steps(&self) -> &'static [Step] {
        match self {
            Narrow::Discrete { .. } => &[Step::Decide],
            Narrow::Continuous(_) => &[Step::Sift, Step::Solve],
        }
    }

    /// The lists that a step fills.
    pub fn lists(&mut self, step: Step) -> Vec<&mut dyn Growing> {
        match (self, step) {
            (Narrow::Discrete { contacts, undecided }, Step::Decide) => {
                let undecided = undecided.as_mut().map(|list| list as &mut dyn Growing);
                std::iter::once(contacts as &mut dyn Growing).chain(undecided).collect()
            }
            (Narrow::Continuous(c), step) => c.lists(step),
            _ => Vec::new(),
        }
    }

    /// The lists between candidates and contacts, with names: for comparing machines.
    pub fn between(&self) -> Vec<(&'static str, &List<Pair>)> {
        match self {
            Narrow::Discrete { undecided, .. } => {
                undecided.iter().map(|list| ("narrow: undecided", list)).collect()
            }
            Narrow::Continuous(c) => c.between(),
        }
    }

    /// Launches a step.
    ///
    /// # Errors
    /// Those of the device.
    pub fn run<R: Precision>(&mut self, step: Step, given: &Given<R>) -> Result<(), Error> {
        match (self, step) {
            (Narrow::Discrete { contacts, undecided }, Step::Decide) => {
                decide(contacts, undecided.as_ref(), given)
            }
            (Narrow::Continuous(c), Step::Sift | Step::Solve) => c.run(step, given),
            _ => Err(Error::Bug { what: format!("the step {step:?} in another kind of query") }),
        }
    }
}

/// Triangle pairs that meet: by floats, or by floats with a bound and exact signs for what they leave.
fn decide<R: Precision>(
    contacts: &List<Pair>,
    undecided: Option<&List<Pair>>,
    given: &Given<R>,
) -> Result<(), Error> {
    let args = DiscreteArgs {
        positions: given.frames.still,
        faces: given.faces,
        pairs: given.pairs,
        contacts: contacts.span(),
        undecided: undecided.map_or(Span::EMPTY, List::span),
        counters: given.counters,
        pairs_at: counter::PAIRS,
        flags: if given.query.adjacent { KEEP_ADJACENT } else { 0 },
    };
    let room = given.pairs.len as usize;
    match undecided {
        None => launch_striding::<R::Moller>(given.device, room, &args),
        Some(undecided) => {
            launch_striding::<R::Filter>(given.device, room, &args)?;
            launch_striding::<R::Exact>(given.device, undecided.room(), &args)
        }
    }
}

/// Launches a kernel over up to `room` items.
pub fn launch_striding<E: Entry>(device: &Device, room: usize, args: &E::Args) -> Result<(), Error> {
    device.launch::<E>(device.blocks_striding::<E>(room), args)
}
