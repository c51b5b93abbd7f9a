//! The memory of a scene on a device, which all of its queries share: topology, positions, broad
//! phases, candidates.

use super::Broad;
use super::query::QueryMemory;
use crate::device::{Buffer, Device, Event};
use crate::error::Error;
use crate::pipeline::broad::{
    BroadContext, CandidateSearch, Candidates, Which, broad_phase, growth, instance_phase, mixed_phase,
    motion_phase, pair_phase,
};
use crate::pipeline::instances::{Instances, deforms};
use crate::pipeline::launch;
use crate::pipeline::list::{GrowableOutput, List};
use crate::pipeline::narrow::{Exclusions, Features};
use crate::pipeline::placing::{Moved, Placing};
use crate::pipeline::precision::Precision;
use crate::pipeline::purpose;
use crate::pipeline::{Layout, QueryParts, SceneParts};
use crate::query::{self, BoundingVolume, Query, QueryKind};
use crate::scene::{Body, BodyKind, Pose};
use nearmiss_kernels::abi::{
    BodyRecord, Counters, FilterArgs, Growth, LeftOutArgs, Pair, Point, Positions, Span, TraverseFlags,
    counter,
};
use nearmiss_kernels::entry::traverse_left_out;
use std::sync::Arc;

/// The choices that two queries must have in common to share a broad phase.
#[derive(Clone, Copy, PartialEq)]
pub enum BroadKey {
    /// Tiles: volume, order, and, in a scene with hubs, whether pairs round a hub are candidates.
    Tiles(BoundingVolume, Option<bool>),
    /// Trees, whose walks keep state: all of a query except its numbers.
    Trees(Query),
    /// Groups of bodies, which are instances of meshes.
    Instances,
    /// The same around a step, or at rest: a query of features.
    Motion { is_at_rest: bool },
    /// The same next to tiles of bodies that deform, as in [`BroadKey::Tiles`].
    Mixed { is_at_rest: bool, volume: BoundingVolume, adjacent: Option<bool> },
    /// The same with words of their relations: a query of pairs of bodies.
    Bodies(QueryKind),
}

impl BroadKey {
    /// Returns the key of a query of that shape.
    fn of(shape: &Query, parts: &QueryParts, (is_gpu, is_mixed): (bool, bool)) -> BroadKey {
        let layout = &parts.layout;
        let has_hubs = !(layout.hubs.is_empty() && layout.rims.is_empty());
        let adjacent = has_hubs.then(|| shape.keeps_adjacent());
        if shape.kind().is_of_bodies() {
            return BroadKey::Bodies(shape.kind());
        }
        if parts.is_of_instances {
            let is_at_rest = shape.kind().is_at_rest();
            if is_mixed {
                return BroadKey::Mixed { is_at_rest, volume: shape.volume(), adjacent };
            }
            let is_of_features = shape.kind().is_of_features();
            return if is_of_features { BroadKey::Motion { is_at_rest } } else { BroadKey::Instances };
        }
        if shape.broad_phase_on(is_gpu) == query::BroadPhase::Tree {
            return BroadKey::Trees(*shape);
        }
        BroadKey::Tiles(shape.volume(), adjacent)
    }
}

/// The memory of a scene.
pub struct SceneMemory<R: Precision> {
    pub device: Device,
    /// Faces and vertices of all bodies; empty if all queries read bodies as instances.
    pub faces: Buffer<[u32; 3]>,
    pub vertices: Placing<R>,
    pub has_vertices: bool,
    /// Bodies that deform, if queries may read the others as instances; empty without such.
    pub deforming: Vec<usize>,
    /// Whether only these are placed.
    pub places_deforming: bool,
    /// Whether queries may read bodies as instances whose poses only the device has.
    has_instances: bool,
    pub layout: Arc<Layout>,
    /// Pairs of bodies that are left out, as kernels read them; empty without such.
    left_out: Buffer<u32>,
    /// Pairs of features that are excluded.
    pub exclusions: Exclusions,
    /// Meshes and poses, from the first query of instances on.
    pub instances: Option<Instances>,
    /// Edges, owned features, and candidates of features; empty before the first query of them.
    pub features: Features,
    /// Candidate triangle pairs of the current query.
    pub pairs: List<Pair>,
    /// Those of bodies that are not left out; `None` without such. Instances never list others.
    allowed: Option<List<Pair>>,
    pub broads: Vec<Broad<R>>,
    /// Whether a submission is being enqueued.
    pub is_submitting: bool,
    /// Events before and after each placing since the last frame.
    pub placing: Vec<[Event; 2]>,
    /// Number of placings so far.
    pub placings: u64,
}

impl<R: Precision> SceneMemory<R> {
    /// Uploads topology and positions, if a query will read them; positions at both ends of the step
    /// if a query in motion will.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: Device, bodies: &[Body], parts: &SceneParts) -> Result<Self, Error> {
        let (empty, of_faces) = (Layout::without_bodies(), device.of(purpose::FACES));
        let deforming: Vec<usize> =
            (0..bodies.len()).filter(|&i| parts.has_instances && deforms(&bodies[i])).collect();
        let places_deforming = !parts.has_vertices && !deforming.is_empty();
        let has_vertices = parts.has_vertices || places_deforming;
        let (layout, placed) = if has_vertices { (&*parts.layout, bodies) } else { (&empty, &[][..]) };
        let are_placed =
            placed.iter().map(|body| !places_deforming || body.kind() == BodyKind::Deformable).collect();
        // Queries of instances have vertices of candidates, and faces, of their own.
        let faces = if places_deforming { &empty.faces } else { &layout.faces };
        let purpose = if places_deforming { purpose::DEFORMING } else { purpose::VERTICES };
        let mut scene = SceneMemory {
            faces: of_faces.upload(faces)?,
            vertices: Placing::new(&device.of(purpose), layout, (placed, are_placed), parts.has_ends)?,
            has_vertices,
            deforming,
            places_deforming,
            has_instances: parts.has_instances,
            layout: parts.layout.clone(),
            left_out: device.of(purpose::LEFT_OUT).upload(&parts.layout.left_out)?,
            exclusions: Exclusions::new(&device, &parts.layout.excluded)?,
            instances: None,
            features: Features::none(&device)?,
            pairs: List::new(&device, "candidate triangle pairs", counter::PAIRS, 0)?,
            allowed: if parts.layout.left_out.is_empty() {
                None
            } else {
                Some(List::new(&device, "allowed triangle pairs", counter::ALLOWED_PAIRS, 0)?)
            },
            broads: Vec::new(),
            is_submitting: false,
            placing: Vec::new(),
            placings: 0,
            device,
        };
        scene.place_instances(bodies)?;
        Ok(scene)
    }

    /// Makes room for so many candidates.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn reserve_pairs(&mut self, capacity: usize) -> Result<(), Error> {
        self.pairs.reserve(&self.device, capacity)?;
        self.allowed.iter_mut().try_for_each(|list| list.reserve(&self.device, capacity))
    }

    /// Returns all lists of a traversal by a broad phase.
    pub fn lists_of_traversal(&mut self, broad: usize) -> Vec<&mut dyn GrowableOutput> {
        let mut lists = self.broads[broad].phase.lists();
        lists.push(&mut self.pairs);
        lists.extend(self.allowed.iter_mut().map(|list| list as &mut dyn GrowableOutput));
        lists
    }

    /// Returns whether queries of instances of this kind read bodies that deform as vertices.
    pub fn mixes(&self, kind: QueryKind) -> bool {
        !self.deforming.is_empty() && !kind.is_of_bodies()
    }

    /// Returns the candidates that the narrow phase reads.
    pub fn candidates(&self, query: &QueryMemory<R>) -> &List<Pair> {
        self.allowed.as_ref().filter(|_| query.leaves_out()).unwrap_or(&self.pairs)
    }

    /// Lists a query's candidates.
    ///
    /// # Errors
    /// Device errors.
    pub fn traverse(
        &mut self,
        query: &QueryMemory<R>,
        (which, counters): (Which, Counters),
    ) -> Result<(), Error> {
        let pairs = self.pairs.output(counters);
        let flags = TraverseFlags::KEEP_ADJACENT.when(query.query.keeps_adjacent());
        let candidates = Candidates { pairs, counters, flags, which, share: query.share };
        self.broadly(query, |broad, given, _| broad.traverse(given, &candidates))?;
        let Some(allowed) = self.allowed.as_ref().filter(|_| query.leaves_out()) else {
            return Ok(());
        };
        let args = LeftOutArgs {
            pairs,
            allowed: allowed.output(counters),
            bodies: query.records(),
            left_out: self.left_out.span(),
        };
        launch::striding::<traverse_left_out>(&self.device, self.pairs.capacity(), &args)
    }

    /// Returns the index of a query's broad phase, made if there is none like it. It is not built
    /// yet.
    ///
    /// # Errors
    /// Device errors.
    pub fn broad_of(&mut self, shape: &Query, parts: &QueryParts) -> Result<usize, Error> {
        let QueryParts { query, layout, .. } = parts;
        let is_gpu = self.device.is_gpu();
        let key = BroadKey::of(shape, parts, (is_gpu, self.mixes(shape.kind())));
        if let Some(at) = self.broads.iter().position(|broad| broad.key == key) {
            return Ok(at);
        }
        let margin = growth(query.listed_within());
        let phase = match key {
            BroadKey::Instances => instance_phase(&self.device, layout)?,
            BroadKey::Motion { is_at_rest } => motion_phase(&self.device, layout, is_at_rest, margin)?,
            BroadKey::Mixed { .. } => {
                let growth = Growth { margin, is_thick: 0 };
                mixed_phase(&self.device, layout, (query, &self.deforming), growth)?
            }
            BroadKey::Bodies(_) => pair_phase(&self.device, layout, query, margin)?,
            BroadKey::Tiles(..) | BroadKey::Trees(_) => {
                let is_thick = layout.is_thick() && query.kind().is_of_features();
                let growth = Growth { margin, is_thick: is_thick.into() };
                broad_phase(&self.device, layout, query, growth)?
            }
        };
        self.broads.push(Broad { key, phase, is_built: false });
        Ok(self.broads.len() - 1)
    }

    /// Moves the named bodies.
    ///
    /// # Errors
    /// Device errors.
    pub fn place(&mut self, bodies: &[Body], moved: &[Moved]) -> Result<(), Error> {
        if self.has_vertices {
            self.vertices.put(&self.device, bodies, moved)?;
        }
        self.place_instances(bodies)
    }

    /// Places instances. It makes them if there are none and the caller's memory has a pose, which is
    /// read now.
    fn place_instances(&mut self, bodies: &[Body]) -> Result<(), Error> {
        let is_lent = |body: &Body| body.kind() == BodyKind::Rigid && body.device_motion().is_some();
        if self.instances.is_none() && self.has_instances && bodies.iter().any(is_lent) {
            self.instances = Some(self.new_instances(bodies)?);
        }
        let device = &self.device;
        self.instances.as_mut().map_or(Ok(()), |instances| instances.put(device, bodies))
    }

    /// Returns instances of the bodies. Poses that only the device has are those of its vertices.
    fn new_instances(&self, bodies: &[Body]) -> Result<Instances, Error> {
        let is_there = |body: &Body| {
            body.kind() == BodyKind::Rigid && body.is_device_resident() && body.device_motion().is_none()
        };
        let found = if bodies.iter().any(is_there) {
            let places = self.vertices.whereabouts()?;
            let ends = places.ends.len();
            let both = |own: &[Pose]| [own[0], own[ends - 1]];
            places.poses.chunks_exact(ends).flat_map(both).collect()
        } else {
            Vec::new()
        };
        Instances::new(&self.device, (bodies, self.vertices.starts()), &self.layout, &found)
    }

    /// Readies meshes and poses for a query of instances.
    ///
    /// # Errors
    /// Device errors.
    pub fn ready_instances(
        &mut self,
        bodies: &[Body],
        (layout, kind): (&Layout, QueryKind),
    ) -> Result<(), Error> {
        if self.instances.is_none() {
            self.instances = Some(self.new_instances(bodies)?);
        }
        let has_vertices = kind.is_of_features() || self.mixes(kind);
        let Some(instances) = &mut self.instances else { return Ok(()) };
        // The host may have poses of a download, which no update named.
        if instances.differ(bodies) {
            instances.put(&self.device, bodies)?;
        }
        if has_vertices {
            instances.ready_motion(&self.device, (bodies, layout), kind.is_at_rest())?;
        }
        instances.ready_boxes(&self.device)?;
        let deform = instances.deform();
        // Meshes that deform are refitted to vertices in the scene.
        if deform { self.ready(kind.is_at_rest()) } else { Ok(()) }
    }

    /// Readies positions for a query at one time, or in motion.
    ///
    /// # Errors
    /// Device errors.
    pub fn ready(&mut self, at_rest: bool) -> Result<(), Error> {
        if self.has_vertices && !self.vertices.is_ready(at_rest) {
            let start = self.device.event()?;
            let purpose = if self.places_deforming { purpose::DEFORMING } else { purpose::STARTS };
            self.vertices.ready(&self.device.of(purpose))?;
            self.placing.push([start, self.device.event()?]);
        }
        Ok(())
    }

    /// Returns positions, vertices of rigid bodies without a pose, and faces, as a query's narrow phase
    /// reads them.
    pub fn positions_of(&self, query: &QueryMemory<R>) -> (Positions<R>, Span<Point<R>>, Span<[u32; 3]>) {
        let is_at_rest = query.is_at_rest();
        let own = self.instances.as_ref().filter(|_| query.is_of_instances);
        match own.and_then(|own| own.motion().map(|motion| (own, motion))) {
            Some((own, motion)) => {
                let (frames, rest) = R::of_f64(motion.vertices(is_at_rest), own.tables().vertices);
                (frames, rest, motion.faces())
            }
            None => (self.vertices.frames(is_at_rest), self.vertices.rest(), self.faces.span()),
        }
    }

    /// Returns whether the last frame placed nothing, or only from device memory, so that a submission
    /// can place it again.
    pub fn is_repeatable(&self) -> bool {
        !self.has_vertices || self.vertices.is_repeatable()
    }

    /// Places the bodies of the last frame again, from the same addresses.
    ///
    /// # Errors
    /// Device errors.
    pub fn again(&mut self) -> Result<(), Error> {
        if self.has_vertices {
            self.vertices.again(&self.device)?;
        }
        self.instances.as_mut().map_or(Ok(()), |instances| instances.again(&self.device))
    }

    /// Calls a function with the broad phase of a query and its context.
    pub fn broadly<T>(
        &mut self,
        query: &QueryMemory<R>,
        what: impl FnOnce(&mut dyn CandidateSearch<R>, &BroadContext<R>, &Layout) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let given = BroadContext {
            device: &self.device,
            frames: self.vertices.frames(query.is_at_rest()),
            faces: self.faces.span(),
            records: query.records(),
            filters: FilterArgs { left_out: self.left_out.span(), ..query.filters() },
            is_submitted: self.is_submitting,
            instances: self.instances.as_ref(),
        };
        what(&mut *self.broads[query.broad].phase, &given, &query.layout)
    }
}

/// Returns the bodies' records for the kernels; empty if there is only one body.
pub fn records(layout: &Layout) -> &[BodyRecord] {
    if layout.has_filters() { &layout.records } else { &[] }
}
