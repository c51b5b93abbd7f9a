//! Memory of the GPU, and memory of the host that the GPU reaches.

use super::context::{Bound, Context};
use super::driver::{Refusal, answer};
use super::stream::Stream;
use std::ptr::{NonNull, null_mut};
use std::sync::Arc;

/// Memory of the GPU.
pub struct Memory {
    context: Arc<Context>,
    addr: u64,
    bytes: usize,
}

impl Memory {
    /// Allocates this number of bytes, with any content.
    pub fn new(context: &Arc<Context>, gpu: &Bound, bytes: usize) -> Result<Memory, Refusal> {
        let mut addr = 0;
        // SAFETY: the driver writes one address, which is freed once.
        answer(unsafe { (gpu.cuMemAlloc_v2)(&mut addr, bytes) })?;
        Ok(Memory { context: context.clone(), addr, bytes })
    }

    /// The address that kernels use.
    pub fn addr(&self) -> u64 {
        self.addr
    }

    /// Sets every byte, after all work before.
    pub fn fill(&mut self, gpu: &Bound, stream: &Stream, byte: u8) -> Result<(), Refusal> {
        // SAFETY: the memory has this number of bytes, and freeing it waits for this.
        unsafe { fill(gpu, stream, self.addr, self.bytes, byte) }
    }

    /// Copies bytes to `start`, after all work before.
    ///
    /// # Safety
    /// The bytes are not accessed before the stream was waited for.
    pub unsafe fn write(
        &mut self,
        gpu: &Bound,
        stream: &Stream,
        start: usize,
        bytes: &[u8],
    ) -> Result<(), Refusal> {
        let to = self.inside(start, bytes.len());
        // SAFETY: the memory has these bytes, and freeing it waits for this. The caller promises
        // the rest.
        answer(unsafe { (gpu.cuMemcpyHtoDAsync_v2)(to, bytes.as_ptr().cast(), bytes.len(), stream.handle()) })
    }

    /// Copies bytes of another context's memory to the start, after all work before.
    ///
    /// # Safety
    /// The other context has these bytes until the copy has ended.
    pub unsafe fn write_from(
        &mut self,
        gpu: &Bound,
        stream: &Stream,
        other: &Context,
        address: u64,
        bytes: usize,
    ) -> Result<(), Refusal> {
        let to = self.inside(0, bytes);
        let (own, theirs) = (self.context.handle(), other.handle());
        // SAFETY: the memory has these bytes, and freeing it waits for this. Both contexts are held.
        // The caller promises the rest.
        answer(unsafe { (gpu.cuMemcpyPeerAsync)(to, own, address, theirs, bytes, stream.handle()) })
    }

    /// Copies bytes from `start`, after all work before.
    ///
    /// # Safety
    /// The bytes are not accessed before the stream was waited for.
    pub unsafe fn read(
        &self,
        gpu: &Bound,
        stream: &Stream,
        start: usize,
        bytes: &mut [u8],
    ) -> Result<(), Refusal> {
        let from = self.inside(start, bytes.len());
        // SAFETY: as in `write`.
        answer(unsafe {
            (gpu.cuMemcpyDtoHAsync_v2)(bytes.as_mut_ptr().cast(), from, bytes.len(), stream.handle())
        })
    }

    /// Copies the first bytes and waits for that copy, not for the stream.
    pub fn read_now(&self, gpu: &Bound, bytes: &mut [u8]) -> Result<(), Refusal> {
        let from = self.inside(0, bytes.len());
        if bytes.is_empty() {
            return Ok(());
        }
        // SAFETY: both sides have this number of bytes; the call waits for the copy.
        answer(unsafe { (gpu.cuMemcpyDtoH_v2)(bytes.as_mut_ptr().cast(), from, bytes.len()) })
    }

    /// The address of a part of it.
    fn inside(&self, start: usize, bytes: usize) -> u64 {
        let end = start.checked_add(bytes);
        assert!(end.is_some_and(|end| end <= self.bytes), "a copy exceeds the GPU's buffer");
        self.addr + start as u64
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        if let Ok(gpu) = self.context.bind() {
            // SAFETY: allocated once, freed once; the call waits for all work of the GPU that may
            // use it. A refusal cannot be reported.
            let _ = unsafe { (gpu.cuMemFree_v2)(self.addr) };
        }
    }
}

/// Sets every byte of a part of the GPU's memory, after all work before.
///
/// # Safety
/// The memory has this number of bytes until the fill ends.
pub unsafe fn fill(gpu: &Bound, stream: &Stream, addr: u64, bytes: usize, byte: u8) -> Result<(), Refusal> {
    // SAFETY: the caller's promise.
    answer(unsafe { (gpu.cuMemsetD8Async)(addr, byte, bytes, stream.handle()) })
}

/// Free bytes of the GPU's memory, as the driver reports them.
pub fn free(gpu: &Bound) -> u64 {
    let (mut free, mut total) = (0, 0);
    // SAFETY: the driver writes two numbers.
    answer(unsafe { (gpu.cuMemGetInfo_v2)(&mut free, &mut total) }).map_or(0, |()| free as u64)
}

/// Page-locked memory of the host: copies from and to it run concurrently with the host.
pub struct Locked {
    context: Arc<Context>,
    start: NonNull<u8>,
    len: usize,
}

// SAFETY: an allocation like a Box of bytes; the borrow checker sees references to it as references
// to its owner.
unsafe impl Send for Locked {}
// SAFETY: as above.
unsafe impl Sync for Locked {}

impl Locked {
    /// Allocates this number of bytes, at least one.
    pub fn new(context: &Arc<Context>, gpu: &Bound, len: usize) -> Result<Locked, Refusal> {
        let mut start = null_mut();
        // SAFETY: the driver writes one address, which is freed once.
        answer(unsafe { (gpu.cuMemAllocHost_v2)(&mut start, len) })?;
        let start = NonNull::new(start.cast()).ok_or(Refusal::OUT_OF_MEMORY)?;
        // SAFETY: the memory has this number of bytes, and nothing else refers to it.
        unsafe { start.write_bytes(0, len) };
        Ok(Locked { context: context.clone(), start, len })
    }

    /// Number of bytes.
    pub fn len(&self) -> usize {
        self.len
    }

    /// A part of the memory.
    pub fn piece(&self, at: usize, bytes: usize) -> &[u8] {
        assert!(at <= self.len && bytes <= self.len - at, "a range exceeds the page-locked memory");
        // SAFETY: within the allocation, which is initialised at its start. The GPU writes to no
        // part that the host may read: the caller that starts a copy promises that
        // (`Memory::read`).
        unsafe { std::slice::from_raw_parts(self.start.as_ptr().add(at), bytes) }
    }

    /// A part of the memory, to write.
    pub fn piece_mut(&mut self, at: usize, bytes: usize) -> &mut [u8] {
        assert!(at <= self.len && bytes <= self.len - at, "a range exceeds the page-locked memory");
        // SAFETY: as in `piece`, and the borrow is exclusive.
        unsafe { std::slice::from_raw_parts_mut(self.start.as_ptr().add(at), bytes) }
    }
}

impl Drop for Locked {
    fn drop(&mut self) {
        if let Ok(gpu) = self.context.bind() {
            // SAFETY: allocated once, freed once, after all copies were waited for
            // (`Staging::room`, `Cuda::drop`). A refusal cannot be reported.
            let _ = unsafe { (gpu.cuMemFreeHost)(self.start.as_ptr().cast()) };
        }
    }
}
