//! Bodies by their names.

use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, call, given, refused};
use crate::rows::text;
use crate::scene::NearmissScene;
use nearmiss::{Error, Scene};
use std::ffi::{CString, c_char};
use std::mem::MaybeUninit;

/// The number of the one body with a name.
///
/// # Safety
/// A `name` that is not NULL is a text.
unsafe fn id_of(scene: &Scene, name: *const c_char) -> Result<u32, Error> {
    // SAFETY: the caller's promise.
    let name = unsafe { text(name) }.ok_or_else(|| refused("name is NULL", "pass a text"))?;
    scene.id_of(&name).map(|id| id.index() as u32)
}

/// Writes the number of the body with that name to `id`.
///
/// Fails with `NEARMISS_INVALID_ARGUMENT` if no body has the name, or several have. The message
/// lists them.
///
/// # Safety
/// `name` is a text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_scene_id(
    scene: Option<&NearmissScene>,
    name: *const c_char,
    id: Option<&mut MaybeUninit<u32>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let (scene, id) = (given(scene, "scene")?, given(id, "id")?);
        // SAFETY: the caller's promise.
        id.write(unsafe { id_of(&scene.scene, name) }?);
        Ok(())
    })
}

/// Writes the number of the body with that name to `id`. Fails as `nearmiss_scene_id`.
///
/// # Safety
/// `name` is a text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_id(
    detector: Option<&mut NearmissDetector>,
    name: *const c_char,
    id: Option<&mut MaybeUninit<u32>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let id = given(id, "id")?;
        // SAFETY: the caller's promise.
        id.write(unsafe { id_of(own.detector.scene(), name) }?);
        Ok(())
    })
}

/// Writes the name of a body, in UTF-8, to `name`. The text lives until the next call of this
/// function with the detector.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_name(
    detector: Option<&mut NearmissDetector>,
    body: u32,
    name: Option<&mut MaybeUninit<*const c_char>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let (id, name) = (own.body(body)?, given(name, "name")?);
        let text = own.detector.scene().get(id).map_or("", |body| body.name());
        // A text of C has no zeros.
        own.name = CString::new(text).map_err(|e| Error::Bug { what: e.to_string() })?;
        name.write(own.name.as_ptr());
        Ok(())
    })
}
