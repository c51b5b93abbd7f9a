//! Arrays in the host's memory.

use crate::errors::{choice, raised};
use nearmiss::Mesh;
use nearmiss::mesh::Positions;
use numpy::{
    Element, PyArray2, PyArrayDescrMethods, PyArrayMethods, PyReadonlyArray2, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;
use std::path::PathBuf;

/// Reads a PLY or OBJ file: (vertices, faces), (n, 3) float32 or float64 as the file has them, and (m, 3) uint32.
///
/// Raises InputError for what is no mesh, with the line or element. Polygons are cut into triangles.
#[pyfunction]
pub fn read_mesh<'py>(
    py: Python<'py>,
    path: PathBuf,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyArray2<u32>>)> {
    let mesh = py.detach(|| Mesh::read(&path)).map_err(raised)?;
    let vertices = match mesh.positions() {
        Positions::F32(points) => rows(py, points).into_any(),
        Positions::F64(points) => rows(py, points).into_any(),
    };
    Ok((vertices, rows(py, mesh.faces())))
}

/// Rows of numbers, copied.
pub fn rows<'py, T: Element + Copy + bytemuck::Pod, const N: usize>(
    py: Python<'py>,
    rows: &[[T; N]],
) -> Bound<'py, PyArray2<T>> {
    let flat = numpy::PyArray1::from_slice(py, rows.as_flattened());
    // So many numbers there are.
    #[allow(clippy::expect_used, reason = "rows times columns are all numbers")]
    flat.reshape([rows.len(), N]).expect("rows of equal length")
}

/// As an array of numpy whose numbers are aligned: itself if it is one, without a copy where its maker allows that.
pub fn asarray<'py>(object: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyUntypedArray>> {
    let made = object.py().import("numpy")?.call_method1("require", (object, object.py().None(), "A"))?;
    Ok(made.cast_into::<PyUntypedArray>()?)
}

/// Whether these are numbers in single or double precision, as the machine has them.
pub fn are_floats(array: &Bound<'_, PyUntypedArray>) -> bool {
    let dtype = array.dtype();
    dtype.kind() == b'f' && [4, 8].contains(&dtype.itemsize()) && [b'=', b'|'].contains(&dtype.byteorder())
}

/// Numbers in single or in double precision, as they are; other numbers become doubles.
fn floats<'py>(object: &Bound<'py, PyAny>, what: &str) -> PyResult<Bound<'py, PyUntypedArray>> {
    let array = asarray(object)?;
    let dtype = array.dtype();
    match (dtype.kind(), dtype.itemsize()) {
        _ if are_floats(&array) => Ok(array),
        (b'f' | b'i' | b'u', ..=8) => {
            let kwargs = [("copy", false)].into_py_dict(object.py())?;
            Ok(array.call_method("astype", ("=f8",), Some(&kwargs))?.cast_into()?)
        }
        _ => Err(choice(
            format!("{what} of type {}", dtype.str()?),
            "give numbers in single or double precision, or integers",
        )),
    }
}

/// Points, three numbers each, copied.
pub fn positions(object: &Bound<'_, PyAny>, what: &str) -> PyResult<Positions> {
    let array = floats(object, what)?;
    of_three(&array, what)?;
    if let Ok(points) = array.cast::<PyArray2<f32>>() {
        return Ok(Positions::F32(triples(&points.readonly())));
    }
    Ok(Positions::F64(triples(&array.cast::<PyArray2<f64>>()?.readonly())))
}

/// Triangles, three vertex indices each, copied.
pub fn faces(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<[u32; 3]>> {
    let array = asarray(object)?;
    let (kind, shape) = (array.dtype().kind(), array.shape().to_vec());
    let empty = shape.iter().product::<usize>() == 0;
    if empty && (shape.len() == 1 || shape.get(1) == Some(&3)) {
        return Ok(Vec::new());
    }
    if !matches!(kind, b'i' | b'u') {
        return Err(choice(
            format!("faces of {name} of type {}", array.dtype().str()?),
            "give integers: three vertex indices a triangle",
        ));
    }
    of_three(&array, &format!("faces of {name}"))?;
    if let Ok(faces) = array.cast::<PyArray2<u32>>() {
        return Ok(triples(&faces.readonly()));
    }
    let wide = array.call_method1("astype", ("=i8",))?;
    let wide = triples(&wide.cast::<PyArray2<i64>>()?.readonly());
    let mut faces = Vec::with_capacity(wide.len());
    for (face, corners) in wide.iter().enumerate() {
        let mut own = [0; 3];
        for (to, &from) in own.iter_mut().zip(corners) {
            *to = u32::try_from(from).map_err(|_| {
                choice(
                    format!("face {face} of {name} names vertex {from}"),
                    "give indices from 0, as many as there are vertices",
                )
            })?;
        }
        faces.push(own);
    }
    Ok(faces)
}

/// A row of numbers in double precision.
pub fn row<const N: usize>(object: &Bound<'_, PyAny>, what: &str) -> PyResult<[f64; N]> {
    let numbers: Vec<f64> = asarray(object)?.call_method0("tolist")?.extract()?;
    let count = numbers.len();
    numbers.try_into().map_err(|_| choice(format!("{what} of {count} numbers"), format!("give {N}")))
}

/// Refuses what are not rows of three.
fn of_three(array: &Bound<'_, PyUntypedArray>, what: &str) -> PyResult<()> {
    match array.shape() {
        [_, 3] => Ok(()),
        shape => Err(choice(format!("{what} of shape {shape:?}"), "give rows of three: shape (n, 3)")),
    }
}

fn triples<T: Element + Copy>(array: &PyReadonlyArray2<'_, T>) -> Vec<[T; 3]> {
    let array = array.as_array();
    array.rows().into_iter().map(|row| [row[0], row[1], row[2]]).collect()
}
