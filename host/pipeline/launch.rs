//! Launches, by how many blocks a kernel gets. The one place that vouches for what the kernels of a frame are given.

use crate::device::Device;
use crate::error::Error;
use nearmiss_kernels::entry::Entry;

/// So many blocks.
///
/// # Errors
/// Those of the device.
pub fn blocks<E: Entry>(device: &Device, blocks: u32, args: &E::Args) -> Result<(), Error> {
    // SAFETY: the stages make their arguments of buffers of this device that the pipeline holds, as the kernel's card asks
    // under "Before"; a buffer that is dropped waits for the launches before.
    unsafe { device.launch::<E>(blocks, args) }
}

/// A lane for each of `items` items.
///
/// # Errors
/// Those of the device.
pub fn each<E: Entry>(device: &Device, items: usize, args: &E::Args) -> Result<(), Error> {
    blocks::<E>(device, device.blocks_for::<E>(items), args)
}

/// Enough to fill the machine, for up to `capacity` items over which the kernel strides.
///
/// # Errors
/// Those of the device.
pub fn striding<E: Entry>(device: &Device, capacity: usize, args: &E::Args) -> Result<(), Error> {
    blocks::<E>(device, device.blocks_striding::<E>(capacity), args)
}

/// As many as run at once, for up to `capacity` items that lanes draw until there are no more.
///
/// # Errors
/// Those of the device.
pub fn at_once<E: Entry>(device: &Device, capacity: usize, args: &E::Args) -> Result<(), Error> {
    blocks::<E>(device, device.blocks_at_once::<E>(capacity)?, args)
}
