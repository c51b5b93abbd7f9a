//! Arrays that a detector reads where they lie.

use crate::dlpack::{CPU, CUDA, CUDA_MANAGED, Dtype, FLOAT, Place, Shape, Taken, packed};
use crate::errors::{choice, raised};
use crate::host::are_floats;
use nearmiss::Device;
use nearmiss::scene::{DeviceRows, Number};
use numpy::{PyArrayDescrMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

/// What keeps an array where it is.
pub enum Held {
    /// What DLPack gave.
    Taken { _tensor: Taken },
    /// The array itself.
    Object { _array: Py<PyAny> },
}

/// Rows of an array, and what holds it.
pub struct LentRows {
    pub rows: DeviceRows,
    pub held: Held,
}

/// Whether an array lies in the memory of an NVIDIA GPU.
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

/// Rows of `width` numbers in a GPU's memory, behind all work that makes them.
pub fn on_gpu(object: &Bound<'_, PyAny>, device: &Device, (width, what): (i64, &str)) -> PyResult<LentRows> {
    let Some((ordinal, stream)) = device.ordinal().zip(device.stream()) else {
        return Err(choice(
            format!("{what} on a GPU for a detector on the CPU"),
            "give the detector a device of that GPU, or arrays of the host",
        ));
    };
    let (shape, held) = if object.hasattr("__dlpack__")? {
        // 0 has no meaning there; 1 is the default stream.
        let kwargs = [("stream", stream.max(1))].into_py_dict(object.py())?;
        let tensor = Taken::of(&object.call_method("__dlpack__", (), Some(&kwargs))?)?;
        (tensor.shape()?, Held::Taken { _tensor: tensor })
    } else {
        (
            by_cuda_array_interface(object, (ordinal, stream), what)?,
            Held::Object { _array: object.clone().unbind() },
        )
    };
    if shape.place.ordinal != ordinal as i32 {
        return Err(choice(
            format!("{what} on GPU {} for a detector on GPU {ordinal}", shape.place.ordinal),
            "put both on one",
        ));
    }
    Ok(LentRows { rows: rows(&shape, width, what)?, held })
}

/// Points in the host's memory, which the CPU's kernels read where they lie; none where they are not laid out for that.
pub fn on_cpu(object: &Bound<'_, PyAny>, what: &str) -> PyResult<Option<LentRows>> {
    let array = if let Ok(array) = object.cast::<PyUntypedArray>() {
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
    let fits =
        shape.len() == 2 && shape[1] == 3 && strides[1] == size && strides[0] > 0 && strides[0] % size == 0;
    if !fits || shape[0] == 0 {
        return Ok(None);
    }
    let told = array.getattr("__array_interface__")?;
    let (address, _) = told.get_item("data")?.extract::<(u64, bool)>()?;
    let shape = Shape {
        address,
        place: Place { kind: CPU, ordinal: 0 },
        dtype: Dtype { code: FLOAT, bits: size as u8 * 8, lanes: 1 },
        shape: shape.iter().map(|&n| n as i64).collect(),
        strides: strides.iter().map(|&s| (s / size) as i64).collect(),
    };
    // An address that is no multiple of the number's size.
    if address % size as u64 != 0 {
        return Ok(None);
    }
    Ok(Some(LentRows {
        rows: rows(&shape, 3, what)?,
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
    if within != 1 || stride < 0 {
        return Err(choice(
            format!("{what} whose rows are not packed, or run backwards"),
            "give a contiguous array: numbers of a row side by side",
        ));
    }
    let size = number.bytes();
    // SAFETY: the array's own description says that rows of such numbers lie there; what is returned holds it, and the detector lets
    // go of it when the work is done. That nobody writes them meanwhile is told to the caller.
    unsafe { DeviceRows::new(of.address, count as usize, stride as usize * size, number) }.map_err(raised)
}

/// The second door, of what has no DLPack.
fn by_cuda_array_interface(
    object: &Bound<'_, PyAny>,
    (ordinal, stream): (u32, u64),
    what: &str,
) -> PyResult<Shape> {
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
            bytes.extract::<Vec<i64>>()?.into_iter().map(|s| s * 8 / i64::from(bits)).collect()
        }
        _ => packed(&shape),
    };
    // Where it says which stream makes the data that must be ours: nothing here waits for another.
    let theirs = match told.get_item("stream")? {
        Some(theirs) if !theirs.is_none() => theirs.extract::<u64>()?,
        _ => stream.max(1),
    };
    if theirs != stream.max(1) {
        return Err(choice(
            format!("{what} of stream {theirs} for a detector on stream {stream}"),
            "open the device on that stream: Device(stream=…)",
        ));
    }
    let dtype = Dtype { code: FLOAT, bits, lanes: 1 };
    Ok(Shape { address, place: Place { kind: CUDA, ordinal: ordinal as i32 }, dtype, shape, strides })
}
