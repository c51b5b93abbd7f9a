//! Contexts, streams and arrays of cudarc.
//!
//! cudarc orders reads and writes of its arrays by events. These calls take part: kernels of other
//! streams that write an array come before the frame that reads it.
//!
//! A captured stream is refused, as nothing ties a `CudaGraph` to the memory in it. To record
//! frames, use [`DeviceRows`](nearmiss::scene::DeviceRows) and [`Detector::submit`].
//!
//! [`Detector::submit`]: nearmiss::Detector::submit

use crate::array::{DeviceArray, OwnedArray, sealed};
use crate::element::Element;
use ::cudarc::driver::sys::CUstreamCaptureStatus;
use ::cudarc::driver::{CudaSlice, CudaStream, CudaView, CudaViewMut, DevicePtr, DriverError, SyncOnDrop};
use nearmiss::{Device, Error};
use std::sync::Arc;

/// CUDA's handle of the default stream of the calling thread.
const PER_THREAD: usize = 2;

fn refused<T>(what: &str, advice: &str) -> Result<T, Error> {
    Err(Error::InvalidArgument { what: what.into(), advice: advice.into() })
}

/// cudarc's error as ours.
fn driver(what: &'static str) -> impl Fn(DriverError) -> Error {
    move |error| Error::Device {
        what: what.into(),
        text: error.to_string(),
        advice: "look at `nvidia-smi`, or run on the CPU",
    }
}

/// The GPU of a stream. All work goes to that stream, after its earlier work. The device keeps the
/// stream and its context.
///
/// # Errors
/// [`Error::InvalidArgument`] for the default stream of the thread, which is another stream in each
/// thread. Others are those of [`Device::gpu`].
pub fn device(stream: &Arc<CudaStream>) -> Result<Device, Error> {
    if stream.cu_stream() as usize == PER_THREAD {
        return refused(
            "the default stream of the thread cannot be used: it is another stream in each thread",
            "make one with `CudaContext::new_stream`",
        );
    }
    let (context, handle) = (stream.context().cu_ctx(), stream.cu_stream());
    // SAFETY: the handles are those of a live stream and of its context, which the stream keeps.
    unsafe { Device::from_stream_of(stream.clone(), context.cast(), handle.cast()) }
}

/// The stream that [`device`] was made from.
fn stream(device: &Device) -> Option<&CudaStream> {
    device.owner()?.downcast_ref()
}

/// Orders a read of an array on the device's stream.
fn order<'a, T>(array: &'a impl DevicePtr<T>, device: &'a Device) -> Result<(u64, SyncOnDrop<'a>), Error> {
    let Some(stream) = stream(device) else {
        return refused(
            "a cudarc array cannot be read by this detector: its device has no cudarc stream",
            "make the detector's device with `nearmiss_interop::cudarc::device`",
        );
    };
    // Another `CudaContext` orders its arrays by itself, also if it is of the same GPU.
    if !Arc::ptr_eq(array.stream().context(), stream.context()) {
        return refused(
            "the array and the detector's stream have different `CudaContext`s",
            "make both from one `CudaContext`",
        );
    }
    let status = stream.capture_status().map_err(driver("querying a stream"))?;
    if status != CUstreamCaptureStatus::CU_STREAM_CAPTURE_STATUS_NONE {
        return refused(
            "arrays cannot be passed while their stream is captured",
            "end the capture, or record `Detector::submit` with `DeviceRows`",
        );
    }
    Ok(array.device_ptr(stream))
}

// SAFETY: a slice has its elements in memory of its context, until it is dropped. `order` checks
// that the device's stream has the same one.
unsafe impl<T: Element> sealed::Ordered for CudaSlice<T> {
    type Order<'a> = SyncOnDrop<'a>;
    fn order<'a>(&'a self, device: &'a Device) -> Result<(u64, SyncOnDrop<'a>), Error> {
        order(self, device)
    }
}

// SAFETY: as above, for a part of a slice that the view borrows.
unsafe impl<T: Element> sealed::Ordered for CudaView<'_, T> {
    type Order<'a>
        = SyncOnDrop<'a>
    where
        Self: 'a;
    fn order<'a>(&'a self, device: &'a Device) -> Result<(u64, SyncOnDrop<'a>), Error> {
        order(self, device)
    }
}

impl<T: Element> DeviceArray for CudaSlice<T> {
    type Element = T;
    fn elements(&self) -> usize {
        self.len()
    }
}

impl<T: Element> DeviceArray for CudaView<'_, T> {
    type Element = T;
    fn elements(&self) -> usize {
        self.len()
    }
}

impl<T: Element> OwnedArray for CudaSlice<T> {
    type View<'a> = CudaViewMut<'a, T>;
    fn view(&mut self) -> CudaViewMut<'_, T> {
        self.as_view_mut()
    }
}
