//! Bytes of a device's memory that the host keeps: in page-locked memory that the GPU copied them
//! into, without another copy.

use crate::device::Device;
use crate::device::buffer::{Buffer, Memory};
#[cfg(feature = "cuda")]
use crate::device::{Machine, cuda};
use crate::error::Error;
use bytemuck::Pod;
use std::sync::Arc;

/// Bytes that the host keeps, aligned to 8 bytes. They need neither buffer nor detector. When they
/// are dropped, later answers use the same memory.
pub struct Kept(Bytes);

/// Factor by which a block may exceed the bytes that are kept in it.
#[cfg(feature = "cuda")]
const WASTEFUL: usize = 4;
/// Bytes for which any block of four times that size will do.
#[cfg(feature = "cuda")]
const LITTLE: usize = 1 << 18;

enum Bytes {
    /// Whole words, and how many bytes of them count.
    Own(Vec<u64>, usize),
    #[cfg(feature = "cuda")]
    Locked(cuda::Kept),
}

impl Kept {
    /// The bytes.
    pub fn bytes(&self) -> &[u8] {
        match &self.0 {
            Bytes::Own(words, bytes) => &bytemuck::cast_slice(words)[..*bytes],
            #[cfg(feature = "cuda")]
            Bytes::Locked(kept) => kept.bytes(),
        }
    }

    /// Copies bytes; `read` writes them.
    fn copied<E>(bytes: usize, read: impl FnOnce(&mut [u8]) -> Result<(), E>) -> Result<Kept, E> {
        let mut words = vec![0u64; bytes.div_ceil(size_of::<u64>())];
        read(&mut bytemuck::cast_slice_mut(&mut words)[..bytes])?;
        Ok(Kept(Bytes::Own(words, bytes)))
    }
}

impl Device {
    /// Makes memory that `fill` writes, of earlier answers if there is some; the host keeps it. `None`
    /// if `fill` returns that it has not written all.
    ///
    /// # Errors
    /// [`Error::Device`] of work that failed before.
    pub(crate) fn keep_filled(
        &self,
        bytes: usize,
        fill: &dyn Fn(&mut [u8]) -> bool,
    ) -> Result<Option<Arc<dyn AsRef<[u8]> + Send + Sync>>, Error> {
        #[cfg(feature = "cuda")]
        if let Machine::Cuda(c) = &*self.machine
            && bytes > 0
            && let Some((kept, is_whole)) = c.keep_filled(bytes, fill)?
        {
            return Ok(is_whole.then(|| Arc::new(Kept(Bytes::Locked(kept))) as _));
        }
        let mut is_whole = false;
        let kept = Kept::copied(bytes, |to| {
            is_whole = fill(to);
            Ok::<_, Error>(())
        })?;
        Ok(is_whole.then(|| Arc::new(kept) as _))
    }
}

impl AsRef<[u8]> for Kept {
    fn as_ref(&self) -> &[u8] {
        self.bytes()
    }
}

impl<T: Pod> Buffer<T> {
    /// Keeps the first `len` elements; waits for all work started before, unless they were read
    /// ahead to be kept.
    ///
    /// # Errors
    /// As for [`Buffer::read`].
    ///
    /// # Panics
    /// If the buffer has fewer elements: a fault of the caller.
    pub fn keep(&self, len: usize) -> Result<Kept, Error> {
        assert!(len <= self.len, "more items than the buffer has elements");
        self.usage.waits("memory was kept by the host")?;
        let bytes = len * size_of::<T>();
        if bytes == 0 {
            return Kept::copied(0, |_| Ok(()));
        }
        match (&self.memory, &*self.machine) {
            (Memory::Host(m), _) => {
                self.ledger.read(self.purpose, bytes as u64);
                Kept::copied(bytes, |to| {
                    to.copy_from_slice(m.as_slice(bytes));
                    Ok(())
                })
            }
            #[cfg(feature = "cuda")]
            (Memory::Gpu(m), Machine::Cuda(c)) => {
                let (kept, copied) = c.keep(m, bytes)?;
                self.ledger.read(self.purpose, copied as u64);
                match kept {
                    // A large block would be kept for few bytes.
                    Some(kept) if kept.block() / WASTEFUL > bytes.max(LITTLE) => Kept::copied(bytes, |to| {
                        to.copy_from_slice(kept.bytes());
                        Ok(())
                    }),
                    Some(kept) => Ok(Kept(Bytes::Locked(kept))),
                    // There is no more page-locked memory.
                    None => Kept::copied(bytes, |to| c.read(m, to)),
                }
            }
            #[cfg(feature = "cuda")]
            _ => Err(Error::Bug { what: "memory of another machine".into() }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::emulator::{Emulator, Mode};

    #[test]
    fn bytes_are_kept_while_the_device_goes_on() {
        let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"));
        let mut buffer = device.upload(&[[1u32, 2, 3], [4, 5, 6], [7, 8, 9]]).expect("memory");
        let kept = [0, 1, 2].map(|len| buffer.keep(len).expect("kept"));
        buffer.write(&[[0; 3]; 3]).expect("nothing forbids it");
        drop(buffer);
        let there = kept.each_ref().map(|kept| bytemuck::cast_slice::<u8, u32>(kept.bytes()));
        assert_eq!(there, [&[][..], &[1, 2, 3], &[1, 2, 3, 4, 5, 6]]);
    }

    #[test]
    fn the_host_fills_bytes_and_keeps_them() {
        let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"));
        let filled = |bytes, is_whole| {
            let fill = |to: &mut [u8]| {
                to.fill(7);
                is_whole
            };
            device.keep_filled(bytes, &fill).expect("no machine fails")
        };
        for bytes in [0, 1, 20] {
            assert_eq!((*filled(bytes, true).expect("all")).as_ref(), vec![7; bytes]);
            assert!(filled(bytes, false).is_none());
        }
    }
}
