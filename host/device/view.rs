//! Reads of a device's memory by the host, without a copy if the machine allows it.

mod kept;

pub use kept::Kept;

use super::buffer::{Buffer, Memory};
use super::usage::Usage;
use super::{Device, Machine};
use crate::error::Error;
use bytemuck::Pod;
use std::ops::Deref;
use std::sync::atomic::Ordering;

/// Elements that the host reads in place. While there is a view, [`Device::launch`] refuses every
/// kernel.
pub struct View<'a, T> {
    elements: Elements<'a, T>,
    usage: &'a Usage,
}

enum Elements<'a, T> {
    Here(&'a [T]),
    #[cfg(feature = "cuda")]
    Staged(super::cuda::Known),
    #[cfg(feature = "cuda")]
    Own(Vec<T>),
}

impl<T: Pod> Deref for View<'_, T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        match &self.elements {
            Elements::Here(elements) => elements,
            #[cfg(feature = "cuda")]
            Elements::Staged(known) => bytemuck::cast_slice(known.bytes()),
            #[cfg(feature = "cuda")]
            Elements::Own(elements) => elements,
        }
    }
}

impl<T> Drop for View<'_, T> {
    fn drop(&mut self) {
        self.usage.views.fetch_sub(1, Ordering::Relaxed);
    }
}

/// The first bytes of a buffer, to be read ahead.
#[cfg_attr(not(feature = "cuda"), allow(dead_code, reason = "the host reaches all memory"))]
pub struct Ahead<'a> {
    memory: &'a Memory,
    bytes: usize,
    purpose: &'static str,
    is_kept: bool,
}

impl Ahead<'_> {
    /// The same, to be [kept](Buffer::keep) by the host.
    pub fn to_keep(self) -> Self {
        Ahead { is_kept: true, ..self }
    }
}

impl<T: Pod> Buffer<T> {
    /// The first `len` elements, or as many as there are, for [`Device::read_ahead`].
    pub fn ahead(&self, len: usize) -> Ahead<'_> {
        let bytes = len.min(self.len) * size_of::<T>();
        Ahead { memory: &self.memory, bytes, purpose: self.purpose, is_kept: false }
    }

    /// A view of the first `len` elements; waits for all work started before, unless they were read
    /// ahead.
    ///
    /// # Errors
    /// As for [`Buffer::read`].
    ///
    /// # Panics
    /// If the buffer has fewer elements: a fault of the caller.
    pub fn view(&self, len: usize) -> Result<View<'_, T>, Error> {
        assert!(len <= self.len, "more items than the buffer has elements");
        self.usage.waits("memory was read in place by the host")?;
        let bytes = len * size_of::<T>();
        let elements = match (&self.memory, &*self.machine) {
            (Memory::Host(m), _) => {
                self.ledger.read(self.purpose, bytes as u64);
                Elements::Here(bytemuck::cast_slice(m.as_slice(bytes)))
            }
            #[cfg(feature = "cuda")]
            (Memory::Gpu(m), Machine::Cuda(c)) => match c.known(m, bytes) {
                Some(known) => Elements::Staged(known),
                None => Elements::Own(self.read(len)?),
            },
            #[cfg(feature = "cuda")]
            _ => return Err(Error::Bug { what: "memory of another machine".into() }),
        };
        self.usage.views.fetch_add(1, Ordering::Relaxed);
        Ok(View { elements, usage: &self.usage })
    }
}

impl Device {
    /// Copies the first elements of several buffers to the host with one wait. Reads of them before
    /// the next launch or write wait no more. Does nothing if the host reaches the machine's
    /// memory.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text, also of a kernel that failed before.
    #[cfg_attr(not(feature = "cuda"), allow(unused_variables, reason = "the host reaches all memory"))]
    pub fn read_ahead(&self, all: &[Ahead]) -> Result<(), Error> {
        self.usage.waits("memory was read by the host")?;
        match &*self.machine {
            Machine::Emulator(_) => Ok(()),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => {
                all.iter().for_each(|ahead| self.ledger.read(ahead.purpose, ahead.bytes as u64));
                // Memory of another machine is refused at its read.
                let card = all.iter().filter_map(|ahead| match ahead.memory {
                    Memory::Gpu(memory) => {
                        Some(super::cuda::First { memory, bytes: ahead.bytes, is_kept: ahead.is_kept })
                    }
                    Memory::Host(_) => None,
                });
                c.read_ahead(&card.collect::<Vec<_>>())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::emulator::{Emulator, Mode};
    use nearmiss_kernels::abi::SortArgs;
    use nearmiss_kernels::entry::sort_pass;

    #[test]
    fn nothing_is_launched_while_the_host_looks() {
        let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"));
        let buffer = device.upload(&[1u64, 2, 3]).expect("memory");
        let args: SortArgs = bytemuck::Zeroable::zeroed();
        // SAFETY: no items and empty spans: the kernel touches nothing.
        let launch = || unsafe { device.launch::<sort_pass>(1, &args) };
        {
            let [one, other] = [2, 3].map(|len| buffer.view(len).expect("a view"));
            device.read_ahead(&[buffer.ahead(9)]).expect("as many as there are");
            assert_eq!((&*one, &*other), (&[1, 2][..], &[1, 2, 3][..]));
            drop(one);
            let error = launch().expect_err("the other is still there");
            assert!(matches!(&error, Error::Bug { what } if what.contains("sort_pass")), "{error}");
        }
        assert_eq!(device.launches(), 0);
        assert_eq!(buffer.view(0).expect("a view").len(), 0);
    }
}
