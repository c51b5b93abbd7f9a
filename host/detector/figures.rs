//! Figures of a detector and of its answers.

use super::Detector;
use crate::contacts::{Contacts, Note, Summary};
use crate::error::Error;
use crate::query::{Broad, Query};
use crate::scene::Body;

impl Detector {
    /// Smallest tolerance of a pair of bodies by a certified solver, a length. As named, which is one for all pairs. By default
    /// a pair has the smaller default of its two bodies: [`Certified::TOLERANCE`](crate::query::Certified::TOLERANCE) of the mean
    /// edge of the mesh that a body was made of, rounded down to a power of two. It stays when bodies move.
    pub fn tolerance(&self) -> Option<f64> {
        self.question.tolerances.as_ref().map(|tolerances| tolerances.least)
    }

    /// Largest tolerance of a pair of bodies by a certified solver, a length: that of [`Detector::tolerance`] if all pairs have
    /// the same.
    pub fn largest_tolerance(&self) -> Option<f64> {
        self.question.tolerances.as_ref().map(|tolerances| tolerances.largest)
    }

    /// The figures of an answer and the notes beside it, as the command line prints them. Cost: a hash of the answer, and the notes:
    /// a comparison of both ends of the step if nothing moves, a sort of all vertices if there are [`Note::MANY`](crate::contacts::Note::MANY)
    /// contacts.
    pub fn summary(&self, contacts: &Contacts) -> Summary {
        let (bodies, query) = (self.scene.bodies(), self.question.query);
        let broad = query.broad_on(self.device.is_gpu());
        let by_trees = broad == Broad::Tree;
        Summary {
            triangles: bodies.iter().map(Body::face_count).sum(),
            vertices: bodies.iter().map(Body::vertex_count).sum(),
            frames: if bodies.iter().any(Body::is_moving) { 2 } else { 1 },
            query: query.kind(),
            bv: query.bv().name(),
            broad,
            refit: by_trees.then(|| query.refit_on(self.device.is_gpu())),
            traversal: by_trees.then(|| query.traversal_on(self.device.is_gpu())),
            solver: query.solver(),
            backend: self.device.backend(),
            device: self.device.name(),
            triangle_pairs: contacts.triangle_pairs,
            candidates: contacts.candidates,
            contacts: contacts.len(),
            unresolved: contacts.unresolved,
            degraded: contacts.degraded.clone(),
            tolerance: self.tolerance(),
            largest_tolerance: self
                .largest_tolerance()
                .filter(|_| self.largest_tolerance() != self.tolerance()),
            separation: query.certified().map(|certified| certified.params().separation),
            distance: if let Query::Near(near) = query { Some(near.distance) } else { None },
            nearest: contacts.nearest().copied(),
            earliest_toi: contacts.earliest_toi(),
            starts_crossing: contacts.starts_crossing,
            hash: format!("{:016x}", contacts.hash()),
            reruns: contacts.reruns,
            slices: contacts.slices,
            builds: self.engine.builds,
            queues: contacts.queues,
            front: contacts.front,
            ms: contacts.stages,
            bytes: self.device.bytes().1,
            notes: Note::of(bodies, &query, contacts),
        }
    }

    /// The notes beside an answer, of bodies where they were: those of [`Detector::summary`], at the same cost.
    pub fn notes(&self, contacts: &Contacts) -> Vec<Note> {
        Note::of(self.scene.bodies(), &self.question.query, contacts)
    }

    /// How many levels the tree over what moves has, and that over what is static, where there is one.
    pub fn depths(&self) -> Vec<usize> {
        self.engine.pipeline.as_ref().map_or(Vec::new(), |pipeline| pipeline.depths())
    }

    /// How often a list was too short and a frame was run again within itself, since the bodies were last replaced.
    pub fn reruns(&self) -> u64 {
        self.engine.pipeline.as_ref().map_or(0, |pipeline| pipeline.reruns())
    }

    /// What each stage left in the device's memory after the last [`Detector::detect`], as hashes by stage: trees to
    /// the bit, lists as sets. Two machines that agree on these agree on every kernel. For tests and `selftest`.
    ///
    /// # Errors
    /// Those of the device.
    pub fn fingerprints(&self) -> Result<Vec<(&'static str, u64)>, Error> {
        self.engine.pipeline.as_ref().map_or(Ok(Vec::new()), |pipeline| pipeline.fingerprints())
    }

    /// Checks every tree as it lies on the device; volumes too, which [`Detector::detect`] sets.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; those of the device.
    pub fn check_volumes(&self) -> Result<(), Error> {
        self.engine.pipeline.as_ref().map_or(Ok(()), |pipeline| pipeline.check())
    }
}
