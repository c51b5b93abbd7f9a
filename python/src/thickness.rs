//! Thickness of bodies, as numbers and arrays.

use crate::errors::choice;
use crate::host::{are_numbers, asarray};
use nearmiss::Thickness;
use numpy::{PyArray1, PyArrayMethods, PyUntypedArrayMethods, ToPyArray};
use pyo3::prelude::*;
use pyo3::{Bound, IntoPyObjectExt};

/// A thickness: one number, or one for each vertex, copied.
pub fn thickness_of(given: &Bound<'_, PyAny>, name: &str) -> PyResult<Thickness> {
    if let Ok(radius) = given.extract::<f64>() {
        return Ok(Thickness::Same(radius));
    }
    let (array, what) = (asarray(given)?, format!("thickness of {name}"));
    are_numbers(&array, &what)?;
    if array.shape().len() != 1 {
        return Err(choice(
            format!("{what} of shape {:?}", array.shape()),
            "give a radius, or one for each vertex: shape (n,)",
        ));
    }
    let wide = array.call_method1("astype", ("=f8",))?.cast_into::<PyArray1<f64>>()?;
    Ok(Thickness::Each(wide.readonly().as_array().to_vec()))
}

/// The same for Python: a float, or an array.
pub fn to_python<'py>(py: Python<'py>, thickness: &Thickness) -> PyResult<Bound<'py, PyAny>> {
    match thickness {
        Thickness::Same(radius) => radius.into_bound_py_any(py),
        Thickness::Each(radii) => Ok(radii.to_pyarray(py).into_any()),
    }
}
