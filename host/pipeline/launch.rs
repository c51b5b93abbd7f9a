//! Launches, by the number of blocks. The only place that vouches for the arguments of a frame's
//! kernels.

use crate::device::{Device, Place};
use crate::error::Error;
use nearmiss_kernels::entry::Entry;

/// Launches a number of blocks.
///
/// # Errors
/// Device errors.
pub fn blocks<E: Entry>(device: &Device, blocks: u32, args: &E::Args) -> Result<(), Error> {
    // SAFETY: the stages make their arguments of buffers of this device that the pipeline holds, as
    // the kernel's header requires under "Before". A buffer that is dropped waits for the launches
    // before.
    unsafe { device.launch::<E>(blocks, args) }
}

/// Launches a lane for each of `items` items.
///
/// # Errors
/// Device errors.
pub fn each<E: Entry>(device: &Device, items: usize, args: &E::Args) -> Result<(), Error> {
    blocks::<E>(device, device.blocks_for::<E>(items), args)
}

/// Launches enough blocks to fill the machine, for up to `capacity` items over which the kernel
/// strides.
///
/// # Errors
/// Device errors.
pub fn striding<E: Entry>(device: &Device, capacity: usize, args: &E::Args) -> Result<(), Error> {
    blocks::<E>(device, device.blocks_striding::<E>(capacity), args)
}

/// Launches as many blocks as run at once, for up to `capacity` items that lanes draw one by one.
///
/// # Errors
/// Device errors.
pub fn at_once<E: Entry>(device: &Device, capacity: usize, args: &E::Args) -> Result<(), Error> {
    at_once_in::<E>(device, Place::Whole, capacity, args)
}

/// The same, with a block an item if there are few: for long work that lanes of a warp do not do
/// together.
///
/// # Errors
/// Device errors.
pub fn spread<E: Entry>(device: &Device, capacity: usize, args: &E::Args) -> Result<(), Error> {
    let lanes = if device.is_gpu() { E::LANES as usize } else { 1 };
    at_once::<E>(device, capacity.saturating_mul(lanes), args)
}

/// As [`at_once`], in a part of the device: for launches at the same time.
///
/// # Errors
/// Device errors.
pub fn at_once_in<E: Entry>(
    device: &Device,
    place: Place,
    capacity: usize,
    args: &E::Args,
) -> Result<(), Error> {
    blocks::<E>(device, device.blocks_at_once_in::<E>(place, capacity)?, args)
}
