//! One scene on several devices: each has all positions, and finds its share of the tiles.

mod cuts;
mod division;
mod edits;
mod first;
mod grouped;
mod interrupted;
mod left_out;
mod lent;
mod submit;
mod tiles;

use crate::contacts::{Answer, Contacts, Located, Note};
use crate::detector::Detector;
use crate::device::{Device, Interrupt};
use crate::error::Error;
use crate::pipeline::Share;
use crate::query::{BroadPhase, Query, Rebuild, TypedQuery};
use crate::scene::{BodyId, Motion, Scene};
pub use division::DeviceShare;
use division::Division;
use lent::Copies;
use std::time::Instant;

/// One scene on several devices of one host. Each has all positions, finds the pairs of its share
/// of the tiles and tests them as one device does. The answers are merged in canonical order. The
/// answer and its hash are those of a [`Detector`], to the bit, for any division of the work.
///
/// The first frame is divided by the number of tiles. The following are divided by the cost of each
/// tile in the last one, if that was uneven.
///
/// ```
/// use nearmiss::device::{Backend, Device};
/// use nearmiss::{Body, Discrete, Mesh, MultiDetector, mesh::Positions};
///
/// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.2, 0.2, -1.0], [0.3, 0.2, 1.0], [0.2, 0.3, 1.0]];
/// let mesh = Mesh::new("two triangles", Positions::F32(corners), vec![[0, 1, 2], [3, 4, 5]])?;
/// let devices = vec![Device::open(Backend::Cpu, Some(1))?, Device::open(Backend::Cpu, Some(1))?];
/// let mut detector = MultiDetector::new(devices, Body::deformable(mesh))?;
/// assert_eq!(detector.query(&Discrete::default())?[0].triangles, [0, 1]);
/// # Ok::<(), nearmiss::Error>(())
/// ```
pub struct MultiDetector {
    parts: Vec<Detector>,
    divisions: Vec<Division>,
    /// Builds of each device when all had the same tiles.
    agreed: Vec<u64>,
    in_turn: bool,
    copies: Vec<Copies>,
    /// Handle that ends the work of all devices.
    interrupt: Interrupt,
}

impl MultiDetector {
    /// Puts the scene on every device. Several devices find candidates by tiles, for any volume.
    /// Clones of one device are queried [in turn](MultiDetector::in_turn). Cost: on each that of a
    /// [`Detector`]; lists are as long as the shares.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] without devices; those of a [`Detector`].
    pub fn new(devices: Vec<Device>, scene: impl Into<Scene>) -> Result<MultiDetector, Error> {
        let scene = scene.into();
        if devices.is_empty() {
            return Err(refused("a scene on no device", "give at least one device"));
        }
        // One thread at a time uses a machine.
        let in_turn =
            devices.iter().enumerate().any(|(k, one)| devices[..k].iter().any(|other| one.is(other)));
        let interrupt = devices.iter().find_map(Device::interrupt).cloned().unwrap_or_default();
        let part = |device: Device| {
            let device = device.with_interrupt(&interrupt);
            Detector::with_share(device, scene.clone(), Share::WHOLE).map(Detector::of_several)
        };
        let parts = devices.into_iter().map(part).collect::<Result<Vec<_>, _>>()?;
        Ok(MultiDetector {
            agreed: vec![0; parts.len()],
            parts,
            divisions: Vec::new(),
            in_turn,
            copies: Vec::new(),
            interrupt,
        })
    }

    /// Returns the query as each device runs it: by tiles, which are built on all devices together,
    /// or on none.
    fn divisible(&self, query: Query) -> Result<Query, Error> {
        let several = self.parts.len() > 1;
        if query.kind().is_of_bodies() {
            let what = format!("a {} query by a `MultiDetector`", query.kind());
            return Err(refused(&what, "use a `Detector` on one device: its work is not divided"));
        }
        if several && !query.kind().takes_traversals() {
            return Err(refused("a distance on several devices", "use one device: its walk is not divided"));
        }
        let search = query.search();
        let by_tiles = several && search.broad_phase.is_none() && !search.is_of_trees();
        let query = if by_tiles { query.with_broad_phase(BroadPhase::Tiles) } else { query };
        Ok(query.with_rebuild(Rebuild::Manual))
    }

    /// Queries the devices one after another: for devices that are one machine, if each is to be
    /// timed alone.
    pub fn in_turn(self) -> MultiDetector {
        MultiDetector { in_turn: true, ..self }
    }

    /// As [`Detector::update`]. Positions may be in the memory of any of the devices, behind the work
    /// of its stream; the other devices get copies. Then all have read them when the call returns.
    ///
    /// # Errors
    /// As there; [`Error::InvalidArgument`] for positions in memory of a GPU that is none of these
    /// devices, and if a device is a CPU.
    pub fn update(&mut self, motions: &[(BodyId, Motion)]) -> Result<(), Error> {
        self.updated(motions, None)
    }

    fn updated(&mut self, motions: &[(BodyId, Motion)], query: Option<&Query>) -> Result<(), Error> {
        let is_first = self.parts[0].is_first_of(motions);
        let is_lent = motions.iter().any(|(_, input)| matches!(input, Motion::OnDevice(_)));
        let mut updated = self.lent(motions).and_then(|lent| {
            self.each_numbered(|part, detector| detector.apply(&lent[part], query)).map(drop)
        });
        if is_lent {
            // The caller may write them again.
            updated = updated.and(self.each(|detector| detector.device().wait()).map(drop));
        }
        if is_first && updated.is_ok() {
            // All devices build their tiles after the first update of a body.
            self.divisions.iter_mut().for_each(|division| division.wear.add_new_place());
        }
        self.ended(updated)
    }

    /// As [`Detector::query`].
    ///
    /// # Errors
    /// As there; [`Error::InvalidArgument`] for a distance, for pairs of bodies and for trees, which cannot be
    /// divided.
    pub fn query<Q: TypedQuery>(&mut self, query: &Q) -> Result<Answer<Q::Rows>, Error> {
        let answered = self.answer((*query).into(), Instant::now());
        self.ended(answered).map(Contacts::typed::<Q>)
    }

    /// As [`Detector::step`].
    ///
    /// # Errors
    /// As of [`MultiDetector::update`] and [`MultiDetector::query`].
    pub fn step<Q: TypedQuery>(
        &mut self,
        motions: &[(BodyId, Motion)],
        query: &Q,
    ) -> Result<Answer<Q::Rows>, Error> {
        let (start, whole) = (Instant::now(), (*query).into());
        self.divisible(whole)?.check()?;
        self.updated(motions, Some(&whole))?;
        let answered = self.answer(whole, start);
        self.ended(answered).map(Contacts::typed::<Q>)
    }

    /// As [`Detector::begin`].
    ///
    /// # Errors
    /// As there; [`Error::InvalidArgument`] for a query that cannot be divided.
    pub fn begin(&mut self, query: &Query) -> Result<(), Error> {
        let query = self.divisible(*query)?;
        let at = self.division(&query);
        self.divide(at, &query)?;
        let before = self.builds_now();
        let begun = self.each(|detector| detector.begin(&query)).map(drop);
        if begun.is_ok() {
            self.agree(&before);
        }
        self.ended(begun)
    }

    /// As [`Detector::geometry`].
    ///
    /// # Errors
    /// As there.
    pub fn geometry<T: Located>(&mut self, found: &Answer<T>) -> Result<T::Geometry, Error> {
        let query = self.divisible(found.query)?;
        let geometry = self.parts[0].geometry_by(found, &query);
        self.ended(geometry)
    }

    /// As [`Detector::download_positions`].
    ///
    /// # Errors
    /// As there.
    pub fn download_positions(&mut self) -> Result<(), Error> {
        self.parts[0].download_positions()
    }

    /// As [`Detector::notes`].
    pub fn notes(&self, contacts: &Contacts) -> Vec<Note> {
        self.parts[0].notes(contacts)
    }

    /// As [`Detector::scene`].
    pub fn scene(&self) -> &Scene {
        self.parts[0].scene()
    }

    /// As [`Detector::tolerance`].
    pub fn tolerance(&mut self) -> f64 {
        self.parts[0].tolerance()
    }

    /// As [`Detector::largest_tolerance`].
    pub fn largest_tolerance(&mut self) -> f64 {
        self.parts[0].largest_tolerance()
    }

    /// Returns for each share the number of tiles beyond its own that it met in a query's last
    /// frame. A tile has 32 triangles. A device without all positions would need them sent. Reads
    /// all pairs of tiles back, for measurements. Only the last slice of a share is counted.
    ///
    /// # Errors
    /// Those of the device.
    pub fn met_beyond(&mut self, query: &Query) -> Result<Vec<u64>, Error> {
        let query = self.divisible(*query)?;
        self.each(|detector| detector.met_beyond(&query))
    }

    /// Runs one frame, and records the times that divide the next.
    fn answer(&mut self, whole: Query, start: Instant) -> Result<Contacts, Error> {
        let (query, wears) = (self.divisible(whole)?, whole.search().rebuilds());
        let at = self.division(&query);
        if wears && self.divisions[at].wear.is_worn(self.parts[0].moving_triangles()) {
            self.renew()?;
        }
        self.divide(at, &query)?;
        let answers = self.answers(&query)?;
        let division = &mut self.divisions[at];
        division.ms = answers.iter().map(|answer| answer.stats.stages.total).collect();
        let whole = self.whole(answers, whole, start)?;
        self.divisions[at].wear.add(whole.stats.steps);
        Ok(whole)
    }

    /// Calls a function on every device, at the same time unless in turn. All devices run it, even
    /// if one fails.
    fn each<T: Send>(
        &mut self,
        what: impl Fn(&mut Detector) -> Result<T, Error> + Sync,
    ) -> Result<Vec<T>, Error> {
        self.each_numbered(|_, part| what(part))
    }

    /// Calls a function on every device, one after another. All devices run it, even if one fails.
    fn one_by_one<T>(
        &mut self,
        what: impl Fn(usize, &mut Detector) -> Result<T, Error>,
    ) -> Result<Vec<T>, Error> {
        let parts = self.parts.iter_mut().enumerate();
        let done: Vec<_> = parts.map(|(number, part)| what(number, part)).collect();
        done.into_iter().collect()
    }

    /// As [`MultiDetector::each`], with the number of the device.
    fn each_numbered<T: Send>(
        &mut self,
        what: impl Fn(usize, &mut Detector) -> Result<T, Error> + Sync,
    ) -> Result<Vec<T>, Error> {
        if self.in_turn || self.parts.len() == 1 {
            return self.one_by_one(what);
        }
        let parts = self.parts.iter_mut().enumerate();
        let lost = |_| Err(Error::Bug { what: "a device's thread has panicked".into() });
        std::thread::scope(|scope| {
            let what = &what;
            let threads: Vec<_> =
                parts.map(|(number, part)| scope.spawn(move || what(number, part))).collect();
            let done: Vec<_> = threads.into_iter().map(|thread| thread.join().unwrap_or_else(lost)).collect();
            done.into_iter().collect()
        })
    }
}

/// Error for an argument that several devices do not take.
fn refused(what: &str, advice: &str) -> Error {
    Error::InvalidArgument { what: what.into(), advice: advice.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A share that ends too early loses pairs; one that begins too early finds some twice.
    #[test]
    fn a_hole_and_an_overlap_are_noticed() {
        use crate::device::emulator::{Emulator, Mode};
        let device = || Device::emulator(Emulator::new(Mode::Engine, Some(1)).expect("a thread"));
        let body = crate::samples::soup(400, 5, false);
        let found = |shares: Option<[[u64; 2]; 2]>| {
            let devices = vec![device(), device()];
            let mut several = MultiDetector::new(devices, body.clone()).expect("detectors");
            let query = several.divisible(Query::discrete()).expect("tiles");
            let at = several.division(&query);
            for (share, [from, to]) in
                several.divisions[at].shares.iter_mut().zip(shares.into_iter().flatten())
            {
                *share = Share { from, to };
            }
            several.query(&Query::discrete()).expect("an answer").len()
        };
        let (all, half) = (Share::ALL, Share::ALL / 2);
        let whole = found(None);
        assert_eq!(found(Some([[0, half], [half, all]])), whole);
        assert!(found(Some([[0, half / 2], [half, all]])) < whole);
        assert!(found(Some([[0, half], [half / 2, all]])) > whole);
    }
}
