//! Work queues that share units through a pool, in one launch.

use super::segments::Segments;
use super::{Walk, WalkContext, resident};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::launch;
use crate::pipeline::list::GrowableOutput;
use crate::pipeline::precision::Precision;
use crate::query::StealShape;
use nearmiss_kernels::abi::{Pair, StealArgs, StealFlags, control, pool};
use nearmiss_kernels::entry::{self, Kernels};

/// Default number of pool places per queue, 16 KB a queue. Queues run dry only a few times each,
/// for any size of the trees, since they receive large subtrees.
const PLACES: u32 = 32;

/// The walk of [`crate::query::Traversal::Steal`].
pub struct Steal {
    shape: StealShape,
    cores: u32,
    units: Segments<1>,
    pool: Buffer<u64>,
    chunks: Buffer<Pair>,
    control: Buffer<u64>,
    /// Number of launches so far: it marks pool entries of earlier launches as stale.
    launches: u64,
}

impl Steal {
    /// Allocates the queues and the pool.
    ///
    /// # Errors
    /// Device errors.
    pub fn new<V: Kernels>(device: &Device, shape: StealShape) -> Result<Self, Error> {
        let cores = shape.cores.unwrap_or_else(|| resident::<entry::traverse_steal<V>>(device));
        let places = shape.pool.unwrap_or((PLACES * cores).min(control::MOST_PLACES)) as usize;
        let mut words = device.buffer(places)?;
        // Once: later launches have other numbers.
        words.clear()?;
        Ok(Steal {
            shape,
            cores,
            units: Segments::new(device, cores, shape.segment as u64)?,
            pool: words,
            chunks: device.buffer(places * pool::CHUNK as usize)?,
            control: device.buffer(1)?,
            launches: 0,
        })
    }
}

impl<R: Precision, V: Kernels> Walk<R, V> for Steal {
    fn launch(&mut self, given: &WalkContext<R, V>) -> Result<(), Error> {
        self.control.clear()?;
        self.launches += 1;
        let args = StealArgs {
            to: given.pair_args(self.shape.local),
            units: self.units.span(0),
            pool: self.pool.span(),
            chunks: self.chunks.span(),
            control: self.control.span(),
            launch: self.launches << pool::LAUNCH,
            segment: self.units.len(),
            tries: self.shape.tries,
            flags: StealFlags::EAGER.when(self.shape.eager),
            pad: 0,
        };
        launch::blocks::<entry::traverse_steal<V>>(given.device, self.cores, &args)
    }

    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        vec![&mut self.units]
    }

    /// A recorded launch that runs twice would take the first run's pool entries for its own.
    fn without_host(&self) -> Result<(), &'static str> {
        Err("traversal `steal` numbers its launches on the host")
    }
}
