//! One scene on several devices: every one has all positions, and finds what is its share of the tiles.

mod cuts;
mod interrupted;

use crate::contacts::{ContactGeometry, Contacts};
use crate::detector::{Detector, Wear};
use crate::device::{Device, Interrupt};
use crate::error::Error;
use crate::pipeline::Share;
use crate::query::{Broad, Query, Rebuild};
use crate::scene::{Body, BodyId, Input, Scene};
use cuts::cuts;
use std::time::Instant;

/// A frame is uneven where the slowest share takes more than this many times the mean: then the next one is cut anew, by what each tile
/// cost. Above what equal frames differ by, some hundredths.
const UNEVEN: f64 = 1.05;

/// One scene on several devices of one host: each is told all positions, finds the pairs of its share of the tiles and asks them all
/// that one device asks; the answers are put together in canonical order. The answer is that of a [`Detector`], to the bit and with
/// the same hash, however the work is divided.
///
/// The first frame is divided by the number of tiles; the following by what each tile cost in the last one, where that was uneven.
///
/// ```
/// use nearmiss::device::{Backend, Device};
/// use nearmiss::{Body, Mesh, MultiDetector, Query, mesh::Positions};
///
/// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.2, 0.2, -1.0], [0.3, 0.2, 1.0], [0.2, 0.3, 1.0]];
/// let mesh = Mesh::new("two triangles", Positions::F32(corners), vec![[0, 1, 2], [3, 4, 5]])?;
/// let devices = vec![Device::open(Backend::Cpu, Some(1))?, Device::open(Backend::Cpu, Some(1))?];
/// let mut detector = MultiDetector::new(devices, Body::still(mesh), Query::discrete())?;
/// assert_eq!(detector.detect()?.triangles(), [[0, 1]]);
/// # Ok::<(), nearmiss::Error>(())
/// ```
pub struct MultiDetector {
    parts: Vec<Detector>,
    shares: Vec<Share>,
    /// Milliseconds of the last frame, on each device's own clock.
    ms: Vec<f64>,
    in_turn: bool,
    /// What ends the work of all.
    interrupt: Interrupt,
    /// How often each device had made its tiles when last all were made from the same positions: so that tiles are the same.
    builds: Vec<u64>,
    wear: Wear,
    /// Whether all are made anew by themselves.
    wears: bool,
}

/// What a device did of a frame.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DeviceShare {
    /// What the machine calls itself.
    pub device: String,
    /// Its part of the tiles, 0 to 1, in the last frame.
    pub tiles: f64,
    /// Milliseconds of that frame, on its own clock; 0 before there was one.
    pub ms: f64,
}

impl MultiDetector {
    /// Takes the scene to every device; several find candidates by tiles, whatever volume is chosen, and clones of one device are asked
    /// [in turn](MultiDetector::in_turn). Cost: on each that of a [`Detector`]; lists are as long as the shares.
    ///
    /// # Errors
    /// [`Error::Choice`] for no devices, for a distance and for candidates by trees, which cannot be divided; those of a [`Detector`].
    pub fn new(
        devices: Vec<Device>,
        scene: impl Into<Scene>,
        query: impl Into<Query>,
    ) -> Result<MultiDetector, Error> {
        let (scene, query) = (scene.into(), query.into());
        let refused = |what: &str, advice: &str| Error::Choice { what: what.into(), advice: advice.into() };
        let count = devices.len();
        if count == 0 {
            return Err(refused("a scene on no device", "name at least one"));
        }
        if count > 1 && !query.kind().takes_traversals() {
            return Err(refused("a distance on several devices", "ask one device: its walk is not divided"));
        }
        // One thread at a time uses a machine.
        let in_turn =
            devices.iter().enumerate().any(|(k, one)| devices[..k].iter().any(|other| one.is(other)));
        let search = query.search();
        let by_tiles = count > 1 && search.broad.is_none() && !search.is_of_trees();
        let query = if by_tiles { query.with_broad(Broad::Tiles) } else { query };
        // All devices together, or none.
        let wears = query.search().rebuilds();
        let query = query.with_rebuild(Rebuild::Never);
        let part = |k: usize| k as u64 * Share::ALL / count as u64;
        let shares: Vec<Share> = (0..count).map(|k| Share { from: part(k), to: part(k + 1) }).collect();
        let interrupt = devices.iter().find_map(Device::interrupt).cloned().unwrap_or_default();
        let part = |(device, &share): (Device, _)| {
            let device = device.with_interrupt(&interrupt);
            Detector::with_share(device, scene.clone(), query, share).map(Detector::of_several)
        };
        let parts = devices.into_iter().zip(&shares).map(part).collect::<Result<Vec<_>, _>>()?;
        let builds = parts.iter().map(Detector::builds).collect();
        let (ms, wear) = (vec![0.0; count], Wear::default());
        Ok(MultiDetector { parts, shares, ms, in_turn, interrupt, builds, wear, wears })
    }

    /// Asks the devices one after another: where they are one machine in truth, and each is to be timed as if it were alone.
    pub fn in_turn(self) -> MultiDetector {
        MultiDetector { in_turn: true, ..self }
    }

    /// As [`Detector::frame`].
    ///
    /// # Errors
    /// As there; [`Error::Choice`] for positions in the memory of one device.
    pub fn frame(&mut self, inputs: &[(BodyId, Input)]) -> Result<Contacts, Error> {
        if let Some((id, _)) = inputs.iter().find(|(_, input)| matches!(input, Input::OnDevice(_))) {
            return Err(Error::Choice {
                what: format!("positions of body {id} in the memory of one device, for several"),
                advice: "give positions of the host".into(),
            });
        }
        let answered = self.moved(inputs);
        self.ended(answered)
    }

    fn moved(&mut self, inputs: &[(BodyId, Input)]) -> Result<Contacts, Error> {
        if self.wears && self.parts[0].is_first_of(inputs) {
            // All are built where the first frame of a body puts it.
            self.each(|detector| detector.apply(inputs))?;
            self.renew()?;
            return self.ask(Detector::detect);
        }
        self.ask(|detector| detector.frame(inputs))
    }

    /// As [`Detector::detect`].
    ///
    /// # Errors
    /// As there.
    pub fn detect(&mut self) -> Result<Contacts, Error> {
        let answered = self.ask(Detector::detect);
        self.ended(answered)
    }

    /// As [`Detector::rebuild`].
    ///
    /// # Errors
    /// As there.
    pub fn rebuild(&mut self) -> Result<(), Error> {
        let renewed = self.renew();
        self.ended(renewed)
    }

    fn renew(&mut self) -> Result<(), Error> {
        self.each(Detector::rebuild)?;
        self.agree();
        Ok(())
    }

    /// As [`Detector::builds`], of the device that made its tiles most often.
    pub fn builds(&self) -> u64 {
        self.builds_now().into_iter().max().unwrap_or_default()
    }

    /// Tiles were made on all devices from the same positions.
    fn agree(&mut self) {
        (self.builds, self.wear) = (self.builds_now(), Wear::default());
    }

    fn builds_now(&self) -> Vec<u64> {
        self.parts.iter().map(Detector::builds).collect()
    }

    /// As [`Detector::add`].
    ///
    /// # Errors
    /// As there.
    pub fn add(&mut self, body: &Body) -> Result<BodyId, Error> {
        // All scenes number their bodies in the same way.
        let ids = self.each(|detector| detector.add(body.clone()))?;
        self.begin()?;
        Ok(ids[0])
    }

    /// As [`Detector::remove`].
    ///
    /// # Errors
    /// As there.
    pub fn remove(&mut self, id: BodyId) -> Result<Body, Error> {
        let mut bodies = self.each(|detector| detector.remove(id))?;
        self.begin()?;
        Ok(bodies.swap_remove(0))
    }

    /// As [`Detector::replace`].
    ///
    /// # Errors
    /// As there.
    pub fn replace(&mut self, id: BodyId, body: &Body) -> Result<(), Error> {
        self.each(|detector| detector.replace(id, body.clone()))?;
        self.begin()
    }

    /// After a change of bodies: the same tiles on all devices. The change is made: a trigger waits
    /// for the next frame.
    fn begin(&mut self) -> Result<(), Error> {
        match self.each(Detector::begin) {
            Err(Error::Interrupted) => return Ok(()),
            begun => begun?,
        };
        self.agree();
        Ok(())
    }

    /// As [`Detector::geometry`].
    ///
    /// # Errors
    /// As there.
    pub fn geometry(&mut self, found: &Contacts) -> Result<Vec<ContactGeometry>, Error> {
        let geometry = self.parts[0].geometry(found);
        self.ended(geometry)
    }

    /// As [`Detector::scene`].
    pub fn scene(&self) -> &Scene {
        self.parts[0].scene()
    }

    /// As [`Detector::tolerance`].
    pub fn tolerance(&self) -> Option<f64> {
        self.parts[0].tolerance()
    }

    /// As [`Detector::largest_tolerance`].
    pub fn largest_tolerance(&self) -> Option<f64> {
        self.parts[0].largest_tolerance()
    }

    /// What each device did of the last frame.
    pub fn shares(&self) -> Vec<DeviceShare> {
        let one = |((part, share), &ms): ((&Detector, &Share), &f64)| DeviceShare {
            device: part.machine(),
            tiles: (share.to - share.from) as f64 / Share::ALL as f64,
            ms,
        };
        self.parts.iter().zip(&self.shares).zip(&self.ms).map(one).collect()
    }

    /// How many tiles of 32 triangles each share has met in the last frame that are not its: what would have to be sent to it if it did not
    /// have all positions. Reads all pairs of tiles back, for measurements. Of a share in slices the last one alone is counted.
    ///
    /// # Errors
    /// Those of the device.
    pub fn met_beyond(&mut self) -> Result<Vec<u64>, Error> {
        self.each(|detector| detector.met_beyond())
    }

    /// One frame, and how its work is divided next.
    fn ask(
        &mut self,
        question: impl Fn(&mut Detector) -> Result<Contacts, Error> + Sync,
    ) -> Result<Contacts, Error> {
        let start = Instant::now();
        if self.wears && self.wear.is_worn(self.parts[0].moving_triangles()) {
            self.renew()?;
        }
        self.divide()?;
        let mut answers = self.each(question)?;
        // A device that ran out of memory has made its tiles anew, and a share is of the same tiles on all.
        while self.parts.len() > 1 && self.builds_now() != self.builds {
            self.renew()?;
            answers = self.each(Detector::detect)?;
        }
        self.ms = answers.iter().map(|answer| answer.stages.total).collect();
        let mut whole = self.merged(answers)?;
        self.wear.tell(whole.steps);
        whole.stages.wall = start.elapsed().as_secs_f64() * 1e3;
        Ok(whole)
    }

    /// Does the same on every device, at the same time unless in turn. All do it, whatever becomes
    /// of one.
    fn each<T: Send>(
        &mut self,
        what: impl Fn(&mut Detector) -> Result<T, Error> + Sync,
    ) -> Result<Vec<T>, Error> {
        if self.in_turn || self.parts.len() == 1 {
            let done: Vec<_> = self.parts.iter_mut().map(what).collect();
            return done.into_iter().collect();
        }
        let lost = |_| Err(Error::Bug { what: "a device's thread has panicked".into() });
        std::thread::scope(|scope| {
            let what = &what;
            let threads: Vec<_> = self.parts.iter_mut().map(|part| scope.spawn(move || what(part))).collect();
            let done: Vec<_> = threads.into_iter().map(|thread| thread.join().unwrap_or_else(lost)).collect();
            done.into_iter().collect()
        })
    }

    /// Divides the work anew, where the last frame was uneven.
    fn divide(&mut self) -> Result<(), Error> {
        let (sum, most) = (self.ms.iter().sum::<f64>(), self.ms.iter().copied().fold(0.0, f64::max));
        if most * self.ms.len() as f64 <= UNEVEN * sum {
            return Ok(());
        }
        let mut costs: Vec<f64> = Vec::new();
        for (part, ms) in self.parts.iter().zip(&self.ms) {
            let work = part.tile_work()?;
            let all: u64 = work.iter().sum();
            costs.resize(costs.len().max(work.len()), 0.0);
            let a_unit = ms / all.max(1) as f64;
            costs.iter_mut().zip(&work).for_each(|(cost, &work)| *cost += work as f64 * a_unit);
        }
        let cuts = cuts(&costs, self.parts.len());
        for ((part, share), ends) in self.parts.iter_mut().zip(&mut self.shares).zip(cuts.windows(2)) {
            *share = Share { from: ends[0], to: ends[1] };
            part.take(*share)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A share that ends too early loses pairs, one that begins too early finds some twice, and both are noticed.
    #[test]
    fn a_hole_and_an_overlap_are_noticed() {
        use crate::device::emulator::{Emulator, Mode};
        let device = || Device::emulator(Emulator::new(Mode::Engine, Some(1)).expect("a thread"));
        let body = crate::samples::soup(400, 5, false);
        let found = |shares: Option<[[u64; 2]; 2]>| {
            let devices = vec![device(), device()];
            let mut several =
                MultiDetector::new(devices, body.clone(), Query::discrete()).expect("detectors");
            for (part, [from, to]) in several.parts.iter_mut().zip(shares.into_iter().flatten()) {
                part.take(Share { from, to }).expect("a share");
            }
            several.detect().expect("an answer").len()
        };
        let (all, half) = (Share::ALL, Share::ALL / 2);
        let whole = found(None);
        assert_eq!(found(Some([[0, half], [half, all]])), whole);
        assert!(found(Some([[0, half / 2], [half, all]])) < whole);
        assert!(found(Some([[0, half], [half / 2, all]])) > whole);
    }
}
