//! A detector: a scene on a device.

use crate::device::NearmissDevice;
use crate::error::{NearmissCode, NearmissError, call, free, given, make, refused};
use crate::scene::NearmissScene;
use crate::several::Machines;
use nearmiss::scene::BodyId;
use nearmiss::{Body, Detector, Device, Error, Query};
use std::ffi::CString;
use std::mem::MaybeUninit;
use std::sync::atomic::Ordering;

/// A scene on a device. It answers queries of all kinds, step after step, from one memory.
pub struct NearmissDetector {
    pub(crate) detector: Machines,
    pub(crate) devices: Vec<Device>,
    /// Queries of the last preparation.
    pub(crate) prepared: Vec<Query>,
    /// Lists that `nearmiss_detector_on_device` has shown since then.
    pub(crate) starts: Vec<Vec<[u32; 3]>>,
    /// The text that `nearmiss_detector_plan` has shown last.
    pub(crate) plan: CString,
    /// The text that `nearmiss_detector_name` has shown last.
    pub(crate) name: CString,
    /// Whether a call has begun and not ended.
    broken: bool,
}

impl NearmissDetector {
    pub(crate) fn new(detector: Machines, devices: Vec<Device>) -> NearmissDetector {
        let (prepared, starts) = (Vec::new(), Vec::new());
        let (plan, name) = (CString::default(), CString::default());
        NearmissDetector { detector, devices, prepared, starts, plan, name, broken: false }
    }

    /// The work of a call with a detector. After a panic it is not used again.
    pub(crate) fn work(
        detector: Option<&mut NearmissDetector>,
        error: Option<&mut MaybeUninit<NearmissError>>,
        work: impl FnOnce(&mut NearmissDetector) -> Result<(), Error>,
    ) -> NearmissCode {
        call(error, || {
            let detector = given(detector, "detector")?;
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

    /// The body of a number, at its place on the device.
    pub(crate) fn downloaded(&mut self, number: u32) -> Result<&Body, Error> {
        let id = self.body(number)?;
        self.detector.download_positions()?;
        let found = self.detector.scene().get(id);
        found.ok_or_else(|| Error::Bug { what: format!("body {number}") })
    }

    /// The body of a number.
    pub(crate) fn body(&self, number: u32) -> Result<BodyId, Error> {
        self.detector.scene().id(number as usize).ok_or_else(|| {
            let advice = "pass the number that adding it returned, until it is removed";
            refused(format!("there is no body {number} in the scene"), advice)
        })
    }
}

/// Copies a scene to a device. The detector answers queries of all kinds. Memory for a kind is
/// taken by its first query. The scene cannot change any more; add bodies by
/// `nearmiss_detector_add`. A scene without bodies has empty answers.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_create(
    device: Option<&NearmissDevice>,
    scene: Option<&NearmissScene>,
    detector: Option<&mut MaybeUninit<*mut NearmissDetector>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(detector, "detector", error, || {
        let device = given(device, "device")?.device.clone();
        let NearmissScene { scene, is_copied } = given(scene, "scene")?;
        let detector = Detector::new(device.clone(), scene.clone())?;
        is_copied.store(true, Ordering::Relaxed);
        Ok(NearmissDetector::new(Machines::One(Box::new(detector)), vec![device]))
    })
}

/// Default tolerance of continuous and earliest queries, a length: the smallest of all pairs of
/// bodies. A pair has the smaller one of its bodies: 1e-4 of the body's mean edge.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_tolerance(
    detector: Option<&mut NearmissDetector>,
    tolerance: Option<&mut MaybeUninit<f64>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        given(tolerance, "tolerance")?.write(own.detector.tolerance());
        Ok(())
    })
}

/// Largest default tolerance of a pair of bodies, a length.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_largest_tolerance(
    detector: Option<&mut NearmissDetector>,
    tolerance: Option<&mut MaybeUninit<f64>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        given(tolerance, "tolerance")?.write(own.detector.largest_tolerance());
        Ok(())
    })
}

/// Rebuilds tiles over moving bodies. It pays when bodies have moved far since tiles were built.
/// Queries do it by themselves, except with `NEARMISS_REBUILD_MANUAL`.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_rebuild(
    detector: Option<&mut NearmissDetector>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| own.detector.rebuild())
}

/// Frees the detector, after all that it has submitted. Its answers stay.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_free(detector: Option<Box<NearmissDetector>>) {
    free(detector);
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearmiss::{Mesh, device::Backend, mesh::Positions};

    #[test]
    fn a_detector_is_not_used_after_a_fault() {
        let corners = Positions::F32(vec![[0.0; 3]; 3]);
        let body = Body::deformable(Mesh::new("a point", corners, vec![[0, 1, 2]]).expect("a mesh"));
        let device = Device::open(Backend::Cpu, Some(1)).expect("a thread");
        let detector = Detector::new(device.clone(), body).expect("a detector");
        let mut own = NearmissDetector::new(Machines::One(Box::new(detector)), vec![device]);
        assert_eq!(nearmiss_detector_rebuild(Some(&mut own), None), NearmissCode::NEARMISS_OK);
        let code = NearmissDetector::work(Some(&mut own), None, |_| panic!("a fault"));
        assert_eq!(code, NearmissCode::NEARMISS_BUG);
        assert_eq!(nearmiss_detector_rebuild(Some(&mut own), None), NearmissCode::NEARMISS_BUG);
        nearmiss_detector_free(Some(Box::new(own)));
    }
}
