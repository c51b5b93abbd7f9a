//! Tables of measured figures: made from `benches/results/**/*.csv` and written into pages.
//!
//! A page marks the place of a table by two lines:
//!
//! ```text
//! <!-- figures: NAME -->
//! <!-- end -->
//! ```
//!
//! `benches/tables.toml` says what each table shows. `benches/results/origins.csv` says on which
//! machine and when each file was measured. `cargo run -p nearmiss-lab --example figures` writes
//! the tables; `tests/architecture/figures.rs` compares them.

mod page;
mod recorded;
mod table;

pub use page::{names, refill};
pub use table::Tables;

use std::fs;
use std::path::{Path, PathBuf};

/// Pages that may hold tables, from the root of the repository.
///
/// # Errors
/// A sentence if a folder cannot be read.
pub fn pages(root: &Path) -> Result<Vec<PathBuf>, String> {
    let mut found = vec![root.join("README.md")];
    let mut folders = vec![root.join("docs")];
    while let Some(folder) = folders.pop() {
        let entries = fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        for entry in entries {
            let path = entry.map_err(|e| format!("{}: {e}", folder.display()))?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "md") {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}
