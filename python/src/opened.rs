//! A detector is opened: on a device, with a scene.

use crate::asked::Asked;
use crate::detector::Detector;
use crate::device::Device;
use crate::errors::raised;
use crate::scene::{Scene, scene_of};
use crate::watch::{Calls, watched};
use pyo3::prelude::*;
use std::sync::Mutex;

/// A scene has become that of a detector.
///
/// # Errors
/// That of Python if the scene is being changed.
pub fn take(scene: &Bound<'_, PyAny>) -> PyResult<()> {
    if let Ok(scene) = scene.cast::<Scene>() {
        scene.try_borrow_mut()?.taken = true;
    }
    Ok(())
}

impl Detector {
    /// Opens a detector; on the default device if none is given.
    pub fn opened(
        py: Python<'_>,
        scene: &Bound<'_, PyAny>,
        device: Option<Py<Device>>,
    ) -> PyResult<Detector> {
        let device = match device {
            Some(device) => device,
            None => py.get_type::<Device>().call0()?.cast_into::<Device>()?.unbind(),
        };
        let bodies = scene_of(scene)?;
        let (turn, calls) = (&device.get().turn, Calls::new(device.get().device.is_gpu()));
        let on = device.get().device.clone().with_interrupt(&calls.interrupt);
        let detector = watched(py, &calls, |watch| {
            let _turn = watch.lock(turn)?;
            watch.begins();
            nearmiss::Detector::new(on, bodies)
        });
        let one = Mutex::new(Asked::new(detector?.map_err(raised)?, device.get().device.is_gpu()));
        take(scene)?;
        Ok(Detector { one, device, calls })
    }
}
