//! Work queues that help each other out, in one launch.

use super::segments::Segments;
use super::{Walk, Walked, resident};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::room::Growing;
use crate::pipeline::volumes::Kernels;
use crate::query::StealShape;
use nearmiss_kernels::abi::{EAGER, StealArgs, control};

/// See [`crate::query::Traversal::Steal`].
pub struct Steal {
    shape: StealShape,
    cores: u32,
    units: Segments<1>,
    pool: Buffer<u64>,
    control: Buffer<u64>,
}

impl Steal {
    /// Takes the memory.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new<V: Kernels>(device: &Device, shape: StealShape) -> Result<Self, Error> {
        let cores = shape.cores.unwrap_or_else(|| resident::<V::Steal>(device));
        let mut pool = device.buffer(shape.pool as usize)?;
        // Every launch leaves it so.
        pool.clear()?;
        Ok(Steal {
            shape,
            cores,
            units: Segments::new(device, cores, shape.segment as u64)?,
            pool,
            control: device.buffer(control::COUNT as usize)?,
        })
    }
}

impl<V: Kernels> Walk<V> for Steal {
    fn launch(&mut self, given: &Walked<V>) -> Result<(), Error> {
        self.control.clear()?;
        let args = StealArgs {
            to: given.pair_args(self.shape.local),
            units: self.units.span(0),
            pool: self.pool.span(),
            control: self.control.span(),
            segment: self.units.len(),
            tries: self.shape.tries,
            flags: if self.shape.eager { EAGER } else { 0 },
            pad: 0,
        };
        given.device.launch::<V::Steal>(self.cores, &args)
    }

    fn lists(&mut self) -> Vec<&mut dyn Growing> {
        vec![&mut self.units]
    }
}
