//! Work that is the same frame after frame. What a frame launches is listed first; where the list is that of the last time, a GPU is
//! given all of it at once, as a graph. Nobody has to say that something changed: another list is another frame.

#[cfg(feature = "cuda")]
use super::cuda;
use super::held::{self, LaunchesOnly};
use super::{Device, Event, Machine};
use crate::error::Error;
use nearmiss_kernels::entry::Entry;
use std::sync::atomic::Ordering;

/// Something that a device does in its turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Act {
    /// A kernel starts.
    Launch {
        /// Its name.
        kernel: &'static str,
        /// Blocks, lanes of each, bytes of shared memory of each.
        grid: (u32, u32, u32),
        /// Where its arguments begin, in words of the listing.
        args: usize,
    },
    /// Memory is set.
    Fill {
        /// Where.
        addr: u64,
        /// How many bytes.
        bytes: usize,
        /// To what.
        byte: u8,
    },
    /// A mark is passed.
    Mark(usize),
}

/// What a device is to do, in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Listing {
    acts: Vec<Act>,
    /// Arguments of all launches, each at a word's beginning.
    args: Vec<u64>,
}

impl Listing {
    /// All of it, with the arguments of launches.
    #[cfg_attr(not(feature = "cuda"), allow(dead_code, reason = "a CPU does it at once"))]
    pub fn acts(&self) -> impl Iterator<Item = (Act, &[u64])> {
        self.acts.iter().map(|&act| match act {
            Act::Launch { args, .. } => (act, &self.args[args..]),
            Act::Fill { .. } | Act::Mark(_) => (act, [].as_slice()),
        })
    }

    /// A launch behind what is there.
    pub fn launch<E: Entry>(&mut self, blocks: u32, args: &E::Args) {
        const { assert!(align_of::<E::Args>() <= align_of::<u64>()) };
        let at = self.args.len();
        let bytes = bytemuck::bytes_of(args);
        self.args.resize(at + bytes.len().div_ceil(size_of::<u64>()), 0);
        bytemuck::cast_slice_mut(&mut self.args[at..])[..bytes.len()].copy_from_slice(bytes);
        let grid = (blocks, E::LANES, E::SHARED);
        self.acts.push(Act::Launch { kernel: E::NAME, grid, args: at });
    }

    /// Anything else behind what is there.
    pub fn push(&mut self, act: Act) {
        self.acts.push(act);
    }

    fn clear(&mut self) {
        self.acts.clear();
        self.args.clear();
    }
}

/// Points in the work, to measure from and to.
pub struct Marks<'a> {
    device: &'a Device,
    events: &'a mut [Event],
}

impl Marks<'_> {
    /// The work comes by the mark of that number.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    pub fn pass(&mut self, which: usize) -> Result<(), Error> {
        if held::list(&self.device.usage, |list| list.push(Act::Mark(which))) && self.device.is_gpu() {
            return Ok(());
        }
        self.events[which].again(self.device)
    }
}

/// What was done the last time, and how it is done at once.
#[derive(Default)]
pub struct Replay {
    events: Vec<Event>,
    last: Listing,
    /// The memory of a listing.
    spare: Listing,
    /// Of `last`, once it was the same twice.
    #[cfg(feature = "cuda")]
    graph: Option<cuda::Graph>,
}

impl Replay {
    /// Nothing yet, with so many marks.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    pub fn new(device: &Device, marks: usize) -> Result<Replay, Error> {
        let events = (0..marks).map(|_| device.event()).collect::<Result<_, _>>()?;
        Ok(Replay { events, ..Replay::default() })
    }

    /// Milliseconds between two marks that were passed; waits for the later one.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    pub fn ms(&self, from: usize, to: usize) -> Result<f64, Error> {
        self.events[from].to(&self.events[to])
    }

    /// Does work as it comes.
    ///
    /// # Errors
    /// Those of the work.
    pub fn straight(
        &mut self,
        device: &Device,
        work: impl FnOnce(&mut Marks) -> Result<(), Error>,
    ) -> Result<(), Error> {
        work(&mut Marks { device, events: &mut self.events })
    }

    /// Does work that only launches, clears and passes marks; what it did the last time too, at once.
    ///
    /// # Errors
    /// Those of the work and of the device.
    ///
    /// # Safety
    /// The work gives no memory back: it is begun when this returns, not when it is told. The device is always the same.
    pub unsafe fn run(
        &mut self,
        device: &Device,
        work: impl FnOnce(&mut Marks) -> Result<(), Error>,
    ) -> Result<(), Error> {
        if !device.can_list()? {
            let _only = device.launches_only();
            return self.straight(device, work);
        }
        let mut list = std::mem::take(&mut self.spare);
        list.clear();
        let only = LaunchesOnly::new(&device.usage, Some(list));
        let done = self.straight(device, work);
        let list = only.listed();
        done?;
        self.perform(device, &list)?;
        self.spare = std::mem::replace(&mut self.last, list);
        Ok(())
    }

    /// Does what is listed, as a graph where it was the same the last time.
    fn perform(&mut self, device: &Device, list: &Listing) -> Result<(), Error> {
        let is_same = *list == self.last;
        if is_same {
            device.usage.replays.fetch_add(1, Ordering::Relaxed);
        }
        match &*device.machine {
            // It was done as it was listed.
            Machine::Emulator(_) => Ok(()),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => {
                self.graph = self.graph.take().filter(|_| is_same);
                let marks: Vec<&cuda::Event> = self.events.iter().filter_map(Event::gpu).collect();
                if !is_same {
                    // SAFETY: the spans of what was just listed are of buffers that live: the promise of who launched, and of `run`.
                    return unsafe { c.perform(list, &marks) };
                }
                if self.graph.is_none() {
                    // SAFETY: as above; it is launched where the same was just listed, and the marks are its neighbours here.
                    self.graph = Some(unsafe { c.record(list, &marks) }?);
                }
                self.graph.as_ref().map_or(Ok(()), |graph| c.replay(graph))
            }
        }
    }
}

impl Device {
    /// Whether work may be listed: not for the default stream, nor for one that its owner captures, which wants the work itself.
    fn can_list(&self) -> Result<bool, Error> {
        match &*self.machine {
            Machine::Emulator(_) => Ok(true),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.can_record(),
        }
    }
}

#[cfg(test)]
mod tests;
