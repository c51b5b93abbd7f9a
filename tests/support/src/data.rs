//! Where public test data lies: its sources and licences are in docs/internals/accuracy.md. It is not part of the project.
//!
//! build.rs looks for the folder; a test that needs it opens with
//! `#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]`, so that it is reported as ignored
//! where there is none.

use std::path::PathBuf;

/// A file or folder of the public test data: below `NEARMISS_DATA`, else beside the repository.
pub fn data(path: &str) -> PathBuf {
    let root = std::env::var_os("NEARMISS_DATA").map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data")),
        PathBuf::from,
    );
    let path = root.join(path);
    assert!(path.exists(), "no {} (set NEARMISS_DATA to the folder of public test data)", path.display());
    path
}
