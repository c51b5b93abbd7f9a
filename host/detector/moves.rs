//! Bodies move from frame to frame.

use super::Detector;
use super::edits::empty;
use super::frame::without_ends;
use crate::device::emulator::start_threads;
use crate::error::Error;
use crate::pipeline::Moved;
use crate::query::Query;
use crate::scene::{BodyId, Motion};

impl Detector {
    /// Moves bodies to their inputs; the others rest where they are, or where their step ended.
    ///
    /// # Errors
    /// As of [`Detector::update`], and of a query that will read them. On an error nothing has
    /// moved.
    pub(crate) fn apply(&mut self, inputs: &[(BodyId, Motion)], query: Option<&Query>) -> Result<(), Error> {
        self.read_again(false);
        self.engine.submits_alone = false;
        let named = self.put(inputs, query)?;
        let mut moved = Vec::with_capacity(inputs.len());
        for (body, (own, named)) in self.scene.bodies_mut().iter_mut().zip(named).enumerate() {
            if named || !self.resident.is_lost(body) && own.rest() {
                moved.push(Moved { body, rests: !named });
            }
        }
        let moved = self.moved(&moved);
        if moved.is_err() {
            self.lose_unread();
        }
        moved
    }

    /// Moves bodies on the host, all or none. Returns for each body of the scene if it was named.
    fn put(&mut self, inputs: &[(BodyId, Motion)], query: Option<&Query>) -> Result<Vec<bool>, Error> {
        let mut named = vec![false; self.scene.bodies().len()];
        for (id, input) in inputs {
            let Some(body) = self.scene.get(*id) else { return Err(empty(*id)) };
            if std::mem::replace(&mut named[id.index()], true) {
                return Err(Error::InvalidArgument {
                    what: format!("two inputs for body {id}, {}", body.name()),
                    advice: "give one input for each body".into(),
                });
            }
            body.check(input)?;
            if let (false, Motion::OnDevice(motion)) = (self.device.is_gpu(), input) {
                // SAFETY: the maker of the rows promised that the detector's device can read them
                // during this call. That device is a CPU.
                let (ends, poses) = unsafe { motion.read() };
                body.check_found(&ends, &poses)?;
            }
        }
        let has_ends = inputs.is_empty() || inputs.iter().any(|(_, input)| input.is_moving());
        if let Some(query) = query.filter(|query| !query.kind().is_at_rest() && !has_ends) {
            return Err(without_ends(query));
        }
        self.placed.name(&named, has_ends);
        for (id, input) in inputs {
            let body = self.scene.get_mut(*id).ok_or_else(|| empty(*id))?;
            body.put(input);
            self.resident.set_lost(id.index(), false);
        }
        Ok(named)
    }

    /// Moves bodies on the device. At the first frame in f64 a pipeline in f32 changes to f64, with
    /// trees built again. It does not change back.
    fn moved(&mut self, moved: &[Moved]) -> Result<(), Error> {
        if moved.is_empty() {
            return Ok(());
        }
        start_threads()?;
        self.engine.answered = None;
        if self.placed.mark(self.scene.bodies().len(), moved) {
            self.engine.pipeline.iter_mut().for_each(|pipeline| pipeline.add_new_place());
        }
        let widens =
            !self.engine.holds_f64 && moved.iter().any(|moved| self.scene.bodies()[moved.body].needs_f64());
        if widens && self.engine.pipeline.is_some() {
            self.download_positions()?;
        }
        // A pipeline that widens frees its memory first. If placing fails, the old positions are of
        // no use.
        let placed = match self.engine.pipeline.take().filter(|_| !widens) {
            Some(mut pipeline) => {
                pipeline.place(self.scene.bodies(), moved).map(|()| self.engine.pipeline = Some(pipeline))
            }
            // Memory of the caller is read now.
            None if self.scene.bodies().iter().any(|body| body.device_motion().is_some()) => {
                self.begin_scene()
            }
            None => Ok(()),
        };
        let is_held = self.engine.pipeline.is_some() || self.device.is_gpu();
        for body in self.scene.bodies_mut() {
            let motion = body.device_motion().copied();
            body.placed();
            // If nothing can meet, no pipeline holds the positions: the host reads them.
            if let (false, Some(motion)) = (is_held, motion) {
                // SAFETY: the maker of the rows promised that the detector's device can read them
                // during this call. That device is a CPU.
                let (ends, poses) = unsafe { motion.read() };
                body.bring(&ends, &poses);
            }
        }
        placed
    }
}
