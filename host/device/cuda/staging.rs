//! Page-locked memory for transfers: copies run concurrently with the host. The results that every
//! frame needs are read ahead, all with one wait.

use super::context::{Bound, Context};
use super::driver::refused;
use super::memory::{Locked, Memory};
use super::stream::Stream;
use crate::error::Error;
use std::sync::Arc;

/// Initial size in bytes, and the largest piece of an upload.
const FIRST: usize = 8 << 20;
const PIECE: usize = 4 << 20;
/// Maximum size in bytes. It grows up to this for reading ahead; more is read on demand, in pieces.
const MOST: usize = 256 << 20;
/// Alignment of a copy: enough for every element.
const ALIGN: usize = 256;

/// The memory. Copies before `used` may still be in progress. A reader of bytes that were read
/// ahead holds it too.
pub struct Staging {
    context: Arc<Context>,
    memory: Arc<Locked>,
    used: usize,
    ahead: Vec<Ahead>,
    /// The stream's epoch when `ahead` was read.
    epoch: u64,
}

/// The first bytes of a buffer of the GPU.
struct Ahead {
    addr: u64,
    at: usize,
    bytes: usize,
}

/// Bytes that were read ahead. While there are some, nothing else is transferred through the
/// memory.
pub struct Known {
    memory: Arc<Locked>,
    at: usize,
    bytes: usize,
}

impl Known {
    /// The bytes.
    pub fn bytes(&self) -> &[u8] {
        self.memory.piece(self.at, self.bytes)
    }
}

fn locked(context: &Arc<Context>, gpu: &Bound, bytes: usize) -> Result<Arc<Locked>, Error> {
    Locked::new(context, gpu, bytes).map(Arc::new).map_err(refused("locking host memory"))
}

impl Staging {
    /// Allocates the memory.
    pub fn new(context: &Arc<Context>, gpu: &Bound) -> Result<Staging, Error> {
        let memory = locked(context, gpu, FIRST)?;
        Ok(Staging { context: context.clone(), memory, used: 0, ahead: Vec::new(), epoch: 0 })
    }

    /// Whether the host still reads bytes that were read ahead.
    pub fn is_looked_at(&mut self) -> bool {
        self.own().is_err()
    }

    /// The memory, if nothing reads it. Only `known` shares it, so this holds as long as `self` is
    /// borrowed.
    fn own(&mut self) -> Result<&mut Locked, Error> {
        let seen = || Error::Bug { what: "a transfer while the host reads another".into() };
        Arc::get_mut(&mut self.memory).ok_or_else(seen)
    }

    /// The start of this number of free bytes. Waits for copies in progress only if no space is
    /// left. Allocates only if the memory was always too small.
    fn room(&mut self, gpu: &Bound, stream: &Stream, bytes: usize) -> Result<usize, Error> {
        let wanted = bytes.next_multiple_of(ALIGN);
        let there = self.own()?.len();
        if self.used + wanted > there {
            stream.wait(gpu).map_err(refused("waiting for copies"))?;
            self.used = 0;
            self.ahead.clear();
            if wanted > there {
                self.memory = locked(&self.context, gpu, wanted.next_power_of_two())?;
            }
        }
        let at = self.used;
        self.used += wanted;
        Ok(at)
    }

    /// Copies bytes to the GPU after all work started before; waits only for space.
    pub fn write(
        &mut self,
        gpu: &Bound,
        stream: &Stream,
        to: &mut Memory,
        bytes: &[u8],
    ) -> Result<(), Error> {
        for (piece, start) in bytes.chunks(PIECE).zip((0..).step_by(PIECE)) {
            let at = self.room(gpu, stream, piece.len())?;
            let from = self.own()?.piece_mut(at, piece.len());
            from.copy_from_slice(piece);
            // SAFETY: this space is not accessed again before the stream was waited for (`room`),
            // nor freed (the GPU's drop waits).
            unsafe { to.write(gpu, stream, start, from) }.map_err(refused("copying to the GPU"))?;
        }
        Ok(())
    }

    /// Starts the copy of a part of a buffer; returns its destination.
    fn start(
        &mut self,
        gpu: &Bound,
        stream: &Stream,
        from: &Memory,
        (start, bytes): (usize, usize),
    ) -> Result<usize, Error> {
        let at = self.room(gpu, stream, bytes)?;
        let to = self.own()?.piece_mut(at, bytes);
        // SAFETY: nothing reads this space before the stream was waited for, which every caller
        // does. Otherwise as in `write`.
        unsafe { from.read(gpu, stream, start, to) }.map_err(refused("copying from the GPU"))?;
        Ok(at)
    }

    /// Waits for all work before. Then all space is free, except that of bytes that were read
    /// ahead.
    fn wait(&mut self, gpu: &Bound, stream: &Stream) -> Result<(), Error> {
        stream.wait(gpu).map_err(refused("copying from the GPU"))?;
        self.used = self.ahead.iter().map(|a| (a.at + a.bytes).next_multiple_of(ALIGN)).max().unwrap_or(0);
        Ok(())
    }

    /// Copies bytes from the GPU, in pieces; waits for all work before.
    pub fn read(
        &mut self,
        gpu: &Bound,
        stream: &Stream,
        from: &Memory,
        bytes: &mut [u8],
    ) -> Result<(), Error> {
        for (piece, start) in bytes.chunks_mut(PIECE).zip((0..).step_by(PIECE)) {
            let at = self.start(gpu, stream, from, (start, piece.len()))?;
            self.wait(gpu, stream)?;
            piece.copy_from_slice(self.memory.piece(at, piece.len()));
        }
        if bytes.is_empty() { self.wait(gpu, stream) } else { Ok(()) }
    }

    /// Copies the first bytes of several buffers from the GPU with one wait, if they fit; waits for
    /// all work before in any case. They are valid for that epoch.
    pub fn read_ahead(
        &mut self,
        gpu: &Bound,
        stream: &Stream,
        epoch: u64,
        all: &[(&Memory, usize)],
    ) -> Result<(), Error> {
        self.own()?;
        self.ahead.clear();
        let sum: usize = all.iter().map(|(_, bytes)| bytes.next_multiple_of(ALIGN)).sum();
        if sum > MOST {
            return self.wait(gpu, stream);
        }
        // Space for all at once, so that no copy takes the space of another.
        let whole = self.room(gpu, stream, sum)?;
        self.used = whole;
        let mut ahead = Vec::with_capacity(all.len());
        for (memory, bytes) in all.iter().filter(|(_, bytes)| *bytes > 0) {
            let at = self.start(gpu, stream, memory, (0, *bytes))?;
            ahead.push(Ahead { addr: memory.addr(), at, bytes: *bytes });
        }
        (self.ahead, self.epoch) = (ahead, epoch);
        // Bytes whose wait failed are not valid.
        self.wait(gpu, stream).inspect_err(|_| self.ahead.clear())
    }

    /// The first bytes of the buffer at `addr`, if they were read ahead in this epoch.
    pub fn known(&self, epoch: u64, addr: u64, bytes: usize) -> Option<Known> {
        let fits = |a: &&Ahead| self.epoch == epoch && a.addr == addr && a.bytes >= bytes;
        let found = self.ahead.iter().find(fits)?;
        Some(Known { memory: self.memory.clone(), at: found.at, bytes })
    }
}
