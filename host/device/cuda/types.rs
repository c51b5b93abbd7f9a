//! The driver's types and constants that we use (CUDA Driver API reference, 11.8; unchanged since
//! 11.4).

#![allow(non_camel_case_types, reason = "the driver's names")]

use std::ffi::{c_int, c_void};

pub type CUcontext = *mut c_void;
pub type CUdevice = c_int;
pub type CUdeviceptr = u64;
pub type CUdevice_attribute = u32;
pub type CUevent = *mut c_void;
pub type CUfunction = *mut c_void;
pub type CUjit_option = u32;
pub type CUmodule = *mut c_void;
pub type CUpointer_attribute = u32;
pub type CUgraph = *mut c_void;
pub type CUgraphExec = *mut c_void;
pub type CUstream = *mut c_void;
pub type CUstreamCaptureMode = u32;
pub type CUstreamCaptureStatus = u32;

pub const CUDA_ERROR_INVALID_VALUE: u32 = 1;
pub const CUDA_ERROR_OUT_OF_MEMORY: u32 = 2;
pub const CUDA_ERROR_INVALID_IMAGE: u32 = 200;
pub const CUDA_ERROR_NO_BINARY_FOR_GPU: u32 = 209;
pub const CUDA_ERROR_INVALID_PTX: u32 = 218;
pub const CUDA_ERROR_UNSUPPORTED_PTX_VERSION: u32 = 222;
pub const CUDA_ERROR_INVALID_SOURCE: u32 = 300;
pub const CUDA_ERROR_NOT_FOUND: u32 = 500;
pub const CUDA_ERROR_NOT_SUPPORTED: u32 = 801;
pub const CUDA_ERROR_STREAM_CAPTURE_UNSUPPORTED: u32 = 900;
pub const CUDA_ERROR_STREAM_CAPTURE_WRONG_THREAD: u32 = 908;

pub const CU_DEVICE_ATTRIBUTE_MULTIPROCESSOR_COUNT: CUdevice_attribute = 16;
pub const CU_DEVICE_ATTRIBUTE_MAX_THREADS_PER_MULTIPROCESSOR: CUdevice_attribute = 39;
pub const CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR: CUdevice_attribute = 75;
pub const CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR: CUdevice_attribute = 76;

pub const CU_POINTER_ATTRIBUTE_MEMORY_TYPE: CUpointer_attribute = 2;
pub const CU_POINTER_ATTRIBUTE_DEVICE_ORDINAL: CUpointer_attribute = 9;
pub const CU_MEMORYTYPE_DEVICE: u32 = 2;

pub const CU_EVENT_DEFAULT: u32 = 0;
pub const CU_EVENT_RECORD_DEFAULT: u32 = 0;
pub const CU_EVENT_RECORD_EXTERNAL: u32 = 1;
pub const CU_EVENT_WAIT_DEFAULT: u32 = 0;
pub const CU_STREAM_CAPTURE_MODE_THREAD_LOCAL: CUstreamCaptureMode = 1;
pub const CU_STREAM_CAPTURE_STATUS_NONE: CUstreamCaptureStatus = 0;
pub const CU_STREAM_NON_BLOCKING: u32 = 1;
/// Handles of default streams; a macro of the driver's header.
pub const CU_STREAM_LEGACY: usize = 1;
pub const CU_STREAM_PER_THREAD: usize = 2;
pub const CU_JIT_MAX_REGISTERS: CUjit_option = 0;
pub const CU_JIT_GENERATE_LINE_INFO: CUjit_option = 13;

/// Our types and constants are those of the driver's header, as cudarc has them.
#[cfg(test)]
mod tests {
    use super::*;
    use cudarc::driver::sys;

    #[test]
    fn sizes_and_constants_are_the_headers() {
        let ours = [
            size_of::<CUcontext>(),
            size_of::<CUdevice>(),
            size_of::<CUdeviceptr>(),
            size_of::<CUdevice_attribute>(),
            size_of::<CUevent>(),
            size_of::<CUfunction>(),
            size_of::<CUjit_option>(),
            size_of::<CUmodule>(),
            size_of::<CUpointer_attribute>(),
            size_of::<CUgraph>(),
            size_of::<CUgraphExec>(),
            size_of::<CUstream>(),
            size_of::<CUstreamCaptureMode>(),
            size_of::<CUstreamCaptureStatus>(),
        ];
        let theirs = [
            size_of::<sys::CUcontext>(),
            size_of::<sys::CUdevice>(),
            size_of::<sys::CUdeviceptr>(),
            size_of::<sys::CUdevice_attribute>(),
            size_of::<sys::CUevent>(),
            size_of::<sys::CUfunction>(),
            size_of::<sys::CUjit_option>(),
            size_of::<sys::CUmodule>(),
            size_of::<sys::CUpointer_attribute>(),
            size_of::<sys::CUgraph>(),
            size_of::<sys::CUgraphExec>(),
            size_of::<sys::CUstream>(),
            size_of::<sys::CUstreamCaptureMode>(),
            size_of::<sys::CUstreamCaptureStatus>(),
        ];
        assert_eq!(ours, theirs);
        use sys::CUdevice_attribute as Attribute;
        let pairs = [
            (CUDA_ERROR_INVALID_VALUE, sys::CUresult::CUDA_ERROR_INVALID_VALUE as u32),
            (CUDA_ERROR_OUT_OF_MEMORY, sys::CUresult::CUDA_ERROR_OUT_OF_MEMORY as u32),
            (CUDA_ERROR_INVALID_IMAGE, sys::CUresult::CUDA_ERROR_INVALID_IMAGE as u32),
            (CUDA_ERROR_NO_BINARY_FOR_GPU, sys::CUresult::CUDA_ERROR_NO_BINARY_FOR_GPU as u32),
            (CUDA_ERROR_INVALID_PTX, sys::CUresult::CUDA_ERROR_INVALID_PTX as u32),
            (CUDA_ERROR_UNSUPPORTED_PTX_VERSION, sys::CUresult::CUDA_ERROR_UNSUPPORTED_PTX_VERSION as u32),
            (CUDA_ERROR_INVALID_SOURCE, sys::CUresult::CUDA_ERROR_INVALID_SOURCE as u32),
            (CUDA_ERROR_NOT_FOUND, sys::CUresult::CUDA_ERROR_NOT_FOUND as u32),
            (CUDA_ERROR_NOT_SUPPORTED, sys::CUresult::CUDA_ERROR_NOT_SUPPORTED as u32),
            (
                CUDA_ERROR_STREAM_CAPTURE_UNSUPPORTED,
                sys::CUresult::CUDA_ERROR_STREAM_CAPTURE_UNSUPPORTED as u32,
            ),
            (
                CUDA_ERROR_STREAM_CAPTURE_WRONG_THREAD,
                sys::CUresult::CUDA_ERROR_STREAM_CAPTURE_WRONG_THREAD as u32,
            ),
            (
                CU_DEVICE_ATTRIBUTE_MULTIPROCESSOR_COUNT,
                Attribute::CU_DEVICE_ATTRIBUTE_MULTIPROCESSOR_COUNT as u32,
            ),
            (
                CU_DEVICE_ATTRIBUTE_MAX_THREADS_PER_MULTIPROCESSOR,
                Attribute::CU_DEVICE_ATTRIBUTE_MAX_THREADS_PER_MULTIPROCESSOR as u32,
            ),
            (
                CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR,
                Attribute::CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR as u32,
            ),
            (
                CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR,
                Attribute::CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR as u32,
            ),
            (
                CU_POINTER_ATTRIBUTE_MEMORY_TYPE,
                sys::CUpointer_attribute::CU_POINTER_ATTRIBUTE_MEMORY_TYPE as u32,
            ),
            (
                CU_POINTER_ATTRIBUTE_DEVICE_ORDINAL,
                sys::CUpointer_attribute::CU_POINTER_ATTRIBUTE_DEVICE_ORDINAL as u32,
            ),
            (CU_MEMORYTYPE_DEVICE, sys::CUmemorytype::CU_MEMORYTYPE_DEVICE as u32),
            (CU_EVENT_DEFAULT, sys::CUevent_flags::CU_EVENT_DEFAULT as u32),
            (CU_EVENT_RECORD_DEFAULT, sys::CUevent_record_flags::CU_EVENT_RECORD_DEFAULT as u32),
            (CU_EVENT_RECORD_EXTERNAL, sys::CUevent_record_flags::CU_EVENT_RECORD_EXTERNAL as u32),
            (CU_EVENT_WAIT_DEFAULT, sys::CUevent_wait_flags::CU_EVENT_WAIT_DEFAULT as u32),
            (
                CU_STREAM_CAPTURE_MODE_THREAD_LOCAL,
                sys::CUstreamCaptureMode::CU_STREAM_CAPTURE_MODE_THREAD_LOCAL as u32,
            ),
            (CU_STREAM_CAPTURE_STATUS_NONE, sys::CUstreamCaptureStatus::CU_STREAM_CAPTURE_STATUS_NONE as u32),
            (CU_STREAM_NON_BLOCKING, sys::CUstream_flags::CU_STREAM_NON_BLOCKING as u32),
            (CU_JIT_MAX_REGISTERS, sys::CUjit_option::CU_JIT_MAX_REGISTERS as u32),
            (CU_JIT_GENERATE_LINE_INFO, sys::CUjit_option::CU_JIT_GENERATE_LINE_INFO as u32),
        ];
        assert!(pairs.iter().all(|(ours, theirs)| ours == theirs), "{pairs:?}");
    }
}
