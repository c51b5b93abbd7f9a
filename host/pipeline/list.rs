//! Lists that grow: entries past the end are counted, the list is enlarged to the exact demand, and
//! the frame fills it again.

use super::counts::Counts;
use crate::device::{Ahead, Buffer, Device, Kept, View};
use crate::error::Error;
use bytemuck::Pod;
use nearmiss_kernels::abi::{Counter, Counters, Output, Span};
use rayon::prelude::*;
use xxhash_rust::xxh3::xxh3_64;

/// A list in device memory, with a counter of its entries.
pub struct List<T> {
    name: &'static str,
    counter: Counter,
    entries: Buffer<T>,
}

/// Longest list: entries are numbered with 32 bits, and so is the first one behind the list that any
/// lane of a launch looks for.
pub const LONGEST: u64 = u32::MAX as u64 - (1 << 24);
/// Most bytes that are read ahead beyond the last frame's demand: they take as long as a short
/// wait.
const MORE: usize = 1 << 18;

impl<T: Pod> List<T> {
    /// Allocates a list with room for `capacity` entries.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn new(
        device: &Device,
        name: &'static str,
        counter: Counter,
        capacity: usize,
    ) -> Result<Self, Error> {
        Ok(List { name, counter, entries: device.of(name).buffer(capacity.min(LONGEST as usize))? })
    }

    /// Makes room for at least `capacity` entries. If the list grows, its entries are lost.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn reserve(&mut self, device: &Device, capacity: usize) -> Result<(), Error> {
        if capacity > self.capacity() {
            let device = device.of(self.name);
            self.entries = device.buffer(0)?;
            self.entries = device.buffer(capacity.min(LONGEST as usize))?;
        }
        Ok(())
    }

    /// Sets every byte of the memory to zero, after all work started before.
    ///
    /// # Errors
    /// Device errors.
    pub fn clear(&mut self) -> Result<(), Error> {
        self.entries.clear()
    }

    /// Returns the list as a kernel's output, with these counters.
    pub fn output(&self, counters: Counters) -> Output<T> {
        counters.output(self.entries.span(), self.counter)
    }

    /// Returns the memory alone, if the number of entries is known from elsewhere.
    pub fn entries(&self) -> Span<T> {
        self.entries.span()
    }

    /// Returns the number of entries that there is room for.
    pub fn capacity(&self) -> usize {
        self.entries.len()
    }

    /// Returns the number of entries that the kernels counted.
    pub fn demand(&self, counters: &Counts) -> u64 {
        counters[self.counter]
    }

    /// Sets the first entries, and their number in `counts`.
    ///
    /// # Errors
    /// Device errors.
    ///
    /// # Panics
    /// If there are more entries than room: a fault of the caller.
    pub fn put(&mut self, entries: &[T], counts: &mut Counts) -> Result<(), Error> {
        counts[self.counter] = entries.len() as u64;
        self.entries.write(entries)
    }

    /// Returns the first entries, to be read ahead: the demand of a frame with these counters, and
    /// an eighth more.
    pub fn ahead(&self, counters: &Counts) -> Ahead<'_> {
        let demand = self.demand(counters);
        self.entries.ahead((demand + demand / 8) as usize)
    }

    /// Returns the first entries, to be read ahead and kept: as many, but few more for a long list.
    /// Entries beyond these take another wait.
    pub fn ahead_to_keep(&self, counters: &Counts) -> Ahead<'_> {
        let demand = self.demand(counters);
        let more = (demand / 8).min((MORE / size_of::<T>()) as u64);
        self.entries.ahead((demand + more) as usize).to_keep()
    }

    /// Returns the entries, to be kept.
    ///
    /// # Errors
    /// Device errors.
    pub fn keep(&self, counters: &Counts) -> Result<Kept, Error> {
        self.entries.keep(self.demand(counters) as usize)
    }

    /// Returns a view of the entries.
    ///
    /// # Errors
    /// Device errors.
    pub fn view(&self, counters: &Counts) -> Result<View<'_, T>, Error> {
        self.entries.view(self.demand(counters) as usize)
    }

    /// Returns the entries.
    ///
    /// # Errors
    /// Device errors.
    pub fn read(&self, counters: &Counts) -> Result<Vec<T>, Error> {
        self.first(self.demand(counters))
    }

    /// Returns the first `count` entries.
    ///
    /// # Errors
    /// Device errors.
    pub fn first(&self, count: u64) -> Result<Vec<T>, Error> {
        self.entries.read(count as usize)
    }
}

/// A list, seen as the number of its entries. They are counted again when its step runs again.
pub trait GrowableOutput {
    /// Returns the counter of the entries.
    fn counter(&self) -> Counter;
    /// Returns the number of entries that there is room for.
    fn room(&self) -> u64;
    /// Returns whether the kernels counted more entries than there is room for.
    fn has_overflowed(&self, counters: &Counts) -> bool {
        counters[self.counter()] > self.room()
    }
    /// Makes room for the counted entries, and an eighth more for the next frame. Returns whether
    /// the list grew.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`] if there is no memory, or the list would be longer than 32 bits can
    /// index.
    fn grow(&mut self, device: &Device, counters: &Counts) -> Result<bool, Error>;
}

/// A list between two steps, as two machines compare it.
pub trait Comparable {
    /// Returns a hash of the entries; their order does not matter.
    ///
    /// # Errors
    /// Device errors.
    fn fingerprint(&self, counters: &Counts) -> Result<u64, Error>;
}

/// A list with a name, for comparing machines.
pub type Named<'a> = (&'static str, &'a dyn Comparable);

/// Returns a list with a name.
pub fn named<'a>(name: &'static str, list: &'a dyn Comparable) -> Named<'a> {
    (name, list)
}

impl<T: Pod + Ord + Send> Comparable for List<T> {
    fn fingerprint(&self, counters: &Counts) -> Result<u64, Error> {
        let mut entries = self.read(counters)?;
        entries.par_sort_unstable();
        Ok(xxh3_64(bytemuck::cast_slice(&entries)))
    }
}

/// A counter without a list.
impl GrowableOutput for Counter {
    fn counter(&self) -> Counter {
        *self
    }
    fn room(&self) -> u64 {
        u64::MAX
    }
    fn grow(&mut self, _: &Device, _: &Counts) -> Result<bool, Error> {
        Ok(false)
    }
}

impl<T: Pod> GrowableOutput for List<T> {
    fn counter(&self) -> Counter {
        self.counter
    }
    fn room(&self) -> u64 {
        self.capacity() as u64
    }
    fn grow(&mut self, device: &Device, counters: &Counts) -> Result<bool, Error> {
        let demand = self.demand(counters);
        if !self.has_overflowed(counters) {
            return Ok(false);
        }
        let capacity = |given| Error::OutOfMemory {
            what: format!("the list of {}", self.name),
            asked: demand * size_of::<T>() as u64,
            given,
        };
        if demand > LONGEST {
            return Err(capacity(LONGEST * size_of::<T>() as u64));
        }
        let wanted = (demand + demand / 8).min(LONGEST) as usize;
        // The old entries are not needed: the list is filled again.
        let device = device.of(self.name);
        self.entries = device.buffer(0)?;
        self.entries = device.buffer(wanted)?;
        Ok(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::emulator::{Emulator, Mode};
    use nearmiss_kernels::abi::{Pair, counter};

    /// 92,683 equal triangles have 4,295,022,903 pairs: 55,607 more than 2^32.
    #[test]
    fn a_list_beyond_32_bits_is_refused_with_its_size() {
        let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"));
        let mut list = List::<Pair>::new(&device, "pairs", counter::PAIRS, 16).expect("capacity");
        let grow = |list: &mut List<Pair>, demand: u64| {
            let mut counts = Counts::default();
            counts[counter::PAIRS] = demand;
            list.grow(&device, &counts)
        };
        assert!(!grow(&mut list, 16).expect("long enough"));
        assert!(grow(&mut list, 17).expect("longer") && list.capacity() == 19);
        for demand in [LONGEST + 1, 92_683 * 92_682 / 2, u64::MAX / 64] {
            match grow(&mut list, demand) {
                Err(Error::OutOfMemory { asked, given, .. }) => {
                    assert_eq!((asked, given), (demand * 8, LONGEST * 8));
                }
                other => panic!("{demand}: {other:?}"),
            }
        }
    }
}
