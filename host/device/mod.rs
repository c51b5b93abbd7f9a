//! Machines that run kernels: an NVIDIA GPU, or the CPU.

mod answers;
mod buffer;
mod code;
#[cfg(feature = "cuda")]
mod cuda;
mod held;
mod interrupt;
mod ledger;
mod marks;
mod peers;
mod place;
mod replay;
mod shared;
mod usage;
mod view;

pub use buffer::Buffer;
pub use ledger::Count;
pub(crate) use ledger::Work;
pub use marks::Event;
#[doc(hidden)]
pub use nearmiss_emulator as emulator;
pub use nearmiss_emulator::{Interrupt, listen, listening};
pub(crate) use place::Place;
pub(crate) use replay::{Marks, Replay};
pub use shared::Owner;
pub use view::{Ahead, Kept, View};

use crate::error::Error;
use crate::memory;
use crate::query::named;
use crate::words::counted;
use buffer::Memory;
use bytemuck::Pod;
use emulator::{Emulator, Mode};
use ledger::Ledger;
use nearmiss_kernels::entry::Entry;
use std::marker::PhantomData;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use usage::Usage;

named! {
    /// Machine to use.
    pub enum Backend {
        /// The CPU, on all its cores.
        Cpu = "cpu",
        /// The NVIDIA GPU.
        Cuda = "cuda",
        /// The GPU if there is one, else the CPU.
        Auto = "auto",
    }
}

#[allow(clippy::derivable_impls, reason = "`named!` makes the enum, and takes no attribute of a variant")]
impl Default for Backend {
    fn default() -> Self {
        Backend::Auto
    }
}

/// A machine that runs kernels, and its memory. Any thread may use it, one at a time; clones are
/// the same machine. For concurrent work open one each.
#[derive(Clone)]
pub struct Device {
    machine: Arc<Machine>,
    usage: Arc<Usage>,
    ledger: Arc<Ledger>,
    /// Purpose of the next allocation.
    purpose: &'static str,
    /// The handle that ends its work early.
    interrupt: Option<Interrupt>,
}

enum Machine {
    Emulator(Emulator),
    #[cfg(feature = "cuda")]
    Cuda(cuda::Cuda),
}

impl Machine {
    fn is_gpu(&self) -> bool {
        !matches!(self, Machine::Emulator(_))
    }
}

impl Device {
    /// The first GPU, or `threads` threads of the CPU, by default and at most one a processor: more
    /// only wait for each other. [`Backend::Auto`] uses `threads` if there is no GPU.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for threads of a GPU; [`Error::Device`], with the driver's text,
    /// if there is none or it refuses; [`Error::KernelMismatch`] for kernels of other sources.
    pub fn open(backend: Backend, threads: Option<usize>) -> Result<Device, Error> {
        if let (Backend::Cuda, Some(threads)) = (backend, threads) {
            return Err(Error::InvalidArgument {
                what: format!("threads cannot be set for a GPU, got {threads}"),
                advice: "leave the threads out, or choose the CPU".into(),
            });
        }
        let processors = std::thread::available_parallelism().map_or(usize::MAX, usize::from);
        let threads = threads.map(|count| count.min(processors));
        match backend {
            Backend::Cpu => Ok(Self::emulator(Emulator::new(Mode::Engine, threads)?)),
            Backend::Cuda => Self::gpu(0),
            Backend::Auto if cfg!(feature = "cuda") => match Self::gpu(0) {
                // `auto` covers a missing GPU; a GPU that refuses our kernels is reported.
                Err(Error::Device { .. }) => Self::open(Backend::Cpu, threads),
                other => other,
            },
            Backend::Auto => Self::open(Backend::Cpu, threads),
        }
    }

    /// The GPU with that number, in the driver's order. It uses the GPU's primary context, which is
    /// shared in the program. Threads stay bound to the context that they were bound to.
    ///
    /// # Errors
    /// As for [`Device::open`]; if there is no such GPU, the text has the number of GPUs.
    #[cfg_attr(not(feature = "cuda"), allow(unused_variables, reason = "there is none"))]
    pub fn gpu(ordinal: u32) -> Result<Device, Error> {
        #[cfg(feature = "cuda")]
        return Ok(Self::with(Machine::Cuda(cuda::Cuda::new(ordinal)?)));
        #[cfg(not(feature = "cuda"))]
        Err(Error::Device {
            what: "opening the GPU".into(),
            text: "this program was built without the feature `cuda`".into(),
            advice: "build it with that feature, or run on the CPU",
        })
    }

    /// An emulator, for example one under the sanitizer.
    pub fn emulator(emulator: Emulator) -> Device {
        Self::with(Machine::Emulator(emulator))
    }

    /// The same machine with at most `bytes` of memory. Its clones have this limit too.
    pub fn with_memory_limit(self, bytes: u64) -> Device {
        self.usage.most.store(bytes, Ordering::Relaxed);
        self
    }

    fn with(machine: Machine) -> Device {
        let (usage, ledger) = (Arc::new(Usage::new()), Arc::new(Ledger::default()));
        Device { machine: Arc::new(machine), usage, ledger, purpose: "of no purpose", interrupt: None }
    }

    /// The same machine for one user, with counts of its own too.
    pub(crate) fn for_one(&self) -> Device {
        let interrupt = self.interrupt.clone().unwrap_or_default();
        Device { ledger: Arc::new(Ledger::default()), interrupt: Some(interrupt), ..self.clone() }
    }

    /// The same machine; its allocations are counted under that purpose.
    pub(crate) fn of(&self, purpose: &'static str) -> Device {
        Device { purpose, ..self.clone() }
    }

    /// Launches and transfers of this user since the last call.
    pub(crate) fn work(&self) -> Work {
        self.ledger.work()
    }

    /// Memory that this user holds, by purpose.
    pub(crate) fn held(&self) -> std::collections::BTreeMap<&'static str, Count> {
        self.ledger.held()
    }

    /// The machine's name.
    pub fn name(&self) -> String {
        match &*self.machine {
            Machine::Emulator(e) if e.sanitizer().is_some() => "CPU, under the sanitizer".into(),
            Machine::Emulator(e) => format!("CPU, {}", counted(e.threads() as u64, "thread", "threads")),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.name().into(),
        }
    }

    /// `cpu` or `cuda`.
    pub fn backend(&self) -> &'static str {
        if self.is_gpu() { "cuda" } else { "cpu" }
    }

    /// Whether both are clones of one device, which one thread uses at a time.
    pub(crate) fn is(&self, other: &Device) -> bool {
        Arc::ptr_eq(&self.machine, &other.machine)
    }

    /// Whether this is a GPU: thousands of lanes at once, and launches that cost microseconds.
    pub fn is_gpu(&self) -> bool {
        self.machine.is_gpu()
    }

    /// The GPU's number in the driver's order; `None` for a CPU.
    pub fn ordinal(&self) -> Option<u32> {
        match &*self.machine {
            Machine::Emulator(_) => None,
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => Some(c.ordinal()),
        }
    }

    /// The handle of the stream of all work (`CUstream`; 0 is the default one); `None` for a CPU.
    pub fn stream(&self) -> Option<u64> {
        match &*self.machine {
            Machine::Emulator(_) => None,
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => Some(c.stream()),
        }
    }

    /// Lanes of a block of a kernel on this machine.
    pub fn lanes<E: Entry>(&self) -> u32 {
        match &*self.machine {
            Machine::Emulator(e) => e.lanes::<E>(),
            #[cfg(feature = "cuda")]
            Machine::Cuda(_) => E::LANES,
        }
    }

    /// Blocks for `items` items, one lane each.
    pub fn blocks_for<E: Entry>(&self, items: usize) -> u32 {
        // Item counts are below 2^32, so block counts are too.
        items.div_ceil(self.lanes::<E>() as usize) as u32
    }

    /// Blocks for up to `room` items whose number only the device knows. They fill the machine, and
    /// the kernel strides over the remaining items.
    pub fn blocks_striding<E: Entry>(&self, room: usize) -> u32 {
        let full = match &*self.machine {
            Machine::Emulator(e) => 32 * e.threads() as u32,
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.resident_blocks(E::LANES),
        };
        self.blocks_for::<E>(room).clamp(1, full)
    }

    /// Blocks for up to `room` items whose number only the device knows, at most those that run at
    /// once. For kernels whose lanes draw items until none is left.
    ///
    /// # Errors
    /// Errors of the device.
    pub fn blocks_at_once<E: Entry>(&self, room: usize) -> Result<u32, Error> {
        self.blocks_at_once_in::<E>(Place::Whole, room)
    }

    /// The same, in a part of the device.
    ///
    /// # Errors
    /// Errors of the device.
    pub(crate) fn blocks_at_once_in<E: Entry>(&self, place: Place, room: usize) -> Result<u32, Error> {
        let full = match (&*self.machine, place) {
            (Machine::Emulator(_), _) => self.blocks_striding::<E>(room),
            #[cfg(feature = "cuda")]
            (Machine::Cuda(c), place) => c.blocks_at_once::<E>(place)?,
        };
        Ok(self.blocks_for::<E>(room).clamp(1, full.max(1)))
    }

    /// Allocates `len` elements: zeroed (poisoned under the sanitizer).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`] beyond the machine's memory or [`Device::with_memory_limit`].
    pub fn buffer<T: Pod>(&self, len: usize) -> Result<Buffer<T>, Error> {
        self.usage.allows("memory was taken")?;
        self.usage.allocations.fetch_add(1, Ordering::Relaxed);
        let bytes = len.checked_mul(size_of::<T>()).ok_or(Error::OutOfMemory {
            what: "device memory".into(),
            asked: (len as u64).saturating_mul(size_of::<T>() as u64),
            given: isize::MAX as u64,
        })?;
        let most = |given| Error::OutOfMemory {
            what: "device memory, as limited".into(),
            asked: bytes as u64,
            given,
        };
        self.usage.take(bytes as u64).map_err(most)?;
        let memory = match &*self.machine {
            Machine::Emulator(e) => memory::require("host memory", bytes as u64)
                .and_then(|()| e.memory(bytes).map(Memory::Host).map_err(Error::from)),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.memory(bytes).map(Memory::Gpu),
        };
        let memory = memory.inspect_err(|_| self.usage.give(bytes as u64))?;
        self.usage.peak.fetch_max(self.bytes().0, Ordering::Relaxed);
        self.ledger.takes(self.purpose, bytes as u64);
        Ok(Buffer {
            memory,
            len,
            machine: self.machine.clone(),
            usage: self.usage.clone(),
            ledger: self.ledger.clone(),
            purpose: self.purpose,
            element: PhantomData,
        })
    }

    /// Allocates a buffer that holds `items`.
    ///
    /// # Errors
    /// As for [`Device::buffer`], and [`Error::Device`] if the transfer fails.
    pub fn upload<T: Pod>(&self, items: &[T]) -> Result<Buffer<T>, Error> {
        let mut buffer = self.buffer(items.len())?;
        buffer.write(items)?;
        Ok(buffer)
    }

    /// Starts a kernel after all work started before.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text; [`Error::Interrupted`]; [`Error::Bug`] under the
    /// sanitizer, and while there is a [`View`].
    ///
    /// # Safety
    /// The spans of `args` are of buffers of this device that live until the kernel ends (dropping
    /// one waits). No other thread accesses them meanwhile. "Before" of the kernel's card holds.
    pub unsafe fn launch<E: Entry>(&self, blocks: u32, args: &E::Args) -> Result<(), Error> {
        if blocks == 0 {
            return Ok(());
        }
        // The memory under a view must not change.
        if self.usage.views.load(Ordering::Relaxed) > 0 {
            return Err(Error::Bug {
                what: format!("{} was launched while the host looks at memory", E::NAME),
            });
        }
        self.may_launch()?;
        self.usage.launches.fetch_add(1, Ordering::Relaxed);
        self.ledger.launched(E::NAME);
        #[cfg_attr(not(feature = "cuda"), allow(unused_variables, reason = "a CPU does it at once"))]
        let is_listed = held::list(&self.usage, |list| list.launch::<E>(blocks, args));
        match &*self.machine {
            Machine::Emulator(e) => {
                // SAFETY: the caller's promise. A CPU executes listed work at once.
                unsafe { e.launch::<E>(blocks, args, self.interrupt()) }.map_err(Error::from)
            }
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) if is_listed => c.load::<E>(),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.launch::<E>(blocks, args, held::is_held(&self.usage)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_moves_between_threads_with_its_memory() {
        fn send<T: Send>() {}
        send::<Device>();
        send::<Buffer<u64>>();
        send::<View<u64>>();
        send::<Event>();
        send::<crate::Detector>();
        let device = Device::open(Backend::Cpu, Some(1)).expect("a thread");
        let mut buffer = device.upload(&[1u32, 2, 3]).expect("memory");
        let there = std::thread::spawn(move || {
            buffer.write(&[4]).expect("written");
            (buffer, device)
        });
        let (buffer, device) = there.join().expect("no panic");
        assert_eq!(buffer.read(3).expect("read"), [4, 2, 3]);
        assert_eq!(device.bytes(), (12, 12));
        drop(buffer);
        assert_eq!(device.bytes(), (0, 12));
    }

    #[test]
    fn no_more_threads_than_processors_are_taken() {
        let processors = std::thread::available_parallelism().map_or(1, usize::from);
        for asked in [processors + 1, usize::MAX] {
            let device = Device::open(Backend::Cpu, Some(asked)).expect("threads");
            assert_eq!(device.name(), format!("CPU, {}", counted(processors as u64, "thread", "threads")));
        }
    }

    #[test]
    fn a_card_that_is_not_there_is_told() {
        let Err(error) = Device::gpu(u32::MAX) else { panic!("there is none of that number") };
        assert!(matches!(error, Error::Device { .. }) && error.exit_code() == 4, "{error:?}");
        if Device::gpu(0).is_ok() {
            assert!(error.to_string().starts_with("opening GPU 4294967295: there "), "{error}");
        }
    }
}
