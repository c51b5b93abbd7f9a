//! Replay of work that is the same frame after frame.
//! A frame's launches are listed first. If the list equals the last one, a GPU launches it as one
//! graph. Changes need no report: another list is another frame.

#[cfg(feature = "cuda")]
use super::cuda;
use super::held::{self, LaunchesOnly};
use super::{Device, Event, Machine};
use crate::error::Error;
use nearmiss_kernels::entry::Entry;
use std::sync::atomic::Ordering;

/// One step of a device's work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Act {
    /// A kernel launch.
    Launch {
        /// Name of the kernel.
        kernel: &'static str,
        /// Blocks, lanes per block, bytes of shared memory per block.
        grid: (u32, u32, u32),
        /// Start of its arguments, in words of the listing.
        args: usize,
    },
    /// A fill of memory.
    Fill {
        /// Address.
        addr: u64,
        /// Number of bytes.
        bytes: usize,
        /// Value of each byte.
        byte: u8,
    },
    /// The event of that number.
    Mark(usize),
    /// Steps from here to [`Act::Back`] come after earlier ones, and at the same time as later ones.
    Aside,
    /// See [`Act::Aside`].
    Back,
    /// Later steps come after all that went aside.
    Join,
    /// A point behind all that went aside so far.
    Flag,
    /// Later steps come after all that went aside before the last [`Act::Flag`].
    JoinFlag,
}

/// The steps of a device, in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Listing {
    acts: Vec<Act>,
    /// Arguments of all launches, each aligned to a word.
    args: Vec<u64>,
}

impl Listing {
    /// All steps, with the arguments of launches.
    #[cfg_attr(not(feature = "cuda"), allow(dead_code, reason = "a CPU does it at once"))]
    pub fn acts(&self) -> impl Iterator<Item = (Act, &[u64])> {
        self.acts.iter().map(|&act| match act {
            Act::Launch { args, .. } => (act, &self.args[args..]),
            Act::Fill { .. }
            | Act::Mark(_)
            | Act::Aside
            | Act::Back
            | Act::Join
            | Act::Flag
            | Act::JoinFlag => (act, [].as_slice()),
        })
    }

    /// Appends a launch.
    pub fn launch<E: Entry>(&mut self, blocks: u32, args: &E::Args) {
        const { assert!(align_of::<E::Args>() <= align_of::<u64>()) };
        let at = self.args.len();
        let bytes = bytemuck::bytes_of(args);
        self.args.resize(at + bytes.len().div_ceil(size_of::<u64>()), 0);
        bytemuck::cast_slice_mut(&mut self.args[at..])[..bytes.len()].copy_from_slice(bytes);
        let grid = (blocks, E::LANES, E::SHARED);
        self.acts.push(Act::Launch { kernel: E::NAME, grid, args: at });
    }

    /// Appends any other step.
    pub fn push(&mut self, act: Act) {
        self.acts.push(act);
    }

    fn clear(&mut self) {
        self.acts.clear();
        self.args.clear();
    }
}

/// Events in the work, to measure from and to.
pub struct Marks<'a> {
    device: &'a Device,
    events: &'a mut [Event],
}

impl Marks<'_> {
    /// Passes the event of that number.
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

/// The last frame's work, and its graph.
#[derive(Default)]
pub struct Replay {
    events: Vec<Event>,
    last: Listing,
    /// An unused listing, kept for its memory.
    spare: Listing,
    /// The graph of `last`, once the same work came twice.
    #[cfg(feature = "cuda")]
    graph: Option<cuda::Graph>,
}

impl Replay {
    /// A replay without work, with this number of events.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    pub fn new(device: &Device, marks: usize) -> Result<Replay, Error> {
        let events = (0..marks).map(|_| device.event()).collect::<Result<_, _>>()?;
        Ok(Replay { events, ..Replay::default() })
    }

    /// Milliseconds between two events that were passed; waits for the later one.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    pub fn ms(&self, from: usize, to: usize) -> Result<f64, Error> {
        self.events[from].to(&self.events[to])
    }

    /// Executes work without a list.
    ///
    /// # Errors
    /// Errors of the work.
    pub fn straight(
        &mut self,
        device: &Device,
        work: impl FnOnce(&mut Marks) -> Result<(), Error>,
    ) -> Result<(), Error> {
        work(&mut Marks { device, events: &mut self.events })
    }

    /// Executes work that only launches, clears and passes events. Work that equals the last is
    /// replayed as one graph.
    ///
    /// # Errors
    /// Errors of the work and of the device.
    ///
    /// # Safety
    /// The work frees no memory: it starts when this function returns, not when it is listed. The
    /// device is always the same.
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

    /// Executes a list, as a graph if it equals the last one.
    fn perform(&mut self, device: &Device, list: &Listing) -> Result<(), Error> {
        let is_same = *list == self.last;
        if is_same {
            device.usage.replays.fetch_add(1, Ordering::Relaxed);
        }
        match &*device.machine {
            // A CPU executed it while it was listed.
            Machine::Emulator(_) => Ok(()),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => {
                self.graph = self.graph.take().filter(|_| is_same);
                let marks: Vec<&cuda::Event> = self.events.iter().filter_map(Event::gpu).collect();
                if !is_same {
                    // SAFETY: the spans of this list are of live buffers: the promise of each
                    // launch, and of `run`.
                    return unsafe { c.perform(list, &marks) };
                }
                if self.graph.is_none() {
                    // SAFETY: as above. The graph is launched only after the same list, and `self`
                    // keeps its marks.
                    self.graph = Some(unsafe { c.record(list, &marks) }?);
                }
                self.graph.as_ref().map_or(Ok(()), |graph| c.replay(graph))
            }
        }
    }
}

impl Device {
    /// Says that launches follow soon.
    pub(crate) fn wake(&self) {
        match &*self.machine {
            Machine::Emulator(e) => e.wake(),
            #[cfg(feature = "cuda")]
            Machine::Cuda(_) => {}
        }
    }

    /// Does work at the same time as later work, until [`Device::join`] or [`Device::join_flag`].
    /// Neither needs what the other writes. It comes after all earlier work of this function. It is
    /// done in its turn on a CPU, outside a replay, and when stages are timed.
    ///
    /// # Errors
    /// Errors of the work.
    pub(crate) fn beside(&self, work: impl FnOnce() -> Result<(), Error>) -> Result<(), Error> {
        self.lists(Act::Aside);
        let done = work();
        self.lists(Act::Back);
        done
    }

    /// Later work comes after all work of [`Device::beside`].
    pub(crate) fn join(&self) {
        self.lists(Act::Join);
    }

    /// Notes a point behind all work of [`Device::beside`] so far.
    pub(crate) fn flag(&self) {
        self.lists(Act::Flag);
    }

    /// Later work comes after the work of [`Device::beside`] before the last [`Device::flag`]. Work
    /// of [`Device::beside`] behind that point goes on at the same time.
    pub(crate) fn join_flag(&self) {
        self.lists(Act::JoinFlag);
    }

    fn lists(&self, act: Act) {
        if !self.times_stages() {
            held::list(&self.usage, |list| list.push(act));
        }
    }

    /// Whether work may be listed. It may not be on the default stream, nor on one that its owner
    /// captures, which needs the work itself.
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
