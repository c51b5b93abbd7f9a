//! The kernels' code: machine code if there is some for the GPU, else PTX, which the driver
//! compiles.

use super::context::{Bound, Context};
use super::driver::{Refusal, refused};
use super::module::Module;
use crate::device::code::cubins::{Capability, Cubins};
use crate::device::code::ptx::{Parts, unpacked};
use crate::error::Error;
use nearmiss_kernels::entry::{Entry, status_frame};
use std::sync::{Arc, OnceLock};

/// The kernels' PTX, found or compiled by build.rs.
const PTX: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/nearmiss.ptx.zst"));
/// Machine code that build.rs found to be made from it. Empty in a build from source.
const CUBINS: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/nearmiss.cubins"));

/// The PTX in parts, once a process.
static PARTS: OnceLock<Result<Parts, String>> = OnceLock::new();

fn parts() -> Result<&'static Parts, Error> {
    let text = || {
        let text = unpacked(PTX)?;
        Ok(Parts::new(std::str::from_utf8(&text).map_err(|error| error.to_string())?))
    };
    let parts = PARTS.get_or_init(text).as_ref();
    parts.map_err(|why| Error::Bug { what: format!("the embedded PTX: {why}") })
}

/// Decompresses the PTX in a thread of its own, while the driver starts. Without a thread, the
/// first kernel decompresses it.
fn read_ahead() {
    let _ = std::thread::Builder::new().name("nearmiss-ptx".into()).spawn(|| drop(parts()));
}

/// Begins what needs no GPU.
pub fn start() {
    if CUBINS.is_empty() {
        read_ahead();
    }
}

/// Code of all kernels for a GPU.
pub struct Code {
    gpu: Capability,
    cubins: Cubins<'static>,
    /// Why the driver refused machine code. After that, it compiles PTX.
    refusal: OnceLock<Refusal>,
}

impl Code {
    /// The code for a GPU of that compute capability.
    pub fn new(gpu: Capability) -> Result<Code, Error> {
        let cubins = Cubins::new(CUBINS)
            .map_err(|why| Error::Bug { what: format!("the embedded machine code: {why}") })?;
        let code = Code { gpu, cubins, refusal: OnceLock::new() };
        if !code.has_machine_code() {
            read_ahead();
        }
        Ok(code)
    }

    fn has_machine_code(&self) -> bool {
        self.cubins.covers(self.gpu) && self.refusal.get().is_none()
    }

    /// The form of the code, and why machine code is not used.
    pub fn form(&self) -> String {
        let newest = self.cubins.choose(self.gpu, status_frame::NAME, status_frame::REGISTERS);
        match (self.refusal.get(), newest) {
            (Some(refusal), _) => {
                format!("PTX, compiled by the driver: it refused the machine code ({})", refusal.text())
            }
            (None, Some(((major, minor), _))) => {
                format!("machine code for compute capability {major}.{minor}")
            }
            (None, None) => "PTX, compiled by the driver".into(),
        }
    }

    /// A module with the stamp of the sources.
    pub fn stamped(&self, context: &Arc<Context>, gpu: &Bound) -> Result<Module, Error> {
        const WHAT: &str = "loading the kernels";
        let stamped = self.machine_code(context, gpu, status_frame::NAME, status_frame::REGISTERS, WHAT)?;
        match stamped {
            Some(module) => Ok(module),
            None => Module::new(context, gpu, parts()?.common(), None).map_err(refused(WHAT)),
        }
    }

    /// A module with a kernel.
    pub fn module<E: Entry>(&self, context: &Arc<Context>, gpu: &Bound) -> Result<Module, Error> {
        if let Some(module) = self.machine_code(context, gpu, E::NAME, E::REGISTERS, E::NAME)? {
            return Ok(module);
        }
        let text = parts()?.module(E::NAME);
        let text = text.ok_or_else(|| Error::Bug { what: format!("no kernel {} in the PTX", E::NAME) })?;
        Module::new(context, gpu, &text, E::REGISTERS).map_err(refused(E::NAME))
    }

    /// The module from machine code; `None` if there is none or the driver refuses it.
    fn machine_code(
        &self,
        context: &Arc<Context>,
        gpu: &Bound,
        kernel: &str,
        registers: Option<u32>,
        what: &'static str,
    ) -> Result<Option<Module>, Error> {
        if !self.has_machine_code() {
            return Ok(None);
        }
        let Some((_, packed)) = self.cubins.choose(self.gpu, kernel, registers) else { return Ok(None) };
        let bug = |why| Error::Bug { what: format!("the machine code of {kernel}: {why}") };
        let code = unpacked(packed).map_err(bug)?;
        match Module::of_machine_code(context, gpu, &code) {
            Ok(module) => Ok(Some(module)),
            Err(refusal) if refusal.is_of_code() => {
                self.refusal.get_or_init(|| refusal);
                Ok(None)
            }
            Err(refusal) => Err(refused(what)(refusal)),
        }
    }
}
