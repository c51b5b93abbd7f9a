//! Features in motion: their lists, and the launches from triangle pairs to contacts.

use super::rungs::Rungs;
use super::{Given, Step, launch_striding};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::blunt::{self, Blunt};
use crate::pipeline::layout::Layout;
use crate::pipeline::precision::Precision;
use crate::pipeline::room::{Growing, List, Tally};
use crate::query::{Motion, Query, Solver};
use nearmiss_kernels::abi::{Facet, Hit, Pair, RejectArgs, SiftArgs, SolveArgs, Span, counter};

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
    facets: Buffer<Facet>,
    /// What the solver is asked, vertex/face and edge/edge: pairs that may meet; with a separation, pairs whose boxes come
    /// within it.
    asked: [List<Pair>; 2],
    /// Vertex/face contacts.
    pub vf_hits: List<Hit>,
    /// Edge/edge contacts.
    pub ee_hits: List<Hit>,
    /// What certified solvers climb.
    rungs: Rungs,
    /// Hits that are not certain, those whose budget ended, those of both, and those too large for the tolerance.
    tallies: [Tally; 4],
    /// Whether pairs may be too large for the tolerance: see [`Blunt`].
    pub blunt: Option<Blunt>,
    /// Pairs of features whose boxes meet, where the first step counts them and lists fewer.
    candidates: Option<[Tally; 2]>,
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
        let (room, counters, [vf, ee]) = if query.is_apart() {
            (rooms.candidates, [counter::VF, counter::EE], ["vertex/face candidates", "edge/edge candidates"])
        } else {
            let counters = [counter::VF_SURVIVORS, counter::EE_SURVIVORS];
            (rooms.survivors, counters, ["vertex/face pairs that may meet", "edge/edge pairs that may meet"])
        };
        let facet = |((&corners, &edges), &owned)| Facet { corners, owned, edges, pad: 0 };
        let facets: Vec<_> =
            layout.faces.iter().zip(&layout.face_edges).zip(&layout.owners).map(facet).collect();
        Ok(Continuous {
            query,
            edges: device.upload(&layout.edges)?,
            facets: device.upload(&facets)?,
            asked: [
                List::new(device, vf, counters[0], room[0])?,
                List::new(device, ee, counters[1], room[1])?,
            ],
            vf_hits: List::new(device, "vertex/face contacts", counter::VF_HITS, hits[0])?,
            ee_hits: List::new(device, "edge/edge contacts", counter::EE_HITS, hits[1])?,
            rungs: Rungs::new(device, &query, rooms.left)?,
            tallies: [counter::UNRESOLVED, counter::ENDED, counter::ENDED_UNRESOLVED, counter::BLUNT]
                .map(Tally),
            blunt: None,
            candidates: (!query.is_apart()).then_some([Tally(counter::VF), Tally(counter::EE)]),
            earliest: earliest.then(|| device.buffer(1)).transpose()?,
        })
    }

    /// The lists that a step fills.
    pub fn lists(&mut self, step: Step) -> Vec<&mut dyn Growing> {
        match step {
            Step::Sift => {
                let lists = self.asked.iter_mut().map(|list| list as &mut dyn Growing);
                lists
                    .chain(self.candidates.iter_mut().flatten().map(|tally| tally as &mut dyn Growing))
                    .collect()
            }
            Step::Solve => {
                let mut lists: Vec<&mut dyn Growing> = vec![&mut self.vf_hits, &mut self.ee_hits];
                lists.extend(self.tallies.iter_mut().map(|tally| tally as &mut dyn Growing));
                lists.extend(self.rungs.lists());
                lists
            }
            Step::Traverse | Step::Decide => Vec::new(),
        }
    }

    /// The lists between candidates and contacts, with names: for comparing machines.
    pub fn between(&self) -> Vec<(&'static str, &List<Pair>)> {
        let [vf, ee] = &self.asked;
        let mut lists = vec![("narrow: vf", vf), ("narrow: ee", ee)];
        lists.extend(self.rungs.between());
        lists
    }

    /// Puts pairs where [`Step::Sift`] would leave them, vertex/face and edge/edge. The counters that say how many they are.
    ///
    /// # Errors
    /// Those of the device.
    ///
    /// # Panics
    /// When there are more than the lists have room for: a fault of the caller.
    pub fn give(&mut self, [vf, ee]: [&[Pair]; 2]) -> Result<[(u32, u64); 2], Error> {
        let [vf_list, ee_list] = &mut self.asked;
        Ok([vf_list.put(vf)?, ee_list.put(ee)?])
    }

    /// Launches a step.
    ///
    /// # Errors
    /// Those of the device.
    pub fn run<R: Precision>(&mut self, step: Step, given: &Given<R>) -> Result<(), Error> {
        match step {
            Step::Sift => self.sift(given),
            _ => self.solve(given),
        }
    }

    fn sift<R: Precision>(&self, given: &Given<R>) -> Result<(), Error> {
        let [vf, ee] = &self.asked;
        let args = SiftArgs {
            frames: given.frames,
            facets: self.facets.span(),
            pairs: given.pairs,
            vf: vf.span(),
            ee: ee.span(),
            counters: given.counters,
            gap: given.query.gap(),
            params: given.query.params(),
        };
        let room = given.pairs.len as usize;
        if self.query.is_apart() {
            launch_striding::<R::SiftNear>(given.device, room, &args)
        } else {
            launch_striding::<R::Sift>(given.device, room, &args)
        }
    }

    /// Leaves out of `candidates` what certainly stays apart, as [`Step::Sift`] does.
    ///
    /// # Errors
    /// Those of the device.
    pub fn reject<R: Precision>(&self, given: &Given<R>, candidates: &[List<Pair>; 2]) -> Result<(), Error> {
        let args = |candidates: &List<Pair>, survivors: &List<Pair>| RejectArgs {
            frames: given.frames,
            faces: given.faces,
            edges: self.edges.span(),
            candidates: candidates.span(),
            survivors: survivors.span(),
            counters: given.counters,
            params: given.query.params(),
        };
        let ([vf, ee], [may_vf, may_ee]) = (candidates, &self.asked);
        launch_striding::<R::RejectVf>(given.device, vf.room(), &args(vf, may_vf))?;
        launch_striding::<R::RejectEe>(given.device, ee.room(), &args(ee, may_ee))
    }

    fn solve<R: Precision>(&mut self, given: &Given<R>) -> Result<(), Error> {
        if let Some(earliest) = &mut self.earliest {
            earliest.write(&[u64::MAX])?;
        }
        let [vf, ee] = &self.asked;
        let solver = self.query.solver();
        if solver.is_certified() {
            let hits = [&self.vf_hits, &self.ee_hits];
            let earliest = self.earliest.as_ref().map_or(Span::EMPTY, Buffer::span);
            self.rungs.climb(given, self.edges.span(), ([vf, ee], hits, earliest))?;
            return blunt::count(self.blunt, (self.edges.span(), &self.vf_hits, &self.ee_hits), given);
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
            _ => {
                launch_striding::<R::Vf64>(given.device, vf.room(), &of_vf)?;
                launch_striding::<R::Ee64>(given.device, ee.room(), &of_ee)
            }
        }
    }
}
