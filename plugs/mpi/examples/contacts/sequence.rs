//! Parts of the program that read scene files, as they are there.

#[path = "../../../../cli/src/sequence/exclusions.rs"]
pub mod exclusions;
#[path = "../../../../cli/src/sequence/file.rs"]
pub mod file;
#[path = "../../../../cli/src/sequence/film.rs"]
pub mod film;
#[path = "../../../../cli/src/sequence/globs.rs"]
pub mod globs;
#[path = "../../../../cli/src/sequence/poses.rs"]
pub mod poses;

use nearmiss::Error;
use std::path::Path;

/// The folder from which a scene names its meshes.
pub fn folder_of(scene: &Path) -> &Path {
    scene.parent().unwrap_or(Path::new(""))
}

/// The fault of an error, and its remedy.
pub fn parts(error: &Error) -> (String, String) {
    let text = error.to_string();
    let (what, advice) = text.split_once("; ").unwrap_or((&text, "correct it"));
    (what.into(), advice.into())
}
