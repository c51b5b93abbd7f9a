//! Page-locked memory that transfers go through: copies run beside the host, and what a frame is sure to be asked for is
//! read ahead of being asked, all of it with one wait.

use super::cuda::refused;
use crate::error::Error;
use cust::memory::{AsyncCopyDestination, DeviceBuffer, LockedBuffer};
use cust::stream::Stream;

/// Bytes of it at first, and of the largest piece of an upload.
const FIRST: usize = 8 << 20;
const PIECE: usize = 4 << 20;
/// It grows up to so many bytes for what is read ahead; more is read when it is asked for, in pieces.
const MOST: usize = 256 << 20;
/// Where a copy may begin: enough for every element.
const ALIGN: usize = 256;

/// The memory. What lies before `used` may still be under way.
pub struct Staging {
    memory: LockedBuffer<u8>,
    used: usize,
    ahead: Vec<Ahead>,
    /// The stream's epoch when `ahead` was read.
    epoch: u64,
}

/// The first bytes of a buffer of the card.
struct Ahead {
    addr: u64,
    at: usize,
    bytes: usize,
}

fn locked(bytes: usize) -> Result<LockedBuffer<u8>, Error> {
    // SAFETY: a page-locked buffer of bytes; every byte is written before it is read.
    unsafe { LockedBuffer::uninitialized(bytes) }.map_err(refused("locking host memory"))
}

impl Staging {
    /// Takes the memory.
    pub fn new() -> Result<Staging, Error> {
        Ok(Staging { memory: locked(FIRST)?, used: 0, ahead: Vec::new(), epoch: 0 })
    }

    /// Where so many bytes are free. Waits for what is under way only where there is no more room, and takes more memory
    /// only where there never was.
    fn room(&mut self, stream: &Stream, bytes: usize) -> Result<usize, Error> {
        let wanted = bytes.next_multiple_of(ALIGN);
        if self.used + wanted > self.memory.len() {
            stream.synchronize().map_err(refused("waiting for copies"))?;
            self.used = 0;
            self.ahead.clear();
            if wanted > self.memory.len() {
                self.memory = locked(wanted.next_power_of_two())?;
            }
        }
        let at = self.used;
        self.used += wanted;
        Ok(at)
    }

    /// Copies bytes to the card behind all that was started before; waits for nothing but room.
    pub fn write(&mut self, stream: &Stream, to: &mut DeviceBuffer<u8>, bytes: &[u8]) -> Result<(), Error> {
        for (piece, start) in bytes.chunks(PIECE).zip((0..).step_by(PIECE)) {
            let at = self.room(stream, piece.len())?;
            let from = &mut self.memory[at..at + piece.len()];
            from.copy_from_slice(piece);
            let mut to = to.index(start..start + piece.len());
            // SAFETY: this room is not touched again before the stream was waited for (`room`), nor given back (the card's
            // drop waits); freeing the buffer waits for the stream's work on it.
            unsafe { to.async_copy_from(&*from, stream) }.map_err(refused("copying to the card"))?;
        }
        Ok(())
    }

    /// Starts the copy of a buffer's first bytes, and says where they will be.
    fn start(
        &mut self,
        stream: &Stream,
        from: &DeviceBuffer<u8>,
        (start, bytes): (usize, usize),
    ) -> Result<usize, Error> {
        let at = self.room(stream, bytes)?;
        let from = from.index(start..start + bytes);
        // SAFETY: nobody reads this room before the stream was waited for, which every caller does; else as in `write`.
        unsafe { from.async_copy_to(&mut self.memory[at..at + bytes], stream) }
            .map_err(refused("copying from the card"))?;
        Ok(at)
    }

    /// Waits for all work before: then all room is free, but for what was read ahead.
    fn wait(&mut self, stream: &Stream) -> Result<(), Error> {
        stream.synchronize().map_err(refused("copying from the card"))?;
        self.used = self.ahead.iter().map(|a| (a.at + a.bytes).next_multiple_of(ALIGN)).max().unwrap_or(0);
        Ok(())
    }

    /// Copies bytes from the card, in pieces; waits for all work before.
    pub fn read(&mut self, stream: &Stream, from: &DeviceBuffer<u8>, bytes: &mut [u8]) -> Result<(), Error> {
        for (piece, start) in bytes.chunks_mut(PIECE).zip((0..).step_by(PIECE)) {
            let at = self.start(stream, from, (start, piece.len()))?;
            self.wait(stream)?;
            piece.copy_from_slice(&self.memory[at..at + piece.len()]);
        }
        if bytes.is_empty() { self.wait(stream) } else { Ok(()) }
    }

    /// Copies the first bytes of several buffers from the card with one wait, where they fit; they hold for that epoch.
    pub fn read_ahead(
        &mut self,
        stream: &Stream,
        epoch: u64,
        all: &[(&super::cuda::Memory, usize)],
    ) -> Result<(), Error> {
        self.ahead.clear();
        let sum: usize = all.iter().map(|(_, bytes)| bytes.next_multiple_of(ALIGN)).sum();
        if sum > MOST {
            return Ok(());
        }
        // Room for all at once, so that none of it makes room for another.
        let whole = self.room(stream, sum)?;
        self.used = whole;
        let mut ahead = Vec::with_capacity(all.len());
        for (memory, bytes) in all.iter().filter(|(_, bytes)| *bytes > 0) {
            let at = self.start(stream, memory.buffer(), (0, *bytes))?;
            ahead.push(Ahead { addr: memory.addr(), at, bytes: *bytes });
        }
        (self.ahead, self.epoch) = (ahead, epoch);
        self.wait(stream)
    }

    /// The first bytes of the buffer at `addr`, if they were read ahead in this epoch.
    pub fn known(&self, epoch: u64, addr: u64, bytes: usize) -> Option<&[u8]> {
        let fits = |a: &&Ahead| self.epoch == epoch && a.addr == addr && a.bytes >= bytes;
        self.ahead.iter().find(fits).map(|a| &self.memory[a.at..a.at + bytes])
    }
}
