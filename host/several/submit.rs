//! Submitted frames of several devices, for which the host does not wait.

use super::MultiDetector;
use super::lent::Copies;
use crate::contacts::{Answer, Contacts, DeviceAnswer, DeviceExtras};
use crate::detector::{Detector, check_submission};
use crate::error::Error;
use crate::pipeline::not_prepared;
use crate::query::{Query, TypedQuery};
use crate::scene::{BodyId, DeviceMotion, Motion};
use std::time::Instant;

impl MultiDetector {
    /// As [`Detector::prepare`]. Memory of the motions may be on any of the devices. The work is
    /// divided by what each tile costs now, for all queries together, until the next preparation.
    ///
    /// # Errors
    /// As there, and as of [`MultiDetector::update`] and [`MultiDetector::query`].
    pub fn prepare(&mut self, motions: &[(BodyId, DeviceMotion)], queries: &[Query]) -> Result<(), Error> {
        self.prepare_with(motions, queries, &DeviceExtras::default())
    }

    /// As [`Detector::prepare_with`]: each device makes the parts of its share.
    ///
    /// # Errors
    /// As there, and as of [`MultiDetector::prepare`]. [`Error::InvalidArgument`] for the contacts at the
    /// earliest time: each share has a time of its own.
    pub fn prepare_with(
        &mut self,
        motions: &[(BodyId, DeviceMotion)],
        queries: &[Query],
        extras: &DeviceExtras,
    ) -> Result<(), Error> {
        let prepared = self.prepared(motions, queries, extras);
        self.ended(prepared)
    }

    fn prepared(
        &mut self,
        motions: &[(BodyId, DeviceMotion)],
        queries: &[Query],
        extras: &DeviceExtras,
    ) -> Result<(), Error> {
        check_submission(queries)?;
        if extras.first_contacts {
            return Err(Error::InvalidArgument {
                what: "contacts at the earliest time in memory of several devices: the time of a share is \
                       not the earliest of all"
                    .into(),
                advice: "use one device, or `first_contacts` of the collected answer".into(),
            });
        }
        let queries: Vec<Query> =
            queries.iter().map(|query| self.divisible(*query)).collect::<Result<_, _>>()?;
        // Arrays of an earlier preparation may be gone.
        self.unprepare();
        let given: Vec<(BodyId, Motion)> =
            motions.iter().map(|&(id, motion)| (id, Motion::OnDevice(motion))).collect();
        let in_motion = queries.iter().find(|query| !query.kind().is_at_rest());
        self.updated(&given, in_motion)?;
        let mut asked = Vec::new();
        for query in &queries {
            self.answer(*query, Instant::now())?;
            asked.push((self.division(query), *query));
        }
        let shares = self.cut(&asked)?;
        asked.iter().for_each(|(at, _)| self.divisions[*at].shares.clone_from(&shares));
        self.parts.iter_mut().zip(&shares).for_each(|(part, share)| part.take(*share));
        loop {
            let (before, lent) = (self.builds_now(), self.lent(&given)?);
            self.each_numbered(|part, detector| {
                let own = lent[part].iter().filter_map(|(id, motion)| match motion {
                    Motion::OnDevice(own) => Some((*id, *own)),
                    Motion::Positions(_) | Motion::Step(_) | Motion::Pose(_) | Motion::PoseStep(_) => None,
                });
                detector.prepare_with(&own.collect::<Vec<_>>(), &queries, extras)
            })?;
            if self.agree(&before) {
                return Ok(());
            }
            // Shares are parts of one order of tiles.
            self.renew()?;
        }
    }

    /// As [`Detector::is_prepared`]: whether every device is.
    pub fn is_prepared(&self) -> bool {
        self.parts.iter().all(Detector::is_prepared)
    }

    /// As [`Detector::submit`]. On each GPU the work follows that of the streams whose GPUs have the
    /// memory, and what these streams do next follows the copies. If several devices are one GPU, the
    /// stream is the first one's. No graph can record it.
    ///
    /// # Errors
    /// As there.
    pub fn submit(&mut self) -> Result<(), Error> {
        if !self.is_prepared() {
            return Err(not_prepared());
        }
        let copied = self.copy_again();
        let submitted = copied.and_then(|()| match self.parts.iter().all(|part| part.device().is_gpu()) {
            // A launch takes less time than a thread.
            true => self.one_by_one(|_, detector| detector.submit()).map(drop),
            false => self.each(Detector::submit).map(drop),
        });
        let submitted = submitted.and_then(|()| self.wait_for_readers());
        self.ended(submitted)
    }

    /// As [`Detector::unprepare`].
    pub fn unprepare(&mut self) {
        self.parts.iter_mut().for_each(Detector::unprepare);
        self.copies.iter_mut().for_each(Copies::forget);
    }

    /// As [`Detector::on_device`], for each device in their order: the rows of its share, in its
    /// memory, behind the work of its stream. An earliest query has the first contact of each
    /// share.
    pub fn on_device(&self, query: &Query) -> Option<Vec<DeviceAnswer>> {
        let query = self.divisible(*query).ok()?;
        self.parts.iter().map(|part| part.on_device(&query)).collect()
    }

    /// As [`Detector::collect`], of all devices together.
    ///
    /// # Errors
    /// As there, and as of [`MultiDetector::query`].
    pub fn collect<Q: TypedQuery>(&mut self, query: &Q) -> Result<Answer<Q::Rows>, Error> {
        let collected = self.collected((*query).into());
        self.ended(collected).map(Contacts::typed::<Q>)
    }

    fn collected(&mut self, whole: Query) -> Result<Contacts, Error> {
        let (query, start) = (self.divisible(whole)?, Instant::now());
        let before = self.builds_now();
        let answers = self.each(|detector| detector.collect(&query))?;
        if !self.agree(&before) {
            // A device that needed more memory has built other tiles.
            return self.answer(whole, start);
        }
        self.whole(answers, whole, start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::Device;
    use crate::device::emulator::{Emulator, Mode};
    use crate::samples::soup;
    use crate::scene::{DeviceRows, Number, Scene};
    use std::cell::Cell;

    #[test]
    fn a_device_that_is_passed_over_is_noticed() {
        let device = || Device::emulator(Emulator::new(Mode::Engine, Some(1)).expect("a thread"));
        let (near, scene) = (Query::near(0.02), Scene::from(soup(400, 5, false)));
        let id = scene.ids().next().expect("a body");
        let points = [5, 9].map(|seed| soup(400, seed, false).positions_t0().to_f64());
        let memory: Vec<Cell<[f64; 3]>> = points[0].iter().map(|&point| Cell::new(point)).collect();
        // SAFETY: the points are there as long as the test, which writes them between frames.
        let rows = unsafe { DeviceRows::new(memory.as_ptr() as u64, memory.len(), 24, Number::F64) };
        let input = [(id, DeviceMotion::Positions(rows.expect("rows")))];
        let mut several = MultiDetector::new(vec![device(), device()], scene).expect("detectors");
        several.prepare(&input, &[near]).expect("prepared");
        memory.iter().zip(&points[1]).for_each(|(cell, &point)| cell.set(point));
        several.submit().expect("submitted");
        let wanted = several.collect(&near).expect("an answer").hash();
        for lost in 0..2 {
            memory.iter().zip(&points[0]).for_each(|(cell, &point)| cell.set(point));
            several.prepare(&input, &[near]).expect("prepared");
            memory.iter().zip(&points[1]).for_each(|(cell, &point)| cell.set(point));
            several.parts[1 - lost].submit().expect("submitted");
            assert_ne!(several.collect(&near).expect("an answer").hash(), wanted, "device {lost}");
        }
    }
}
