//! Features in motion: their lists, and the launches from triangle pairs to contacts.

use super::rungs::Rungs;
use super::{Given, Step, launch_striding};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::layout::Layout;
use crate::pipeline::precision::Precision;
use crate::pipeline::room::{Growing, List, Tally};
use crate::query::{Motion, Query, Solver};
use nearmiss_kernels::abi::{Hit, Pair, RejectArgs, SiftArgs, SolveArgs, Span, counter};

/// How many entries the lists of a continuous query have room for at first: vertex/face, edge/edge.
pub struct Rooms {
    /// Candidates.
    pub candidates: [usize; 2],
    /// Those that may meet.
    pub survivors: [usize; 2],
    /// Contacts.
    pub hits: [usize; 2],
    /// Pairs that a rung leaves to the next.
    pub left: [usize; 2],
}

/// The lists and the topology of a continuous query.
pub struct Continuous {
    query: Query,
    pub(super) edges: Buffer<[u32; 2]>,
    face_edges: Buffer<[u32; 3]>,
    owners: Buffer<u32>,
    vf: List<Pair>,
    ee: List<Pair>,
    /// Those that may meet, vertex/face and edge/edge; there is no such step with a separation.
    survivors: Option<[List<Pair>; 2]>,
    /// Vertex/face contacts.
    pub vf_hits: List<Hit>,
    /// Edge/edge contacts.
    pub ee_hits: List<Hit>,
    /// What certified solvers climb.
    rungs: Rungs,
    /// Hits that are not certain.
    unresolved: Tally,
    /// The smallest toi, where only that is asked for.
    pub earliest: Option<Buffer<u64>>,
}

impl Continuous {
    /// Takes the memory.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(device: &Device, layout: &Layout, query: Query, rooms: Rooms) -> Result<Self, Error> {
        let earliest = query.motion == Motion::Earliest;
        let hits = if earliest { [0, 0] } else { rooms.hits };
        let Rooms { candidates, survivors, left, .. } = rooms;
        let survivors = || -> Result<_, Error> {
            Ok([
                List::new(device, "vertex/face survivors", counter::VF_SURVIVORS, survivors[0])?,
                List::new(device, "edge/edge survivors", counter::EE_SURVIVORS, survivors[1])?,
            ])
        };
        Ok(Continuous {
            query,
            edges: device.upload(&layout.edges)?,
            face_edges: device.upload(&layout.face_edges)?,
            owners: device.upload(&layout.owners)?,
            vf: List::new(device, "vertex/face candidates", counter::VF, candidates[0])?,
            ee: List::new(device, "edge/edge candidates", counter::EE, candidates[1])?,
            survivors: (!query.is_apart()).then(survivors).transpose()?,
            vf_hits: List::new(device, "vertex/face contacts", counter::VF_HITS, hits[0])?,
            ee_hits: List::new(device, "edge/edge contacts", counter::EE_HITS, hits[1])?,
            rungs: Rungs::new(device, &query, left)?,
            unresolved: Tally(counter::UNRESOLVED),
            earliest: earliest.then(|| device.buffer(1)).transpose()?,
        })
    }

    /// The steps, in their order. A separation has nothing that signs could reject.
    pub fn steps(&self) -> &'static [Step] {
        match self.survivors {
            Some(_) => &[Step::Sift, Step::Reject, Step::Solve],
            None => &[Step::Sift, Step::Solve],
        }
    }

    /// The lists that a step fills.
    pub fn lists(&mut self, step: Step) -> Vec<&mut dyn Growing> {
        match step {
            Step::Sift => vec![&mut self.vf, &mut self.ee],
            Step::Reject => {
                self.survivors.iter_mut().flatten().map(|list| list as &mut dyn Growing).collect()
            }
            Step::Solve => {
                let mut lists: Vec<&mut dyn Growing> =
                    vec![&mut self.vf_hits, &mut self.ee_hits, &mut self.unresolved];
                lists.extend(self.rungs.lists());
                lists
            }
            Step::Traverse | Step::Decide => Vec::new(),
        }
    }

    /// The lists between candidates and contacts, with names: for comparing machines.
    pub fn between(&self) -> Vec<(&'static str, &List<Pair>)> {
        let mut lists = vec![("narrow: vf", &self.vf), ("narrow: ee", &self.ee)];
        if let Some([vf, ee]) = &self.survivors {
            lists.extend([("narrow: vf that may meet", vf), ("narrow: ee that may meet", ee)]);
        }
        lists.extend(self.rungs.between());
        lists
    }

    /// What the solver is asked.
    fn asked(&self) -> [&List<Pair>; 2] {
        self.survivors.as_ref().map_or([&self.vf, &self.ee], |lists| lists.each_ref())
    }

    /// Puts pairs where a step would leave them, vertex/face and edge/edge: [`Step::Sift`] candidates, [`Step::Reject`]
    /// those that may meet, or candidates where there is no such step. The counters that say how many they are.
    ///
    /// # Errors
    /// Those of the device.
    ///
    /// # Panics
    /// When there are more than the lists have room for: a fault of the caller.
    pub fn give(&mut self, step: Step, [vf, ee]: [&[Pair]; 2]) -> Result<[(u32, u64); 2], Error> {
        let [vf_list, ee_list] = match (step, &mut self.survivors) {
            (Step::Reject, Some(lists)) => lists.each_mut(),
            _ => [&mut self.vf, &mut self.ee],
        };
        Ok([vf_list.put(vf)?, ee_list.put(ee)?])
    }

    /// Launches a step.
    ///
    /// # Errors
    /// Those of the device.
    pub fn run<R: Precision>(&mut self, step: Step, given: &Given<R>) -> Result<(), Error> {
        match step {
            Step::Sift => self.sift(given),
            Step::Reject => self.reject(given),
            _ => self.solve(given),
        }
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
            separation: given.query.gap(),
        };
        launch_striding::<R::Sift>(given.device, given.pairs.len as usize, &args)
    }

    fn reject<R: Precision>(&self, given: &Given<R>) -> Result<(), Error> {
        let Some([vf_survivors, ee_survivors]) = &self.survivors else { return Ok(()) };
        let args = |candidates: &List<Pair>, survivors: &List<Pair>| RejectArgs {
            frames: given.frames,
            faces: given.faces,
            edges: self.edges.span(),
            candidates: candidates.span(),
            survivors: survivors.span(),
            counters: given.counters,
            params: given.query.params(),
        };
        launch_striding::<R::RejectVf>(given.device, self.vf.room(), &args(&self.vf, vf_survivors))?;
        launch_striding::<R::RejectEe>(given.device, self.ee.room(), &args(&self.ee, ee_survivors))
    }

    fn solve<R: Precision>(&mut self, given: &Given<R>) -> Result<(), Error> {
        if let Some(earliest) = &mut self.earliest {
            earliest.write(&[u64::MAX])?;
        }
        let [vf, ee] = self.asked();
        let solver = self.query.solver();
        if solver.is_certified() {
            let hits = [&self.vf_hits, &self.ee_hits];
            let earliest = self.earliest.as_ref().map_or(Span::EMPTY, Buffer::span);
            return self.rungs.climb(given, self.edges.span(), ([vf, ee], hits, earliest));
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
        let (of_vf, of_ee) = (args(vf, &self.vf_hits), args(ee, &self.ee_hits));
        match solver {
            Solver::CubicF32 => {
                launch_striding::<R::Vf32>(given.device, vf.room(), &of_vf)?;
                launch_striding::<R::Ee32>(given.device, ee.room(), &of_ee)
            }
            Solver::Additive => {
                launch_striding::<R::AdditiveVf>(given.device, vf.room(), &of_vf)?;
                launch_striding::<R::AdditiveEe>(given.device, ee.room(), &of_ee)
            }
            _ => {
                launch_striding::<R::Vf64>(given.device, vf.room(), &of_vf)?;
                launch_striding::<R::Ee64>(given.device, ee.room(), &of_ee)
            }
        }
    }
}
