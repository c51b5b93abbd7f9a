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
    /// So many bytes, whatever they hold.
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

    /// Sets every byte, behind all work before.
    pub fn fill(&mut self, gpu: &Bound, stream: &Stream, byte: u8) -> Result<(), Refusal> {
        // SAFETY: so many bytes are there, and freeing them waits for this.
        unsafe { fill(gpu, stream, self.addr, self.bytes, byte) }
    }

    /// Copies bytes to `start`, behind all work before.
    ///
    /// # Safety
    /// The bytes are not touched before the stream was waited for.
    pub unsafe fn write(
        &mut self,
        gpu: &Bound,
        stream: &Stream,
        start: usize,
        bytes: &[u8],
    ) -> Result<(), Refusal> {
        let to = self.inside(start, bytes.len());
        // SAFETY: so many bytes are there; freeing them waits for this; the rest is the caller's promise.
        answer(unsafe { (gpu.cuMemcpyHtoDAsync_v2)(to, bytes.as_ptr().cast(), bytes.len(), stream.handle()) })
    }

    /// Copies bytes from `start`, behind all work before.
    ///
    /// # Safety
    /// The bytes are not touched before the stream was waited for.
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

    /// Copies the first bytes and waits for that; not for the stream.
    pub fn read_now(&self, gpu: &Bound, bytes: &mut [u8]) -> Result<(), Refusal> {
        let from = self.inside(0, bytes.len());
        if bytes.is_empty() {
            return Ok(());
        }
        // SAFETY: so many bytes are there, and as many here; the call waits for the copy.
        answer(unsafe { (gpu.cuMemcpyDtoH_v2)(bytes.as_mut_ptr().cast(), from, bytes.len()) })
    }

    /// The address of a piece of it.
    fn inside(&self, start: usize, bytes: usize) -> u64 {
        let end = start.checked_add(bytes);
        assert!(end.is_some_and(|end| end <= self.bytes), "a copy beyond the GPU's memory");
        self.addr + start as u64
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        if let Ok(gpu) = self.context.bind() {
            // SAFETY: taken once, freed once; the call waits for all work of the GPU that may use it. A refusal finds nobody
            // to be told.
            let _ = unsafe { (gpu.cuMemFree_v2)(self.addr) };
        }
    }
}

/// Sets every byte of a piece of the GPU's memory, behind all work before.
///
/// # Safety
/// So many bytes are there, until this is over.
pub unsafe fn fill(gpu: &Bound, stream: &Stream, addr: u64, bytes: usize, byte: u8) -> Result<(), Refusal> {
    // SAFETY: the caller's promise.
    answer(unsafe { (gpu.cuMemsetD8Async)(addr, byte, bytes, stream.handle()) })
}

/// Free bytes of the GPU's memory, as far as the driver tells.
pub fn free(gpu: &Bound) -> u64 {
    let (mut free, mut total) = (0, 0);
    // SAFETY: the driver writes two numbers.
    answer(unsafe { (gpu.cuMemGetInfo_v2)(&mut free, &mut total) }).map_or(0, |()| free as u64)
}

/// Page-locked memory of the host: copies from and to it run beside the host.
pub struct Locked {
    context: Arc<Context>,
    start: NonNull<u8>,
    len: usize,
}

// SAFETY: an allocation like a Box of bytes; references to it follow those to the owner.
unsafe impl Send for Locked {}
// SAFETY: as above.
unsafe impl Sync for Locked {}

impl Locked {
    /// So many bytes, at least one.
    pub fn new(context: &Arc<Context>, gpu: &Bound, len: usize) -> Result<Locked, Refusal> {
        let mut start = null_mut();
        // SAFETY: the driver writes one address, which is freed once.
        answer(unsafe { (gpu.cuMemAllocHost_v2)(&mut start, len) })?;
        let start = NonNull::new(start.cast()).ok_or(Refusal::OUT_OF_MEMORY)?;
        // SAFETY: so many bytes are there and nobody else knows them.
        unsafe { start.write_bytes(0, len) };
        Ok(Locked { context: context.clone(), start, len })
    }

    /// How many bytes.
    pub fn len(&self) -> usize {
        self.len
    }

    /// A piece.
    pub fn piece(&self, at: usize, bytes: usize) -> &[u8] {
        assert!(at <= self.len && bytes <= self.len - at, "beyond the page-locked memory");
        // SAFETY: inside the allocation, which is written from the start on. The GPU writes to no piece that somebody may
        // look at: who starts a copy promises that (`Memory::read`).
        unsafe { std::slice::from_raw_parts(self.start.as_ptr().add(at), bytes) }
    }

    /// A piece, to write.
    pub fn piece_mut(&mut self, at: usize, bytes: usize) -> &mut [u8] {
        assert!(at <= self.len && bytes <= self.len - at, "beyond the page-locked memory");
        // SAFETY: as in `piece`, and the borrow is exclusive.
        unsafe { std::slice::from_raw_parts_mut(self.start.as_ptr().add(at), bytes) }
    }
}

impl Drop for Locked {
    fn drop(&mut self) {
        if let Ok(gpu) = self.context.bind() {
            // SAFETY: taken once, freed once, after copies under way were waited for (`Staging::room`, `Cuda::drop`). A
            // refusal finds nobody to be told.
            let _ = unsafe { (gpu.cuMemFreeHost)(self.start.as_ptr().cast()) };
        }
    }
}
