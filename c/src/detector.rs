//! A scene on a device, ready to be asked; and bodies that come, go and change.

use crate::body::NearmissBody;
use crate::device::NearmissDevice;
use crate::error::{NearmissCode, NearmissError, call, free, given, make};
use crate::input::body;
use crate::query::NearmissQuery;
use crate::scene::NearmissScene;
use nearmiss::scene::BodyId;
use nearmiss::{Detector, Device, Error, Query};
use std::ffi::CString;
use std::mem::MaybeUninit;
use std::sync::atomic::Ordering;

/// A scene on a device, asked frame after frame.
pub struct NearmissDetector {
    pub(crate) detector: Detector,
    pub(crate) query: Query,
    pub(crate) device: Device,
    pub(crate) ids: Vec<BodyId>,
    /// What `nearmiss_detector_on_device` showed last.
    pub(crate) starts: Vec<[u32; 3]>,
    /// What `nearmiss_detector_plan` showed last.
    pub(crate) plan: CString,
    /// Whether a call has begun and not ended.
    broken: bool,
}

impl NearmissDetector {
    /// Works with a detector. What a panic leaves is not worked with again.
    pub(crate) fn work(
        detector: Option<&mut NearmissDetector>,
        error: Option<&mut MaybeUninit<NearmissError>>,
        work: impl FnOnce(&mut NearmissDetector) -> Result<(), Error>,
    ) -> NearmissCode {
        call(error, || {
            let detector = given(detector, "the detector")?;
            if detector.broken {
                return Err(Error::Bug {
                    what: "an earlier call with this detector ended in a fault".into(),
                });
            }
            detector.broken = true;
            let done = work(detector);
            detector.broken = false;
            done
        })
    }
}

/// Takes a copy of a scene, to which nothing can be added from then on, to a device and builds its
/// trees. Cost: linear in triangles; memory grows with what is found.
///
/// A scene without bodies answers nothing. Fails with `NEARMISS_INVALID_ARGUMENT` for choices that do not go
/// together; with `NEARMISS_OUT_OF_MEMORY` and `NEARMISS_DEVICE`.
///
/// # Safety
/// The names of the query are texts or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_new(
    device: Option<&NearmissDevice>,
    scene: Option<&NearmissScene>,
    query: Option<&NearmissQuery>,
    detector: Option<&mut MaybeUninit<*mut NearmissDetector>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(detector, "the detector", error, || {
        let device = given(device, "the device")?.device.clone();
        let NearmissScene { scene, ids, taken } = given(scene, "the scene")?;
        // SAFETY: the caller's promise.
        let query = unsafe { given(query, "the query")?.query() }?;
        let mut detector = Detector::new(device.clone(), scene.clone())?;
        detector.begin(&query)?;
        taken.store(true, Ordering::Relaxed);
        Ok(NearmissDetector {
            detector,
            query,
            device,
            ids: ids.clone(),
            starts: Vec::new(),
            plan: CString::default(),
            broken: false,
        })
    })
}

/// The tolerance of a certified solver, a length: as asked, or the smallest default of a pair of
/// bodies, which is the smaller of theirs; -1 of other solvers.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_tolerance(
    detector: Option<&mut NearmissDetector>,
    tolerance: Option<&mut MaybeUninit<f64>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let named = own.query.certified().map(|certified| certified.tolerance);
        let tolerance_of = |named: Option<f64>| named.unwrap_or_else(|| own.detector.tolerance());
        given(tolerance, "the tolerance")?.write(named.map_or(-1.0, tolerance_of));
        Ok(())
    })
}

/// The largest tolerance of a pair of bodies, a length: that of `nearmiss_detector_tolerance` if
/// all pairs have the same; -1 of other solvers.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_largest_tolerance(
    detector: Option<&mut NearmissDetector>,
    tolerance: Option<&mut MaybeUninit<f64>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let named = own.query.certified().map(|certified| certified.tolerance);
        let tolerance_of = |named: Option<f64>| named.unwrap_or_else(|| own.detector.largest_tolerance());
        given(tolerance, "the tolerance")?.write(named.map_or(-1.0, tolerance_of));
        Ok(())
    })
}

/// Makes tiles or trees over what moves anew: pays when bodies have moved far from where these were made.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_rebuild(
    detector: Option<&mut NearmissDetector>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| own.detector.rebuild())
}

/// Adds a body, from the next frame on, and tells its number: that of one that was removed, where there is one. `id` may be NULL. Cost: as of
/// making the detector, at the next frame.
///
/// # Safety
/// What the body points to is there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_add(
    detector: Option<&mut NearmissDetector>,
    body: Option<&NearmissBody>,
    id: Option<&mut MaybeUninit<u32>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        // SAFETY: the caller's promise.
        let body = unsafe { given(body, "the body")?.body() }?;
        let added = own.detector.add(body)?;
        if added.index() == own.ids.len() {
            own.ids.push(added);
        }
        if let Some(id) = id {
            id.write(added.index() as u32);
        }
        Ok(())
    })
}

/// Puts another body, of any mesh, in the place of one, from the next frame on. Cost: as of making the detector, at the next frame.
///
/// # Safety
/// What the body points to is there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_replace(
    detector: Option<&mut NearmissDetector>,
    id: u32,
    new: Option<&NearmissBody>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        // SAFETY: the caller's promise.
        let new = unsafe { given(new, "the body")?.body() }?;
        own.detector.replace(body(&own.ids, id)?, new)
    })
}

/// Takes a body out, from the next frame on; others keep their numbers. Cost: as of making the detector, at the next frame.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_remove(
    detector: Option<&mut NearmissDetector>,
    id: u32,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| own.detector.remove(body(&own.ids, id)?).map(drop))
}

/// Frees the detector; waits for what it has submitted. Its answers stay.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_free(detector: Option<Box<NearmissDetector>>) {
    free(detector);
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearmiss::{Body, Mesh, device::Backend, mesh::Positions};

    #[test]
    fn a_detector_that_met_a_fault_is_not_worked_with_again() {
        let corners = Positions::F32(vec![[0.0; 3]; 3]);
        let body = Body::deformable(Mesh::new("a point", corners, vec![[0, 1, 2]]).expect("a mesh"));
        let device = Device::open(Backend::Cpu, Some(1)).expect("a thread");
        let detector = Detector::new(device.clone(), body).expect("a detector");
        let mut own = NearmissDetector {
            detector,
            query: Query::discrete(),
            device,
            ids: Vec::new(),
            starts: Vec::new(),
            plan: CString::default(),
            broken: false,
        };
        assert_eq!(nearmiss_detector_rebuild(Some(&mut own), None), NearmissCode::NEARMISS_OK);
        let code = NearmissDetector::work(Some(&mut own), None, |_| panic!("a fault"));
        assert_eq!(code, NearmissCode::NEARMISS_BUG);
        assert_eq!(nearmiss_detector_rebuild(Some(&mut own), None), NearmissCode::NEARMISS_BUG);
        nearmiss_detector_free(Some(Box::new(own)));
    }
}
