//! Detectors that answer one query step after step, for tests, figures and tables.

use nearmiss::contacts::DeviceAnswer;
use nearmiss::device::Device;
use nearmiss::research::{DetectorExt, QueryExt};
use nearmiss::scene::BodyId;
use nearmiss::scene::{DeviceMotion, Motion};
use nearmiss::{
    Body, Contacts, Detector, DeviceShare, Error, MultiDetector, Query, Scene, Stage, Stages, plan,
};
use std::ops::{Deref, DerefMut};

/// A detector with its query. Everything else is that of the detector.
pub struct OneQuery {
    detector: Detector,
    query: Query,
}

impl Deref for OneQuery {
    type Target = Detector;

    fn deref(&self) -> &Detector {
        &self.detector
    }
}

impl DerefMut for OneQuery {
    fn deref_mut(&mut self) -> &mut Detector {
        &mut self.detector
    }
}

impl OneQuery {
    /// Makes a detector, allocates the query's memory and builds tiles or trees. Stages are timed.
    ///
    /// # Errors
    /// Errors of the detector, and of the query's numbers.
    pub fn new(device: Device, scene: impl Into<Scene>, query: impl Into<Query>) -> Result<OneQuery, Error> {
        let query = query.into();
        query.check()?;
        let mut detector = Detector::new(device, scene)?;
        detector.begin(&query)?;
        detector.time_stages(true);
        Ok(OneQuery { detector, query })
    }

    /// As [`DetectorExt::time_stages`]; stages are timed at first.
    pub fn time_stages(&mut self, are_timed: bool) {
        self.detector.time_stages(are_timed);
    }

    /// Runs `frame` so often, with stages timed or not, and returns the times of each run. Two runs
    /// before do not count: a GPU launches the first one and records the second one.
    ///
    /// # Errors
    /// Those of `frame`.
    pub fn times(
        &mut self,
        are_timed: bool,
        frames: u32,
        mut frame: impl FnMut(&mut OneQuery) -> Result<Stages, Error>,
    ) -> Result<Vec<Stages>, Error> {
        self.time_stages(are_timed);
        for _ in 0..2 {
            frame(self)?;
        }
        (0..frames).map(|_| frame(self)).collect()
    }

    /// The query.
    pub fn query(&self) -> &Query {
        &self.query
    }

    /// As [`Detector::step`].
    ///
    /// # Errors
    /// As there.
    pub fn frame(&mut self, motions: &[(BodyId, Motion)]) -> Result<Contacts, Error> {
        self.detector.step(motions, &self.query)
    }

    /// As [`Detector::query`].
    ///
    /// # Errors
    /// As there.
    pub fn detect(&mut self) -> Result<Contacts, Error> {
        self.detector.query(&self.query)
    }

    /// Moves a body to the positions of another one with the same mesh; others rest.
    ///
    /// # Errors
    /// As [`Detector::update`].
    pub fn move_to(&mut self, body: usize, frame: Body) -> Result<(), Error> {
        self.move_all([(body, &frame)])
    }

    /// Moves several bodies at once, as [`OneQuery::move_to`].
    ///
    /// # Errors
    /// As [`Detector::update`]; [`Error::Bug`] for a body that does not exist.
    pub fn move_all<'a>(&mut self, frames: impl IntoIterator<Item = (usize, &'a Body)>) -> Result<(), Error> {
        let mut motions = Vec::new();
        for (body, frame) in frames {
            let id = self.detector.scene().id(body);
            let id = id.ok_or_else(|| Error::Bug { what: format!("there is no body {body}") })?;
            let motion = match (frame.kind(), frame.positions_t1()) {
                (nearmiss::scene::BodyKind::Rigid, _) => Motion::PoseStep(frame.pose_step()),
                (_, None) => Motion::positions(frame.positions_t0()),
                (_, Some(end)) => Motion::step(frame.positions_t0(), end),
            };
            motions.push((id, motion));
        }
        self.detector.update(&motions)
    }

    /// As [`Detector::prepare`]; also returns the current answer.
    ///
    /// # Errors
    /// As there.
    pub fn prepare(&mut self, motions: &[(BodyId, DeviceMotion)]) -> Result<Contacts, Error> {
        self.detector.prepare(motions, &[self.query])?;
        self.detector.collect(&self.query)
    }

    /// As [`Detector::collect`].
    ///
    /// # Errors
    /// As there.
    pub fn collect(&mut self) -> Result<Contacts, Error> {
        self.detector.collect(&self.query)
    }

    /// As [`Detector::on_device`].
    pub fn on_device(&self) -> Option<DeviceAnswer> {
        self.detector.on_device(&self.query)
    }

    /// As [`Detector::plan`].
    ///
    /// # Errors
    /// As there.
    pub fn plan(&mut self) -> Result<plan::Plan, Error> {
        self.detector.plan(&self.query)
    }

    /// As [`Detector::repeat_stage`].
    ///
    /// # Errors
    /// As there.
    pub fn repeat_stage(&mut self, stage: Stage, times: u32) -> Result<Vec<f64>, Error> {
        self.detector.repeat_stage(&self.query, stage, times)
    }

    /// As [`Detector::narrow_steps`].
    ///
    /// # Errors
    /// As there.
    pub fn narrow_steps(&mut self) -> Result<Vec<(&'static str, f64)>, Error> {
        self.detector.narrow_steps(&self.query)
    }

    /// As [`Detector::fingerprints`].
    ///
    /// # Errors
    /// As there.
    pub fn fingerprints(&mut self) -> Result<Vec<(&'static str, u64)>, Error> {
        self.detector.fingerprints(&self.query)
    }

    /// As [`Detector::check_volumes`].
    ///
    /// # Errors
    /// As there.
    pub fn check_volumes(&mut self) -> Result<(), Error> {
        self.detector.check_volumes(&self.query)
    }

    /// As [`Detector::depths`].
    pub fn depths(&mut self) -> Vec<usize> {
        self.detector.depths(&self.query)
    }

    /// Returns the smallest tolerance of the query's pairs; `None` without a certified solver.
    pub fn tolerance(&mut self) -> Option<f64> {
        let certified = self.query.certified()?;
        Some(certified.tolerance.unwrap_or_else(|| self.detector.tolerance()))
    }

    /// Returns the largest tolerance of the query's pairs; `None` without a certified solver.
    pub fn largest_tolerance(&mut self) -> Option<f64> {
        let certified = self.query.certified()?;
        Some(certified.tolerance.unwrap_or_else(|| self.detector.largest_tolerance()))
    }
}

/// Several detectors of one scene, with their query. Everything else is that of the detectors.
pub struct OneQueryOnSeveral {
    detector: MultiDetector,
    query: Query,
}

impl Deref for OneQueryOnSeveral {
    type Target = MultiDetector;

    fn deref(&self) -> &MultiDetector {
        &self.detector
    }
}

impl DerefMut for OneQueryOnSeveral {
    fn deref_mut(&mut self) -> &mut MultiDetector {
        &mut self.detector
    }
}

impl OneQueryOnSeveral {
    /// Makes detectors of a scene, one per device.
    ///
    /// # Errors
    /// Errors of the detectors, and of the query's numbers.
    pub fn new(
        devices: Vec<Device>,
        scene: impl Into<Scene>,
        query: impl Into<Query>,
    ) -> Result<OneQueryOnSeveral, Error> {
        let query = query.into();
        query.check()?;
        let mut detector = MultiDetector::new(devices, scene)?;
        detector.begin(&query)?;
        Ok(OneQueryOnSeveral { detector, query })
    }

    /// As [`MultiDetector::in_turn`].
    #[must_use]
    pub fn in_turn(self) -> OneQueryOnSeveral {
        OneQueryOnSeveral { detector: self.detector.in_turn(), ..self }
    }

    /// As [`MultiDetector::step`].
    ///
    /// # Errors
    /// As there.
    pub fn frame(&mut self, motions: &[(BodyId, Motion)]) -> Result<Contacts, Error> {
        self.detector.step(motions, &self.query)
    }

    /// As [`MultiDetector::query`].
    ///
    /// # Errors
    /// As there.
    pub fn detect(&mut self) -> Result<Contacts, Error> {
        self.detector.query(&self.query)
    }

    /// As [`MultiDetector::shares`].
    pub fn shares(&self) -> Vec<DeviceShare> {
        self.detector.shares(&self.query)
    }

    /// As [`MultiDetector::met_beyond`].
    ///
    /// # Errors
    /// As there.
    pub fn met_beyond(&mut self) -> Result<Vec<u64>, Error> {
        self.detector.met_beyond(&self.query)
    }
}
