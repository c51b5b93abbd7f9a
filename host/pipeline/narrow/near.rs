//! Features at rest: their lists, and the launches from triangle pairs to those within a distance.

use super::features::Features;
use super::{NarrowContext, Step};
use crate::device::Device;
use crate::error::Error;
use crate::pipeline::launch;
use crate::pipeline::layout::Layout;
use crate::pipeline::list::{Counter, GrowableOutput, List};
use crate::pipeline::order::Order;
use crate::pipeline::precision::Precision;
use nearmiss_kernels::abi::{NearArgs, NearHit, Pair, Span, counter};

/// The lists and the topology of a near query.
pub struct Near {
    /// Topology, and the pairs whose boxes come within the distance.
    features: Features,
    /// Vertices and faces within the distance.
    pub vf_hits: List<NearHit>,
    /// Edges within the distance.
    pub ee_hits: List<NearHit>,
    /// Hits that are not certainly within it.
    unresolved: Counter,
    /// All hits in order, where the device orders them.
    pub ordered: Option<Order<NearHit>>,
}

impl Near {
    /// Takes the memory: `capacity` entries for candidates, twice as many for edges, `few` for hits.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(device: &Device, layout: &Layout, (capacity, few): (usize, usize)) -> Result<Self, Error> {
        let order = || Order::new(device, layout, few);
        Ok(Near {
            features: Features::new(device, layout, [capacity, 2 * capacity])?,
            vf_hits: List::new(device, "vertex/face pairs within the distance", counter::VF_HITS, few)?,
            ee_hits: List::new(device, "edge/edge pairs within the distance", counter::EE_HITS, 2 * few)?,
            unresolved: Counter(counter::UNRESOLVED),
            ordered: device.is_gpu().then(order).transpose()?,
        })
    }

    /// End points of every edge.
    pub fn edges(&self) -> Span<[u32; 2]> {
        self.features.edges.span()
    }

    /// The lists that a step fills.
    pub fn lists(&mut self, step: Step) -> Vec<&mut dyn GrowableOutput> {
        match step {
            Step::Features => self.features.lists(),
            Step::Near => vec![&mut self.vf_hits, &mut self.ee_hits, &mut self.unresolved],
            Step::Order => {
                self.ordered.iter_mut().map(|order| &mut order.list as &mut dyn GrowableOutput).collect()
            }
            Step::Traverse | Step::Decide | Step::Cull | Step::Solve => Vec::new(),
        }
    }

    /// The lists between candidates and hits, with names: for comparing machines.
    pub fn between(&self) -> Vec<(&'static str, &List<Pair>)> {
        self.features.between()
    }

    /// Launches a step.
    ///
    /// # Errors
    /// Those of the device.
    pub fn run<R: Precision>(&mut self, step: Step, given: &NarrowContext<R>) -> Result<(), Error> {
        match (step, &mut self.ordered) {
            (Step::Features, _) => self.features.run::<R, R::FeaturesAtRest>(given),
            (Step::Order, Some(order)) => {
                let given_to = (given.bodies, given.counters);
                order.run(given.device, &self.vf_hits, Some(&self.ee_hits), given_to)
            }
            (Step::Order, None) => Ok(()),
            _ => self.measure(given),
        }
    }

    fn measure<R: Precision>(&self, given: &NarrowContext<R>) -> Result<(), Error> {
        let [vf, ee] = &self.features.candidates;
        let args = NearArgs {
            positions: given.frames.still,
            faces: given.faces,
            edges: self.features.edges.span(),
            vf: vf.span(),
            ee: ee.span(),
            vf_hits: self.vf_hits.span(),
            ee_hits: self.ee_hits.span(),
            counters: given.counters,
            distance: given.query.listed_within(),
        };
        launch::striding::<R::Near>(given.device, vf.capacity() + ee.capacity(), &args)
    }
}
