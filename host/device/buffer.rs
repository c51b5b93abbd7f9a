//! Typed buffers in a device's memory.

#[cfg(feature = "cuda")]
use super::cuda;
use super::held;
use super::ledger::Ledger;
use super::replay::Act;
use super::usage::Usage;
use super::{Machine, emulator};
use crate::error::Error;
use bytemuck::Pod;
use nearmiss_kernels::abi::Span;
use std::marker::PhantomData;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// Memory of a machine.
pub(super) enum Memory {
    Host(emulator::Memory),
    #[cfg(feature = "cuda")]
    Gpu(cuda::Memory),
}

/// Elements of `T` in a device's memory. Freed when dropped.
pub struct Buffer<T> {
    pub(super) memory: Memory,
    pub(super) len: usize,
    pub(super) machine: Arc<Machine>,
    pub(super) usage: Arc<Usage>,
    pub(super) ledger: Arc<Ledger>,
    pub(super) purpose: &'static str,
    // The buffer holds no `T` itself: whether `T` may be sent does not matter.
    pub(super) element: PhantomData<fn() -> T>,
}

impl<T: Pod> Buffer<T> {
    /// Number of elements.
    pub fn len(&self) -> usize {
        self.len
    }
    /// Whether the buffer has no elements.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }
    /// The span that a kernel takes as its argument.
    pub fn span(&self) -> Span<T> {
        let addr = match &self.memory {
            Memory::Host(m) => m.addr(),
            #[cfg(feature = "cuda")]
            Memory::Gpu(m) => m.addr(),
        };
        // SAFETY: the buffer has this number of elements in zeroed memory of this device, aligned
        // for any of them. The caller of a launch promises that they live as long as the kernel
        // uses them.
        unsafe { Span::new(addr, self.len as u64) }
    }

    /// Sets the first elements, after all work started before.
    ///
    /// # Errors
    /// [`Error::Device`] when the transfer fails.
    ///
    /// # Panics
    /// If there are more items than elements: a fault of the caller.
    pub fn write(&mut self, items: &[T]) -> Result<(), Error> {
        assert!(items.len() <= self.len, "more items than the buffer has elements");
        self.usage.allows("memory was written by the host")?;
        let count = size_of_val(items) as u64;
        self.ledger.wrote(self.purpose, count);
        self.usage.uploaded.fetch_add(count, Ordering::Relaxed);
        let bytes: &[u8] = bytemuck::cast_slice(items);
        match (&mut self.memory, &*self.machine) {
            (Memory::Host(m), Machine::Emulator(e)) => {
                m.as_mut_slice(bytes.len()).copy_from_slice(bytes);
                if let Some(sanitizer) = e.sanitizer() {
                    sanitizer.host_wrote(m.addr(), bytes.len());
                }
                Ok(())
            }
            #[cfg(feature = "cuda")]
            (Memory::Gpu(m), Machine::Cuda(c)) => c.write(m, bytes),
            #[cfg(feature = "cuda")]
            _ => Err(Error::Bug { what: "memory of another machine".into() }),
        }
    }

    /// Sets every byte to zero, after all work started before.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    pub fn clear(&mut self) -> Result<(), Error> {
        self.fill(0)
    }

    /// Sets every byte, after all work started before.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    pub fn fill(&mut self, byte: u8) -> Result<(), Error> {
        let bytes = self.len * size_of::<T>();
        self.ledger.cleared(self.purpose, bytes as u64);
        let fill = Act::Fill { addr: self.span().addr(), bytes, byte };
        if held::list(&self.usage, |list| list.push(fill)) && self.machine.is_gpu() {
            return Ok(());
        }
        match (&mut self.memory, &*self.machine) {
            (Memory::Host(m), Machine::Emulator(e)) => {
                m.as_mut_slice(bytes).fill(byte);
                if let Some(sanitizer) = e.sanitizer() {
                    sanitizer.host_wrote(m.addr(), bytes);
                }
                Ok(())
            }
            #[cfg(feature = "cuda")]
            (Memory::Gpu(m), Machine::Cuda(c)) => c.fill(m, byte),
            #[cfg(feature = "cuda")]
            _ => Err(Error::Bug { what: "memory of another machine".into() }),
        }
    }

    /// Copies the first `len` elements to the host; waits for all work started before.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text, also of a kernel that failed before.
    ///
    /// # Panics
    /// If the buffer has fewer elements: a fault of the caller.
    pub fn read(&self, len: usize) -> Result<Vec<T>, Error> {
        assert!(len <= self.len, "more items than the buffer has elements");
        self.usage.waits("memory was read by the host")?;
        let bytes = len * size_of::<T>();
        if !self.is_known(bytes) {
            self.ledger.read(self.purpose, bytes as u64);
        }
        match (&self.memory, &*self.machine) {
            (Memory::Host(m), _) => Ok(bytemuck::cast_slice(m.as_slice(len * size_of::<T>())).to_vec()),
            #[cfg(feature = "cuda")]
            (Memory::Gpu(m), Machine::Cuda(c)) => {
                let mut items = vec![T::zeroed(); len];
                c.read(m, bytemuck::cast_slice_mut(&mut items))?;
                Ok(items)
            }
            #[cfg(feature = "cuda")]
            _ => Err(Error::Bug { what: "memory of another machine".into() }),
        }
    }
}

impl<T> Buffer<T> {
    /// Whether this number of bytes was read ahead, so that a read transfers nothing.
    #[cfg_attr(not(feature = "cuda"), allow(unused_variables, reason = "the host reaches all memory"))]
    pub(super) fn is_known(&self, bytes: usize) -> bool {
        match (&self.memory, &*self.machine) {
            #[cfg(feature = "cuda")]
            (Memory::Gpu(m), Machine::Cuda(c)) => c.known(m, bytes).is_some(),
            _ => false,
        }
    }
}

impl<T> Drop for Buffer<T> {
    fn drop(&mut self) {
        let bytes = (self.len * size_of::<T>()) as u64;
        self.usage.give(bytes);
        self.ledger.gives(self.purpose, bytes);
        if let (Memory::Host(m), Machine::Emulator(e)) = (&self.memory, &*self.machine)
            && let Some(sanitizer) = e.sanitizer()
        {
            sanitizer.invalidate(m.addr());
        }
    }
}
