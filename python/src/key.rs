//! Bodies by number or by name.

use crate::errors::choice;
use nearmiss::error::Error;
use nearmiss::scene::{BodyId, Scene};
use pyo3::prelude::*;
use pyo3::types::PyString;

/// How Python names a body.
pub enum Key {
    Number(usize),
    Name(String),
}

impl Key {
    /// The key of a body; `what` are the keys of the argument, in messages.
    pub fn of(given: &Bound<'_, PyAny>, what: &str) -> PyResult<Key> {
        if let Ok(number) = given.extract() {
            return Ok(Key::Number(number));
        }
        if let Ok(name) = given.extract() {
            return Ok(Key::Name(name));
        }
        Err(choice(
            format!("{what} must be body numbers or names, got {}", given.repr()?),
            "use a number that add returned, or the name of a body",
        ))
    }
}

/// The key of an argument `body`.
pub fn body_of(given: &Bound<'_, PyAny>) -> PyResult<Key> {
    Key::of(given, "bodies")
}

/// The bodies of keys, in their order.
///
/// # Errors
/// [`Error::InvalidArgument`] for the first number or name that is not of one body.
pub fn bodies(scene: &Scene, keys: &[Key]) -> Result<Vec<BodyId>, Error> {
    let names =
        keys.iter().filter_map(|key| if let Key::Name(name) = key { Some(name.as_str()) } else { None });
    let names: Vec<&str> = names.collect();
    let named = if names.is_empty() { Vec::new() } else { scene.ids_of(names)? };
    let mut named = named.into_iter();
    let of = |key: &Key| match key {
        Key::Number(number) => scene.id(*number).ok_or_else(|| missing(number)),
        Key::Name(name) => named.next().ok_or_else(|| missing(name)),
    };
    keys.iter().map(of).collect()
}

/// The bodies of `N` keys.
///
/// # Errors
/// As of [`bodies`].
pub fn each<const N: usize>(scene: &Scene, keys: &[Key; N]) -> Result<[BodyId; N], Error> {
    let all = bodies(scene, keys)?;
    Ok(std::array::from_fn(|at| all[at]))
}

/// Pairs of bodies, as Python names them.
pub type Pairs = Vec<[Key; 2]>;

/// The pairs of bodies of an argument `pairs`.
pub fn pairs_of(given: &Bound<'_, PyAny>) -> PyResult<Pairs> {
    let mut pairs = Vec::new();
    let wrong = |got: &Bound<'_, PyAny>| -> PyResult<PyErr> {
        let what = format!("pairs must be a list of pairs of bodies, got {}", got.repr()?);
        Ok(choice(what, "use [(a, b), ...] with numbers or names"))
    };
    let Ok(items) = given.try_iter() else { return Err(wrong(given)?) };
    for item in items {
        let item = item?;
        if item.is_instance_of::<PyString>() {
            return Err(wrong(&item)?);
        }
        let Ok([a, b]) = item.extract::<[Bound<'_, PyAny>; 2]>() else { return Err(wrong(&item)?) };
        pairs.push([body_of(&a)?, body_of(&b)?]);
    }
    Ok(pairs)
}

/// The bodies of pairs of keys.
///
/// # Errors
/// As of [`bodies`].
pub fn pairs(scene: &Scene, pairs: &[[Key; 2]]) -> Result<Vec<[BodyId; 2]>, Error> {
    let all = bodies(scene, pairs.as_flattened())?;
    Ok(all.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect())
}

/// Pairs of bodies, as Python has them.
pub fn numbers(pairs: &[[BodyId; 2]]) -> Vec<(usize, usize)> {
    pairs.iter().map(|[a, b]| (a.index(), b.index())).collect()
}

fn missing(body: &impl std::fmt::Display) -> Error {
    Error::InvalidArgument {
        what: format!("body {body} is not in the scene"),
        advice: "use a number that add returned".into(),
    }
}
