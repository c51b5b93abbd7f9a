//! Frames that are submitted and not waited for.

use super::Detector;
use super::frame::Answered;
use crate::contacts::{Contacts, DeviceAnswer};
use crate::device::emulator::start_threads;
use crate::error::Error;
use crate::pipeline::collect::collect;
use crate::scene::{BodyId, DeviceInput, Input};
use std::time::Instant;

impl Detector {
    /// Prepares frames that the host does not wait for: says where bodies will be found, asks for the frame that is there now, loads
    /// every kernel and takes all memory. Then [`Detector::submit`] takes no memory and waits for nothing. Bodies that are not named
    /// rest. Any other call that changes the detector ends it.
    ///
    /// # Errors
    /// As for [`Detector::frame`]; [`Error::Choice`] for a traversal that cannot do without the host.
    pub fn prepare(&mut self, inputs: &[(BodyId, DeviceInput)]) -> Result<Contacts, Error> {
        let prepared = self.prepared(inputs);
        self.ended(prepared)
    }

    fn prepared(&mut self, inputs: &[(BodyId, DeviceInput)]) -> Result<Contacts, Error> {
        let given: Vec<(BodyId, Input)> =
            inputs.iter().map(|&(id, input)| (id, Input::OnDevice(input))).collect();
        self.frame(&given)?;
        if let (true, Some(pipeline)) = (inputs.is_empty(), &mut self.engine.pipeline) {
            pipeline.place(self.scene.bodies(), &[])?;
        }
        // Again, with lists and plans that this frame has settled.
        let contacts = self.detect()?;
        if self.portion.slices > 1 {
            return Err(Error::Choice {
                what: format!("a submission in {} slices", self.portion.slices),
                advice: "the lists of a whole frame have no room: give the device more memory, or ask frame by frame".into(),
            });
        }
        if let Some(pipeline) = &mut self.engine.pipeline {
            pipeline.prepare()?;
        }
        self.placed.submit(inputs);
        Ok(contacts)
    }

    /// Whether [`Detector::submit`] may be called, and what was recorded of it run again: [`Detector::prepare`] was called, and
    /// nothing since then that changes the detector.
    pub fn is_prepared(&self) -> bool {
        let pipeline = self.engine.pipeline.as_ref();
        pipeline.map_or_else(|| !self.may_meet(), |pipeline| pipeline.is_prepared())
    }

    /// Submits a frame to the device's stream, with bodies where their memory says when its turn comes: launches alone. So it may be
    /// called while that stream is captured, and the graph launched as often as wanted, as long as the detector
    /// [is prepared](Detector::is_prepared). [`Detector::on_device`] says where the answer will lie, [`Detector::collect`] waits
    /// for it.
    ///
    /// Times of its stages are not taken. On a CPU it is done when this returns.
    ///
    /// # Errors
    /// [`Error::Choice`] when it is not prepared; those of the device.
    pub fn submit(&mut self) -> Result<(), Error> {
        start_threads()?;
        self.engine.is_answered = false;
        self.read_again(true);
        let submitted = self.engine.pipeline.as_mut().map_or(Ok(()), |pipeline| pipeline.submit());
        self.ended(submitted)
    }

    /// Where the answer of what is submitted lies, for kernels of the caller behind it; `None` where it is not prepared, or nothing can
    /// meet.
    pub fn on_device(&self) -> Option<DeviceAnswer> {
        self.engine.pipeline.as_ref().and_then(|pipeline| pipeline.answer())
    }

    /// Waits for what was submitted last, or recorded and launched again, and brings the answer. Where a list had too little room it
    /// grows and the frame, with bodies where they were placed, is asked again: the answer is whole, and the detector is no longer
    /// [prepared](Detector::is_prepared).
    ///
    /// # Errors
    /// [`Error::Input`] and [`Error::Choice`] for positions and poses of the caller that cannot be computed with; those of the device.
    pub fn collect(&mut self) -> Result<Contacts, Error> {
        let collected = self.collected();
        self.ended(collected)
    }

    fn collected(&mut self) -> Result<Contacts, Error> {
        let start = Instant::now();
        let layout = self.layout()?;
        self.read_again(true);
        let Some(pipeline) = &mut self.engine.pipeline else {
            return Ok(Contacts::none(self.question.query));
        };
        let whole = pipeline.collect()?.map(|(found, stages)| {
            let seen = found.seen;
            collect(found, stages, &layout, &self.device.looks()).map(|contacts| Answered { contacts, seen })
        });
        match whole.transpose()? {
            Some(answered) if self.check_seen(answered.seen)? => self.collect_answer(answered, start),
            _ => self.answer(start),
        }
    }

    fn may_meet(&self) -> bool {
        self.engine.last_layout().is_none_or(|layout| layout.may_meet())
    }
}
