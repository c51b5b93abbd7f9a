//! Bodies move from frame to frame.

use super::Detector;
use super::edits::nobody;
use crate::contacts::Contacts;
use crate::device::emulator::start_threads;
use crate::error::Error;
use crate::mesh::Body;
use crate::pipeline::Moved;
use crate::scene::{BodyId, Input};
use std::time::Instant;

impl Detector {
    /// Moves bodies to where the inputs say, and answers. A body that is not named rests where it was, or where its step
    /// ended, in every query and wherever its positions came from: the answer depends on where bodies are in this frame alone. One submission: an upload of what is named, one launch that places it, and the stages of a frame.
    ///
    /// # Errors
    /// [`Error::Choice`] for a body that is not in the scene, or named twice, or given what its kind does not take;
    /// [`Error::Input`] for positions that no mesh may have: then nothing has moved. Only what lies in a GPU's memory is seen when it is
    /// read: after a frame that is refused for that, the next must name the same bodies, since where these were is gone. Those of the
    /// device.
    pub fn frame(&mut self, inputs: &[(BodyId, Input)]) -> Result<Contacts, Error> {
        let start = Instant::now();
        self.device.work();
        self.go(inputs)?;
        self.answer(start)
    }

    /// Whether a frame of these places a body for the first time.
    pub(crate) fn is_first_of(&self, inputs: &[(BodyId, Input)]) -> bool {
        inputs.iter().any(|(id, _)| !self.was_placed.get(id.index()).is_some_and(|was| *was))
    }

    /// Moves bodies to where the inputs say; the others rest where they are, or where their step ended.
    pub(crate) fn go(&mut self, inputs: &[(BodyId, Input)]) -> Result<(), Error> {
        let named = self.put(inputs)?;
        let mut moved = Vec::with_capacity(inputs.len());
        for (body, (own, named)) in self.scene.bodies_mut().iter_mut().zip(named).enumerate() {
            if named || own.rest() {
                moved.push(Moved { body, rests: !named });
            }
        }
        self.moved(&moved)
    }

    /// Moves bodies to where the inputs say; others stay as they are, in the step that they are in. The trees are kept and refitted
    /// at the next [`Detector::detect`].
    ///
    /// # Errors
    /// As for [`Detector::frame`].
    pub fn place(&mut self, inputs: &[(BodyId, Input)]) -> Result<(), Error> {
        let named = self.put(inputs)?;
        let moved = named.iter().enumerate().filter(|(_, named)| **named);
        self.moved(&moved.map(|(body, _)| Moved { body, rests: false }).collect::<Vec<_>>())
    }

    /// Moves bodies on the host, all or none; of each body of the scene, whether it was named.
    fn put(&mut self, inputs: &[(BodyId, Input)]) -> Result<Vec<bool>, Error> {
        let mut named = vec![false; self.scene.bodies().len()];
        for (id, input) in inputs {
            let Some(body) = self.scene.get(*id) else { return Err(nobody(*id)) };
            if std::mem::replace(&mut named[id.index()], true) {
                return Err(Error::Choice {
                    what: format!("two inputs for body {id}, {}", body.name()),
                    advice: "give one a frame".into(),
                });
            }
            body.check(input)?;
            if let (false, Input::OnDevice(lent)) = (self.device.is_gpu(), input) {
                // SAFETY: its maker has promised that the detector's device can read it during this call, and that is a CPU.
                let (ends, poses) = unsafe { lent.read() };
                body.check_found(&ends, &poses)?;
            }
        }
        self.named.clone_from(&named);
        for (id, input) in inputs {
            let body = self.scene.get_mut(*id).ok_or_else(|| nobody(*id))?;
            body.put(input);
        }
        Ok(named)
    }

    /// Moves bodies on the device. At the first frame in double precision a pipeline in single precision goes over to it, with
    /// trees built anew; it does not go back.
    fn moved(&mut self, moved: &[Moved]) -> Result<(), Error> {
        if moved.is_empty() {
            return Ok(());
        }
        start_threads()?;
        self.answered = false;
        self.was_placed.resize(self.scene.bodies().len(), false);
        for moved in moved.iter().filter(|moved| !moved.rests) {
            self.is_new_place |= !std::mem::replace(&mut self.was_placed[moved.body], true);
        }
        let widens = !self.f64s && moved.iter().any(|moved| self.scene.bodies()[moved.body].needs_f64());
        if widens {
            self.fetch()?;
        }
        // What was held makes room first. Where placing fails there is nothing left to ask of the old positions.
        let placed = match self.pipeline.take().filter(|_| !widens) {
            Some(mut pipeline) => {
                pipeline.place(self.scene.bodies(), moved).map(|()| self.pipeline = Some(pipeline))
            }
            None => self.begun().map(drop),
        };
        let is_held = self.pipeline.is_some() || self.device.is_gpu();
        for body in self.scene.bodies_mut() {
            let lent = body.lent().copied();
            body.placed();
            // Where nothing can meet nothing holds it.
            if let (false, Some(lent)) = (is_held, lent) {
                // SAFETY: its maker has promised that the detector's device can read it during this call, and that is a CPU.
                let (ends, poses) = unsafe { lent.read() };
                body.bring(&ends, &poses);
            }
        }
        placed
    }

    /// Moves a body to where another of the same mesh is: as [`Detector::place`], but from a body, which is kept.
    ///
    /// # Errors
    /// [`Error::Choice`] when the body has other faces than the one it replaces; those of the device.
    pub fn move_to(&mut self, body: usize, frame: Body) -> Result<(), Error> {
        let old = self.scene.bodies().get(body);
        let same = |old: &Body| old.faces() == frame.faces() && old.vertex_count() == frame.vertex_count();
        let Some(meets) = old.filter(|old| same(old) && old.kind() == frame.kind()).map(|old| *old.meets())
        else {
            return Err(Error::Choice {
                what: format!("{} does not replace body {body} of this scene", frame.name()),
                advice: "give frames of the same mesh, or replace the body".into(),
            });
        };
        self.scene.bodies_mut()[body] = frame.with(meets);
        self.moved(&[Moved { body, rests: false }])
    }
}
