//! Narrow: the lists and the launches of the last stage, step by step.

use super::layout::Layout;
use super::precision::Precision;
use super::room::{Growing, List, Tally};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::query::{Motion, Query, Solver};
use nearmiss_kernels::abi::{
    CertifyArgs, DiscreteArgs, ESCALATE, Frames, Hit, KEEP_ADJACENT, Listed, Pair, RejectArgs, SiftArgs,
    SolveArgs, Span, counter,
};
use nearmiss_kernels::entry::Entry;

/// A step of a frame that fills lists; each reads what the one before filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Candidate triangle pairs.
    Traverse,
    /// Triangle pairs that meet.
    Decide,
    /// Vertex/face and edge/edge candidates.
    Sift,
    /// Those that may meet.
    Reject,
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
            Step::Reject => "reject",
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

/// How many entries the lists of a continuous query have room for at first: vertex/face, edge/edge.
pub struct Rooms {
    /// Candidates.
    pub candidates: [usize; 2],
    /// Those that may meet.
    pub survivors: [usize; 2],
    /// Contacts.
    pub hits: [usize; 2],
    /// Pairs that f32 leaves to f64.
    pub escalated: [usize; 2],
}

/// What only one kind of query needs exists only there.
pub enum Narrow {
    /// Triangle pairs at t = 0.
    Discrete {
        /// Pairs that meet.
        contacts: List<Pair>,
        /// Pairs that each filter left to the next, the last one to exact signs; of the exact solver alone.
        undecided: Vec<List<Pair>>,
    },
    /// Features in motion.
    Continuous(Box<Continuous>),
}

/// The lists and the topology of a continuous query.
pub struct Continuous {
    edges: Buffer<[u32; 2]>,
    face_edges: Buffer<[u32; 3]>,
    owners: Buffer<u32>,
    vf: List<Pair>,
    ee: List<Pair>,
    vf_survivors: List<Pair>,
    ee_survivors: List<Pair>,
    /// Vertex/face contacts.
    pub vf_hits: List<Hit>,
    /// Edge/edge contacts.
    pub ee_hits: List<Hit>,
    /// Pairs that f32 leaves to f64, vertex/face and edge/edge; where both are used.
    escalated: Option<[List<Pair>; 2]>,
    /// Hits that are not certain.
    unresolved: Tally,
    /// The smallest toi, where only that is asked for.
    pub earliest: Option<Buffer<u64>>,
}

impl Narrow {
    /// Takes the memory that the query of positions of that precision needs: `room` entries for candidates, `few` for what is
    /// left of them.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new<R: Precision>(
        device: &Device,
        layout: &Layout,
        query: Query,
        (room, few): (usize, usize),
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
            return Ok(Narrow::Discrete { contacts, undecided });
        }
        let rooms = Rooms {
            candidates: [room, 2 * room],
            survivors: [few, 2 * few],
            hits: [few, few],
            escalated: [few / 4, few / 4],
        };
        Ok(Narrow::Continuous(Box::new(Continuous::new(device, layout, query, rooms)?)))
    }

    /// The steps of this query, in their order.
    pub fn steps(&self) -> &'static [Step] {
        match self {
            Narrow::Discrete { .. } => &[Step::Decide],
            Narrow::Continuous(_) => &[Step::Sift, Step::Reject, Step::Solve],
        }
    }

    /// The lists that a step fills.
    pub fn lists(&mut self, step: Step) -> Vec<&mut dyn Growing> {
        match (self, step) {
            (Narrow::Discrete { contacts, undecided }, Step::Decide) => {
                let undecided = undecided.iter_mut().map(|list| list as &mut dyn Growing);
                std::iter::once(contacts as &mut dyn Growing).chain(undecided).collect()
            }
            (Narrow::Continuous(c), Step::Sift) => vec![&mut c.vf, &mut c.ee],
            (Narrow::Continuous(c), Step::Reject) => vec![&mut c.vf_survivors, &mut c.ee_survivors],
            (Narrow::Continuous(c), Step::Solve) => {
                let mut lists: Vec<&mut dyn Growing> =
                    vec![&mut c.vf_hits, &mut c.ee_hits, &mut c.unresolved];
                lists.extend(c.escalated.iter_mut().flatten().map(|list| list as &mut dyn Growing));
                lists
            }
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
            Narrow::Continuous(c) => {
                let mut lists = vec![
                    ("narrow: vf", &c.vf),
                    ("narrow: ee", &c.ee),
                    ("narrow: vf that may meet", &c.vf_survivors),
                    ("narrow: ee that may meet", &c.ee_survivors),
                ];
                if let Some([vf, ee]) = &c.escalated {
                    lists.extend([("narrow: vf for f64", vf), ("narrow: ee for f64", ee)]);
                }
                lists
            }
        }
    }

    /// Launches a step.
    ///
    /// # Errors
    /// Those of the device.
    pub fn run<R: Precision>(&mut self, step: Step, given: &Given<R>) -> Result<(), Error> {
        match (self, step) {
            (Narrow::Discrete { contacts, undecided }, Step::Decide) => decide(contacts, undecided, given),
            (Narrow::Continuous(c), Step::Sift) => c.sift(given),
            (Narrow::Continuous(c), Step::Reject) => c.reject(given),
            (Narrow::Continuous(c), Step::Solve) => c.solve(given),
            _ => Err(Error::Bug { what: format!("the step {step:?} in another kind of query") }),
        }
    }
}

/// Triangle pairs that meet: by floats, or by floats with a bound, in f32 and in f64, and exact signs for what they leave.
fn decide<R: Precision>(
    contacts: &List<Pair>,
    undecided: &[List<Pair>],
    given: &Given<R>,
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
    let (device, room) = (given.device, given.pairs.len as usize);
    let candidates = args(given.pairs, counter::PAIRS, undecided.first());
    let (first, last) = match undecided {
        [] => return launch_striding::<R::Moller>(device, room, &candidates),
        [first, .., last] => (first, Some(last)),
        [first] => (first, None),
    };
    launch_striding::<R::Filter>(device, room, &candidates)?;
    let left = args(first.span(), first.counter(), last);
    let Some(last) = last else { return launch_striding::<R::Exact>(device, first.room(), &left) };
    launch_striding::<R::Wide>(device, first.room(), &left)?;
    launch_striding::<R::Exact>(device, last.room(), &args(last.span(), last.counter(), None))
}

impl Continuous {
    /// Takes the memory.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(device: &Device, layout: &Layout, query: Query, rooms: Rooms) -> Result<Self, Error> {
        let earliest = query.motion == Motion::Earliest;
        let hits = if earliest { [0, 0] } else { rooms.hits };
        let Rooms { candidates, survivors, escalated, .. } = rooms;
        let escalated = || -> Result<_, Error> {
            Ok([
                List::new(device, "escalated vertex/face pairs", counter::VF_ESCALATED, escalated[0])?,
                List::new(device, "escalated edge/edge pairs", counter::EE_ESCALATED, escalated[1])?,
            ])
        };
        Ok(Continuous {
            edges: device.upload(&layout.edges)?,
            face_edges: device.upload(&layout.face_edges)?,
            owners: device.upload(&layout.owners)?,
            vf: List::new(device, "vertex/face candidates", counter::VF, candidates[0])?,
            ee: List::new(device, "edge/edge candidates", counter::EE, candidates[1])?,
            vf_survivors: List::new(device, "vertex/face survivors", counter::VF_SURVIVORS, survivors[0])?,
            ee_survivors: List::new(device, "edge/edge survivors", counter::EE_SURVIVORS, survivors[1])?,
            vf_hits: List::new(device, "vertex/face contacts", counter::VF_HITS, hits[0])?,
            ee_hits: List::new(device, "edge/edge contacts", counter::EE_HITS, hits[1])?,
            escalated: (query.solver() == Solver::Certified).then(escalated).transpose()?,
            unresolved: Tally(counter::UNRESOLVED),
            earliest: earliest.then(|| device.buffer(1)).transpose()?,
        })
    }

    /// Puts pairs where a step would leave them, vertex/face and edge/edge: [`Step::Sift`] candidates, [`Step::Reject`]
    /// those that may meet. The counters that say how many they are.
    ///
    /// # Errors
    /// Those of the device.
    ///
    /// # Panics
    /// When there are more than the lists have room for: a fault of the caller.
    pub fn give(&mut self, step: Step, [vf, ee]: [&[Pair]; 2]) -> Result<[(u32, u64); 2], Error> {
        let lists = match step {
            Step::Sift => [&mut self.vf, &mut self.ee],
            _ => [&mut self.vf_survivors, &mut self.ee_survivors],
        };
        let [vf_list, ee_list] = lists;
        Ok([vf_list.put(vf)?, ee_list.put(ee)?])
    }

    fn sift<R: Precision>(&self, given: &Given<R>) -> Result<(), Error> {
        let args = SiftArgs {
            frames: given.frames,
            faces: given.faces,
            face_edges: self.face_edges.span(),
            owners: self.owners.span(),
            pairs: given.pairs,
            vf: self.vf.span(),
            ee: self.ee.span(),
            counters: given.counters,
            separation: given.query.params().separation,
        };
        launch_striding::<R::Sift>(given.device, given.pairs.len as usize, &args)
    }

    fn reject<R: Precision>(&self, given: &Given<R>) -> Result<(), Error> {
        let args = |candidates: &List<Pair>, survivors: &List<Pair>| RejectArgs {
            frames: given.frames,
            faces: given.faces,
            edges: self.edges.span(),
            candidates: candidates.span(),
            survivors: survivors.span(),
            counters: given.counters,
            separation: given.query.params().separation,
        };
        let (vf, ee) = (args(&self.vf, &self.vf_survivors), args(&self.ee, &self.ee_survivors));
        if vf.separation > 0.0 {
            launch_striding::<R::RejectNearVf>(given.device, self.vf.room(), &vf)?;
            return launch_striding::<R::RejectNearEe>(given.device, self.ee.room(), &ee);
        }
        launch_striding::<R::RejectVf>(given.device, self.vf.room(), &vf)?;
        launch_striding::<R::RejectEe>(given.device, self.ee.room(), &ee)
    }

    fn solve<R: Precision>(&mut self, given: &Given<R>) -> Result<(), Error> {
        if let Some(earliest) = &mut self.earliest {
            earliest.write(&[u64::MAX])?;
        }
        if given.query.solver().is_certified() {
            return self.certify(given);
        }
        let args = |survivors: &List<Pair>, hits: &List<Hit>| SolveArgs {
            frames: given.frames,
            faces: given.faces,
            edges: self.edges.span(),
            survivors: survivors.span(),
            hits: hits.span(),
            earliest: self.earliest.as_ref().map_or(Span::EMPTY, Buffer::span),
            counters: given.counters,
        };
        let (vf, ee) = (args(&self.vf_survivors, &self.vf_hits), args(&self.ee_survivors, &self.ee_hits));
        let (of_vf, of_ee) = (self.vf_survivors.room(), self.ee_survivors.room());
        match given.query.solver() {
            Solver::CubicF32 => {
                launch_striding::<R::Vf32>(given.device, of_vf, &vf)?;
                launch_striding::<R::Ee32>(given.device, of_ee, &ee)
            }
            Solver::Additive => {
                launch_striding::<R::AdditiveVf>(given.device, of_vf, &vf)?;
                launch_striding::<R::AdditiveEe>(given.device, of_ee, &ee)
            }
            _ => {
                launch_striding::<R::Vf64>(given.device, of_vf, &vf)?;
                launch_striding::<R::Ee64>(given.device, of_ee, &ee)
            }
        }
    }

    /// In f32 over the survivors, then in f64 over what that escalated; or in one of them over all.
    fn certify<R: Precision>(&self, given: &Given<R>) -> Result<(), Error> {
        let listed = |pairs: &List<Pair>, hits: &List<Hit>, escalated: Option<&List<Pair>>| Listed {
            pairs: pairs.span(),
            hits: hits.span(),
            escalated: escalated.map_or(Span::EMPTY, List::span),
            pairs_at: pairs.counter(),
            hits_at: hits.counter(),
            escalated_at: escalated.map_or(0, List::counter),
            pad: 0,
        };
        let args = |[vf, ee]: [&List<Pair>; 2], escalated: Option<&[List<Pair>; 2]>| CertifyArgs {
            frames: given.frames,
            faces: given.faces,
            edges: self.edges.span(),
            vf: listed(vf, &self.vf_hits, escalated.map(|[vf, _]| vf)),
            ee: listed(ee, &self.ee_hits, escalated.map(|[_, ee]| ee)),
            earliest: self.earliest.as_ref().map_or(Span::EMPTY, Buffer::span),
            counters: given.counters,
            params: given.query.params(),
            flags: if escalated.is_some() { ESCALATE } else { 0 },
            pad: 0,
        };
        let survivors = [&self.vf_survivors, &self.ee_survivors];
        let room = |[vf, ee]: [&List<Pair>; 2]| vf.room() + ee.room();
        let device = given.device;
        let escalated = self.escalated.as_ref();
        if given.query.solver() == Solver::CertifiedF64 {
            return launch_drawing::<R::Certify64>(device, room(survivors), &args(survivors, None));
        }
        launch_drawing::<R::Certify32>(device, room(survivors), &args(survivors, escalated))?;
        match escalated {
            None => Ok(()),
            Some(lists) => {
                let lists = lists.each_ref();
                launch_drawing::<R::Certify64>(device, room(lists), &args(lists, None))
            }
        }
    }
}

/// Launches a kernel over up to `room` items.
fn launch_striding<E: Entry>(device: &Device, room: usize, args: &E::Args) -> Result<(), Error> {
    device.launch::<E>(device.blocks_striding::<E>(room), args)
}

/// Launches a kernel whose lanes draw from up to `room` items.
fn launch_drawing<E: Entry>(device: &Device, room: usize, args: &E::Args) -> Result<(), Error> {
    device.launch::<E>(device.blocks_at_once::<E>(room)?, args)
}
