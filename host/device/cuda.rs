//! An NVIDIA card, through cust. The kernels' PTX is embedded; the driver compiles it for the card it finds.

use super::ptx::Parts;
use super::staging::Staging;
use crate::error::Error;
use cust::context::Context;
use cust::device::{Device as Card, DeviceAttribute};
use cust::error::CudaError;
use cust::event::{Event as CudaEvent, EventFlags};
use cust::function::{BlockSize, Function};
use cust::memory::{CopyDestination, DeviceBuffer};
use cust::module::{Module, ModuleJitOption};
use cust::stream::{Stream, StreamFlags};
use nearmiss_kernels::entry::Entry as Kernel;
use std::cell::{Cell, Ref, RefCell, RefMut};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::ffi::c_void;

/// The kernels, as build.rs found or made them.
const PTX: &str = include_str!(concat!(env!("OUT_DIR"), "/nearmiss.ptx"));
/// The stamp of the sources that this program was built with.
const STAMP: &str = env!("NEARMISS_STAMP");
/// The oldest card that the PTX is for: compute capability 8.0.
const CAPABILITY: (i32, i32) = (8, 0);

/// A card, its context, one stream, and a module for each kernel that was used.
pub struct Cuda {
    name: String,
    processors: u32,
    resident_lanes: u32,
    staging: RefCell<Staging>,
    /// Counts what may change the card's memory: what was read ahead holds until the next of these.
    epoch: Cell<u64>,
    parts: Parts<'static>,
    modules: RefCell<HashMap<&'static str, Module>>,
    stream: Stream,
    // Last, so that it is dropped last.
    _context: Context,
}

/// The driver keeps the lines of the Rust sources, for profilers; the machine code is the same.
const LINES: [ModuleJitOption; 1] = [ModuleJitOption::GenerateLineInfo(true)];

/// Memory of the card.
pub struct Memory(DeviceBuffer<u8>);

impl Memory {
    /// The address that kernels use.
    pub fn addr(&self) -> u64 {
        self.0.as_device_ptr().as_raw()
    }
    /// Itself, as the driver's wrapper knows it.
    pub fn buffer(&self) -> &DeviceBuffer<u8> {
        &self.0
    }
}

/// A point in the card's stream.
pub struct Event(CudaEvent);

impl Event {
    /// Milliseconds to a later event; waits for it.
    pub fn to(&self, later: &Event) -> Result<f64, Error> {
        later.0.synchronize().map_err(refused("waiting for the card"))?;
        later.0.elapsed_time_f32(&self.0).map(f64::from).map_err(refused("reading the card's clock"))
    }
}

/// The driver's refusal as our error.
pub fn refused(what: &'static str) -> impl Fn(CudaError) -> Error {
    move |e| match e {
        CudaError::OutOfMemory => Error::Room { what: what.into(), asked: 0, given: 0 },
        _ => Error::Device {
            what: what.into(),
            text: e.to_string(),
            advice: "look at `nvidia-smi`, or run with `--backend cpu`",
        },
    }
}

impl Cuda {
    /// The first card.
    pub fn new() -> Result<Self, Error> {
        #[cfg(target_os = "linux")]
        super::driver::load().map_err(|text| Error::Device {
            what: "looking for the CUDA driver".into(),
            text: text.to_string(),
            advice: "install NVIDIA's driver, or run with `--backend cpu`",
        })?;
        cust::init(cust::CudaFlags::empty()).map_err(refused("starting the CUDA driver"))?;
        let card = Card::get_device(0).map_err(refused("looking for a card"))?;
        let read = |what| card.get_attribute(what).map_err(refused("asking the card what it is"));
        let name = card.name().map_err(refused("asking the card's name"))?;
        let capability =
            (read(DeviceAttribute::ComputeCapabilityMajor)?, read(DeviceAttribute::ComputeCapabilityMinor)?);
        if capability < CAPABILITY {
            return Err(Error::Device {
                what: format!("using the card {name}"),
                text: format!(
                    "it has compute capability {}.{}, the kernels need 8.0",
                    capability.0, capability.1
                ),
                advice: "run with `--backend cpu`",
            });
        }
        let processors = read(DeviceAttribute::MultiprocessorCount)? as u32;
        let resident_lanes = processors * read(DeviceAttribute::MaxThreadsPerMultiprocessor)? as u32;
        let context = Context::new(card).map_err(refused("making a context"))?;
        let stream = Stream::new(StreamFlags::NON_BLOCKING, None).map_err(refused("making a stream"))?;
        let parts = Parts::new(PTX);
        let common = Module::from_ptx(parts.common(), &[]).map_err(refused("loading the kernels"))?;
        check_stamp(&common)?;
        Ok(Cuda {
            name,
            processors,
            resident_lanes,
            staging: RefCell::new(Staging::new()?),
            epoch: Cell::new(0),
            parts,
            modules: RefCell::default(),
            stream,
            _context: context,
        })
    }

    /// What the driver calls the card.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Blocks of that many lanes that fill the card.
    pub fn resident_blocks(&self, lanes: u32) -> u32 {
        self.resident_lanes / lanes
    }

    /// Zeroed memory of the card.
    pub fn memory(&self, bytes: usize) -> Result<Memory, Error> {
        // SAFETY: every byte is set below, before anything reads it: the stream orders the two.
        let buffer = unsafe { DeviceBuffer::<u8>::uninitialized(bytes.max(16)) }.map_err(|e| match e {
            CudaError::OutOfMemory => {
                let (free, _) = cust::memory::mem_get_info().unwrap_or((0, 0));
                Error::Room { what: "memory of the card".into(), asked: bytes as u64, given: free as u64 }
            }
            other => refused("taking memory of the card")(other),
        })?;
        let mut memory = Memory(buffer);
        self.clear(&mut memory)?;
        Ok(memory)
    }

    /// Sets every byte to zero.
    pub fn clear(&self, memory: &mut Memory) -> Result<(), Error> {
        self.changes();
        // SAFETY: freeing the buffer waits for the stream's work on it.
        unsafe { memory.0.set_8_async(0, &self.stream) }.map_err(refused("clearing memory of the card"))
    }

    /// What was read ahead holds no longer.
    fn changes(&self) {
        self.epoch.set(self.epoch.get() + 1);
    }

    /// The staging memory, unless the host still looks at what was read ahead.
    fn staging(&self) -> Result<RefMut<'_, Staging>, Error> {
        let seen = |_| Error::Bug { what: "a transfer while the host looks at another".into() };
        self.staging.try_borrow_mut().map_err(seen)
    }

    /// Copies bytes to the card, through page-locked memory; does not wait for the card.
    pub fn write(&self, memory: &mut Memory, bytes: &[u8]) -> Result<(), Error> {
        self.changes();
        self.staging()?.write(&self.stream, &mut memory.0, bytes)
    }

    /// Copies bytes from the card, through page-locked memory; waits for all work before, unless it was read ahead.
    pub fn read(&self, memory: &Memory, bytes: &mut [u8]) -> Result<(), Error> {
        if let Some(known) = self.known(memory, bytes.len()) {
            bytes.copy_from_slice(&known);
            return Ok(());
        }
        match self.staging.try_borrow_mut() {
            Ok(mut staging) => staging.read(&self.stream, &memory.0, bytes),
            // The host still looks at what was read ahead, of which this is not: a copy of its own.
            Err(_) => {
                self.stream.synchronize().map_err(refused("waiting for the card"))?;
                memory.0.index(0..bytes.len()).copy_to(bytes).map_err(refused("copying from the card"))
            }
        }
    }

    /// Copies the first bytes of several buffers, as many as fit into page-locked memory, with one wait: those that are
    /// asked for next are then there.
    pub fn read_ahead(&self, all: &[(&Memory, usize)]) -> Result<(), Error> {
        self.staging()?.read_ahead(&self.stream, self.epoch.get(), all)
    }

    /// The first bytes of a buffer, if they were read ahead and nothing has changed since.
    pub fn known(&self, memory: &Memory, bytes: usize) -> Option<Ref<'_, [u8]>> {
        let staging = self.staging.try_borrow().ok()?;
        Ref::filter_map(staging, |s| s.known(self.epoch.get(), memory.addr(), bytes)).ok()
    }

    /// Starts a kernel.
    pub fn launch<E: Kernel>(&self, blocks: u32, args: &E::Args) -> Result<(), Error> {
        self.changes();
        let mut args = *args;
        let parameters = [(&raw mut args).cast::<c_void>()];
        self.with_function::<E, _>(|function| {
            // SAFETY: the kernel takes one parameter of this type (the stamp says that host and PTX come from the same
            // sources), and its spans are memory of this card that the caller's buffers keep alive: freeing a buffer
            // waits for the launches before it.
            unsafe { self.stream.launch(function, blocks, E::LANES, E::SHARED, &parameters) }
        })
    }

    /// How many blocks of a kernel run at once: its registers and shared memory tell.
    pub fn blocks_at_once<E: Kernel>(&self) -> Result<u32, Error> {
        let lanes = BlockSize::x(E::LANES);
        let each = self.with_function::<E, _>(|function| {
            function.max_active_blocks_per_multiprocessor(lanes, E::SHARED as usize)
        })?;
        Ok(each * self.processors)
    }

    /// Hands a kernel to `body`; its module is loaded at the first time.
    fn with_function<E: Kernel, T>(
        &self,
        body: impl FnOnce(&Function) -> Result<T, CudaError>,
    ) -> Result<T, Error> {
        let mut modules = self.modules.borrow_mut();
        let module = match modules.entry(E::NAME) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => {
                let text = self.parts.module(E::NAME);
                let text =
                    text.ok_or_else(|| Error::Bug { what: format!("no kernel {} in the PTX", E::NAME) })?;
                new.insert(Module::from_ptx(text, &LINES).map_err(refused(E::NAME))?)
            }
        };
        let function = module.get_function(E::NAME).map_err(refused(E::NAME))?;
        body(&function).map_err(refused(E::NAME))
    }

    /// A point in the stream.
    pub fn mark(&self) -> Result<Event, Error> {
        let event = CudaEvent::new(EventFlags::DEFAULT).map_err(refused("making an event"))?;
        event.record(&self.stream).map_err(refused("recording an event"))?;
        Ok(Event(event))
    }
}

impl Drop for Cuda {
    /// Copies under way must not outlive the page-locked memory that they read.
    fn drop(&mut self) {
        // A card that fails here has failed before, and nobody is left to be told.
        let _ = self.stream.synchronize();
    }
}

/// Refuses kernels that come from other sources than this program.
fn check_stamp(module: &Module) -> Result<(), Error> {
    let global =
        module.get_global::<u64>(c"NEARMISS_STAMP").map_err(refused("looking for the kernels' stamp"))?;
    let mut found = 0u64;
    global.copy_to(&mut found).map_err(refused("reading the kernels' stamp"))?;
    is_ours(found)
}

/// Whether kernels with that stamp come from this program's sources.
fn is_ours(found: u64) -> Result<(), Error> {
    let found = format!("{found:016x}");
    if found == STAMP { Ok(()) } else { Err(Error::Stamp { found, wanted: STAMP.into() }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_of_other_sources_are_refused() {
        let ours = u64::from_str_radix(STAMP, 16).expect("sixteen digits");
        is_ours(ours).expect("our own");
        for bit in 0..64 {
            let error = is_ours(ours ^ 1 << bit).expect_err("another bit");
            assert!(matches!(error, Error::Stamp { .. }) && error.exit_code() == 4, "{error}");
            assert!(
                error.to_string().contains(STAMP) && error.to_string().contains("cargo build"),
                "{error}"
            );
        }
    }

    /// What a kernel comes to that cannot be launched, is killed, or reads what is not its own: an error with its name.
    #[test]
    fn a_failed_launch_names_its_kernel() {
        for code in [
            CudaError::LaunchFailed,
            CudaError::LaunchTimeout,
            CudaError::LaunchOutOfResources,
            CudaError::IllegalAddress,
            CudaError::InvalidPtx,
            CudaError::NotFound,
            CudaError::EccUncorrectable,
            CudaError::UnknownError,
        ] {
            let error = refused("narrow_sift_f32")(code);
            assert!(matches!(error, Error::Device { .. }) && error.exit_code() == 4, "{error:?}");
            let text = error.to_string();
            assert!(text.starts_with("narrow_sift_f32: ") && text.contains("--backend cpu"), "{text}");
        }
        let memory = refused("loading the kernels")(CudaError::OutOfMemory);
        assert!(matches!(memory, Error::Room { .. }) && memory.exit_code() == 4, "{memory:?}");
    }
}
