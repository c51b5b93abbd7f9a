//! The engine of a detector: the pipeline with its memory, and the cost of builds and frames so
//! far.

use super::layouts::Layouts;
use crate::contacts::NearestTriangles;
use crate::device::{Device, Work};
use crate::error::Error;
use crate::mesh::{MAX_FACES, MAX_VERTICES, Problem};
use crate::pipeline::{self, Layout, Pipeline, SceneParts};
use crate::query::Query;
use crate::scene::{Body, Scene};
use std::sync::Arc;

/// A pipeline, and the record of its builds and frames.
#[derive(Default)]
pub struct Engine {
    /// Layouts by query; empty after bodies were added, removed or replaced.
    pub layouts: Layouts,
    /// `None` before the first query, if nothing can meet, and after memory ran out. The next query
    /// makes it again.
    pub pipeline: Option<Box<dyn Pipeline>>,
    /// Whether the pipeline holds positions in f64: if any body does, so that nothing is rounded.
    pub holds_f64: bool,
    /// Whether it holds both ends of the step: from the first query in motion on.
    pub has_ends: bool,
    /// Whether it holds vertices in the scene: from the first query on that reads them.
    pub has_vertices: bool,
    /// Whether queries read bodies as instances if they can, as long as there is this pipeline.
    pub has_instances: bool,
    /// Whether a submission of bodies is prepared of which none may meet, so without a pipeline.
    pub submits_alone: bool,
    /// Query whose answer the device holds, for the current positions.
    pub answered: Option<Query>,
    /// The last triangles of nearest bodies that were found among instances; within, `None` if no two
    /// bodies may meet. The next search begins there; no answer depends on it.
    pub nearest: Option<Option<NearestTriangles>>,
    /// Milliseconds of the last build of tiles or trees.
    pub construct_ms: f64,
    /// Number of builds of tiles or trees.
    pub builds: u64,
    /// Consecutive frames of the last query, since tiles or trees were first built for it.
    pub frames: u64,
    last: Option<Query>,
    /// The device's work in the last build, and in the last frame.
    pub build_work: Work,
    pub frame_work: Work,
}

impl Engine {
    /// Makes the pipeline, with memory for the bodies at their current positions.
    ///
    /// # Errors
    /// Those of the device.
    pub fn begin(&mut self, device: &Device, scene: &Scene, layout: Arc<Layout>) -> Result<(), Error> {
        self.holds_f64 = scene.bodies().iter().any(Body::needs_f64);
        let (has_ends, has_vertices, has_instances) = (self.has_ends, self.has_vertices, self.has_instances);
        let parts = SceneParts { layout, holds_f64: self.holds_f64, has_ends, has_vertices, has_instances };
        self.pipeline = Some(pipeline::pipeline(device.clone(), scene.bodies(), &parts)?);
        (self.frames, self.last) = (0, None);
        Ok(())
    }

    /// Records a build of tiles or trees, and its milliseconds.
    pub fn count_build(&mut self, ms: f64) {
        (self.builds, self.construct_ms, self.answered) = (self.builds + 1, ms, None);
    }

    /// Records a frame of a query, and its work.
    pub fn count_frame(&mut self, query: &Query, work: Work) {
        let is_same = self.last == Some(*query);
        self.frames = if is_same { self.frames + 1 } else { 1 };
        (self.last, self.frame_work) = (Some(*query), work);
    }

    /// Whether the last two frames were of that query.
    pub fn has_run_twice(&self, query: &Query) -> bool {
        self.last == Some(*query) && self.frames >= 2
    }

    /// Whether a submission may be launched again.
    pub fn is_prepared(&self) -> bool {
        self.pipeline.as_ref().is_some_and(|pipeline| pipeline.is_prepared())
    }

    /// Drops the pipeline and the layouts, after the bodies changed.
    pub fn drop_all(&mut self) {
        self.drop_pipeline();
        (self.layouts, self.nearest) = (Layouts::default(), None);
    }

    /// Drops the pipeline with all its memory.
    pub fn drop_pipeline(&mut self) {
        (self.pipeline, self.answered, self.submits_alone) = (None, None, false);
    }
}

/// Checks that 32-bit indices reach all triangles, vertices and edges (at most three a triangle) of
/// all bodies together.
pub fn fits(triangles: usize, vertices: usize) -> Result<(), Error> {
    let all = [("triangles", triangles, MAX_FACES), ("vertices", vertices, MAX_VERTICES)];
    match all.into_iter().find(|(_, count, limit)| count > limit) {
        None => Ok(()),
        Some((what, count, limit)) => {
            let problem = Problem::TooMany { what, count: count as u64, limit: limit as u64 };
            Err(Error::Input { file: "the scene".into(), problem })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_indices_reach_is_refused() {
        assert!(fits(MAX_FACES, MAX_VERTICES).is_ok());
        for (triangles, vertices) in [(MAX_FACES + 1, 3), (1, MAX_VERTICES + 1)] {
            let error = fits(triangles, vertices).expect_err("too many").to_string();
            assert!(
                error.contains(&triangles.max(vertices).to_string()) && error.contains("at most"),
                "{error}"
            );
        }
    }
}
