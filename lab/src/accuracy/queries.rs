//! Folders of query files.

use crate::case::{Case, file};
use nearmiss::error::Error;
use std::path::{Path, PathBuf};

/// Queries of one folder, in the order of its files.
pub struct Queries {
    /// The folder, below the one that was given.
    pub name: String,
    /// The questions.
    pub cases: Vec<Case>,
    /// Whether each meets, by the file.
    pub meets: Vec<bool>,
}

/// Walks a folder: every `.csv` and `.csv.gz` in a folder called `vertex-face` or `edge-edge` is read, in order of names.
///
/// # Errors
/// [`Error::Choice`] for a folder without such a file; [`Error::Input`] for a row that cannot be used, with its line.
pub fn queries(root: &Path) -> Result<Vec<Queries>, Error> {
    let mut files = Vec::new();
    walk(root, &mut files)?;
    files.sort();
    let mut all: Vec<Queries> = Vec::new();
    for path in files {
        let name = path.to_string_lossy();
        let (Some(folder), Some(features)) = (path.parent(), file::features(&path)) else { continue };
        if !name.ends_with(".csv") && !name.ends_with(".csv.gz") {
            continue;
        }
        let name = folder.strip_prefix(root).unwrap_or(folder).display().to_string();
        let (cases, meets): (Vec<_>, Vec<_>) = file::queries(&path, features)?.into_iter().unzip();
        match all.last_mut().filter(|last| last.name == name) {
            Some(last) => {
                last.cases.extend(cases);
                last.meets.extend(meets);
            }
            None => all.push(Queries { name, cases, meets }),
        }
    }
    if all.is_empty() {
        return Err(bad(root, "no folder vertex-face or edge-edge with a .csv or .csv.gz file below it"));
    }
    Ok(all)
}

fn bad(folder: &Path, what: impl std::fmt::Display) -> Error {
    Error::Choice {
        what: format!("{}: {what}", folder.display()),
        advice:
            "give a folder of query files: eight rows a query, three numerators and denominators, and 0 or 1"
                .into(),
    }
}

fn walk(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Error> {
    for entry in std::fs::read_dir(folder).map_err(|e| bad(folder, e))? {
        let path = entry.map_err(|e| bad(folder, e))?.path();
        if path.is_dir() {
            walk(&path, files)?;
        } else {
            files.push(path);
        }
    }
    Ok(())
}
