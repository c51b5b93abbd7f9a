//! The bodies of a detector.

use crate::body::NearmissBody;
use crate::error::{NearmissCode, NearmissError, call, free, given, make, refused};
use nearmiss::Scene;
use std::mem::MaybeUninit;
use std::sync::atomic::AtomicBool;

/// Bodies, by their numbers.
pub struct NearmissScene {
    pub(crate) scene: Scene,
    /// Whether a detector has a copy.
    pub(crate) is_copied: AtomicBool,
}

/// A scene without bodies.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_scene_create(
    scene: Option<&mut MaybeUninit<*mut NearmissScene>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(scene, "scene", error, || {
        Ok(NearmissScene { scene: Scene::new(), is_copied: AtomicBool::new(false) })
    })
}

/// Adds a body and writes its number to `id`, which may be NULL. Numbers count from 0. Cost: a copy
/// of the mesh, and a pass over it.
///
/// Fails with `NEARMISS_INPUT` for positions that are not finite or too large and for indices out
/// of range, naming the first. Fails with `NEARMISS_INVALID_ARGUMENT` for a field without a
/// meaning, and for a scene of which a detector has a copy. Then nothing is added.
///
/// # Safety
/// Memory that the body points to is there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_scene_add(
    scene: Option<&mut NearmissScene>,
    body: Option<&NearmissBody>,
    id: Option<&mut MaybeUninit<u32>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let scene = given(scene, "scene")?;
        if *scene.is_copied.get_mut() {
            let what = "scene was copied by a detector, which would not see the body";
            return Err(refused(what, "call nearmiss_detector_add, or make another scene"));
        }
        // SAFETY: the caller's promise.
        let body = unsafe { given(body, "body")?.body() }?;
        let added = scene.scene.add(body);
        if let Some(id) = id {
            id.write(added.index() as u32);
        }
        Ok(())
    })
}

/// Frees the scene. Detectors keep their copies.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_scene_free(scene: Option<Box<NearmissScene>>) {
    free(scene);
}
