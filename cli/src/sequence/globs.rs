//! Patterns of files in scenes: `cloth.*.ply` is all frames of cloth, in the order of their numbers.

use super::film::natural;
use glob::{MatchOptions, Pattern, glob_with};
use std::path::{Path, PathBuf};

/// As in a shell: a star is no separator, and no dot at the beginning of a name.
const AS_IN_A_SHELL: MatchOptions =
    MatchOptions { case_sensitive: true, require_literal_separator: true, require_literal_leading_dot: true };

/// The files, patterns expanded, relative to a folder. A file that has a pattern as its name is that
/// file.
///
/// # Errors
/// The fault of a pattern and its remedy.
pub fn expanded(folder: &Path, names: Vec<PathBuf>) -> Result<Vec<PathBuf>, (String, &'static str)> {
    let mut all = Vec::with_capacity(names.len());
    for name in names {
        let text = name.to_string_lossy();
        if !text.contains(['*', '?', '[']) || folder.join(&name).is_file() {
            all.push(name);
            continue;
        }
        let within = Pattern::escape(&folder.to_string_lossy());
        let pattern = Path::new(&within).join(&name);
        let found = glob_with(&pattern.to_string_lossy(), AS_IN_A_SHELL).map_err(|e| {
            (format!("`meshes` has the pattern {text:?}, which is malformed: {}", e.msg), "correct it")
        })?;
        // A folder that cannot be read has no files that match.
        let found = found.flatten().filter(|file| file.is_file());
        let mut found: Vec<PathBuf> =
            found.map(|file| file.strip_prefix(folder).map(Path::to_owned).unwrap_or(file)).collect();
        if found.is_empty() {
            return Err((format!("no file matches {text:?}"), "correct the pattern of `meshes`"));
        }
        found.sort_by_cached_key(|file| natural(file));
        all.append(&mut found);
    }
    Ok(all)
}
