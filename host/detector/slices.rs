//! Runs a frame: at once, or in slices of the tiles if its lists would exceed the memory.

use super::Detector;
use super::frame::Answered;
use super::question::Question;
use crate::contacts::{Contacts, Keep};
use crate::error::Error;
use crate::pipeline::collect::collect;
use crate::pipeline::{Layout, Share};

/// Reason why slices stopped.
enum Stopped {
    /// An error of the device: finer slices may fit.
    Device(Error),
    /// An error of the host: the answer could not be downloaded.
    Host(Error),
}

impl From<Error> for Stopped {
    fn from(error: Error) -> Stopped {
        Stopped::Device(error)
    }
}

impl Detector {
    /// Runs a frame, slice after slice; `None` if nothing can meet.
    ///
    /// # Errors
    /// As of [`Detector::begun`].
    pub(super) fn run(&mut self, question: &Question, layout: &Layout) -> Result<Option<Answered>, Error> {
        let answered = loop {
            let Some(at) = self.begun(question)? else { return Ok(None) };
            match self.every_slice(at, question, layout) {
                Ok(answered) => break answered,
                Err(Stopped::Host(error)) => return Err(error),
                Err(Stopped::Device(error)) => self.slice_finer(error, &question.query)?,
            }
        };
        if answered.is_some() {
            let work = self.device.work();
            self.engine.count_frame(&question.query, work);
        }
        Ok(answered)
    }

    /// Runs all slices and merges them.
    fn every_slice(
        &mut self,
        at: usize,
        question: &Question,
        layout: &Layout,
    ) -> Result<Option<Answered>, Stopped> {
        let (mut all, mut seen) = (Vec::new(), None);
        let device = self.device.clone();
        let looks = device.looks();
        self.portion.work_of_tiles.clear();
        let query = &question.query;
        let slices = self.portion.slices(query);
        for slice in 0..slices {
            let Some(pipeline) = &mut self.engine.pipeline else { return Ok(None) };
            if slices > 1 {
                pipeline.take(at, self.portion.slice(query, slice))?;
            }
            pipeline.after(at, all.iter().map(|slice: &Contacts| slice.len() as u64).sum());
            let frame = pipeline.frame(at)?;
            seen = frame.0.seen;
            all.push(collect(frame, query, layout, &looks).map_err(Stopped::Host)?);
            if slices > 1 && self.portion.share != Share::WHOLE {
                self.portion.add_work(pipeline.work(at)?);
            }
        }
        let keep: Keep = &|bytes, fill| device.keep_filled(bytes, fill);
        let merged = Contacts::merged(all, |a, b| a + b, keep, &looks);
        let mut contacts = merged.map_err(Stopped::Host)?;
        if looks.ended() {
            return Err(Stopped::Host(Error::Interrupted));
        }
        contacts.stats.slices = slices;
        Ok(Some(Answered { contacts, seen }))
    }
}
