//! Answers in page-locked memory. The GPU copies into a block, and the answer keeps it. A block
//! that no answer keeps is used again: frames allocate nothing, and touch no fresh pages.

use super::context::{Bound, Context};
use super::driver::refused;
use super::memory::{Locked, Memory};
use super::stream::Stream;
use crate::error::Error;
use crate::memory;
use std::sync::Arc;

/// Least size of a block, in bytes.
const LEAST: usize = 1 << 16;
/// Size from which on a block has an eighth more than the answer, in bytes; below, it is a power of
/// two.
const LARGE: usize = 64 << 20;
/// Most blocks that no answer keeps. The ones that were used least recently are freed.
const SPARE: usize = 16;
/// Most bytes of them. One block of any size is kept.
const SPARE_BYTES: usize = 1 << 30;
/// Size from which on no new block is made for bytes that are read ahead: the answer may be refused.
const CHECKED: usize = 16 << 20;

/// Bytes of a block.
pub struct Kept {
    memory: Arc<Locked>,
    bytes: usize,
}

impl Kept {
    /// The bytes.
    pub fn bytes(&self) -> &[u8] {
        self.memory.piece(0, self.bytes)
    }

    /// Bytes of the block, of which the answer may use few.
    pub fn block(&self) -> usize {
        self.memory.len()
    }
}

/// The first bytes of a buffer of the GPU, in a block of their own.
struct Ahead {
    addr: u64,
    memory: Arc<Locked>,
    bytes: usize,
}

/// All blocks: those that answers keep, and others.
pub struct Blocks {
    context: Arc<Context>,
    /// Each once here, and once with the answer that keeps it.
    blocks: Vec<Arc<Locked>>,
    ahead: Vec<Ahead>,
    /// The stream's epoch when `ahead` was read.
    epoch: u64,
}

impl Blocks {
    /// No blocks.
    pub fn new(context: &Arc<Context>) -> Blocks {
        Blocks { context: context.clone(), blocks: Vec::new(), ahead: Vec::new(), epoch: 0 }
    }

    /// The smallest block that no answer keeps and that has room, taken out of the list.
    fn free(&mut self, bytes: usize) -> Option<Arc<Locked>> {
        let fits = |(_, block): &(usize, &Arc<Locked>)| is_free(block) && block.len() >= bytes;
        let found = self.blocks.iter().enumerate().filter(fits).min_by_key(|(_, block)| block.len());
        found.map(|(at, _)| at).map(|at| self.blocks.remove(at))
    }

    /// A free block, or a new one; nothing if the host or the driver has no memory for it.
    fn take(&mut self, gpu: &Bound, stream: &Stream, bytes: usize) -> Result<Option<Arc<Locked>>, Error> {
        let found = self.free(bytes);
        self.trim(gpu, stream)?;
        let size = if bytes < LARGE { bytes.max(LEAST).next_power_of_two() } else { bytes + bytes / 8 };
        Ok(found.or_else(|| {
            memory::require("the rows of an answer", size as u64).ok()?;
            Locked::new(&self.context, gpu, size).ok().map(Arc::new)
        }))
    }

    /// Frees the blocks that too many are left over.
    fn trim(&mut self, gpu: &Bound, stream: &Stream) -> Result<(), Error> {
        let (mut count, mut bytes, mut surplus) = (0, 0, Vec::new());
        // The last ones were used most recently.
        for (at, block) in self.blocks.iter().enumerate().rev().filter(|(_, block)| is_free(block)) {
            (count, bytes) = (count + 1, bytes + block.len());
            if count > SPARE || (count > 1 && bytes > SPARE_BYTES) {
                surplus.push(at);
            }
        }
        if !surplus.is_empty() {
            // A copy that failed may still be in progress.
            stream.wait(gpu).map_err(refused("waiting for copies"))?;
        }
        surplus.into_iter().for_each(|at| drop(self.blocks.remove(at)));
        Ok(())
    }

    /// Bytes of the blocks that no answer keeps.
    pub fn spare(&self) -> u64 {
        let ahead = self.ahead.iter().map(|ahead| ahead.memory.len());
        let free = self.blocks.iter().filter(|block| is_free(block)).map(|block| block.len());
        free.chain(ahead).sum::<usize>() as u64
    }

    /// Forgets bytes that were read ahead. The caller reads others, in this epoch.
    pub fn forget(&mut self, epoch: u64) {
        self.ahead.clear();
        self.epoch = epoch;
    }

    /// Starts the copy of the first bytes of a buffer, if there is a block for them. The caller waits
    /// for the stream.
    pub fn start(&mut self, gpu: &Bound, stream: &Stream, from: &Memory, bytes: usize) -> Result<(), Error> {
        let found = if bytes < CHECKED { self.take(gpu, stream, bytes)? } else { self.free(bytes) };
        if let Some(mut memory) = found {
            let copied = copy(gpu, stream, from, 0..bytes, &mut memory);
            self.blocks.push(memory.clone());
            copied?;
            self.ahead.push(Ahead { addr: from.addr(), memory, bytes });
        }
        Ok(())
    }

    /// A block without another holder, for the host to write; nothing if there is no memory for it.
    pub fn room(&mut self, gpu: &Bound, stream: &Stream, bytes: usize) -> Result<Option<Arc<Locked>>, Error> {
        let found = self.take(gpu, stream, bytes)?;
        // A copy that failed may still be in progress.
        stream.wait(gpu).map_err(refused("waiting for copies"))?;
        Ok(found)
    }

    /// The first bytes of a block, which the host has written.
    pub fn keep_written(&mut self, memory: Arc<Locked>, bytes: usize) -> Kept {
        self.blocks.push(memory.clone());
        Kept { memory, bytes }
    }

    /// The first bytes of a buffer, and how many of them had to be copied: none if they were read
    /// ahead in this epoch. Nothing if there is no memory for them.
    pub fn keep(
        &mut self,
        gpu: &Bound,
        stream: &Stream,
        epoch: u64,
        (from, bytes): (&Memory, usize),
    ) -> Result<(Option<Kept>, usize), Error> {
        let at = self.ahead.iter().position(|ahead| self.epoch == epoch && ahead.addr == from.addr());
        let ahead = at.map(|at| self.ahead.swap_remove(at));
        let (mut memory, there) = match ahead.filter(|ahead| ahead.memory.len() >= bytes) {
            Some(ahead) => (ahead.memory, ahead.bytes),
            None => match self.take(gpu, stream, bytes)? {
                Some(memory) => (memory, 0),
                None => return Ok((None, 0)),
            },
        };
        // It has one holder while it is written.
        self.blocks.retain(|block| !Arc::ptr_eq(block, &memory));
        let copied = copy(gpu, stream, from, there.min(bytes)..bytes, &mut memory);
        self.blocks.push(memory.clone());
        copied?;
        if there < bytes {
            stream.wait(gpu).map_err(refused("copying from the GPU"))?;
        }
        Ok((Some(Kept { memory, bytes }), bytes.saturating_sub(there)))
    }
}

/// Whether no answer keeps a block, and no bytes were read ahead into it.
fn is_free(block: &Arc<Locked>) -> bool {
    Arc::strong_count(block) == 1
}

/// Starts the copy of a part of a buffer to the same part of a block that has one holder.
fn copy(
    gpu: &Bound,
    stream: &Stream,
    from: &Memory,
    part: std::ops::Range<usize>,
    to: &mut Arc<Locked>,
) -> Result<(), Error> {
    let seen = || Error::Bug { what: "a transfer while the host reads another".into() };
    let to = Arc::get_mut(to).ok_or_else(seen)?.piece_mut(part.start, part.len());
    if to.is_empty() {
        return Ok(());
    }
    // SAFETY: no answer has the block before the stream was waited for, which `keep` and the caller
    // of `start` do. A block is freed only after such a wait (`trim`, the GPU's drop).
    unsafe { from.read(gpu, stream, part.start, to) }.map_err(refused("copying from the GPU"))
}
