//! Bodies that come, go and change, and pairs of them that are left out.

use crate::body::{NearmissBody, thickness};
use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, call, given, refused};
use crate::rows::items;
use crate::scene::NearmissScene;
use nearmiss::Error;
use nearmiss::scene::{BodyId, Scene};
use std::mem::MaybeUninit;

/// Adds a body, and writes its number to `id`, which may be NULL. Numbers of removed bodies are
/// used again. The next query rebuilds.
///
/// # Safety
/// Memory that the body points to is there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_add(
    detector: Option<&mut NearmissDetector>,
    body: Option<&NearmissBody>,
    id: Option<&mut MaybeUninit<u32>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        // SAFETY: the caller's promise.
        let body = unsafe { given(body, "body")?.body() }?;
        let added = own.detector.add(body)?;
        if let Some(id) = id {
            id.write(added.index() as u32);
        }
        Ok(())
    })
}

/// Replaces a body by another, of any mesh, under the same number. The next query rebuilds.
///
/// # Safety
/// Memory that the body points to is there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_replace(
    detector: Option<&mut NearmissDetector>,
    id: u32,
    body: Option<&NearmissBody>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        // SAFETY: the caller's promise.
        let body = unsafe { given(body, "body")?.body() }?;
        own.detector.replace(own.body(id)?, body)
    })
}

/// Removes a body. The others keep their numbers. The next query rebuilds.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_remove(
    detector: Option<&mut NearmissDetector>,
    id: u32,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| own.detector.remove(own.body(id)?).map(drop))
}

/// Sets the thickness of a body, from the next query on, which rebuilds: `count` radii, as those of
/// `NearmissBody`. If it is the same, nothing changes. Another one ends the preparation of
/// submissions.
///
/// Fails with `NEARMISS_INVALID_ARGUMENT` for a radius that is no length, and for another number of
/// radii. Then the thickness is as before.
///
/// # Safety
/// `radii` points to that many numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_set_thickness(
    detector: Option<&mut NearmissDetector>,
    id: u32,
    radii: *const f64,
    count: usize,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        // SAFETY: the caller's promise.
        let radii = unsafe { items(radii, count, "radii") }?;
        own.detector.set_thickness(own.body(id)?, thickness(radii)?)
    })
}

/// The pairs of bodies in a list of the caller.
///
/// # Safety
/// `pairs` points to twice as many numbers as `count`, if that is not 0.
unsafe fn pairs_of(scene: &Scene, pairs: *const u32, count: usize) -> Result<Vec<[BodyId; 2]>, Error> {
    // SAFETY: the caller's promise.
    let numbers = unsafe { items(pairs.cast::<[u32; 2]>(), count, "pairs") }?;
    let of = |&number: &u32| {
        let advice = "pass the number that adding it returned, until it is removed";
        let missing = || refused(format!("there is no body {number} in the scene"), advice);
        scene.id(number as usize).ok_or_else(missing)
    };
    numbers.iter().map(|[a, b]| Ok([of(a)?, of(b)?])).collect()
}

/// Replaces the list of pairs of bodies that are not tested against each other, by any query: as
/// the links of a robot that share a joint. `pairs` has `count` pairs, two numbers of bodies each.
/// Order and repeats do not matter; a count of 0 leaves out none.
///
/// Fails with `NEARMISS_INVALID_ARGUMENT` for a body that is not in the scene, for a body with
/// itself, and for a scene of which a detector has a copy. Then the list is as before.
///
/// # Safety
/// `pairs` points to that many numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_scene_leave_out(
    scene: Option<&mut NearmissScene>,
    pairs: *const u32,
    count: usize,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let scene = given(scene, "scene")?;
        if *scene.is_copied.get_mut() {
            let what = "scene was copied by a detector, which would not see the list";
            return Err(refused(what, "call nearmiss_detector_leave_out, or make another scene"));
        }
        // SAFETY: the caller's promise.
        let list = unsafe { pairs_of(&scene.scene, pairs, count) }?;
        scene.scene.leave_out(&list)
    })
}

/// As `nearmiss_scene_leave_out`, from the next query on, which rebuilds. A removed body takes its
/// pairs with it, a replaced one keeps them. Another list ends the preparation of submissions.
///
/// # Safety
/// `pairs` points to that many numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_leave_out(
    detector: Option<&mut NearmissDetector>,
    pairs: *const u32,
    count: usize,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        // SAFETY: the caller's promise.
        let list = unsafe { pairs_of(own.detector.scene(), pairs, count) }?;
        own.detector.leave_out(&list)
    })
}

/// Writes the pairs of bodies that are left out, two numbers each: the smaller one first,
/// ascending. They live until a call changes the bodies or the list.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_left_out(
    detector: Option<&mut NearmissDetector>,
    pairs: Option<&mut MaybeUninit<*const u32>>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let (pairs, count) = (given(pairs, "pairs")?, given(count, "count")?);
        let list = own.detector.left_out();
        // A number of a body is a u32.
        pairs.write(list.as_ptr().cast());
        count.write(list.len());
        Ok(())
    })
}
