//! A detector that goes through a sequence, step by step.

use super::Sequence;
use crate::args::DetectArgs;
use crate::progress::during;
use nearmiss::contacts::Contacts;
use nearmiss::error::Error;
use nearmiss::query::Query;
use nearmiss::scene::Scene;
use nearmiss_lab::OneQuery;

/// A detector, and the sequence that it goes through.
pub struct Walk<'a> {
    pub all: &'a Sequence,
    pub detector: OneQuery,
    at_rest: bool,
    rebuild_every: Option<u32>,
}

impl Walk<'_> {
    /// A detector that begins where the first step does.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new<'a>(
        args: &DetectArgs,
        all: &'a Sequence,
        (scene, query): (Scene, Query),
    ) -> Result<Walk<'a>, Error> {
        let device = args.machine.open()?;
        let at_rest = query.kind().is_at_rest();
        let detector = during("building", || OneQuery::new(device, scene, query))?;
        Ok(Walk { all, detector, at_rest, rebuild_every: args.research.rebuild_every })
    }

    /// The answer at a step.
    ///
    /// # Errors
    /// Those of the device.
    pub fn at(&mut self, step: usize) -> Result<Contacts, Error> {
        during(format!("step {step}"), || self.answer(step))
    }

    fn answer(&mut self, step: usize) -> Result<Contacts, Error> {
        let is_rebuilt = self.rebuild_every.is_some_and(|every| (step as u64).is_multiple_of(every.into()));
        let inputs = self.all.inputs(self.detector.scene(), step, self.at_rest);
        match step {
            0 => self.detector.detect(),
            _ if is_rebuilt => {
                self.detector.update(&inputs)?;
                self.detector.rebuild()?;
                self.detector.detect()
            }
            _ => self.detector.frame(&inputs),
        }
    }
}
