//! Contexts, streams and arrays of cust.
//!
//! Streams of cust follow the default stream, and so its copies and fills. Kernels that write an
//! array run on the detector's stream. If they run on another one, the detector's stream must follow
//! it: `Stream::wait_event`.
//!
//! A `DeviceSlice` can be copied, and the copy outlives its buffer. So it cannot be passed:
//!
//! ```compile_fail,E0277
//! # use cust::memory::DeviceBuffer;
//! # use nearmiss::{Detector, Error, scene::BodyId};
//! # use nearmiss_interop::{Input, update};
//! fn slice(detector: &mut Detector, cloth: BodyId, array: DeviceBuffer<f32>) -> Result<(), Error> {
//!     update(detector, &[(cloth, Input::positions(array.as_slice()))])
//! }
//! ```
//!
//! A buffer can, until it is freed:
//!
//! ```no_run
//! # use cust::memory::DeviceBuffer;
//! # use nearmiss::{Detector, Error, scene::BodyId};
//! # use nearmiss_interop::{Input, update};
//! fn alive(detector: &mut Detector, cloth: BodyId, array: DeviceBuffer<f32>) -> Result<(), Error> {
//!     update(detector, &[(cloth, Input::positions(&array))])
//! }
//! ```
//!
//! ```compile_fail,E0505
//! # use cust::memory::DeviceBuffer;
//! # use nearmiss::{Detector, Error, scene::BodyId};
//! # use nearmiss_interop::{Input, update};
//! fn freed(detector: &mut Detector, cloth: BodyId, array: DeviceBuffer<f32>) -> Result<(), Error> {
//!     let inputs = [(cloth, Input::positions(&array))];
//!     drop(array);
//!     update(detector, &inputs)
//! }
//! ```

use crate::array::{DeviceArray, OwnedArray, sealed};
use crate::element::Element;
use ::cust::context::Context;
use ::cust::memory::{DeviceBuffer, DeviceCopy};
use ::cust::stream::Stream;
use ::cust::sys;
use nearmiss::{Device, Error};
use std::ptr::null_mut;
use std::sync::Arc;

/// The stream of a device, and its context. Fields are dropped in this order.
struct Owner {
    stream: Arc<Stream>,
    context: Context,
}

fn refused<T>(what: &str, advice: &str) -> Result<T, Error> {
    Err(Error::InvalidArgument { what: what.into(), advice: advice.into() })
}

/// The GPU of a context and a stream. All work goes to that stream, after its earlier work. The
/// device keeps both.
///
/// The context is the primary one of its GPU; those of `cust::context::legacy` have another type.
///
/// # Errors
/// [`Error::InvalidArgument`] if the stream is of another context. Others are those of
/// [`Device::gpu`].
pub fn device(context: Context, stream: &Arc<Stream>) -> Result<Device, Error> {
    let mut own: sys::CUcontext = null_mut();
    // SAFETY: the stream lives, and the driver writes one handle.
    let code = unsafe { sys::cuStreamGetCtx(stream.as_inner(), &mut own) };
    if code != sys::CUresult::CUDA_SUCCESS {
        return Err(Error::Device {
            what: "querying the context of a stream".into(),
            text: format!("the driver refuses: {code:?}"),
            advice: "look at `nvidia-smi`, or run on the CPU",
        });
    }
    if own != context.as_raw() {
        return refused(
            "the stream is of another context than the one that was passed",
            "make the stream while the thread is bound to that context",
        );
    }
    let owner = Arc::new(Owner { stream: stream.clone(), context });
    let (context, handle) = (owner.context.as_raw(), owner.stream.as_inner());
    // SAFETY: the handles are those of a live context and of a stream in it, which the owner keeps.
    unsafe { Device::from_stream_of(owner, context.cast(), handle.cast()) }
}

/// The stream and the context that [`device`] was made from.
fn owner(device: &Device) -> Option<&Owner> {
    device.owner()?.downcast_ref()
}

/// The context in which memory was allocated; `None` if the driver has none for it.
fn context_of(address: u64) -> Option<sys::CUcontext> {
    let mut context: sys::CUcontext = null_mut();
    let what = sys::CUpointer_attribute::CU_POINTER_ATTRIBUTE_CONTEXT;
    // SAFETY: the driver writes one handle, and accepts any address: it refuses unknown ones.
    let code = unsafe { sys::cuPointerGetAttribute((&raw mut context).cast(), what, address) };
    (code == sys::CUresult::CUDA_SUCCESS && !context.is_null()).then_some(context)
}

// SAFETY: a buffer has its elements in memory of its context until it is dropped. `order` checks
// that the device's stream has the same one.
unsafe impl<T: Element + DeviceCopy> sealed::Ordered for DeviceBuffer<T> {
    type Order<'a> = ();

    fn order<'a>(&'a self, device: &'a Device) -> Result<(u64, ()), Error> {
        let Some(owner) = owner(device) else {
            return refused(
                "a cust array cannot be read by this detector: its device has no cust stream",
                "make the detector's device with `nearmiss_interop::cust::device`",
            );
        };
        let address = self.as_device_ptr().as_raw();
        // No memory was allocated for no elements.
        if !self.is_empty() && context_of(address) != Some(owner.context.as_raw()) {
            return refused(
                "the array is of another context than the detector's stream, or of a memory pool",
                "allocate it by `DeviceBuffer::from_slice` or `zeroed` in that context",
            );
        }
        Ok((address, ()))
    }
}

impl<T: Element + DeviceCopy> DeviceArray for DeviceBuffer<T> {
    type Element = T;
    fn elements(&self) -> usize {
        self.len()
    }
}

/// The view is shared: `as_device_ptr` of it is the argument of a kernel, which is launched in
/// `unsafe` code.
impl<T: Element + DeviceCopy> OwnedArray for DeviceBuffer<T> {
    type View<'a> = &'a DeviceBuffer<T>;
    fn view(&mut self) -> &DeviceBuffer<T> {
        self
    }
}
