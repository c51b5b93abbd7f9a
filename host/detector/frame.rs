//! A frame, from inputs to answer.
//!
//! | step | does | in |
//! | --- | --- | --- |
//! | `apply` | checks the inputs, moves bodies on the host and on the device | `moves.rs` |
//! | `ready` | memory, and tiles or trees that are worth keeping | `ready.rs` |
//! | `run` | the stages, slice by slice where memory is short | `slices.rs` |
//! | `check_seen` | what placing saw in memory of the caller | `resident.rs` |
//! | `collect_answer` | caveats (`caveats.rs`) and times | here |
//! | `ended` | a call that was interrupted leaves no answer | `interrupted.rs` |

use super::Detector;
use crate::contacts::Contacts;
use crate::error::Error;
use crate::pipeline::{Seen, Stages};
use crate::scene::{BodyId, Input};
use std::time::Instant;

/// The answer of a frame, and what placing saw of positions in memory of the caller.
pub struct Answered {
    pub contacts: Contacts,
    pub seen: Option<Seen>,
}

impl Detector {
    /// Moves bodies to where the inputs say, and answers. A body that is not named rests where it was, or where its step
    /// ended, in every query and wherever its positions came from: the answer depends on where bodies are in this frame alone. One submission: an upload of what is named, one launch that places it, and the stages of a frame.
    ///
    /// # Errors
    /// [`Error::Choice`] for a body that is not in the scene, or named twice, or given what its kind does not take, and by a query in
    /// motion for inputs of which none has two ends;
    /// [`Error::Input`] for positions that no mesh may have: then nothing has moved. Only what lies in a GPU's memory is seen when it is
    /// read: after a frame that is refused for that, the next must name the same bodies, since where these were is gone. Those of the
    /// device.
    pub fn frame(&mut self, inputs: &[(BodyId, Input)]) -> Result<Contacts, Error> {
        let start = Instant::now();
        self.device.work();
        let answered = self.apply(inputs).and_then(|()| self.answer(start));
        self.ended(answered)
    }

    /// All contacts with the bodies where they are, in canonical order. Where the lists of a frame outgrow the memory, or an index,
    /// candidates by tiles are found slice by slice, a share of the tiles after the other, and the answer is the same:
    /// [`Contacts::slices`] says how many they were.
    ///
    /// # Errors
    /// Those of the device: [`Error::OutOfMemory`] when memory ends all the same. There is no partial answer.
    pub fn detect(&mut self) -> Result<Contacts, Error> {
        self.device.work();
        let answered = self.answer(Instant::now());
        self.ended(answered)
    }

    /// The answer of a frame that began then, with the bodies where they are. A frame that needs doubles, and had singles, runs again.
    pub(super) fn answer(&mut self, start: Instant) -> Result<Contacts, Error> {
        loop {
            let layout = self.ready()?;
            let Some(answered) = self.run(&layout)? else {
                return Ok(Contacts::none(self.question.query));
            };
            if self.check_seen(answered.seen)? {
                return self.collect_answer(answered, start);
            }
        }
    }

    /// The answer, with its caveats and its times.
    pub(super) fn collect_answer(&mut self, answered: Answered, start: Instant) -> Result<Contacts, Error> {
        let Answered { mut contacts, seen } = answered;
        self.engine.is_answered = true;
        self.engine.wear.tell(contacts.steps);
        self.resident.saw(seen);
        self.tell_below_precision(&mut contacts)?;
        self.tell_turns(&mut contacts)?;
        let wall = start.elapsed().as_secs_f64() * 1e3;
        contacts.stages = Stages { construct: self.engine.construct_ms, wall, ..contacts.stages };
        Ok(contacts)
    }
}
