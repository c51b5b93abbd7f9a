//! Device-resident bodies: only the device has their positions.

use super::Detector;
use crate::error::Error;
use crate::mesh::Positions;
use crate::pipeline::{Layout, Seen, Whereabouts};
use crate::scene::{Body, Pose};
use std::sync::Arc;

/// Record of device-resident bodies.
#[derive(Default)]
pub struct Resident {
    /// Largest coordinate in memory of the caller so far.
    pub largest: f64,
    /// Whether the last frame that placed each body was refused: its position is unknown.
    lost: Vec<bool>,
}

impl Resident {
    /// Whether a body was placed in a frame that was refused, and in none since.
    pub fn is_lost(&self, body: usize) -> bool {
        self.lost.get(body).is_some_and(|is_lost| *is_lost)
    }

    /// Records whether a body's position is unknown; a body that is placed again is known.
    pub fn set_lost(&mut self, body: usize, is_lost: bool) {
        if is_lost {
            self.lost.resize(self.lost.len().max(body + 1), false);
        }
        if let Some(was_lost) = self.lost.get_mut(body) {
            *was_lost = is_lost;
        }
    }

    /// Records the largest coordinate of a frame.
    pub fn saw(&mut self, seen: Option<Seen>) {
        self.largest = seen.map_or(self.largest, |seen| seen.largest.max(self.largest));
    }
}

impl Detector {
    /// Downloads the bodies that only the device has ([`Body::is_device_resident`]), so that
    /// [`Detector::scene`] has their positions. Cost: a copy of all vertices, and a wait.
    ///
    /// # Errors
    /// [`Error::Input`] and [`Error::InvalidArgument`] for invalid positions and poses of the
    /// caller; those of the device.
    pub fn download_positions(&mut self) -> Result<(), Error> {
        self.read_again(false);
        if !self.scene.bodies().iter().any(Body::is_device_resident) {
            return Ok(());
        }
        self.all_known()?;
        if let Some(places) = self.places()? {
            if places.all.seen.is_some_and(|seen| seen.invalid) {
                self.check_places(&places)?;
            }
            self.bring(&places);
        }
        Ok(())
    }

    /// Marks bodies that a submission reads as placed: they are where their memory says. The
    /// detector does not know how often a recorded submission was launched. Bodies of a refused
    /// submission are marked only if there is another.
    pub(super) fn read_again(&mut self, is_another: bool) {
        if !self.engine.is_prepared() {
            return;
        }
        for (body, motion) in &self.placed.submitted {
            let body = body.index();
            if is_another || !self.resident.is_lost(body) {
                self.resident.set_lost(body, false);
                self.scene.bodies_mut()[body].placed_again(motion.is_moving());
            }
        }
    }

    /// Returns the positions of all bodies on the device; `None` without a pipeline, which has the
    /// memory in which bodies are placed.
    fn places(&mut self) -> Result<Option<Places>, Error> {
        if self.engine.pipeline.is_none() {
            return Ok(None);
        }
        // By this layout the memory is divided among the bodies.
        let layout = self.any_layout()?;
        let Some(pipeline) = &self.engine.pipeline else { return Ok(None) };
        Ok(Some(Places { all: pipeline.whereabouts()?, layout }))
    }

    /// Copies these positions to the bodies.
    fn bring(&mut self, places: &Places) {
        for (i, body) in self.scene.bodies_mut().iter_mut().enumerate() {
            // Bodies in memory of the caller are skipped: they have moved since.
            if body.is_device_resident() && body.device_motion().is_none() {
                let (ends, poses) = places.of(i);
                body.bring(&ends, poses);
                self.resident.set_lost(i, false);
            }
        }
    }

    /// Records that a body's position is unknown.
    fn lose(&mut self, body: usize) {
        self.resident.set_lost(body, true);
        self.scene.bodies_mut()[body].placed_again(false);
    }

    /// Loses the bodies whose arrays a failed frame has not read. No later call reads these arrays:
    /// the caller may have freed them.
    pub(super) fn lose_unread(&mut self) {
        for body in 0..self.scene.bodies().len() {
            if self.scene.bodies()[body].device_motion().is_some() {
                self.lose(body);
            }
        }
    }

    /// Downloads every body before the device's memory is freed. If positions of the last frame are
    /// invalid, its bodies are lost: they must be named again.
    pub(super) fn bring_all(&mut self) {
        let lost: Vec<bool> =
            (0..self.scene.bodies().len()).map(|body| self.resident.is_lost(body)).collect();
        let places = self.places().ok().flatten();
        let is_valid = places.as_ref().is_some_and(|places| {
            let mut residents =
                self.scene.bodies().iter().enumerate().filter(|(_, body)| body.is_device_resident());
            residents.all(|(i, body)| {
                let (ends, poses) = places.of(i);
                body.check_found(&ends, poses).is_ok()
            })
        });
        if let Some(places) = &places {
            self.bring(places);
        }
        for (body, was_lost) in lost.into_iter().enumerate() {
            if was_lost || self.placed.is_named(body) && !is_valid {
                self.lose(body);
            }
        }
    }

    /// Checks that the host or a pipeline has the position of every body.
    pub(super) fn all_known(&self) -> Result<(), Error> {
        self.none_lost()?;
        let gone = |body: &&Body| body.is_device_resident() && body.device_motion().is_none();
        match self.scene.bodies().iter().find(gone) {
            Some(body) if self.engine.pipeline.is_none() => Err(Error::InvalidArgument {
                what: format!(
                    "the position of {} is unknown: only the device had it, and that memory is gone",
                    body.name()
                ),
                advice: "pass its positions or its pose again".into(),
            }),
            _ => Ok(()),
        }
    }

    /// Checks that no body is lost: placed in a frame that was refused, and in none since.
    pub(super) fn none_lost(&self) -> Result<(), Error> {
        let mut bodies = self.scene.bodies().iter().enumerate();
        match bodies.find(|(body, _)| self.resident.is_lost(*body)) {
            Some((_, body)) => Err(Error::InvalidArgument {
                what: format!(
                    "the position of {} is unknown: the frame that named it last was refused and has overwritten it",
                    body.name()
                ),
                advice: "name it again, and all other bodies of that frame".into(),
            }),
            None => Ok(()),
        }
    }

    /// Returns whether the answer holds, by the placing's checks of positions in memory of the
    /// caller. If these need f64 and the pipeline has f32, the pipeline is dropped. The frame must
    /// run again: false.
    ///
    /// # Errors
    /// [`Error::Input`] and [`Error::InvalidArgument`] for values that no precision can hold. They
    /// name the body and the vertex. Others are those of the device.
    pub(super) fn check_seen(&mut self, seen: Option<Seen>) -> Result<bool, Error> {
        if !seen.is_some_and(|seen| seen.invalid) {
            return Ok(true);
        }
        let Some(places) = self.places()? else { return Ok(true) };
        let are_single = self.check_places(&places)?;
        if self.engine.holds_f64 || are_single {
            // Only vertices that no face uses are invalid.
            return Ok(true);
        }
        self.bring(&places);
        self.engine.drop_pipeline();
        Ok(false)
    }

    /// Returns whether f32 can compute with positions in memory of the caller. If f64 cannot
    /// either, the positions of that frame's bodies are unknown.
    ///
    /// # Errors
    /// [`Error::Input`] and [`Error::InvalidArgument`], naming the body and the vertex.
    fn check_places(&mut self, places: &Places) -> Result<bool, Error> {
        let residents = self.scene.bodies().iter().enumerate().filter(|(_, body)| body.is_device_resident());
        let checked = residents.map(|(i, body)| {
            let (ends, poses) = places.of(i);
            body.check_found(&ends, poses)
        });
        let are_single = checked.reduce(|all, own| Ok(all? & own?)).unwrap_or(Ok(true));
        if are_single.is_err() {
            let named: Vec<usize> =
                (0..self.scene.bodies().len()).filter(|&body| self.placed.is_named(body)).collect();
            named.into_iter().for_each(|body| self.lose(body));
        }
        are_single
    }
}

/// Positions of all bodies, by body.
struct Places {
    all: Whereabouts,
    layout: Arc<Layout>,
}

impl Places {
    /// Returns a body's vertices at both ends or at the only one, and its poses.
    fn of(&self, i: usize) -> (Vec<Positions>, &[Pose]) {
        let range = self.layout.starts[i].vertex as usize..self.layout.starts[i + 1].vertex as usize;
        let part = |positions: &Positions| match positions {
            Positions::F32(points) => Positions::F32(points[range.clone()].to_vec()),
            Positions::F64(points) => Positions::F64(points[range.clone()].to_vec()),
        };
        let ends = self.all.ends.len();
        let poses = self.all.poses.get(i * ends..(i + 1) * ends).unwrap_or_default();
        (self.all.ends.iter().map(part).collect(), poses)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::level;
    use crate::scene::{DeviceMotion, DeviceRows, Motion, Number};
    use crate::{Device, Discrete, device::Backend};

    #[test]
    fn no_call_reads_arrays_of_a_frame_that_failed() {
        let body = |z| Body::deformable(level(z));
        let device = Device::open(Backend::Cpu, Some(1)).expect("a thread");
        let mut detector = Detector::new(device, vec![body(0.0), body(1.0)]).expect("a detector");
        // SAFETY: nothing reads them; that is the claim. There is nothing at this address.
        let gone = unsafe { DeviceRows::new(8, 3, 12, Number::F32) }.expect("rows");
        let gone = Motion::OnDevice(DeviceMotion::Positions(gone));
        detector.scene.bodies_mut()[0].put(&gone);
        detector.lose_unread();
        let refused = detector.query(&Discrete::default()).map(|found| found.len());
        let error = refused.expect_err("a position that is unknown").to_string();
        assert!(error.starts_with("the position of cloth is unknown"), "{error}");
        let id = detector.scene().ids().next().expect("a body");
        detector.update(&[(id, Motion::positions(level(1.0).positions()))]).expect("known again");
        assert_eq!(detector.query(&Discrete::default()).expect("an answer").len(), 1);
    }
}
