//! Statistics of a detector and of its answers.

use super::Detector;
use crate::contacts::{Contacts, Note, Summary};
use crate::error::Error;
use crate::pipeline::Tolerances;
use crate::query::{BroadPhase, Query};
use crate::scene::Body;
use std::sync::Arc;

impl Detector {
    /// Smallest default tolerance of a pair of bodies for a query without one, in scene units. A
    /// pair has the smaller default of its two bodies. That is 1e-4 of the mean edge of the body's
    /// original mesh, rounded down to a power of two. It stays when bodies move. Cost: a square
    /// root for each side of a triangle, once a body.
    pub fn tolerance(&mut self) -> f64 {
        self.default_tolerances().least
    }

    /// Largest default tolerance of a pair of bodies for a certified solver, in scene units. It is
    /// [`Detector::tolerance`] if all pairs have the same.
    pub fn largest_tolerance(&mut self) -> f64 {
        self.default_tolerances().largest
    }

    /// Returns the statistics and notes of an answer, as the command line prints them. Cost: a hash
    /// of the answer, and the notes. Notes compare both ends of the step if nothing moves. They
    /// sort all vertices if there are [`Note::MANY`](crate::contacts::Note::MANY) contacts.
    pub(crate) fn summary(&mut self, contacts: &Contacts) -> Summary {
        let query = contacts.query;
        let named = query.certified().map(|certified| certified.tolerance);
        let tolerances = match named {
            Some(None) => Some(self.default_tolerances()),
            Some(Some(tolerance)) => Some(Arc::new(Tolerances::named(tolerance))),
            None => None,
        };
        let bodies = self.scene.bodies();
        let broad = query.broad_phase_on(self.device.is_gpu());
        let by_trees = broad == BroadPhase::Tree;
        Summary {
            triangles: bodies.iter().map(Body::face_count).sum(),
            edges: bodies.iter().map(|body| body.loose_counts()[0]).sum(),
            points: bodies.iter().map(|body| body.loose_counts()[1]).sum(),
            vertices: bodies.iter().map(Body::vertex_count).sum(),
            frames: if bodies.iter().any(Body::is_moving) { 2 } else { 1 },
            query: query.kind(),
            bounding_volume: query.volume().name(),
            broad_phase: broad,
            refit: by_trees.then(|| query.refit_on(self.device.is_gpu())),
            traversal: by_trees.then(|| query.traversal_on(self.device.is_gpu())),
            solver: query.solver(),
            backend: self.device.backend(),
            device: self.device.name(),
            triangle_pairs: contacts.stats.triangle_pairs,
            candidates: contacts.stats.candidates,
            contacts: contacts.len(),
            undecided: contacts.undecided,
            caveats: contacts.caveats.clone(),
            tolerance: tolerances.as_ref().map(|tolerances| tolerances.least),
            largest_tolerance: tolerances
                .filter(|tolerances| tolerances.least < tolerances.largest)
                .map(|tolerances| tolerances.largest),
            min_separation: query.certified().map(|certified| certified.params().min_separation),
            approaching: query.certified().map(|certified| certified.approaching).filter(|is| *is),
            distance: match query {
                Query::Near(near) => Some(near.distance),
                Query::BodyDistances(distances) => Some(distances.within),
                Query::Discrete(_)
                | Query::Continuous(_)
                | Query::Earliest(_)
                | Query::Distance(_)
                | Query::BodyPairs(_) => None,
            },
            nearest: contacts.nearest().copied(),
            earliest_toi: contacts.earliest_toi(),
            starts_crossing: contacts.starts_crossing,
            hash: format!("{:016x}", contacts.hash()),
            reruns: contacts.stats.reruns,
            slices: contacts.stats.slices,
            builds: self.engine.builds,
            queues: contacts.stats.queues,
            front: contacts.stats.front,
            ms: contacts.stats.stages,
            bytes: self.device.bytes().1,
            notes: Note::of(bodies, &query, contacts),
        }
    }

    /// Returns the notes of an answer; bodies are still in the answer's positions. Notes and cost
    /// are those of [`DetectorExt::summary`](crate::research::DetectorExt::summary).
    pub fn notes(&self, contacts: &Contacts) -> Vec<Note> {
        Note::of(self.scene.bodies(), &contacts.query, contacts)
    }

    /// Returns the number of levels of a query's trees: over moving bodies, and over fixed ones if
    /// there are any.
    pub(crate) fn depths(&mut self, query: &Query) -> Vec<usize> {
        self.of_query(query, Vec::new(), |pipeline, at| Ok(pipeline.depths(at))).unwrap_or_default()
    }

    /// Number of frames that were rerun because a list was too short, since the bodies were last
    /// replaced.
    pub fn reruns(&self) -> u64 {
        self.engine.pipeline.as_ref().map_or(0, |pipeline| pipeline.reruns())
    }

    /// Returns hashes of the device's memory by stage, after a last frame of this query. Trees are
    /// compared to the bit, lists as sets. Two machines with equal hashes agree on every kernel.
    /// For tests and `selftest`.
    ///
    /// # Errors
    /// Those of the device.
    pub(crate) fn fingerprints(&mut self, query: &Query) -> Result<Vec<(&'static str, u64)>, Error> {
        self.of_query(query, Vec::new(), |pipeline, at| pipeline.fingerprints(at))
    }

    /// Checks every tree of a query in device memory, with the volumes that a frame sets.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; those of the device.
    pub(crate) fn check_volumes(&mut self, query: &Query) -> Result<(), Error> {
        self.of_query(query, (), |pipeline, at| pipeline.check(at))
    }
}
