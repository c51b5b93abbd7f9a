//! The engine of a detector: the pipeline with its memory, and what building and frames have cost so far.

use super::Wear;
use super::question::Question;
use crate::device::emulator::start_threads;
use crate::device::{Device, Work};
use crate::error::Error;
use crate::memory;
use crate::mesh::{MAX_FACES, MAX_VERTICES, Problem};
use crate::pipeline::{self, Layout, Pieces, Pipeline};
use crate::scene::{Body, Scene};
use std::sync::Arc;

/// Fewest bytes of the host's memory that a triangle takes in a detector: its topology, and on a CPU its tree and first lists.
const OF_A_TRIANGLE: u64 = 300;

/// A pipeline, and its account.
#[derive(Default)]
pub struct Engine {
    /// `None` where bodies came, went or changed since the last frame.
    layout: Option<Arc<Layout>>,
    /// `None` where nothing can meet, or where memory ended: then the next frame asks for it again.
    pub pipeline: Option<Box<dyn Pipeline>>,
    /// Whether the pipeline holds positions in f64: where any body has them so, so that nothing is rounded.
    pub holds_f64: bool,
    /// Whether the device holds the answer for where the bodies are now.
    pub is_answered: bool,
    /// Milliseconds of the last building of tiles or trees.
    pub construct_ms: f64,
    /// The cost of frames since tiles or trees were made.
    pub wear: Wear,
    /// How often tiles or trees were made.
    pub builds: u64,
    /// Frames answered since the pipeline began.
    pub frames: u64,
    /// The device's work in the last building of the trees, and in the last frame.
    pub build_work: Work,
    pub frame_work: Work,
}

impl Engine {
    /// Where every body lies in the memory that all share. All that is asked begins here, so a process that was forked is told here
    /// that it cannot ask.
    pub fn layout(
        &mut self,
        device: &Device,
        scene: &Scene,
        question: &Question,
    ) -> Result<Arc<Layout>, Error> {
        start_threads()?;
        if let Some(layout) = &self.layout {
            return Ok(layout.clone());
        }
        let bodies = scene.bodies();
        let triangles: usize = bodies.iter().map(Body::face_count).sum();
        fits(triangles, bodies.iter().map(Body::vertex_count).sum())?;
        memory::require("trees and lists", triangles as u64 * OF_A_TRIANGLE)?;
        let made = Layout::within(bodies, question.query.kind(), &device.looks());
        let mut layout = made.ok_or(Error::Interrupted)?;
        layout.find_hubs(question.query.keeps_adjacent());
        if let Some(tolerances) = &question.tolerances {
            layout.tolerances = tolerances.records(&layout.starts);
        }
        let layout = Arc::new(layout);
        self.layout = Some(layout.clone());
        Ok(layout)
    }

    /// The layout of the last frame, if bodies are those of then.
    pub fn last_layout(&self) -> Option<&Layout> {
        self.layout.as_deref()
    }

    /// Makes the pipeline, with memory for the bodies where they are and trees built.
    ///
    /// # Errors
    /// Those of the device.
    pub fn begin(&mut self, device: &Device, scene: &Scene, pieces: Pieces) -> Result<(), Error> {
        self.holds_f64 = pieces.holds_f64;
        let mut pipeline = pipeline::pipeline(device.clone(), scene.bodies(), pieces)?;
        device.work();
        let constructed = pipeline.construct();
        if matches!(constructed, Ok(_) | Err(Error::Interrupted)) {
            // Also an interrupted one knows where bodies are.
            self.pipeline = Some(pipeline);
        }
        self.construct_ms = constructed?;
        (self.frames, self.build_work) = (0, device.work());
        self.count_build();
        Ok(())
    }

    /// Tiles or trees are new.
    pub fn count_build(&mut self) {
        (self.wear, self.builds) = (Wear::default(), self.builds + 1);
    }

    /// Whether a submission may be launched again.
    pub fn is_prepared(&self) -> bool {
        self.pipeline.as_ref().is_some_and(|pipeline| pipeline.is_prepared())
    }

    /// Drops the pipeline and the layout: bodies are others.
    pub fn drop_all(&mut self) {
        (self.pipeline, self.layout, self.is_answered) = (None, None, false);
    }
}

/// Whether indices of 32 bits reach all triangles, vertices and edges (at most three a triangle) of all bodies together.
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
