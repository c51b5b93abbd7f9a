//! Detectors on several devices of one host, which divide the work of each query.

use crate::detector::NearmissDetector;
use crate::device::NearmissDevice;
use crate::error::{NearmissCode, NearmissError, given, make, refused};
use crate::query::NearmissQuery;
use crate::rows::items;
use crate::scene::NearmissScene;
use nearmiss::contacts::{DeviceAnswer, DeviceExtras, First, GroupBy, Grouped, Located, Note, RowList};
use nearmiss::scene::{BodyId, DeviceMotion, Exclusions, Motion, Scene, Thickness};
use nearmiss::words::counted;
use nearmiss::{Answer, Body, Contact, Contacts, Detector, Error, Interrupt, MultiDetector, Query};
use std::mem::MaybeUninit;
use std::sync::atomic::Ordering;

/// A scene on one device, or divided among several.
pub(crate) enum Machines {
    One(Box<Detector>),
    Several(MultiDetector),
}

/// Calls a method that both have.
macro_rules! both {
    ($machines:expr, $own:ident => $call:expr) => {
        match $machines {
            Machines::One($own) => $call,
            Machines::Several($own) => $call,
        }
    };
}

impl Machines {
    /// The detector on one device; an error that names what several do not do.
    pub(crate) fn one(&mut self, what: &str) -> Result<&mut Detector, Error> {
        match self {
            Machines::One(detector) => Ok(detector),
            Machines::Several(_) => Err(refused(
                format!("{what} by a detector on several devices"),
                "make a detector on one device by nearmiss_detector_create",
            )),
        }
    }

    pub(crate) fn scene(&self) -> &Scene {
        both!(self, own => own.scene())
    }

    pub(crate) fn interrupter(&self) -> Interrupt {
        both!(self, own => own.interrupter())
    }

    pub(crate) fn tolerance(&mut self) -> f64 {
        both!(self, own => own.tolerance())
    }

    pub(crate) fn largest_tolerance(&mut self) -> f64 {
        both!(self, own => own.largest_tolerance())
    }

    pub(crate) fn rebuild(&mut self) -> Result<(), Error> {
        both!(self, own => own.rebuild())
    }

    pub(crate) fn add(&mut self, body: Body) -> Result<BodyId, Error> {
        match self {
            Machines::One(own) => own.add(body),
            Machines::Several(own) => own.add(&body),
        }
    }

    pub(crate) fn replace(&mut self, id: BodyId, body: Body) -> Result<(), Error> {
        match self {
            Machines::One(own) => own.replace(id, body),
            Machines::Several(own) => own.replace(id, &body),
        }
    }

    pub(crate) fn remove(&mut self, id: BodyId) -> Result<Body, Error> {
        both!(self, own => own.remove(id))
    }

    pub(crate) fn set_thickness(&mut self, id: BodyId, thickness: Thickness) -> Result<(), Error> {
        both!(self, own => own.set_thickness(id, thickness))
    }

    pub(crate) fn leave_out(&mut self, pairs: &[[BodyId; 2]]) -> Result<(), Error> {
        both!(self, own => own.leave_out(pairs))
    }

    pub(crate) fn left_out(&self) -> &[[BodyId; 2]] {
        both!(self, own => own.left_out())
    }

    pub(crate) fn exclude(&mut self, id: BodyId, exclusions: Exclusions) -> Result<(), Error> {
        match self {
            Machines::One(own) => own.exclude(id, exclusions),
            Machines::Several(own) => own.exclude(id, &exclusions),
        }
    }

    pub(crate) fn exclude_pairs(&mut self, bodies: [BodyId; 2], pairs: &[[u32; 2]]) -> Result<(), Error> {
        both!(self, own => own.exclude_pairs(bodies, pairs))
    }

    pub(crate) fn update(&mut self, motions: &[(BodyId, Motion)]) -> Result<(), Error> {
        both!(self, own => own.update(motions))
    }

    pub(crate) fn query(&mut self, query: &Query) -> Result<Contacts, Error> {
        both!(self, own => own.query(query))
    }

    pub(crate) fn step(&mut self, motions: &[(BodyId, Motion)], query: &Query) -> Result<Contacts, Error> {
        both!(self, own => own.step(motions, query))
    }

    pub(crate) fn first_contacts<T: First>(
        &mut self,
        first: &Answer<T>,
    ) -> Result<Answer<RowList<Contact>>, Error> {
        both!(self, own => own.first_contacts(first))
    }

    pub(crate) fn geometry<T: Located>(&mut self, found: &Answer<T>) -> Result<T::Geometry, Error> {
        both!(self, own => own.geometry(found))
    }

    pub(crate) fn grouped(&mut self, found: &Contacts, body: BodyId, by: GroupBy) -> Result<Grouped, Error> {
        both!(self, own => own.grouped(found, body, by))
    }

    pub(crate) fn least_by_vertex(&mut self, found: &Contacts, body: BodyId) -> Result<Vec<f64>, Error> {
        both!(self, own => own.least_by_vertex(found, body))
    }

    pub(crate) fn notes(&self, found: &Contacts) -> Vec<Note> {
        both!(self, own => own.notes(found))
    }

    pub(crate) fn is_prepared(&self) -> bool {
        both!(self, own => own.is_prepared())
    }

    pub(crate) fn prepare(
        &mut self,
        motions: &[(BodyId, DeviceMotion)],
        queries: &[Query],
        extras: &DeviceExtras,
    ) -> Result<(), Error> {
        both!(self, own => own.prepare_with(motions, queries, extras))
    }

    /// The answer on each device.
    pub(crate) fn on_device(&self, query: &Query) -> Option<Vec<DeviceAnswer>> {
        match self {
            Machines::One(own) => own.on_device(query).map(|answer| vec![answer]),
            Machines::Several(own) => own.on_device(query),
        }
    }

    pub(crate) fn submit(&mut self) -> Result<(), Error> {
        both!(self, own => own.submit())
    }

    pub(crate) fn collect(&mut self, query: &Query) -> Result<Contacts, Error> {
        both!(self, own => own.collect(query))
    }

    pub(crate) fn download_positions(&mut self) -> Result<(), Error> {
        both!(self, own => own.download_positions())
    }
}

impl NearmissDetector {
    /// Checks that there is room for one item a device.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] with the plural of the items.
    pub(crate) fn one_a_device(&self, count: usize, items: &str, is_null: bool) -> Result<(), Error> {
        let devices = self.devices.len();
        if count != devices {
            let devices = counted(devices as u64, "device", "devices");
            let what = format!("detector has {devices}, got room for {count} {items}");
            return Err(refused(what, "give room for one a device"));
        }
        given((!is_null).then_some(()), items).map(drop)
    }
}

/// A device's share of a query's last frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissShare {
    /// Its part of the tiles, 0 to 1.
    pub tiles: f64,
    /// Milliseconds of the frame, by the device's own clock.
    pub ms: f64,
}

/// Copies a scene to several devices of one host, which divide the work of each query. Each has all
/// positions and finds the pairs of its share; answers and hashes are those of one device. `devices`
/// points to `device_count` handles, at least one. See `nearmiss_detector_create`.
///
/// The detector takes the calls of any other, except `nearmiss_detector_on_device`, `_plan` and
/// `_update_poses`; distances, pairs of bodies and trees are not divided. These fail with
/// `NEARMISS_INVALID_ARGUMENT`, and so do motions in memory of a GPU if a device is a CPU. Motions
/// may be in memory of any of the GPUs, behind the work of its stream. All devices have read them
/// when `nearmiss_detector_update` returns, and before what follows a submission on that stream. No
/// CUDA graph can capture a submission.
///
/// # Safety
/// So many handles are there. One thread at a time uses each device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_create_on_several(
    devices: *const Option<&NearmissDevice>,
    device_count: usize,
    scene: Option<&NearmissScene>,
    detector: Option<&mut MaybeUninit<*mut NearmissDetector>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(detector, "detector", error, || {
        // SAFETY: the caller's promise.
        let devices = unsafe { items(devices, device_count, "devices") }?;
        let device = |(at, device): (usize, &Option<&NearmissDevice>)| {
            Ok(given(*device, &format!("devices[{at}]"))?.device.clone())
        };
        let devices = devices.iter().enumerate().map(device).collect::<Result<Vec<_>, Error>>()?;
        let NearmissScene { scene, is_copied } = given(scene, "scene")?;
        let detector = MultiDetector::new(devices.clone(), scene.clone())?;
        is_copied.store(true, Ordering::Relaxed);
        Ok(NearmissDetector::new(Machines::Several(detector), devices))
    })
}

/// Writes each device's share of the last frame of a query: as many as the detector has devices.
/// Shares are 0 before the first frame.
///
/// Fails with `NEARMISS_INVALID_ARGUMENT` for another number of shares, and for a detector that
/// `nearmiss_detector_create` made.
///
/// # Safety
/// There is room for so many shares. The names of the query are texts or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_shares(
    detector: Option<&mut NearmissDetector>,
    query: Option<&NearmissQuery>,
    shares: *mut NearmissShare,
    share_count: usize,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        // SAFETY: the caller's promise.
        let query = unsafe { given(query, "query")?.query() }?;
        own.one_a_device(share_count, "shares", shares.is_null())?;
        let Machines::Several(several) = &own.detector else {
            let advice = "make a detector by nearmiss_detector_create_on_several";
            return Err(refused("shares of a detector on one device", advice));
        };
        let found = several.shares(&query);
        for at in 0..share_count {
            let share = found.get(at).map_or((0.0, 0.0), |share| (share.tiles, share.ms));
            // SAFETY: there is room for so many, as the caller promises.
            unsafe { shares.add(at).write(NearmissShare { tiles: share.0, ms: share.1 }) };
        }
        Ok(())
    })
}
