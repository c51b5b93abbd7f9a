//! Bodies move from frame to frame.

use super::Detector;
use super::edits::nobody;
use crate::device::emulator::start_threads;
use crate::error::Error;
use crate::mesh::Problem;
use crate::pipeline::Moved;
use crate::scene::{Body, BodyId, Input};

impl Detector {
    /// Moves bodies to where the inputs say; the others rest where they are, or where their step ended.
    pub(crate) fn apply(&mut self, inputs: &[(BodyId, Input)]) -> Result<(), Error> {
        let named = self.put(inputs, true)?;
        let mut moved = Vec::with_capacity(inputs.len());
        for (body, (own, named)) in self.scene.bodies_mut().iter_mut().zip(named).enumerate() {
            if named || !self.resident.is_lost(body) && own.rest() {
                moved.push(Moved { body, rests: !named });
            }
        }
        self.moved(&moved)
    }

    /// Moves bodies to where the inputs say; others stay as they are, in the step that they are in. The trees are kept and refitted
    /// at the next [`Detector::detect`].
    ///
    /// # Errors
    /// As for [`Detector::frame`]; bodies may all be put at one end.
    pub fn place(&mut self, inputs: &[(BodyId, Input)]) -> Result<(), Error> {
        let named = self.put(inputs, false)?;
        let moved = named.iter().enumerate().filter(|(_, named)| **named);
        let moved: Vec<_> = moved.map(|(body, _)| Moved { body, rests: false }).collect();
        let placed = self.moved(&moved);
        self.ended(placed)
    }

    /// Moves bodies on the host, all or none; of each body of the scene, whether it was named. In a frame of a query in motion that
    /// names bodies one of them has two ends.
    fn put(&mut self, inputs: &[(BodyId, Input)], is_frame: bool) -> Result<Vec<bool>, Error> {
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
        let in_motion = !self.question.query.kind().is_at_rest();
        if is_frame && in_motion && !inputs.is_empty() && !inputs.iter().any(|(_, input)| input.is_moving()) {
            return Err(Error::Choice {
                what: format!(
                    "no body of the frame has two ends, and the query is {}",
                    self.question.query.kind()
                ),
                advice:
                    "give each body that moves both ends of the step: two arrays of positions, or two poses"
                        .into(),
            });
        }
        self.placed.named.clone_from(&named);
        for (id, input) in inputs {
            let body = self.scene.get_mut(*id).ok_or_else(|| nobody(*id))?;
            body.put(input);
            self.resident.set_lost(id.index(), false);
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
        self.engine.is_answered = false;
        if self.placed.mark(self.scene.bodies().len(), moved) {
            self.engine.wear.tell_new_place();
        }
        let widens =
            !self.engine.holds_f64 && moved.iter().any(|moved| self.scene.bodies()[moved.body].needs_f64());
        if widens {
            self.fetch()?;
        }
        // What was held makes room first. Where placing fails there is nothing left to ask of the old positions.
        let placed = match self.engine.pipeline.take().filter(|_| !widens) {
            Some(mut pipeline) => {
                pipeline.place(self.scene.bodies(), moved).map(|()| self.engine.pipeline = Some(pipeline))
            }
            None => self.begun().map(drop),
        };
        let is_held = self.engine.pipeline.is_some() || self.device.is_gpu();
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
    /// [`Error::Input`] when the body has other faces than the one it replaces, [`Error::Choice`] when it is of another kind or there
    /// is none to replace; those of the device.
    pub fn move_to(&mut self, body: usize, frame: Body) -> Result<(), Error> {
        let same = |old: &&Body| old.kind() == frame.kind();
        let Some(old) = self.scene.bodies().get(body).filter(same) else {
            return Err(Error::Choice {
                what: format!("{} does not replace body {body} of this scene", frame.name()),
                advice: "give a frame of a body of the scene, of its kind, or replace the body".into(),
            });
        };
        if let Some(problem) = other_mesh(old, &frame) {
            return Err(Error::Input { file: frame.name().to_owned(), problem });
        }
        if frame.is_away() {
            return Err(Error::Choice {
                what: format!(
                    "only a device knows where {} is, and its positions here are old",
                    frame.name()
                ),
                advice: "bring it to the host first, with `fetch` of its detector".into(),
            });
        }
        let meets = *old.meets();
        self.resident.set_lost(body, false);
        let old = &mut self.scene.bodies_mut()[body];
        *old = frame.with(meets).with_tolerance_of(old);
        let moved = self.moved(&[Moved { body, rests: false }]);
        self.ended(moved)
    }
}

/// What keeps a body from being a frame of another.
fn other_mesh(old: &Body, new: &Body) -> Option<Problem> {
    let first = || old.name().to_owned();
    let [t0, t1] = [old, new].map(Body::vertex_count);
    if t0 != t1 {
        return Some(Problem::FrameVertices { first: first(), t0, t1 });
    }
    let [t0, t1] = [old, new].map(Body::face_count);
    if t0 != t1 {
        return Some(Problem::FrameFaces { first: first(), t0, t1 });
    }
    let face = old.faces().iter().zip(new.faces()).position(|(a, b)| a != b)?;
    let [t0, t1] = [old, new].map(|body| body.faces()[face].to_vec());
    Some(Problem::FrameFace { first: first(), face, t0, t1 })
}
