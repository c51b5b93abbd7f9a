//! An NVIDIA GPU, through its driver. The kernels are embedded, as PTX and perhaps as machine code.

mod code;
mod context;
mod driver;
mod frames;
mod graph;
mod kept;
mod memory;
mod module;
mod peers;
mod reads;
mod staging;
mod stream;
mod types;

pub use graph::Graph;
pub use kept::Kept;
pub use memory::Memory;
pub use reads::First;
pub use staging::Known;

use super::Owner;
use super::place::Place;
use crate::error::Error;
use code::Code;
use context::{Bound, Context, Gpu};
use driver::{Refusal, refused};
use kept::Blocks;
use module::Function;
use nearmiss_kernels::entry::Entry as Kernel;
use staging::Staging;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use stream::{Side, Stream};
use types::{CUcontext, CUstream};

/// The stamp of the sources of this program.
const STAMP: &str = env!("NEARMISS_STAMP");
/// The oldest GPU that the PTX supports: compute capability 8.0.
const CAPABILITY: (i32, i32) = (8, 0);

/// The first step of every call.
const BINDING: &str = "binding a thread to the GPU";

/// A GPU, its context, one stream, and a module for each kernel that was used.
pub struct Cuda {
    name: String,
    processors: u32,
    resident_lanes: u32,
    staging: Mutex<Staging>,
    /// Memory of answers.
    blocks: Box<Mutex<Blocks>>,
    /// Counts changes of the GPU's memory: bytes that were read ahead are valid until the next one.
    epoch: AtomicU64,
    code: Code,
    functions: Mutex<HashMap<&'static str, Function>>,
    stream: Stream,
    /// The stream for recording graphs, one at a time. Nothing else uses it meanwhile.
    recorder: Mutex<Stream>,
    /// The stream for work that runs at the same time.
    side: Box<Mutex<Side>>,
    context: Arc<Context>,
}

/// An event in the GPU's stream.
pub struct Event(stream::Event);

impl Event {
    /// Milliseconds to a later event; waits for it.
    pub fn to(&self, later: &Event) -> Result<f64, Error> {
        later.0.wait().map_err(refused("waiting for the GPU"))?;
        self.0.to(&later.0).map(f64::from).map_err(refused("reading the GPU's clock"))
    }
}

/// Locks, also after a panic: a panic leaves no state that the next call cannot use.
fn locked<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Cuda {
    /// The GPU with that number.
    pub fn new(ordinal: u32) -> Result<Self, Error> {
        driver::driver()?;
        code::start();
        let gpu = Gpu::new(ordinal)?;
        let context = gpu.context()?;
        let stream = Stream::new(&context).map_err(refused("making a stream"))?;
        Self::with(gpu, context, stream)
    }

    /// A GPU by a context and a stream of the caller.
    ///
    /// # Safety
    /// See [`super::Device::from_stream_of`].
    pub unsafe fn from_stream(
        context: CUcontext,
        stream: CUstream,
        owner: Option<Owner>,
    ) -> Result<Self, Error> {
        // SAFETY: the caller's promise.
        let (gpu, context) = unsafe { Gpu::of(context, stream, owner) }?;
        // SAFETY: as above.
        let stream = unsafe { Stream::borrow(&context, stream) };
        Self::with(gpu, context, stream)
    }

    fn with(gpu: Gpu, context: Arc<Context>, stream: Stream) -> Result<Self, Error> {
        let name = gpu.name()?;
        let capability = (
            gpu.read(types::CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR)?,
            gpu.read(types::CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR)?,
        );
        if capability < CAPABILITY {
            return Err(Error::Device {
                what: format!("using the GPU {name}"),
                text: format!(
                    "compute capability must be at least 8.0, got {}.{}",
                    capability.0, capability.1
                ),
                advice: "run on the CPU",
            });
        }
        let processors = gpu.read(types::CU_DEVICE_ATTRIBUTE_MULTIPROCESSOR_COUNT)? as u32;
        let lanes = gpu.read(types::CU_DEVICE_ATTRIBUTE_MAX_THREADS_PER_MULTIPROCESSOR)? as u32;
        let code = Code::new(capability)?;
        let bound = context.bind().map_err(refused(BINDING))?;
        let stamped = code.stamped(&context, &bound)?;
        is_ours(stamped.global(&bound, c"NEARMISS_STAMP").map_err(refused("reading the kernels' stamp"))?)?;
        let staging = Staging::new(&context, &bound)?;
        let recorder = Stream::new(&context).map_err(refused("making a stream"))?;
        let side = Side::new(&context, &bound).map_err(refused("making a stream"))?;
        drop(bound);
        Ok(Cuda {
            name,
            processors,
            resident_lanes: processors * lanes,
            staging: Mutex::new(staging),
            blocks: Box::new(Mutex::new(Blocks::new(&context))),
            epoch: AtomicU64::new(0),
            code,
            functions: Mutex::default(),
            stream,
            recorder: Mutex::new(recorder),
            side: Box::new(Mutex::new(side)),
            context,
        })
    }

    /// The driver, for this thread. Every call below binds once.
    fn bind(&self) -> Result<Bound<'_>, Error> {
        self.context.bind().map_err(refused(BINDING))
    }

    /// The driver's name of the GPU.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The form of the kernels' code: see [`Code::form`].
    pub fn code(&self) -> String {
        self.code.form()
    }

    /// The GPU's number.
    pub fn ordinal(&self) -> u32 {
        self.context.ordinal()
    }

    /// The handle of its stream.
    pub fn stream(&self) -> u64 {
        self.stream.handle() as u64
    }

    /// The owner of its context and its stream, if it is known.
    pub fn owner(&self) -> Option<&Owner> {
        self.context.owner()
    }

    /// Number of blocks with that many lanes that fill the GPU.
    pub fn resident_blocks(&self, lanes: u32) -> u32 {
        self.resident_lanes / lanes
    }

    /// Allocates zeroed memory of the GPU.
    pub fn memory(&self, bytes: usize) -> Result<Memory, Error> {
        let gpu = self.bind()?;
        let mut memory =
            Memory::new(&self.context, &gpu, bytes.max(16)).map_err(|refusal| match refusal {
                Refusal::OUT_OF_MEMORY => Error::OutOfMemory {
                    what: "memory of the GPU".into(),
                    asked: bytes as u64,
                    given: memory::free(&gpu),
                },
                other => refused("taking memory of the GPU")(other),
            })?;
        // Its readers come later in the stream.
        self.filled(&gpu, &mut memory, 0)?;
        Ok(memory)
    }

    /// Sets every byte.
    pub fn fill(&self, memory: &mut Memory, byte: u8) -> Result<(), Error> {
        self.filled(&self.bind()?, memory, byte)
    }

    fn filled(&self, gpu: &Bound, memory: &mut Memory, byte: u8) -> Result<(), Error> {
        self.changes();
        memory.fill(gpu, &self.stream, byte).map_err(refused("setting memory of the GPU"))
    }

    /// Invalidates the bytes that were read ahead.
    pub fn changes(&self) {
        self.epoch.fetch_add(1, Ordering::Relaxed);
    }

    /// Copies bytes to the GPU through page-locked memory; does not wait for the GPU.
    pub fn write(&self, memory: &mut Memory, bytes: &[u8]) -> Result<(), Error> {
        self.changes();
        locked(&self.staging).write(&self.bind()?, &self.stream, memory, bytes)
    }

    /// Starts a kernel. If only launches are allowed, its module must be loaded already.
    pub fn launch<E: Kernel>(&self, blocks: u32, args: &E::Args, sealed: bool) -> Result<(), Error> {
        self.changes();
        // On the default stream a kernel may be loaded meanwhile: that stream is never captured.
        if sealed && !self.stream.is_default() && !locked(&self.functions).contains_key(E::NAME) {
            return Err(Error::Bug { what: format!("{} was loaded in a frame that only launches", E::NAME) });
        }
        self.with_function::<E, _>(|gpu, function| {
            // SAFETY: the kernel takes one parameter of this type: by the stamp, host and PTX come
            // from the same sources. Its spans are memory of this GPU that the caller's buffers
            // keep alive: freeing a buffer waits for the launches before it.
            unsafe {
                function.launch(gpu, &self.stream, (blocks, E::LANES, E::SHARED), std::slice::from_ref(args))
            }
        })
    }

    /// Loads a kernel, if it is not loaded yet.
    pub fn load<E: Kernel>(&self) -> Result<(), Error> {
        self.with_function::<E, _>(|_, _| Ok(()))
    }

    /// Number of blocks of a kernel that run at once. It depends on registers and shared memory.
    pub fn blocks_at_once<E: Kernel>(&self, place: Place) -> Result<u32, Error> {
        let each =
            self.with_function::<E, _>(|gpu, function| function.blocks_at_once(gpu, E::LANES, E::SHARED))?;
        Ok(place.of_processor(each, E::LANES) * self.processors)
    }

    /// Calls `body` with a kernel; its module is loaded at its first use.
    fn with_function<E: Kernel, T>(
        &self,
        body: impl FnOnce(&Bound, &Function) -> Result<T, Refusal>,
    ) -> Result<T, Error> {
        let gpu = self.bind()?;
        let mut functions = locked(&self.functions);
        let function = match functions.entry(E::NAME) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => {
                let module = self.code.module::<E>(&self.context, &gpu)?;
                new.insert(module.function(&gpu, E::NAME).map_err(refused(E::NAME))?)
            }
        };
        body(&gpu, function).map_err(refused(E::NAME))
    }

    /// Moves an event after all work so far.
    pub fn mark(&self, event: &Event) -> Result<(), Error> {
        event.0.record(&self.bind()?, &self.stream).map_err(refused("recording an event"))
    }

    /// Makes an event in the stream.
    pub fn event(&self) -> Result<Event, Error> {
        let gpu = self.bind()?;
        let event = stream::Event::new(&self.context, &gpu).map_err(refused("making an event"))?;
        event.record(&gpu, &self.stream).map_err(refused("recording an event"))?;
        Ok(Event(event))
    }
}

impl Drop for Cuda {
    /// Copies in progress must not outlive the page-locked memory that they read.
    fn drop(&mut self) {
        // A GPU that fails here has failed before; the failure cannot be reported.
        if let Ok(gpu) = self.context.bind() {
            let _ = self.stream.wait(&gpu);
        }
    }
}

/// Checks that kernels with that stamp come from this program's sources.
fn is_ours(found: u64) -> Result<(), Error> {
    let found = format!("{found:016x}");
    if found == STAMP { Ok(()) } else { Err(Error::KernelMismatch { found, wanted: STAMP.into() }) }
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
            assert!(matches!(error, Error::KernelMismatch { .. }) && error.exit_code() == 4, "{error}");
            assert!(
                error.to_string().contains(STAMP) && error.to_string().contains("cargo build"),
                "{error}"
            );
        }
    }
}
