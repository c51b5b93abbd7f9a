//! Features in motion: their lists, and the launches from triangle pairs to contacts.

use super::features::Features;
use super::rungs::Rungs;
use super::{NarrowContext, Step};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::below_precision::{self, BelowPrecision};
use crate::pipeline::layout::Layout;
use crate::pipeline::list::{Counter, GrowableOutput, List};
use crate::pipeline::order::Order;
use crate::pipeline::precision::Precision;
use crate::pipeline::{launch, purpose};
use crate::query::{Motion, Query, Solver};
use nearmiss_kernels::abi::{CullArgs, Hit, Pair, SolveArgs, Span, counter};

/// How many entries the lists of a continuous query have room for at first: vertex/face, edge/edge.
pub struct Capacities {
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
    /// Topology, and the pairs whose boxes come within the separation.
    features: Features,
    /// Those that may meet; there is no such step with a separation.
    survivors: Option<[List<Pair>; 2]>,
    /// Vertex/face contacts.
    pub vf_hits: List<Hit>,
    /// Edge/edge contacts.
    pub ee_hits: List<Hit>,
    /// What certified solvers climb.
    rungs: Rungs,
    /// Hits that are not certain, those whose budget ended, those of both, and those too large for the tolerance.
    counters: [Counter; 4],
    /// Whether pairs may be too large for the tolerance: see [`BelowPrecision`].
    pub below_precision: Option<BelowPrecision>,
    /// The smallest toi, where only that is asked for.
    pub earliest: Option<Buffer<u64>>,
    /// All contacts in order, where the device orders them.
    pub ordered: Option<Order<Hit>>,
}

impl Continuous {
    /// Takes the memory.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(
        device: &Device,
        layout: &Layout,
        query: Query,
        capacities: Capacities,
    ) -> Result<Self, Error> {
        let earliest = query.motion == Motion::Earliest;
        let hits = if earliest { [0, 0] } else { capacities.hits };
        let lists = |[vf, ee]: [&'static str; 2], [vf_at, ee_at]: [u32; 2], capacity: [usize; 2]| {
            Ok::<_, Error>([
                List::new(device, vf, vf_at, capacity[0])?,
                List::new(device, ee, ee_at, capacity[1])?,
            ])
        };
        let may_meet = ["vertex/face pairs that may meet", "edge/edge pairs that may meet"];
        let survivors =
            || lists(may_meet, [counter::VF_SURVIVORS, counter::EE_SURVIVORS], capacities.survivors);
        Ok(Continuous {
            query,
            features: Features::new(device, layout, capacities.candidates)?,
            survivors: (!query.is_apart()).then(survivors).transpose()?,
            vf_hits: List::new(device, "vertex/face contacts", counter::VF_HITS, hits[0])?,
            ee_hits: List::new(device, "edge/edge contacts", counter::EE_HITS, hits[1])?,
            rungs: Rungs::new(device, &query, capacities.left)?,
            counters: [
                counter::UNRESOLVED,
                counter::ENDED,
                counter::ENDED_UNRESOLVED,
                counter::BELOW_PRECISION,
            ]
            .map(Counter),
            below_precision: None,
            earliest: earliest.then(|| device.of(purpose::EARLIEST).buffer(1)).transpose()?,
            ordered: (device.is_gpu() && !earliest)
                .then(|| Order::new(device, layout, hits[0] / 4))
                .transpose()?,
        })
    }

    /// The steps, in their order. With a separation there is nothing that signs could reject.
    pub fn steps(&self) -> &'static [Step] {
        match self.survivors {
            Some(_) => &[Step::Features, Step::Cull, Step::Solve],
            None => &[Step::Features, Step::Solve],
        }
    }

    /// The lists that a step fills.
    pub fn lists(&mut self, step: Step) -> Vec<&mut dyn GrowableOutput> {
        match step {
            Step::Features => self.features.lists(),
            Step::Cull => {
                self.survivors.iter_mut().flatten().map(|list| list as &mut dyn GrowableOutput).collect()
            }
            Step::Solve => {
                let mut lists: Vec<&mut dyn GrowableOutput> = vec![&mut self.vf_hits, &mut self.ee_hits];
                lists.extend(self.counters.iter_mut().map(|counter| counter as &mut dyn GrowableOutput));
                lists.extend(self.rungs.lists());
                lists
            }
            Step::Order => {
                self.ordered.iter_mut().map(|order| &mut order.list as &mut dyn GrowableOutput).collect()
            }
            Step::Traverse | Step::Decide | Step::Near => Vec::new(),
        }
    }

    /// The lists between candidates and contacts, with names: for comparing machines.
    pub fn between(&self) -> Vec<(&'static str, &List<Pair>)> {
        let mut lists = self.features.between();
        if let Some([vf, ee]) = &self.survivors {
            lists.extend([("narrow: vf that may meet", vf), ("narrow: ee that may meet", ee)]);
        }
        lists.extend(self.rungs.between());
        lists
    }

    /// What the solver is asked.
    fn asked(&self) -> [&List<Pair>; 2] {
        self.survivors.as_ref().unwrap_or(&self.features.candidates).each_ref()
    }

    /// Puts pairs where a step would leave them, vertex/face and edge/edge: [`Step::Features`] candidates, [`Step::Cull`]
    /// those that may meet, or candidates where there is no such step. The counters that say how many they are.
    ///
    /// # Errors
    /// Those of the device.
    ///
    /// # Panics
    /// When there are more than the lists have room for: a fault of the caller.
    pub fn give(&mut self, step: Step, [vf, ee]: [&[Pair]; 2]) -> Result<[(u32, u64); 2], Error> {
        let [vf_list, ee_list] = match (step, &mut self.survivors) {
            (Step::Cull, Some(lists)) => lists.each_mut(),
            _ => self.features.candidates.each_mut(),
        };
        Ok([vf_list.put(vf)?, ee_list.put(ee)?])
    }

    /// Launches a step.
    ///
    /// # Errors
    /// Those of the device.
    pub fn run<R: Precision>(&mut self, step: Step, given: &NarrowContext<R>) -> Result<(), Error> {
        match step {
            Step::Features => self.features.run::<R, R::Features>(given),
            Step::Cull => self.cull(given),
            Step::Order => self.order(given),
            _ => self.solve(given),
        }
    }

    fn cull<R: Precision>(&self, given: &NarrowContext<R>) -> Result<(), Error> {
        let ([vf, ee], Some([may_vf, may_ee])) = (&self.features.candidates, &self.survivors) else {
            return Ok(());
        };
        let args = CullArgs {
            frames: given.frames,
            faces: given.faces,
            edges: self.features.edges.span(),
            vf: vf.span(),
            ee: ee.span(),
            may_vf: may_vf.span(),
            may_ee: may_ee.span(),
            counters: given.counters,
            params: given.query.params(),
        };
        launch::striding::<R::Cull>(given.device, vf.capacity() + ee.capacity(), &args)
    }

    fn order<R: Precision>(&mut self, given: &NarrowContext<R>) -> Result<(), Error> {
        match &mut self.ordered {
            None => Ok(()),
            Some(order) => {
                let given_to = (given.bodies, given.counters);
                order.run(given.device, &self.vf_hits, Some(&self.ee_hits), given_to)
            }
        }
    }

    fn solve<R: Precision>(&mut self, given: &NarrowContext<R>) -> Result<(), Error> {
        if let Some(earliest) = &mut self.earliest {
            earliest.write(&[u64::MAX])?;
        }
        let [vf, ee] = self.asked();
        let solver = self.query.solver();
        if solver.is_certified() {
            let hits = [&self.vf_hits, &self.ee_hits];
            let earliest = self.earliest.as_ref().map_or(Span::EMPTY, Buffer::span);
            self.rungs.climb(given, self.features.edges.span(), ([vf, ee], hits, earliest))?;
            return below_precision::count(
                self.below_precision,
                (self.features.edges.span(), &self.vf_hits, &self.ee_hits),
                given,
            );
        }
        let args = |survivors: &List<Pair>, hits: &List<Hit>| SolveArgs {
            frames: given.frames,
            faces: given.faces,
            edges: self.features.edges.span(),
            survivors: survivors.span(),
            hits: hits.span(),
            earliest: self.earliest.as_ref().map_or(Span::EMPTY, Buffer::span),
            counters: given.counters,
        };
        let (of_vf, of_ee) = (args(vf, &self.vf_hits), args(ee, &self.ee_hits));
        match solver {
            Solver::CubicF32 => {
                launch::striding::<R::Vf32>(given.device, vf.capacity(), &of_vf)?;
                launch::striding::<R::Ee32>(given.device, ee.capacity(), &of_ee)
            }
            _ => {
                launch::striding::<R::Vf64>(given.device, vf.capacity(), &of_vf)?;
                launch::striding::<R::Ee64>(given.device, ee.capacity(), &of_ee)
            }
        }
    }
}
