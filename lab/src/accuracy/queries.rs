//! Folders of query files.

use crate::case::{Case, file};
use nearmiss::error::Error;
use std::path::{Path, PathBuf};

/// Queries of one folder, in the order of its files.
pub struct Queries {
    /// The folder, relative to the given one.
    pub name: String,
    /// The cases.
    pub cases: Vec<Case>,
    /// Whether each meets, according to the file.
    pub meets: Vec<bool>,
}

/// Reads every `.csv` and `.csv.gz` in a folder called `vertex-face` or `edge-edge` below `root`,
/// in order of names.
///
/// # Errors
/// [`Error::InvalidArgument`] for a folder without such a file; [`Error::Input`] for an invalid
/// row, with its line.
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
        return Err(bad(root, "no .csv or .csv.gz file in a folder vertex-face or edge-edge below it"));
    }
    Ok(all)
}

fn bad(folder: &Path, what: impl std::fmt::Display) -> Error {
    Error::InvalidArgument {
        what: format!("{}: {what}", folder.display()),
        advice:
            "give a folder of query files: eight rows a query, three numerators and denominators, and 0 or 1"
                .into(),
    }
}

fn walk(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Error> {
    for entry in std::fs::read_dir(folder).map_err(|e| bad(folder, e))? {
        let entry = entry.map_err(|e| bad(folder, e))?;
        // Links to folders are not followed: one may form a cycle.
        if entry.file_type().map_err(|e| bad(folder, e))?.is_dir() {
            walk(&entry.path(), files)?;
        } else {
            files.push(entry.path());
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_link_that_leads_round_is_not_followed() {
        let root = std::env::temp_dir().join(format!("nearmiss-queries-{}", std::process::id()));
        let folder = root.join("vertex-face");
        fs::create_dir_all(&folder).expect("a folder");
        fs::write(folder.join("one.csv"), "0,1,0,1,0,1,1\n".repeat(8)).expect("a file");
        for name in ["a", "b", "c"] {
            std::os::unix::fs::symlink(&root, folder.join(name)).expect("a link");
        }
        std::os::unix::fs::symlink(folder.join("one.csv"), folder.join("two.csv")).expect("a link");
        let found = queries(&root);
        fs::remove_dir_all(&root).expect("ours");
        let found = found.expect("a folder of queries");
        assert_eq!((found.len(), found[0].cases.len()), (1, 2), "links to files are");
    }
}
