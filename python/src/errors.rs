//! The library's errors as exceptions: one class a variant, each with the library's sentence.

use nearmiss::Error;
use nearmiss::query::Named;
use pyo3::prelude::*;

/// The classes of `lib/nearmiss/errors.py`.
mod classes {
    use pyo3::import_exception;

    import_exception!(nearmiss.errors, NearmissError);
    import_exception!(nearmiss.errors, InputError);
    import_exception!(nearmiss.errors, InvalidArgumentError);
    import_exception!(nearmiss.errors, DeviceError);
    import_exception!(nearmiss.errors, OutOfMemory);
    import_exception!(nearmiss.errors, Interrupted);
    import_exception!(nearmiss.errors, Bug);
    import_exception!(nearmiss.errors, MeshWarning);
}

use classes::{
    Bug, DeviceError, InputError, Interrupted, InvalidArgumentError, MeshWarning, NearmissError, OutOfMemory,
};

/// The exception of an error.
pub fn raised(error: Error) -> PyErr {
    let text = error.to_string();
    match error {
        Error::Input { .. } => InputError::new_err(text),
        Error::InvalidArgument { .. } => InvalidArgumentError::new_err(text),
        Error::Device { .. } | Error::KernelMismatch { .. } => DeviceError::new_err(text),
        Error::OutOfMemory { .. } | Error::AnswerTooLarge { .. } => OutOfMemory::new_err(text),
        Error::Interrupted => Interrupted::new_err(text),
        Error::Bug { .. } => Bug::new_err(text),
        _ => NearmissError::new_err(text),
    }
}

/// Warns of a mesh without some parts of its file. Returns an error if warnings are errors.
pub fn warn(py: Python<'_>, text: &str) -> PyResult<()> {
    let text = std::ffi::CString::new(text.replace('\0', "\\0"))?;
    PyErr::warn(py, &py.get_type::<MeshWarning>(), &text, 1)
}

/// An argument that does not exist or does not fit.
pub fn choice(what: impl Into<String>, advice: impl Into<String>) -> PyErr {
    raised(Error::InvalidArgument { what: what.into(), advice: advice.into() })
}

/// The choice of that name; `argument` is the argument's.
pub fn named<T: Named>(argument: &str, name: &str) -> PyResult<T> {
    T::of(name).ok_or_else(|| {
        choice(format!("{argument} has no choice {name:?}"), one_of(T::ALL.iter().map(|of| of.name())))
    })
}

/// An integer from `least` to `most`; `name` is the argument's.
pub fn integer(given: &Bound<'_, PyAny>, name: &str, [least, most]: [i64; 2]) -> PyResult<i64> {
    match given.extract::<i64>() {
        Ok(number) if (least..=most).contains(&number) => Ok(number),
        _ => Err(choice(
            format!("{name} must be an integer from {least} to {most}, got {}", given.repr()?),
            "give such a number",
        )),
    }
}

/// An integer that may be left out.
pub fn optional(given: &Bound<'_, PyAny>, name: &str, range: [i64; 2]) -> PyResult<Option<i64>> {
    if given.is_none() { Ok(None) } else { integer(given, name, range).map(Some) }
}

/// All names that there are.
pub fn one_of<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let quoted: Vec<String> = names.into_iter().map(|name| format!("\"{name}\"")).collect();
    format!("choose one of {}", quoted.join(", "))
}
