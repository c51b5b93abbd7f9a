//! Events in the stream of work, and a device's counts.

#[cfg(feature = "cuda")]
use super::cuda;
use super::held::LaunchesOnly;
use super::{Device, Machine};
use crate::error::Error;
use std::fmt;
use std::sync::atomic::Ordering;
use std::time::Instant;

impl fmt::Debug for Device {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_struct("Device").field("backend", &self.backend()).field("name", &self.name()).finish()
    }
}

impl Device {
    /// An event in the stream of work, to measure from or to.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    pub fn event(&self) -> Result<Event, Error> {
        self.usage.allows("a mark was made")?;
        match &*self.machine {
            Machine::Emulator(_) => Ok(Event::Host(Instant::now())),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => Ok(Event::Gpu(c.event()?)),
        }
    }

    /// Waits for all work started before.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text, also of a kernel that failed before.
    pub fn wait(&self) -> Result<(), Error> {
        self.usage.waits("the device was waited for")?;
        match &*self.machine {
            Machine::Emulator(_) => Ok(()),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.wait(),
        }
    }

    /// Number of replays so far: frames with the same work as the frame before. A GPU launches it
    /// as one graph.
    pub fn replays(&self) -> u64 {
        self.usage.replays.load(Ordering::Relaxed)
    }

    /// Number of kernel launches so far.
    pub fn launches(&self) -> u64 {
        self.usage.launches.load(Ordering::Relaxed)
    }

    /// Number of allocations so far.
    pub fn allocations(&self) -> u64 {
        self.usage.allocations.load(Ordering::Relaxed)
    }

    /// Bytes copied from the host to the device's memory so far.
    pub fn uploaded(&self) -> u64 {
        self.usage.uploaded.load(Ordering::Relaxed)
    }

    /// Makes frames mark the time of each stage, or not. A mark in a graph costs a GPU 3 to 4
    /// microseconds.
    pub(crate) fn time_stages(&self, are_timed: bool) {
        self.usage.times_stages.store(are_timed, Ordering::Relaxed);
    }

    /// Whether frames mark the time of each stage: always on a CPU, where a mark costs nothing.
    pub(crate) fn times_stages(&self) -> bool {
        !self.is_gpu() || self.usage.times_stages.load(Ordering::Relaxed)
    }

    /// Number of times that the host waited for the device so far.
    pub fn waits(&self) -> u64 {
        self.usage.waits.load(Ordering::Relaxed)
    }

    /// Restricts this thread to launches and clears as long as the result lives: a stream that is
    /// being captured accepts those. Allocations, reads, writes and events are refused.
    pub(crate) fn launches_only(&self) -> LaunchesOnly {
        LaunchesOnly::new(&self.usage, None)
    }

    /// Marks the device's memory as changed by another party: a graph that was launched again.
    pub(crate) fn changed(&self) {
        #[cfg(feature = "cuda")]
        if let Machine::Cuda(c) = &*self.machine {
            c.changes();
        }
    }

    /// Bytes of device memory held now, and the maximum held at once.
    pub fn bytes(&self) -> (u64, u64) {
        (self.usage.bytes.load(Ordering::Relaxed), self.usage.peak.load(Ordering::Relaxed))
    }
}

/// An event in the stream of work.
pub enum Event {
    /// On the CPU.
    Host(Instant),
    /// On the GPU.
    #[cfg(feature = "cuda")]
    Gpu(cuda::Event),
}

impl Event {
    /// Moves the event after all work so far.
    pub(super) fn again(&mut self, device: &Device) -> Result<(), Error> {
        match (self, &*device.machine) {
            (Event::Host(at), _) => *at = Instant::now(),
            #[cfg(feature = "cuda")]
            (Event::Gpu(event), Machine::Cuda(c)) => c.mark(event)?,
            #[cfg(feature = "cuda")]
            _ => return Err(Error::Bug { what: "a mark of another machine".into() }),
        }
        Ok(())
    }

    /// The event of a GPU.
    #[cfg(feature = "cuda")]
    pub(super) fn gpu(&self) -> Option<&cuda::Event> {
        match self {
            Event::Gpu(event) => Some(event),
            Event::Host(_) => None,
        }
    }

    /// Milliseconds from this event to a later one; waits for that one.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    pub fn to(&self, later: &Event) -> Result<f64, Error> {
        match (self, later) {
            (Event::Host(a), Event::Host(b)) => Ok(b.duration_since(*a).as_secs_f64() * 1e3),
            #[cfg(feature = "cuda")]
            (Event::Gpu(a), Event::Gpu(b)) => a.to(b),
            #[cfg(feature = "cuda")]
            _ => Err(Error::Bug { what: "two marks of different machines".into() }),
        }
    }
}
