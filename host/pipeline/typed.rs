//! The pipeline: a frame from positions to contacts, in the order of the stages.

mod found;
mod frame;
#[cfg(test)]
mod in_order;
#[cfg(test)]
mod near;
mod query;
mod refuse;
mod repeat;
#[cfg(test)]
mod sampled;
mod scene;
mod second;
mod submit;
#[cfg(test)]
mod submitted;
mod whereabouts;

pub use found::{Found, Hits, Listed};
pub use submit::{Submits, not_prepared};

use super::broad::{CandidateSearch, Checked, Share};
use super::list::named;
use super::placing::{Moved, Whereabouts};
use super::precision::Precision;
use super::wear::Wear;
use super::{QueryParts, SceneParts};
use crate::device::Device;
use crate::error::Error;
use crate::query::Query;
use crate::scene::Body;
use crate::stages::{Stage, Stages};
use nearmiss_kernels::math::Vec3;
use query::QueryMemory;
use scene::{BroadKey, SceneMemory};
#[cfg(test)]
use std::sync::Arc;

/// A step of a frame that fills lists; each reads the lists of the one before.
#[derive(Clone, Copy)]
pub enum Step {
    /// Candidate triangle pairs of a sample.
    Sample,
    /// Candidate triangle pairs.
    Traverse,
    /// A step of the narrow phase, by its index; and whether it reads a sample.
    Narrow(usize, bool),
    /// Contacts in canonical order, if the device orders them.
    Order,
}

/// A broad phase, and the choices that queries must have in common to use it.
pub struct Broad<R: Precision> {
    key: BroadKey,
    phase: Box<dyn CandidateSearch<R>>,
    is_built: bool,
}

/// The memory of a scene, and of each of its queries.
pub struct TypedPipeline<R: Precision> {
    scene: SceneMemory<R>,
    queries: Vec<QueryMemory<R>>,
    /// Queries that are submitted, whose answers stay on the device.
    submission: Option<submit::Submission>,
}

/// A pipeline of any precision and any volume. A query is named by its index.
pub trait Pipeline: repeat::Again + submit::Submits + Send {
    /// Returns the index of a query, and allocates its memory if no query has its shape. Later
    /// frames use the numbers of this query.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if work cannot be divided; device errors.
    fn take_query(&mut self, parts: &QueryParts) -> Result<usize, Error>;
    /// Moves the named bodies, in ascending order, to their new positions.
    ///
    /// # Errors
    /// Device errors.
    fn place(&mut self, bodies: &[Body], moved: &[Moved]) -> Result<(), Error>;
    /// Returns the positions of all bodies, as the device has them.
    ///
    /// # Errors
    /// Device errors.
    fn whereabouts(&self) -> Result<Whereabouts, Error>;
    /// Readies a query for the current positions. Returns whether tiles or trees must be built for
    /// it.
    ///
    /// # Errors
    /// Device errors.
    fn ready(&mut self, query: usize, bodies: &[Body]) -> Result<bool, Error>;
    /// Builds the moving tiles or trees of a query, from the positions at t = 0. Returns the
    /// milliseconds that it took.
    ///
    /// # Errors
    /// Device errors.
    fn construct(&mut self, query: usize) -> Result<f64, Error>;
    /// Builds them for every query that has them. Returns the milliseconds of each.
    ///
    /// # Errors
    /// Device errors.
    fn construct_all(&mut self) -> Result<Vec<f64>, Error>;
    /// Returns the index of a query; `None` before its first frame.
    fn place_of(&self, query: &Query) -> Option<usize>;
    /// Runs one frame: volumes, candidates, contacts. Lists that were too short grow, and the frame
    /// reruns from there.
    ///
    /// # Errors
    /// Device errors.
    fn frame(&mut self, query: usize) -> Result<(Found<'_>, Stages), Error>;
    /// Marks the next frame as a slice after others, which have found so many rows.
    fn after(&mut self, query: usize, rows: u64);
    /// Restricts later frames to a share.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if work cannot be divided; device errors.
    fn take(&mut self, query: usize, share: Share) -> Result<(), Error>;
    /// Returns the cost of each tile of its share in the last frame, of all tiles; empty if there
    /// is one share.
    ///
    /// # Errors
    /// Device errors.
    fn work(&self, query: usize) -> Result<Vec<u64>, Error>;
    /// Returns how many tiles outside its share it met in the last frame, or the device's error.
    fn met_beyond(&self, query: usize) -> Result<u64, Error>;
    /// Returns the number of levels of each tree.
    fn depths(&self, query: usize) -> Vec<usize>;
    /// Returns how often a frame reran because a list was too short, so far.
    fn reruns(&self) -> u64;
    /// Returns the wear of a query's tiles or trees.
    fn wear(&mut self, query: usize) -> &mut Wear;
    /// Notes that a body has its first position.
    fn add_new_place(&mut self);
    /// Returns a hash of each stage's memory after the last frame, which must be this query's.
    /// Lists count as sets: for comparing machines.
    ///
    /// # Errors
    /// Device errors.
    fn fingerprints(&self, query: usize) -> Result<Vec<(&'static str, u64)>, Error>;
    /// Checks every tree and its volumes.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; device errors.
    fn check(&self, query: usize) -> Result<(), Error>;
}

impl<R: Precision> TypedPipeline<R> {
    /// Uploads topology and positions of a scene.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: Device, bodies: &[Body], parts: &SceneParts) -> Result<Self, Error> {
        let scene = SceneMemory::new(device, bodies, parts)?;
        Ok(TypedPipeline { scene, queries: Vec::new(), submission: None })
    }
}

impl<R: Precision> Pipeline for TypedPipeline<R> {
    fn take_query(&mut self, parts: &QueryParts) -> Result<usize, Error> {
        let at = match self.place_of(&parts.query) {
            Some(at) => at,
            None => {
                self.submission = None;
                let query = QueryMemory::new(&mut self.scene, parts)?;
                self.queries.push(query);
                self.queries.len() - 1
            }
        };
        if self.queries[at].query != parts.query {
            // Submissions keep the numbers that they were prepared with.
            self.submission = None;
        }
        self.queries[at].set(&mut self.scene, parts)?;
        if self.queries[at].share != parts.share {
            self.take(at, parts.share)?;
        }
        Ok(at)
    }

    fn place(&mut self, bodies: &[Body], moved: &[Moved]) -> Result<(), Error> {
        self.submission = None;
        let scene = &mut self.scene;
        scene.placings += 1;
        let start = scene.device.event()?;
        scene.place(bodies, moved)?;
        scene.placing = vec![[start, scene.device.event()?]];
        Ok(())
    }

    fn whereabouts(&self) -> Result<Whereabouts, Error> {
        self.scene.whereabouts()
    }

    fn ready(&mut self, query: usize, bodies: &[Body]) -> Result<bool, Error> {
        self.queries[query].ready(&mut self.scene, bodies)
    }

    fn construct(&mut self, query: usize) -> Result<f64, Error> {
        self.submission = None;
        let device = self.scene.device.clone();
        let own = &mut self.queries[query];
        let at = own.broad;
        self.scene.ready(own.is_at_rest())?;
        let start = device.event()?;
        own.run(&mut self.scene, Stage::Construct)?;
        let end = device.event()?;
        self.scene.broads[at].phase.learn()?;
        self.scene.broads[at].is_built = true;
        self.queries
            .iter_mut()
            .filter(|query| query.broad == at)
            .for_each(|query| query.wear = Wear::default());
        start.to(&end)
    }

    fn construct_all(&mut self) -> Result<Vec<f64>, Error> {
        let built = (0..self.scene.broads.len()).filter(|&at| self.scene.broads[at].is_built);
        let queries: Vec<usize> =
            built.filter_map(|at| self.queries.iter().position(|query| query.broad == at)).collect();
        queries.into_iter().map(|query| self.construct(query)).collect()
    }

    fn place_of(&self, query: &Query) -> Option<usize> {
        let shape = query.shape();
        self.queries.iter().position(|query| query.shape == shape)
    }

    fn frame(&mut self, query: usize) -> Result<(Found<'_>, Stages), Error> {
        self.submission = None;
        self.queries[query].frame(&mut self.scene)
    }

    fn after(&mut self, query: usize, rows: u64) {
        self.queries[query].demand.before = rows;
    }

    fn take(&mut self, query: usize, share: Share) -> Result<(), Error> {
        self.submission = None;
        let query = &mut self.queries[query];
        if share != Share::WHOLE {
            self.scene.broads[query.broad].phase.divide(&self.scene.device)?;
        }
        query.share = share;
        Ok(())
    }

    fn work(&self, query: usize) -> Result<Vec<u64>, Error> {
        self.broad(query).work()
    }

    fn met_beyond(&self, query: usize) -> Result<u64, Error> {
        self.broad(query).met_beyond()
    }

    fn depths(&self, query: usize) -> Vec<usize> {
        self.broad(query).depths()
    }

    fn reruns(&self) -> u64 {
        self.queries.iter().map(|query| query.reruns).sum()
    }

    fn wear(&mut self, query: usize) -> &mut Wear {
        &mut self.queries[query].wear
    }

    fn add_new_place(&mut self) {
        self.queries.iter_mut().for_each(|query| query.wear.add_new_place());
    }

    fn fingerprints(&self, query: usize) -> Result<Vec<(&'static str, u64)>, Error> {
        let own = &self.queries[query];
        let mut prints = self.broad(query).fingerprints()?;
        if own.is_of_instances && !own.is_mixed && !own.query.kind().is_of_features() {
            // Candidates name pairs of tiles by their places, which depend on the schedule.
            return Ok(prints);
        }
        let mut lists = vec![named("traverse", self.scene.candidates(own))];
        lists.extend(own.narrow.between(&self.scene.features));
        for (name, list) in lists {
            prints.push((name, list.fingerprint(&own.last)?));
        }
        Ok(prints)
    }

    fn check(&self, query: usize) -> Result<(), Error> {
        let own = &self.queries[query];
        if own.is_of_instances {
            let has_ends = !own.is_at_rest();
            let ends = (0..1 + usize::from(has_ends)).map(|end| self.scene.all_positions(own, end));
            let ends: Vec<Vec<Vec3<R>>> = ends.collect::<Result<_, _>>()?;
            if let Some(instances) = self.scene.instances.as_ref().filter(|_| own.is_mixed) {
                let wide: Vec<_> = ends.iter().map(|end| end.iter().map(|p| p.wide()).collect()).collect();
                instances.check_deforming(&own.layout.faces, &wide)?;
            }
            let positions = Checked::new(ends, Vec::new());
            return self.broad(query).check(&own.layout, &own.layout.faces, &positions);
        }
        let faces = self.scene.faces.read(self.scene.faces.len())?;
        let turns = if own.is_at_rest() { Vec::new() } else { self.scene.vertices.turn_records()? };
        let positions = Checked::new(self.scene.vertices.positions(own.is_at_rest())?, turns)
            .with_radii(self.scene.vertices.radii().to_vec());
        self.broad(query).check(&own.layout, &faces, &positions)
    }
}

impl<R: Precision> TypedPipeline<R> {
    fn broad(&self, query: usize) -> &dyn CandidateSearch<R> {
        &*self.scene.broads[self.queries[query].broad].phase
    }
}

/// Returns a pipeline with one query whose tiles or trees are built, and the query's index.
#[cfg(test)]
fn one(
    device: &Device,
    bodies: &[Body],
    layout: &std::sync::Arc<super::Layout>,
    query: Query,
) -> (TypedPipeline<f32>, usize) {
    let has_ends = !query.kind().is_at_rest();
    let parts = SceneParts {
        layout: layout.clone(),
        holds_f64: false,
        has_ends,
        has_vertices: true,
        has_instances: false,
    };
    let mut pipeline = TypedPipeline::<f32>::new(device.clone(), bodies, &parts).expect("memory");
    let at = pipeline.take_query(&QueryParts::whole(layout.clone(), query)).expect("memory");
    pipeline.ready(at, bodies).expect("ready");
    pipeline.construct(at).expect("trees");
    (pipeline, at)
}
