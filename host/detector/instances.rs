//! Chooses how queries read rigid and fixed bodies: as instances of their meshes, or by
//! vertices in the scene.

use super::Detector;
use crate::error::Error;
use crate::pipeline::Share;
use crate::query::Query;
use crate::scene::{Body, BodyKind};

/// Triangles of rigid bodies for each one of a deformable body, from which on bodies are instances
/// next to deformable ones. A deformable triangle is then fitted twice, as one of a mesh and as one of
/// a tile: some 250 bytes more of traffic a frame, against some 300 that a rigid triangle saves which
/// nothing places and fits. So one rigid triangle for each deformable one breaks even in traffic. The
/// others pay for launches, which are about twice as many. A cost; no answer depends on it.
const MANY_TIMES: usize = 4;

impl Detector {
    /// Whether the scene's bodies can be read as instances. No rigid or fixed body is tested against
    /// itself, and rigid ones have many times the triangles of deformable ones. Shares, slices and
    /// scenes that exclude pairs of features read vertices.
    fn allows_instances(&self) -> bool {
        let solid = || self.scene.bodies().iter().filter(|body| body.element_count() > 0);
        let triangles = |kind: BodyKind| -> usize {
            solid().filter(|body| body.kind() == kind).map(Body::element_count).sum()
        };
        let (rigid, deforming) = (triangles(BodyKind::Rigid), triangles(BodyKind::Deformable));
        self.is_whole()
            && rigid > 0
            && rigid >= MANY_TIMES * deforming
            && solid().all(|body| body.kind() == BodyKind::Deformable || !body.self_collides())
            && self.scene.excluded.is_empty()
    }

    /// Whether a query reads the whole scene, in one slice.
    pub(super) fn is_whole(&self) -> bool {
        self.portion.share == Share::WHOLE && !self.portion.is_part && !self.portion.has_slices()
    }

    /// Chooses for the next pipeline.
    pub(super) fn choose_instances(&mut self) {
        self.engine.has_instances = self.allows_instances();
        self.engine.has_vertices |= !self.engine.has_instances;
    }

    /// Refuses a query of pairs of bodies by shares of several devices.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`].
    pub(super) fn may_pair_bodies(&mut self, query: &Query) -> Result<(), Error> {
        let kind = query.kind();
        if !kind.is_of_bodies() {
            return Ok(());
        }
        self.read_again(false);
        if self.portion.is_part || self.portion.share != Share::WHOLE {
            return Err(Error::InvalidArgument {
                what: format!("a {kind} query cannot be divided among several devices"),
                advice: "use a `Detector` on one device".into(),
            });
        }
        Ok(())
    }

    /// Returns whether a query reads instances. If it reads vertices and the pipeline has none, the
    /// next pipeline will have them.
    ///
    /// # Errors
    /// As of [`Detector::download_positions`].
    pub(super) fn reads_instances(&mut self, query: &Query) -> Result<bool, Error> {
        if self.engine.pipeline.is_none() {
            self.choose_instances();
        }
        let is_of_bodies = query.kind().is_of_bodies();
        // Instances have no thickness.
        let is_thick = query.kind().is_of_features() && self.is_thick();
        let may_read = query.may_read_instances() && !is_thick;
        let reads = is_of_bodies || self.engine.has_instances && may_read;
        if !reads && !self.engine.has_vertices {
            self.leave_pipeline()?;
            self.engine.has_vertices = true;
        }
        Ok(reads)
    }
}
