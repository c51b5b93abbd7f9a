//! The files of the mesh, and those of `--with`.

use clap::ArgMatches;
use nearmiss::error::Error;
use std::path::PathBuf;

/// Parts the files. `--with` takes one file and may be given twice. Files right after it are its own
/// too if the mesh is named before it, and the mesh's otherwise.
pub fn part(matches: &ArgMatches, meshes: &mut Vec<PathBuf>, with: &mut Vec<PathBuf>) {
    let places = |id| matches.indices_of(id).into_iter().flatten().collect::<Vec<_>>();
    let (of_mesh, mut of_with) = (places("meshes"), places("with"));
    let before = of_mesh.first() < of_with.first();
    let named = std::mem::take(meshes);
    for (file, at) in named.into_iter().zip(of_mesh) {
        if before && of_with.contains(&(at - 1)) {
            of_with.push(at);
            with.push(file);
        } else {
            meshes.push(file);
        }
    }
}

/// A step has two ends.
///
/// # Errors
/// [`Error::InvalidArgument`] for more than two of either.
pub fn at_most_two(meshes: &[PathBuf], with: &[PathBuf]) -> Result<(), Error> {
    match [("MESH", meshes.len()), ("--with", with.len())].into_iter().find(|(_, files)| *files > 2) {
        None => Ok(()),
        Some((of, files)) => Err(Error::InvalidArgument {
            what: format!("{of} takes one or two files, got {files}"),
            advice: "give one mesh, or both ends of a step".into(),
        }),
    }
}

/// A mesh rests, or has as many frames as the other.
///
/// # Errors
/// [`Error::InvalidArgument`] for different numbers of frames.
pub fn as_many(meshes: &[PathBuf], with: &[PathBuf]) -> Result<(), Error> {
    match (meshes.len(), with.len()) {
        (a, b) if a < 2 || b < 2 || a == b => Ok(()),
        (a, b) => Err(Error::InvalidArgument {
            what: format!("MESH and --with must have equal numbers of frames, got {a} and {b}"),
            advice: "give as many files for each, or one file for a mesh at rest".into(),
        }),
    }
}
