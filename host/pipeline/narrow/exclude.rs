//! Pairs of features, and of triangles, that a scene excludes: tables on the device, lists, and the
//! launches that drop such pairs.

use super::{NarrowContext, growable};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::excluded::Excluded;
use crate::pipeline::list::{GrowableOutput, List, Named, named};
use crate::pipeline::precision::Precision;
use crate::pipeline::{launch, purpose};
use nearmiss_kernels::abi::{
    BodyRecord, Counter, ExcludeArgs, ExcludeTrianglesArgs, ExclusionTables, Output, Pair, PartnerBits,
    RestPoint, RestReach, Span,
};
use nearmiss_kernels::entry::{narrow_exclude, narrow_exclude_triangles};

/// The tables of a scene on a device; without memory in a scene that excludes nothing.
pub struct Exclusions {
    partners: Buffer<u32>,
    bits: Buffer<PartnerBits>,
    rest: Buffer<RestPoint>,
    reaches: Buffer<RestReach>,
    faces: Buffer<u32>,
}

impl Exclusions {
    /// Uploads the tables.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, of: &Excluded) -> Result<Self, Error> {
        Ok(Exclusions {
            partners: device.of(purpose::EXCLUDED_VERTICES).upload(&of.partners)?,
            bits: device.of(purpose::EXCLUDED_VERTICES).upload(&of.bits)?,
            rest: device.of(purpose::REST_SHAPES).upload(&of.rest)?,
            reaches: device.of(purpose::REST_SHAPES).upload(&of.reaches)?,
            faces: device.of(purpose::EXCLUDED_FACES).upload(&of.faces)?,
        })
    }

    /// Returns the tables as kernels read them, with the records of the bodies.
    pub fn tables(&self, bodies: Span<BodyRecord>) -> ExclusionTables {
        ExclusionTables {
            partners: self.partners.span(),
            bits: self.bits.span(),
            rest: self.rest.span(),
            reaches: self.reaches.span(),
            bodies,
            faces: self.faces.span(),
        }
    }
}

/// Pairs of features that are not excluded.
pub struct Kept([List<Pair>; 2]);

impl Kept {
    /// Allocates the lists, vertex/face and edge/edge.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(
        device: &Device,
        [vf, ee]: [(&'static str, Counter); 2],
        room: [usize; 2],
    ) -> Result<Self, Error> {
        Ok(Kept([List::new(device, vf.0, vf.1, room[0])?, List::new(device, ee.0, ee.1, room[1])?]))
    }

    /// Returns the lists, vertex/face and edge/edge.
    pub fn lists(&self) -> [&List<Pair>; 2] {
        self.0.each_ref()
    }

    /// Returns the lists, which can grow.
    pub fn growable(&mut self) -> impl Iterator<Item = &mut dyn GrowableOutput> {
        growable(&mut self.0)
    }

    /// Returns the lists, with names: for comparing machines.
    pub fn between(&self, names: [&'static str; 2]) -> impl Iterator<Item = Named<'_>> {
        names.into_iter().zip(&self.0).map(|(name, list)| named(name, list))
    }

    /// Makes room for at least so many pairs of each kind.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn reserve(&mut self, device: &Device, room: usize) -> Result<(), Error> {
        self.0.iter_mut().try_for_each(|list| list.reserve(device, room))
    }

    /// Lists the pairs of these lists that are not excluded.
    ///
    /// # Errors
    /// Device errors.
    pub fn run<R: Precision>(
        &self,
        given: &NarrowContext<R>,
        [vf, ee]: [&List<Pair>; 2],
    ) -> Result<(), Error> {
        let [kept_vf, kept_ee] = self.lists().map(|list| list.output(given.counters));
        let args = ExcludeArgs {
            tables: given.excluded,
            faces: given.faces,
            edges: given.features.edges.span(),
            vf: vf.output(given.counters),
            ee: ee.output(given.counters),
            kept_vf,
            kept_ee,
        };
        launch::striding::<narrow_exclude>(given.device, vf.capacity() + ee.capacity(), &args)
    }
}

/// Lists the pairs of triangles of a list that are not excluded.
///
/// # Errors
/// Device errors.
pub fn exclude_triangles<R: Precision>(
    given: &NarrowContext<R>,
    pairs: &List<Pair>,
    kept: Output<Pair>,
) -> Result<(), Error> {
    let args = ExcludeTrianglesArgs {
        tables: given.excluded,
        faces: given.faces,
        pairs: pairs.output(given.counters),
        kept,
    };
    launch::striding::<narrow_exclude_triangles>(given.device, pairs.capacity(), &args)
}
