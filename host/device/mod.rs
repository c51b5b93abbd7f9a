//! Where kernels run: an NVIDIA card, or the CPU.

#[cfg(feature = "cuda")]
mod cuda;
#[cfg(all(feature = "cuda", target_os = "linux"))]
mod driver;
pub mod emulator;
#[cfg(any(feature = "cuda", test))]
mod ptx;
#[cfg(feature = "cuda")]
mod staging;
mod view;

pub use view::{Ahead, View};

use crate::error::Error;
use crate::query::named;
use crate::words::counted;
use bytemuck::Pod;
use emulator::{Emulator, Mode};
use nearmiss_kernels::abi::Span;
use nearmiss_kernels::entry::Entry;
use std::cell::Cell;
use std::marker::PhantomData;
use std::rc::Rc;
use std::time::Instant;

named! {
    /// Which machine to take.
    pub enum Backend {
        /// The CPU, on all its cores.
        Cpu = "cpu",
        /// The NVIDIA card.
        Cuda = "cuda",
        /// The card where there is one, else the CPU.
        Auto = "auto",
    }
}

impl Default for Backend {
    fn default() -> Self {
        Backend::Auto
    }
}

/// A machine that runs kernels, and its memory. One thread uses it; clones are the same machine.
#[derive(Clone)]
pub struct Device {
    machine: Rc<Machine>,
    tally: Rc<Tally>,
}

enum Machine {
    Emulator(Emulator),
    #[cfg(feature = "cuda")]
    Cuda(cuda::Cuda),
}

/// What a device has been asked for.
#[derive(Default)]
struct Tally {
    launches: Cell<u64>,
    bytes: Cell<u64>,
    peak: Cell<u64>,
    /// Views of memory that the host holds now.
    views: Cell<u64>,
    /// Most bytes that may be held; `None` for what the machine has.
    most: Cell<Option<u64>>,
}

impl Device {
    /// The machine that `backend` names; `threads` of the CPU, or all.
    ///
    /// # Errors
    /// [`Error::Device`] when there is no such machine or its driver refuses, with the driver's text;
    /// [`Error::Stamp`] when the card's kernels come from other sources.
    pub fn open(backend: Backend, threads: Option<usize>) -> Result<Device, Error> {
        match backend {
            Backend::Cpu => Ok(Self::emulator(Emulator::new(Mode::Engine, threads)?)),
            #[cfg(feature = "cuda")]
            Backend::Cuda => Ok(Self::with(Machine::Cuda(cuda::Cuda::new()?))),
            #[cfg(not(feature = "cuda"))]
            Backend::Cuda => Err(Error::Device {
                what: "opening the card".into(),
                text: "this program was built without the feature `cuda`".into(),
                advice: "build it with `--features cuda`, or run with `--backend cpu`",
            }),
            Backend::Auto if cfg!(feature = "cuda") => match Self::open(Backend::Cuda, threads) {
                // No card is what `auto` is for; a card that refuses our kernels is a fault to hear of.
                Err(Error::Device { .. }) => Self::open(Backend::Cpu, threads),
                other => other,
            },
            Backend::Auto => Self::open(Backend::Cpu, threads),
        }
    }

    /// An emulator, for example one under the microscope.
    pub fn emulator(emulator: Emulator) -> Device {
        Self::with(Machine::Emulator(emulator))
    }

    /// The same machine with no more than `bytes` of memory, whatever it has; of its clones too.
    pub fn limited(self, bytes: u64) -> Device {
        self.tally.most.set(Some(bytes));
        self
    }

    fn with(machine: Machine) -> Device {
        Device { machine: Rc::new(machine), tally: Rc::default() }
    }

    /// What the machine calls itself.
    pub fn name(&self) -> String {
        match &*self.machine {
            Machine::Emulator(e) if e.microscope().is_some() => "CPU, under the microscope".into(),
            Machine::Emulator(e) => format!("CPU, {}", counted(e.threads() as u64, "thread", "threads")),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.name().into(),
        }
    }

    /// `cpu` or `cuda`.
    pub fn backend(&self) -> &'static str {
        if self.is_card() { "cuda" } else { "cpu" }
    }

    /// Whether this is a card: thousands of lanes at once, and launches that cost microseconds.
    pub fn is_card(&self) -> bool {
        !matches!(&*self.machine, Machine::Emulator(_))
    }

    /// Lanes of a block of a kernel on this machine.
    pub fn lanes<E: Entry>(&self) -> u32 {
        match &*self.machine {
            Machine::Emulator(e) => e.lanes::<E>(),
            #[cfg(feature = "cuda")]
            Machine::Cuda(_) => E::LANES,
        }
    }

    /// Blocks for `items` items, a lane each.
    pub fn blocks_for<E: Entry>(&self, items: usize) -> u32 {
        // Item counts are below 2^32, so block counts are too.
        items.div_ceil(self.lanes::<E>() as usize) as u32
    }

    /// Blocks for up to `room` items whose number only the device knows: enough to fill the machine, and the kernel
    /// strides over the rest.
    pub fn blocks_striding<E: Entry>(&self, room: usize) -> u32 {
        let full = match &*self.machine {
            Machine::Emulator(e) => 64 * e.threads() as u32,
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.resident_blocks(E::LANES),
        };
        self.blocks_for::<E>(room).clamp(1, full)
    }

    /// Blocks for up to `room` items whose number only the device knows, no more than run at once: for kernels whose
    /// lanes draw items until there are no more.
    ///
    /// # Errors
    /// Those of the device.
    pub fn blocks_at_once<E: Entry>(&self, room: usize) -> Result<u32, Error> {
        let full = match &*self.machine {
            Machine::Emulator(_) => self.blocks_striding::<E>(room),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.blocks_at_once::<E>()?,
        };
        Ok(self.blocks_for::<E>(room).clamp(1, full.max(1)))
    }

    /// Memory for `len` elements: zeroed (poisoned under the microscope).
    ///
    /// # Errors
    /// [`Error::Room`] when the machine has no more, or may use no more: see [`Device::limited`].
    pub fn buffer<T: Pod>(&self, len: usize) -> Result<Buffer<T>, Error> {
        let bytes = len.checked_mul(size_of::<T>()).ok_or(Error::Room {
            what: "device memory".into(),
            asked: u64::MAX,
            given: isize::MAX as u64,
        })?;
        let t = &self.tally;
        let given = t.most.get().map_or(u64::MAX, |most| most.saturating_sub(t.bytes.get()));
        if bytes as u64 > given {
            return Err(Error::Room { what: "device memory, as limited".into(), asked: bytes as u64, given });
        }
        let memory = match &*self.machine {
            Machine::Emulator(e) => Memory::Host(e.memory(bytes)?),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => Memory::Card(c.memory(bytes)?),
        };
        t.bytes.set(t.bytes.get() + bytes as u64);
        t.peak.set(t.peak.get().max(t.bytes.get()));
        Ok(Buffer {
            memory,
            len,
            machine: self.machine.clone(),
            tally: self.tally.clone(),
            element: PhantomData,
        })
    }

    /// Memory that holds `items`.
    ///
    /// # Errors
    /// As for [`Device::buffer`], and [`Error::Device`] when the transfer fails.
    pub fn upload<T: Pod>(&self, items: &[T]) -> Result<Buffer<T>, Error> {
        let mut buffer = self.buffer(items.len())?;
        buffer.write(items)?;
        Ok(buffer)
    }

    /// Starts a kernel behind all that was started before.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text; [`Error::Bug`] under the microscope, and while there is a [`View`].
    ///
    /// # Safety
    /// The spans of `args` are of buffers of this device that live until the launch is done (dropping a buffer waits), and
    /// what the kernel's card asks under "Before" holds.
    pub unsafe fn launch<E: Entry>(&self, blocks: u32, args: &E::Args) -> Result<(), Error> {
        if blocks == 0 {
            return Ok(());
        }
        // The memory under a view must not change.
        if self.tally.views.get() > 0 {
            return Err(Error::Bug {
                what: format!("{} was launched while the host looks at memory", E::NAME),
            });
        }
        self.tally.launches.set(self.tally.launches.get() + 1);
        match &*self.machine {
            Machine::Emulator(e) => e.launch::<E>(blocks, args),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.launch::<E>(blocks, args),
        }
    }

    /// A point in the stream of work, to measure from or to.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    pub fn mark(&self) -> Result<Mark, Error> {
        match &*self.machine {
            Machine::Emulator(_) => Ok(Mark::Host(Instant::now())),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => Ok(Mark::Card(c.mark()?)),
        }
    }

    /// How many kernels were launched so far.
    pub fn launches(&self) -> u64 {
        self.tally.launches.get()
    }

    /// Bytes of device memory held now, and the most held at once.
    pub fn bytes(&self) -> (u64, u64) {
        (self.tally.bytes.get(), self.tally.peak.get())
    }
}

/// A point in the stream of work.
pub enum Mark {
    /// On the CPU.
    Host(Instant),
    /// On the card.
    #[cfg(feature = "cuda")]
    Card(cuda::Event),
}

impl Mark {
    /// Milliseconds from this mark to a later one; waits for it.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    pub fn to(&self, later: &Mark) -> Result<f64, Error> {
        match (self, later) {
            (Mark::Host(a), Mark::Host(b)) => Ok(b.duration_since(*a).as_secs_f64() * 1e3),
            #[cfg(feature = "cuda")]
            (Mark::Card(a), Mark::Card(b)) => a.to(b),
            #[cfg(feature = "cuda")]
            _ => Err(Error::Bug { what: "two marks of different machines".into() }),
        }
    }
}

enum Memory {
    Host(emulator::Memory),
    #[cfg(feature = "cuda")]
    Card(cuda::Memory),
}

/// Elements of `T` in a device's memory. Freed when dropped.
pub struct Buffer<T> {
    memory: Memory,
    len: usize,
    machine: Rc<Machine>,
    tally: Rc<Tally>,
    element: PhantomData<T>,
}

impl<T: Pod> Buffer<T> {
    /// How many elements.
    pub fn len(&self) -> usize {
        self.len
    }
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }
    /// What a kernel is given.
    pub fn span(&self) -> Span<T> {
        let addr = match &self.memory {
            Memory::Host(m) => m.addr(),
            #[cfg(feature = "cuda")]
            Memory::Card(m) => m.addr(),
        };
        // SAFETY: so many elements of zeroed memory of this device, aligned for any of them; what the kernels are given must
        // live as long as they run, which who launches them promises.
        unsafe { Span::new(addr, self.len as u64) }
    }

    /// Sets the first elements, behind all that was started before.
    ///
    /// # Errors
    /// [`Error::Device`] when the transfer fails.
    ///
    /// # Panics
    /// When there are more items than elements: a fault of the caller.
    pub fn write(&mut self, items: &[T]) -> Result<(), Error> {
        assert!(items.len() <= self.len, "more items than the buffer has elements");
        let bytes: &[u8] = bytemuck::cast_slice(items);
        match (&mut self.memory, &*self.machine) {
            (Memory::Host(m), Machine::Emulator(e)) => {
                m.as_mut_slice(bytes.len()).copy_from_slice(bytes);
                if let Some(microscope) = e.microscope() {
                    microscope.host_wrote(m.addr(), bytes.len());
                }
                Ok(())
            }
            #[cfg(feature = "cuda")]
            (Memory::Card(m), Machine::Cuda(c)) => c.write(m, bytes),
            #[cfg(feature = "cuda")]
            _ => Err(Error::Bug { what: "memory of another machine".into() }),
        }
    }

    /// Sets every byte to zero, behind all that was started before.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    pub fn clear(&mut self) -> Result<(), Error> {
        match (&mut self.memory, &*self.machine) {
            #[cfg(feature = "cuda")]
            (Memory::Card(m), Machine::Cuda(c)) => c.clear(m),
            _ => self.write(&vec![T::zeroed(); self.len]),
        }
    }

    /// The first `len` elements; waits for all that was started before.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text, also of a kernel that failed before.
    ///
    /// # Panics
    /// When the buffer has fewer elements: a fault of the caller.
    pub fn read(&self, len: usize) -> Result<Vec<T>, Error> {
        assert!(len <= self.len, "more items than the buffer has elements");
        match (&self.memory, &*self.machine) {
            (Memory::Host(m), _) => Ok(bytemuck::cast_slice(m.as_slice(len * size_of::<T>())).to_vec()),
            #[cfg(feature = "cuda")]
            (Memory::Card(m), Machine::Cuda(c)) => {
                let mut items = vec![T::zeroed(); len];
                c.read(m, bytemuck::cast_slice_mut(&mut items))?;
                Ok(items)
            }
            #[cfg(feature = "cuda")]
            _ => Err(Error::Bug { what: "memory of another machine".into() }),
        }
    }
}

impl<T> Drop for Buffer<T> {
    fn drop(&mut self) {
        let bytes = (self.len * size_of::<T>()) as u64;
        self.tally.bytes.set(self.tally.bytes.get() - bytes);
        if let (Memory::Host(m), Machine::Emulator(e)) = (&self.memory, &*self.machine)
            && let Some(microscope) = e.microscope()
        {
            microscope.forget(m.addr());
        }
    }
}
