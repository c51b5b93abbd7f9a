//! Tiles of several devices. Shares are parts of one order of tiles, so all devices must have built
//! theirs from the same positions.

use super::MultiDetector;
use crate::Detector;
use crate::contacts::Contacts;
use crate::error::Error;
use crate::pipeline::wear::Wear;
use crate::query::Query;

impl MultiDetector {
    /// As [`Detector::rebuild`].
    ///
    /// # Errors
    /// As there.
    pub fn rebuild(&mut self) -> Result<(), Error> {
        let renewed = self.renew();
        self.ended(renewed)
    }

    /// Builds the tiles of all devices again, from the same positions.
    pub(super) fn renew(&mut self) -> Result<(), Error> {
        self.each(Detector::rebuild)?;
        self.divisions.iter_mut().for_each(|division| division.wear = Wear::default());
        self.agreed = self.builds_now();
        Ok(())
    }

    /// As [`Detector::builds`], for the device with the most builds.
    pub fn builds(&self) -> u64 {
        self.builds_now().into_iter().max().unwrap_or_default()
    }

    pub(super) fn builds_now(&self) -> Vec<u64> {
        self.parts.iter().map(Detector::builds).collect()
    }

    /// Returns each device's answer to its share. A device that lost its memory, by an interrupted
    /// call or because it needs more, builds its tiles again, and from later positions. Then all
    /// build, and the query runs again.
    pub(super) fn answers(&mut self, query: &Query) -> Result<Vec<Contacts>, Error> {
        loop {
            if self.parts.len() > 1 && self.agreed != self.builds_now() {
                // An interrupted call has left some devices with other tiles.
                self.renew()?;
            }
            let before = self.builds_now();
            let answers = self.each(|detector| {
                detector.begin(query)?;
                detector.query(query)
            })?;
            if self.agree(&before) {
                return Ok(answers);
            }
        }
    }

    /// Whether all devices have the same tiles after a call that began with these builds: they had
    /// before, and each has built as often since.
    pub(super) fn agree(&mut self, before: &[u64]) -> bool {
        let after = self.builds_now();
        let is_alike = (1..after.len()).all(|k| after[k] - before[k] == after[0] - before[0]);
        if after.len() == 1 || (is_alike && self.agreed == before) {
            self.agreed = after;
            return true;
        }
        self.agreed.clear();
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::Device;
    use crate::device::emulator::{Emulator, Mode};
    use crate::samples::soup;
    use crate::scene::{Motion, Scene};

    /// One device loses its memory after bodies have moved: it builds other tiles than the rest.
    #[test]
    fn a_device_that_lost_its_memory_has_all_build_again() {
        let device = || Device::emulator(Emulator::new(Mode::Engine, Some(1)).expect("a thread"));
        let query = Query::discrete();
        let (body, moved) = (soup(2_000, 5, false), soup(2_000, 9, false));
        let scene = Scene::from(body);
        let id = scene.ids().next().expect("a body");
        let mut whole = Detector::new(device(), scene.clone()).expect("a detector");
        let frame = [(id, Motion::positions(moved.positions_t0()))];
        let wanted = whole.step(&frame, &query).expect("an answer").rows;
        for lost in 0..2 {
            let devices = vec![device(), device()];
            let mut several = MultiDetector::new(devices, scene.clone()).expect("detectors");
            several.query(&query).expect("an answer");
            several.update(&frame).expect("moved");
            several.interrupt.trigger();
            several.parts[lost].query(&query).expect_err("interrupted");
            several.interrupt.clear();
            assert_eq!(several.query(&query).expect("an answer").rows, wanted, "device {lost}");
            assert_eq!(several.query(&query).expect("an answer").rows, wanted, "again, {lost}");
        }
    }

    #[test]
    fn tiles_are_built_once_and_geometry_is_that_of_one_device() {
        let device = || Device::emulator(Emulator::new(Mode::Engine, Some(1)).expect("a thread"));
        let (query, body) = (Query::near(0.02), soup(300, 5, false));
        let mut one = Detector::new(device(), body.clone()).expect("a detector");
        let found = one.query(&query).expect("an answer");
        let wanted = one.geometry(&found).expect("geometry");
        let mut several = MultiDetector::new(vec![device(), device()], body).expect("detectors");
        several.begin(&query).expect("begun");
        let found = several.query(&query).expect("an answer");
        assert!(wanted.len() > 10 && several.builds() == 1, "{} builds", several.builds());
        assert_eq!(several.geometry(&found).expect("geometry"), wanted);
    }
}
