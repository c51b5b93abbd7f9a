//! From triangle pairs to vertex/face and edge/edge candidates: topology, lists, the launch.

use super::NarrowContext;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::counts::Counts;
use crate::pipeline::layout::Layout;
use crate::pipeline::list::{List, Named, named};
use crate::pipeline::precision::Precision;
use crate::pipeline::{launch, purpose};
use nearmiss_kernels::abi::rows::code;
use nearmiss_kernels::abi::{Facet, FeaturesArgs, Output, Pair, Span, counter};
use nearmiss_kernels::entry::Entry;

/// Topology of triangles, and the candidates of a query of features.
pub struct Features {
    /// End points of every edge.
    pub edges: Buffer<[u32; 2]>,
    facets: Buffer<Facet>,
    /// Vertex/face and edge/edge pairs whose boxes are within the gap.
    pub candidates: [List<Pair>; 2],
}

impl Features {
    /// Returns no features: for a scene without such a query.
    ///
    /// # Errors
    /// Device errors.
    pub fn none(device: &Device) -> Result<Self, Error> {
        Features::new(device, &Layout::default(), [0, 0])
    }

    /// Allocates topology and lists, with room for so many candidates of each kind.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, layout: &Layout, [vf, ee]: [usize; 2]) -> Result<Self, Error> {
        let topology = &layout.features;
        let facet = |(at, ((&corners, &edges), &owned)): (usize, ((_, _), &u32))| {
            let is_point = layout.element(at as u32).kind == u32::from(code::VERTEX_VERTEX);
            let is_point = if is_point { Facet::POINT } else { 0 };
            Facet { corners, owned: owned | is_point, edges, pad: 0 }
        };
        let triangles = layout.faces.iter().zip(&topology.face_edges).zip(&topology.owners);
        let facets: Vec<_> = triangles.enumerate().map(facet).collect();
        Ok(Features {
            edges: device.of(purpose::EDGES).upload(&topology.edges)?,
            facets: device.of(purpose::FACETS).upload(&facets)?,
            candidates: [
                List::new(device, "vertex/face candidates", counter::VF, vf)?,
                List::new(device, "edge/edge candidates", counter::EE, ee)?,
            ],
        })
    }

    /// Makes room for the candidates of another query of features; the first one uploads the
    /// topology.
    ///
    /// # Errors
    /// Device errors.
    pub fn reserve(&mut self, device: &Device, layout: &Layout, room: [usize; 2]) -> Result<(), Error> {
        if self.facets.is_empty() {
            *self = Features::new(device, layout, room)?;
        }
        self.candidates.iter_mut().zip(room).try_for_each(|(list, room)| list.reserve(device, room))
    }

    /// Puts pairs, vertex/face and edge/edge, among the candidates, and their numbers in `counts`.
    ///
    /// # Errors
    /// Device errors.
    ///
    /// # Panics
    /// If there are more pairs than room: a fault of the caller.
    pub fn put_candidates(&mut self, [vf, ee]: [&[Pair]; 2], counts: &mut Counts) -> Result<(), Error> {
        let [vf_list, ee_list] = &mut self.candidates;
        vf_list.put(vf, counts)?;
        ee_list.put(ee, counts)
    }

    /// Returns the lists, with names: for comparing machines.
    pub fn between(&self) -> Vec<Named<'_>> {
        let [vf, ee] = &self.candidates;
        vec![named("narrow: vf", vf), named("narrow: ee", ee)]
    }

    /// Returns the topology of the triangles.
    pub fn facets(&self) -> Span<Facet> {
        self.facets.span()
    }

    /// Launches the step over these triangle pairs by kernel `E`, for moving triangles or for those at one time. It lists
    /// pairs within the gap. If a time is `known`, it lists only those within the gap before it.
    ///
    /// # Errors
    /// Device errors.
    pub fn run<R: Precision, E: Entry<Args = FeaturesArgs<R>>>(
        &self,
        given: &NarrowContext<R>,
        pairs: Output<Pair>,
        numbers: (f64, Span<u64>),
    ) -> Result<(), Error> {
        self.run_into::<R, E>(given, pairs, numbers, self.candidates.each_ref())
    }

    /// As [`Features::run`], with other lists for the candidates.
    ///
    /// # Errors
    /// Device errors.
    pub fn run_into<R: Precision, E: Entry<Args = FeaturesArgs<R>>>(
        &self,
        given: &NarrowContext<R>,
        pairs: Output<Pair>,
        (gap, known): (f64, Span<u64>),
        [vf, ee]: [&List<Pair>; 2],
    ) -> Result<(), Error> {
        let args = FeaturesArgs {
            frames: given.frames,
            facets: self.facets.span(),
            pairs,
            vf: vf.output(given.counters),
            ee: ee.output(given.counters),
            gap,
            known,
        };
        launch::at_once::<E>(given.device, pairs.room() as usize, &args)
    }
}
