//! Kernels that the driver has loaded.

use super::context::{Bound, Context};
use super::driver::{Refusal, answer};
use super::stream::Stream;
use super::types::{self, CUfunction, CUmodule};
use std::ffi::{CStr, CString, c_int, c_void};
use std::ptr::null_mut;
use std::sync::Arc;

/// Kernels that the driver has compiled for the GPU, or whose machine code it has loaded.
pub struct Module {
    context: Arc<Context>,
    handle: CUmodule,
}

// SAFETY: the handle is the driver's. Any thread may call the driver's functions, also at the same
// time.
unsafe impl Send for Module {}
// SAFETY: as above.
unsafe impl Sync for Module {}

impl Module {
    /// Compiles a text, with at most that many registers a lane. The driver keeps the lines of the
    /// Rust sources, for profilers; the machine code is the same.
    pub fn new(
        context: &Arc<Context>,
        gpu: &Bound,
        ptx: &str,
        registers: Option<u32>,
    ) -> Result<Module, Refusal> {
        let ptx = text(ptx)?;
        let mut options = vec![types::CU_JIT_GENERATE_LINE_INFO];
        let mut values = vec![std::ptr::without_provenance_mut::<c_void>(1)];
        if let Some(registers) = registers {
            options.push(types::CU_JIT_MAX_REGISTERS);
            values.push(std::ptr::without_provenance_mut(registers as usize));
        }
        // SAFETY: the text ends with zero.
        unsafe { Self::load(context, gpu, ptx.as_bytes_with_nul(), &mut options, &mut values) }
    }

    /// Loads machine code of the assembler. The driver refuses code for another architecture.
    pub fn of_machine_code(context: &Arc<Context>, gpu: &Bound, code: &[u8]) -> Result<Module, Refusal> {
        if !is_machine_code(code) {
            return Err(Refusal(types::CUDA_ERROR_INVALID_VALUE));
        }
        // SAFETY: the file is whole, from its first byte to the length that its header implies:
        // build.rs compared the digest of what the assembler wrote.
        unsafe { Self::load(context, gpu, code, &mut [], &mut []) }
    }

    /// # Safety
    /// The image is a text that ends with zero, or a whole file of machine code. There is a value
    /// for each option.
    unsafe fn load(
        context: &Arc<Context>,
        gpu: &Bound,
        image: &[u8],
        options: &mut [types::CUjit_option],
        values: &mut [*mut c_void],
    ) -> Result<Module, Refusal> {
        let mut handle = null_mut();
        // SAFETY: the caller's promise; a value is a number in place of a pointer. The driver
        // writes one handle, which is unloaded once.
        answer(unsafe {
            (gpu.cuModuleLoadDataEx)(
                &mut handle,
                image.as_ptr().cast(),
                options.len() as u32,
                options.as_mut_ptr(),
                values.as_mut_ptr(),
            )
        })?;
        Ok(Module { context: context.clone(), handle })
    }

    /// A kernel of it.
    pub fn function(self, gpu: &Bound, name: &str) -> Result<Function, Refusal> {
        let name = text(name)?;
        let mut handle = null_mut();
        // SAFETY: the module lives, the name ends with zero, and the driver writes one handle.
        answer(unsafe { (gpu.cuModuleGetFunction)(&mut handle, self.handle, name.as_ptr()) })?;
        Ok(Function { handle, _module: self })
    }

    /// Reads a number in the GPU's memory.
    pub fn global(&self, gpu: &Bound, name: &CStr) -> Result<u64, Refusal> {
        let (mut addr, mut bytes, mut value) = (0, 0, 0u64);
        // SAFETY: the module lives, the name ends with zero, and the driver writes two numbers.
        answer(unsafe { (gpu.cuModuleGetGlobal_v2)(&mut addr, &mut bytes, self.handle, name.as_ptr()) })?;
        if bytes != size_of::<u64>() {
            return Err(Refusal(types::CUDA_ERROR_NOT_FOUND));
        }
        // SAFETY: both sides have this number of bytes; the call waits for the copy.
        answer(unsafe { (gpu.cuMemcpyDtoH_v2)((&raw mut value).cast(), addr, bytes) })?;
        Ok(value)
    }
}

/// Whether this begins as machine code does: an ELF file of 64 bits for CUDA (`EM_CUDA`, 190).
fn is_machine_code(code: &[u8]) -> bool {
    code.len() > 64 && code.starts_with(b"\x7fELF\x02\x01") && code[18..20] == [190, 0]
}

/// A text that ends with zero. The driver accepts no text with a zero inside.
fn text(text: &str) -> Result<CString, Refusal> {
    CString::new(text).map_err(|_| Refusal(types::CUDA_ERROR_INVALID_VALUE))
}

impl Drop for Module {
    fn drop(&mut self) {
        if let Ok(gpu) = self.context.bind() {
            // SAFETY: loaded once, unloaded once, after the GPU's work was waited for
            // (`Cuda::drop`) or before there was any. A refusal cannot be reported.
            let _ = unsafe { (gpu.cuModuleUnload)(self.handle) };
        }
    }
}

/// A kernel, with its module.
pub struct Function {
    handle: CUfunction,
    _module: Module,
}

// SAFETY: the handle is the driver's. Any thread may call the driver's functions, also at the same
// time.
unsafe impl Send for Function {}
// SAFETY: as above.
unsafe impl Sync for Function {}

impl Function {
    /// Launches the kernel.
    ///
    /// # Safety
    /// `parameter` begins with the kernel's only parameter, of its type. The memory that it names
    /// lives until the launch ends.
    pub unsafe fn launch<T>(
        &self,
        gpu: &Bound,
        stream: &Stream,
        (blocks, lanes, shared): (u32, u32, u32),
        parameter: &[T],
    ) -> Result<(), Refusal> {
        let mut parameters = [parameter.as_ptr().cast_mut().cast::<c_void>()];
        // SAFETY: module and stream live. Before it returns, the driver copies the parameter and
        // writes nothing there. The caller promises the rest.
        answer(unsafe {
            (gpu.cuLaunchKernel)(
                self.handle,
                blocks,
                1,
                1,
                lanes,
                1,
                1,
                shared,
                stream.handle(),
                parameters.as_mut_ptr(),
                null_mut(),
            )
        })
    }

    /// Number of its blocks that a multiprocessor runs at once.
    pub fn blocks_at_once(&self, gpu: &Bound, lanes: u32, shared: u32) -> Result<u32, Refusal> {
        let mut blocks = 0;
        // SAFETY: the module lives, and the driver writes one number.
        answer(unsafe {
            (gpu.cuOccupancyMaxActiveBlocksPerMultiprocessor)(
                &mut blocks,
                self.handle,
                lanes as c_int,
                shared as usize,
            )
        })?;
        Ok(blocks as u32)
    }
}
