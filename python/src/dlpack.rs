//! DLPack: arrays that change hands by where they lie, how they are shaped and who frees them.
//!
//! Structs and rules: DLPack 1.1, `dlpack.h`, and the Python specification; the unversioned struct, which every library gives and takes.

use crate::errors::choice;
use pyo3::ffi;
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyCapsuleMethods};
use std::ffi::{CStr, c_void};
use std::ptr::{NonNull, null_mut};

/// Memory of the host.
pub const CPU: i32 = 1;
/// Memory of an NVIDIA GPU.
pub const CUDA: i32 = 2;
/// Memory of an NVIDIA GPU that the host reads too.
pub const CUDA_MANAGED: i32 = 13;

/// Kinds of numbers: signed integers, unsigned ones, floats.
pub const INT: u8 = 0;
/// See [`INT`].
pub const UINT: u8 = 1;
/// See [`INT`].
pub const FLOAT: u8 = 2;

/// The name of a capsule until its tensor is taken, and the name after that.
const FRESH: &CStr = c"dltensor";
const USED: &CStr = c"used_dltensor";

/// Which memory.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    pub kind: i32,
    pub ordinal: i32,
}

/// Which numbers.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dtype {
    pub code: u8,
    pub bits: u8,
    pub lanes: u16,
}

#[repr(C)]
struct Tensor {
    data: *mut c_void,
    place: Place,
    ndim: i32,
    dtype: Dtype,
    shape: *mut i64,
    strides: *mut i64,
    byte_offset: u64,
}

#[repr(C)]
struct ManagedTensor {
    tensor: Tensor,
    manager: *mut c_void,
    deleter: Option<unsafe extern "C" fn(*mut ManagedTensor)>,
}

/// An array of somebody else, freed by its owner when this is dropped.
pub struct Taken(NonNull<ManagedTensor>);

// SAFETY: DLPack lets any thread read a tensor and call its deleter.
unsafe impl Send for Taken {}
// SAFETY: nothing is written through it.
unsafe impl Sync for Taken {}

impl Drop for Taken {
    fn drop(&mut self) {
        // SAFETY: it was taken from its capsule, as the capsule's new name shows. Its deleter is
        // called once.
        unsafe {
            if let Some(deleter) = self.0.as_ref().deleter {
                deleter(self.0.as_ptr());
            }
        }
    }
}

/// Description of an array; strides count elements.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shape {
    pub address: u64,
    pub place: Place,
    pub dtype: Dtype,
    pub shape: Vec<i64>,
    pub strides: Vec<i64>,
}

impl Taken {
    /// Takes what a capsule holds.
    pub fn of(capsule: &Bound<'_, PyAny>) -> PyResult<Taken> {
        let capsule = capsule.cast::<PyCapsule>()?;
        let pointer = capsule.pointer_checked(Some(FRESH))?;
        // SAFETY: the capsule is alive, and the name lives as long as the program.
        if unsafe { ffi::PyCapsule_SetName(capsule.as_ptr(), USED.as_ptr()) } != 0 {
            return Err(PyErr::fetch(capsule.py()));
        }
        Ok(Taken(pointer.cast()))
    }

    /// Its address and shape.
    pub fn shape(&self) -> PyResult<Shape> {
        // SAFETY: it lives until this is dropped.
        let tensor = unsafe { &self.0.as_ref().tensor };
        let dimensions = usize::try_from(tensor.ndim).unwrap_or(0);
        if dimensions > 0 && tensor.shape.is_null() {
            return Err(choice(
                "a DLPack tensor without a shape",
                "give one of a library that keeps to the protocol",
            ));
        }
        let numbers = |at: *const i64| match dimensions {
            0 => Vec::new(),
            // SAFETY: so many numbers lie there, as the protocol says.
            _ => unsafe { std::slice::from_raw_parts(at, dimensions) }.to_vec(),
        };
        let shape = numbers(tensor.shape);
        let strides = if tensor.strides.is_null() { packed(&shape) } else { numbers(tensor.strides) };
        let address = (tensor.data as u64).wrapping_add(tensor.byte_offset);
        Ok(Shape { address, place: tensor.place, dtype: tensor.dtype, shape, strides })
    }
}

/// Strides of an array without gaps.
pub fn packed(shape: &[i64]) -> Vec<i64> {
    let mut strides = vec![1i64; shape.len()];
    for i in (1..shape.len()).rev() {
        strides[i - 1] = strides[i].saturating_mul(shape[i]);
    }
    strides
}

/// Target of our capsules. The struct is first, so a pointer to one is a pointer to the other.
#[repr(C)]
struct Given {
    managed: ManagedTensor,
    numbers: Vec<i64>,
    _owner: Py<PyAny>,
}

/// A capsule of an array of ours, whose owner lives as long as anyone has it.
pub fn capsule<'py>(py: Python<'py>, of: &Shape, owner: Py<PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let numbers = [&of.shape[..], &of.strides[..]].concat();
    let tensor = Tensor {
        data: of.address as *mut c_void,
        place: of.place,
        ndim: of.shape.len() as i32,
        dtype: of.dtype,
        shape: null_mut(),
        strides: null_mut(),
        byte_offset: 0,
    };
    let managed = ManagedTensor { tensor, manager: null_mut(), deleter: Some(freed) };
    let given = Box::into_raw(Box::new(Given { managed, numbers, _owner: owner }));
    // SAFETY: the box is alive; its vector has room for both, and is not touched again.
    unsafe {
        (*given).managed.tensor.shape = (*given).numbers.as_mut_ptr();
        (*given).managed.tensor.strides = (*given).numbers.as_mut_ptr().add(of.shape.len());
    }
    // SAFETY: the pointer is not null, the name lives as long as the program, and the destructor frees the box.
    let made = unsafe { ffi::PyCapsule_New(given.cast(), FRESH.as_ptr(), Some(untaken)) };
    if made.is_null() {
        // SAFETY: no other code has it.
        unsafe { freed(given.cast()) };
    }
    // SAFETY: a new reference, or null and an exception.
    unsafe { Bound::from_owned_ptr_or_err(py, made) }
}

/// Frees an array of ours.
unsafe extern "C" fn freed(managed: *mut ManagedTensor) {
    // The calling thread may be unknown to Python. If the interpreter is ending, the memory is left
    // to the system: nothing may unwind here.
    let _ = Python::try_attach(|_| {
        // SAFETY: it is the box of `capsule`, freed once: by the taker of the tensor, or by the
        // capsule if there was none.
        drop(unsafe { Box::from_raw(managed.cast::<Given>()) });
    });
}

/// Frees a tensor that was not taken.
unsafe extern "C" fn untaken(capsule: *mut ffi::PyObject) {
    // SAFETY: Python gives a capsule of ours; a null answer means that it is used, or called otherwise.
    unsafe {
        if ffi::PyCapsule_IsValid(capsule, FRESH.as_ptr()) == 1 {
            freed(ffi::PyCapsule_GetPointer(capsule, FRESH.as_ptr()).cast());
        }
    }
}
