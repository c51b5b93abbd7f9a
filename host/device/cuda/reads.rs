//! Reads of the GPU's memory, through page-locked memory.

use super::kept::Kept;
use super::memory::Memory;
use super::staging::Known;
use super::{Cuda, locked, refused};
use crate::error::Error;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// The first bytes of a buffer, to be read ahead.
pub struct First<'a> {
    /// The buffer.
    pub memory: &'a Memory,
    /// How many.
    pub bytes: usize,
    /// Whether an answer will keep them.
    pub is_kept: bool,
}

impl Cuda {
    /// Waits for all work so far.
    pub fn wait(&self) -> Result<(), Error> {
        self.stream.wait(&self.bind()?).map_err(refused("waiting for the GPU"))
    }

    /// Copies bytes from the GPU through page-locked memory; waits for all work before, unless they
    /// were read ahead.
    pub fn read(&self, memory: &Memory, bytes: &mut [u8]) -> Result<(), Error> {
        if let Some(known) = self.known(memory, bytes.len()) {
            bytes.copy_from_slice(known.bytes());
            return Ok(());
        }
        let gpu = self.bind()?;
        let mut staging = locked(&self.staging);
        if !staging.is_looked_at() {
            return staging.read(&gpu, &self.stream, memory, bytes);
        }
        drop(staging);
        // The host still reads other bytes that were read ahead, so this is a separate copy.
        self.stream.wait(&gpu).map_err(refused("waiting for the GPU"))?;
        memory.read_now(&gpu, bytes).map_err(refused("copying from the GPU"))
    }

    /// Copies the first bytes of several buffers with one wait, if they fit into page-locked
    /// memory. The next reads find them there.
    pub fn read_ahead(&self, all: &[First]) -> Result<(), Error> {
        let epoch = self.epoch.load(Ordering::Relaxed);
        let gpu = self.bind()?;
        let mut blocks = locked(&self.blocks);
        blocks.forget(epoch);
        let mut kept = all.iter().filter(|first| first.is_kept && first.bytes > 0);
        let started = kept.try_for_each(|first| blocks.start(&gpu, &self.stream, first.memory, first.bytes));
        let others = all.iter().filter(|first| !first.is_kept).map(|first| (first.memory, first.bytes));
        let others: Vec<_> = others.collect();
        let read =
            started.and_then(|()| locked(&self.staging).read_ahead(&gpu, &self.stream, epoch, &others));
        // Bytes whose wait failed are not valid.
        read.inspect_err(|_| blocks.forget(epoch))
    }

    /// The first bytes of a buffer, if they were read ahead and nothing has changed since.
    pub fn known(&self, memory: &Memory, bytes: usize) -> Option<Known> {
        locked(&self.staging).known(self.epoch.load(Ordering::Relaxed), memory.addr(), bytes)
    }

    /// Bytes of page-locked memory that later answers can use.
    pub fn spare(&self) -> u64 {
        locked(&self.blocks).spare()
    }

    /// The first bytes of a buffer, to be kept by the host, and how many were copied now. Nothing
    /// if there is no page-locked memory for them.
    pub fn keep(&self, memory: &Memory, bytes: usize) -> Result<(Option<Kept>, usize), Error> {
        let epoch = self.epoch.load(Ordering::Relaxed);
        locked(&self.blocks).keep(&self.bind()?, &self.stream, epoch, (memory, bytes))
    }

    /// Bytes that the host writes by `fill`, kept as those of [`Cuda::keep`], and what `fill` returns.
    /// Nothing if there is no page-locked memory for them.
    pub fn keep_filled(
        &self,
        bytes: usize,
        fill: &dyn Fn(&mut [u8]) -> bool,
    ) -> Result<Option<(Kept, bool)>, Error> {
        let Some(mut memory) = locked(&self.blocks).room(&self.bind()?, &self.stream, bytes)? else {
            return Ok(None);
        };
        let shared = || Error::Bug { what: "a new answer is in memory of another".into() };
        let is_whole = fill(Arc::get_mut(&mut memory).ok_or_else(shared)?.piece_mut(0, bytes));
        Ok(Some((locked(&self.blocks).keep_written(memory, bytes), is_whole)))
    }
}
