//! Paths of public test data. Its sources and licences are in docs/internals/accuracy.md; it is not
//! part of the project.
//!
//! build.rs looks for the folder. A test that needs it begins with
//! `#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]`, so that it is
//! reported as ignored without the data.

use std::path::PathBuf;

/// A file or folder of the public test data: in `NEARMISS_DATA`, else next to the repository.
pub fn data(path: &str) -> PathBuf {
    let root = std::env::var_os("NEARMISS_DATA").map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data")),
        PathBuf::from,
    );
    let path = root.join(path);
    assert!(path.exists(), "no {}; set NEARMISS_DATA to the folder of public test data", path.display());
    path
}
