//! Which bodies there are.

use crate::body::NearmissBody;
use crate::error::{NearmissCode, NearmissError, call, free, given, make, refused};
use nearmiss::Scene;
use nearmiss::scene::BodyId;
use std::mem::MaybeUninit;
use std::sync::atomic::AtomicBool;

/// Bodies, by their numbers.
pub struct NearmissScene {
    pub(crate) scene: Scene,
    /// The library's name of each number.
    pub(crate) ids: Vec<BodyId>,
    /// Whether a detector has taken a copy.
    pub(crate) taken: AtomicBool,
}

/// A scene without bodies.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_scene_new(
    scene: Option<&mut MaybeUninit<*mut NearmissScene>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(scene, "the scene", error, || {
        Ok(NearmissScene { scene: Scene::new(), ids: Vec::new(), taken: AtomicBool::new(false) })
    })
}

/// Adds a body and tells its number: they are counted from 0. `id` may be NULL. Cost: a copy of the mesh, and a pass over it.
///
/// Fails with `NEARMISS_INPUT` for positions that are not finite or too large, and for indices out of range, naming the first; with
/// `NEARMISS_INVALID_ARGUMENT` for a body that cannot be, and for a scene of which a detector has a copy.
/// Then nothing is added.
///
/// # Safety
/// What the body points to is there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_scene_add(
    scene: Option<&mut NearmissScene>,
    body: Option<&NearmissBody>,
    id: Option<&mut MaybeUninit<u32>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let scene = given(scene, "the scene")?;
        if *scene.taken.get_mut() {
            let what = "adding to a scene of which a detector has a copy, which would not change";
            return Err(refused(what, "add to the detector, or make another scene"));
        }
        // SAFETY: the caller's promise.
        let body = unsafe { given(body, "the body")?.body() }?;
        let added = scene.scene.add(body);
        scene.ids.push(added);
        if let Some(id) = id {
            id.write(added.index() as u32);
        }
        Ok(())
    })
}

/// Frees the scene. Detectors have their own.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_scene_free(scene: Option<Box<NearmissScene>>) {
    free(scene);
}
