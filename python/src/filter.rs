//! Environments, groups and masks of bodies.

use crate::errors::{choice, integer, optional};
use pyo3::prelude::*;

/// An environment, or none of a body that is in all.
pub fn environment_of(given: &Bound<'_, PyAny>) -> PyResult<Option<u32>> {
    Ok(optional(given, "environment", [0, u32::MAX.into()])?.map(|environment| environment as u32))
}

/// Groups of a body: one at least.
pub fn group_of(given: &Bound<'_, PyAny>) -> PyResult<u32> {
    match bits(given, "group")? {
        0 => Err(choice(
            "group is 0: the body is in no group",
            "set mask=0 for a body that collides with no other",
        )),
        group => Ok(group),
    }
}

/// Groups that a body meets.
pub fn mask_of(given: &Bound<'_, PyAny>) -> PyResult<u32> {
    bits(given, "mask")
}

/// 32 bits; of a negative number, as ~1, the low ones.
fn bits(given: &Bound<'_, PyAny>, name: &str) -> PyResult<u32> {
    Ok(integer(given, name, [i32::MIN.into(), u32::MAX.into()])? as u32)
}
