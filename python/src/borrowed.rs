//! Arrays that a detector reads in place.

use crate::dlpack::{CPU, CUDA, CUDA_MANAGED, Dtype, FLOAT, Place, Shape, Taken, packed};
use crate::errors::{choice, raised};
use crate::host::{are_floats, refuse_masked};
use nearmiss::Device;
use nearmiss::scene::{DeviceRows, Number};
use numpy::npyffi::_PyArray_GET_ITEM_DATA;
use numpy::{PyArrayDescrMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

/// A reference that keeps an array in its place.
pub enum Held {
    /// A capsule of DLPack.
    Taken { _tensor: Taken },
    /// The array itself.
    Object { _array: Py<PyAny> },
}

/// Rows of an array, and what holds it.
pub struct BorrowedRows {
    pub rows: DeviceRows,
    pub held: Held,
}

/// Return whether an array is in the memory of an NVIDIA GPU.
#[pyfunction]
pub fn is_on_gpu(object: &Bound<'_, PyAny>) -> bool {
    if object.cast::<PyUntypedArray>().is_ok() {
        return false;
    }
    if let Ok(place) =
        object.call_method0("__dlpack_device__").and_then(|place| place.extract::<(i32, i32)>())
    {
        return [CUDA, CUDA_MANAGED].contains(&place.0);
    }
    object.hasattr("__cuda_array_interface__").unwrap_or(false)
}

/// The number of the GPU that has an array; `None` if the array does not say.
fn gpu_of(object: &Bound<'_, PyAny>) -> PyResult<Option<i32>> {
    if !object.hasattr("__dlpack_device__")? {
        return Ok(None);
    }
    let place: (i32, i32) = object.call_method0("__dlpack_device__")?.extract()?;
    Ok(Some(place.1))
}

/// Rows of `width` numbers in the memory of one of these devices, behind all work that makes them.
pub fn on_gpu(
    object: &Bound<'_, PyAny>,
    devices: &[&Device],
    (width, what): (i64, &str),
) -> PyResult<BorrowedRows> {
    let by_dlpack = object.hasattr("__dlpack__")?;
    let told = if by_dlpack { None } else { Some(by_cuda_array_interface(object, what)?) };
    let gpu = gpu_of(object)?;
    let has = |device: &&&Device| gpu.is_some() && device.ordinal().map(|ordinal| ordinal as i32) == gpu;
    let device = devices.iter().find(has).or(devices.first());
    let Some((device, ordinal, stream)) =
        device.and_then(|device| Some((device, device.ordinal()?, device.stream()?)))
    else {
        return Err(choice(
            format!("{what} are on a GPU, and the detector is on the CPU"),
            "give the detector a device of that GPU, or arrays of the host",
        ));
    };
    let elsewhere = |gpu: i32| {
        choice(format!("{what} are on GPU {gpu}, and the detector is on GPU {ordinal}"), "put both on one")
    };
    // torch says it in other words.
    if let Some(gpu) = gpu.filter(|&gpu| gpu != ordinal as i32) {
        return Err(elsewhere(gpu));
    }
    let (shape, held) = match told {
        // If it names the stream that makes the data, that must be ours: nothing here waits for another.
        Some((_, Some(theirs))) if theirs != stream.max(1) => {
            return Err(choice(
                format!("{what} are of stream {theirs}, and the detector is on stream {stream}"),
                "open the device on that stream: Device(stream=…)",
            ));
        }
        Some((mut shape, _)) => {
            shape.place.ordinal = ordinal as i32;
            (shape, Held::Object { _array: object.clone().unbind() })
        }
        None => {
            // 0 has no meaning there; 1 is the default stream.
            let kwargs = [("stream", stream.max(1))].into_py_dict(object.py())?;
            // torch exports only what is on the current GPU.
            let lent = device.while_current(|| object.call_method("__dlpack__", (), Some(&kwargs)));
            let tensor = Taken::of(&lent.map_err(raised)??)?;
            (tensor.shape()?, Held::Taken { _tensor: tensor })
        }
    };
    if shape.place.ordinal != ordinal as i32 {
        return Err(elsewhere(shape.place.ordinal));
    }
    Ok(BorrowedRows { rows: rows(&shape, width, what)?, held })
}

/// Rows of `width` numbers in the host's memory, which the CPU's kernels read where they lie; none where they are not
/// laid out for that.
pub fn on_cpu(object: &Bound<'_, PyAny>, (width, what): (usize, &str)) -> PyResult<Option<BorrowedRows>> {
    let array = if let Ok(array) = object.cast::<PyUntypedArray>() {
        // It may be of a subclass.
        if !array.is_exact_instance_of::<PyUntypedArray>() {
            refuse_masked(array)?;
        }
        array.clone()
    } else if object.hasattr("__dlpack__")? {
        object.py().import("numpy")?.call_method1("from_dlpack", (object,))?.cast_into::<PyUntypedArray>()?
    } else {
        return Ok(None);
    };
    if !are_floats(&array) {
        return Ok(None);
    }
    let size = array.dtype().itemsize() as isize;
    let (shape, strides) = (array.shape(), array.strides());
    let fits = shape.len() == 2
        && shape[1] == width
        && strides[1] == size
        && strides[0] > 0
        && strides[0] % size == 0;
    if !fits || shape[0] == 0 {
        return Ok(None);
    }
    // The address is from numpy's own struct: a subclass may describe itself wrongly.
    // SAFETY: the array is alive, and the interpreter is held.
    let address = unsafe { (*_PyArray_GET_ITEM_DATA(array.as_array_ptr())).data } as u64;
    let shape = Shape {
        address,
        place: Place { kind: CPU, ordinal: 0 },
        dtype: Dtype { code: FLOAT, bits: size as u8 * 8, lanes: 1 },
        shape: shape.iter().map(|&n| n as i64).collect(),
        strides: strides.iter().map(|&s| (s / size) as i64).collect(),
    };
    // An address that is no multiple of the number's size.
    if !address.is_multiple_of(size as u64) {
        return Ok(None);
    }
    Ok(Some(BorrowedRows {
        rows: rows(&shape, width as i64, what)?,
        held: Held::Object { _array: array.into_any().unbind() },
    }))
}

/// Rows of numbers as the library takes them.
fn rows(of: &Shape, width: i64, what: &str) -> PyResult<DeviceRows> {
    let number = match of.dtype {
        Dtype { code: FLOAT, bits: 32, lanes: 1 } => Number::F32,
        Dtype { code: FLOAT, bits: 64, lanes: 1 } => Number::F64,
        Dtype { code, bits, .. } => {
            return Err(choice(
                format!("{what} of {bits} bit numbers (DLPack's kind {code})"),
                "give numbers in single or double precision",
            ));
        }
    };
    // One row may stand alone.
    let (count, stride, within) = match (&of.shape[..], &of.strides[..]) {
        ([n, columns], [row, column]) if *columns == width => (*n, *row, *column),
        ([columns], [column]) if *columns == width => (1, width, *column),
        (shape, _) => {
            return Err(choice(
                format!("{what} of shape {shape:?}"),
                format!("give rows of {width}: shape (n, {width})"),
            ));
        }
    };
    let size = number.bytes();
    let bytes = usize::try_from(stride).ok().and_then(|stride| stride.checked_mul(size));
    let (Some(bytes), 1, Ok(count)) = (bytes, within, usize::try_from(count)) else {
        return Err(choice(
            format!("{what} whose rows are not packed, or run backwards"),
            "give a contiguous array: numbers of a row side by side",
        ));
    };
    // SAFETY: by the array's own description, rows of such numbers are there. The returned value
    // holds the array, and the detector releases it when the work is done. The documentation
    // requires of the caller that no other code writes them meanwhile.
    unsafe { DeviceRows::new(of.address, count, bytes, number) }.map_err(raised)
}

/// The second door, of what has no DLPack: what it says of itself, on the first GPU, and which stream makes it.
fn by_cuda_array_interface(object: &Bound<'_, PyAny>, what: &str) -> PyResult<(Shape, Option<u64>)> {
    let told = object.getattr("__cuda_array_interface__")?.cast_into::<PyDict>()?;
    let item = |name: &str| {
        told.get_item(name)?.ok_or_else(|| {
            choice(
                format!("{what} without {name} in __cuda_array_interface__"),
                "give what keeps to the protocol",
            )
        })
    };
    let (address, _) = item("data")?.extract::<(u64, bool)>()?;
    let shape = item("shape")?.extract::<Vec<i64>>()?;
    let bits = match item("typestr")?.extract::<String>()?.as_str() {
        "<f4" => 32,
        "<f8" => 64,
        other => {
            return Err(choice(
                format!("{what} of type {other}"),
                "give numbers in single or double precision",
            ));
        }
    };
    let strides = match told.get_item("strides")? {
        Some(bytes) if !bytes.is_none() => {
            let (bytes, size) = (bytes.extract::<Vec<i64>>()?, i64::from(bits / 8));
            if let Some(odd) = bytes.iter().find(|&&stride| stride % size != 0) {
                return Err(choice(
                    format!("{what} with a stride of {odd} bytes between numbers of {size}"),
                    "give an array whose strides are multiples of the number's size: a copy is one",
                ));
            }
            bytes.into_iter().map(|stride| stride / size).collect()
        }
        _ => packed(&shape),
    };
    let theirs =
        told.get_item("stream")?.map(|stream| stream.extract::<Option<u64>>()).transpose()?.flatten();
    let dtype = Dtype { code: FLOAT, bits, lanes: 1 };
    Ok((Shape { address, place: Place { kind: CUDA, ordinal: 0 }, dtype, shape, strides }, theirs))
}
