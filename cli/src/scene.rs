//! `scene`.

use super::args::SceneArgs;
use super::progress::during;
use nearmiss::error::Error;
use nearmiss::mesh::Mesh;
use nearmiss_lab::scene::{ANIMATIONS, Options, animation_with, scene as formula};
use std::path::PathBuf;
use std::process::ExitCode;

/// Writes a scene as PLY frames and says which.
pub fn scene(args: &SceneArgs) -> Result<ExitCode, Error> {
    if ANIMATIONS.contains(&args.name.as_str()) { animated(args) } else { by_formula(args) }
}

fn by_formula(args: &SceneArgs) -> Result<ExitCode, Error> {
    if args.skip.is_some() || args.contact {
        return Err(Error::Choice {
            what: format!("--skip or --contact of {}, which is made by formula", args.name),
            advice: format!("choose one of: {}", ANIMATIONS.join(", ")),
        });
    }
    let body = during("making the scene", || formula(&args.name, triangles_of(args), args.seed))?;
    let frames = body.frames();
    let asked = args.frames.map_or(frames.len() as u64, u64::from);
    if asked > frames.len() as u64 {
        return Err(Error::Choice {
            what: format!("{asked} frames of {}, which has {}", args.name, frames.len()),
            advice: format!("choose one that goes on: {}", ANIMATIONS.join(", ")),
        });
    }
    for (frame, mesh) in frames.iter().take(asked as usize).enumerate() {
        write(args, &format!("t{frame}"), mesh)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn animated(args: &SceneArgs) -> Result<ExitCode, Error> {
    let options = Options { triangles: triangles_of(args), seed: args.seed, contact: args.contact };
    let mut animation = during("making the scene", || {
        let mut animation = animation_with(&args.name, options)?;
        animation.advance(args.skip.unwrap_or(animation.opening()))?;
        Ok::<_, Error>(animation)
    })?;
    for frame in 0..args.frames.unwrap_or(2) {
        if frame > 0 {
            during("making the next frame", || animation.advance(1))?;
        }
        write(args, &format!("{frame:04}"), &animation.mesh()?)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// One frame, into a folder that is made if need be.
fn write(args: &SceneArgs, frame: &str, mesh: &Mesh) -> Result<(), Error> {
    std::fs::create_dir_all(&args.out)
        .map_err(|e| Error::Output { file: args.out.display().to_string(), text: e.to_string() })?;
    let path: PathBuf = args.out.join(format!("{}_{frame}.ply", args.name));
    mesh.write_ply(&path)?;
    super::print(&format!("{}: {} triangles\n", path.display(), mesh.face_count()));
    Ok(())
}

/// Triangles asked for, or those that the scene usually has.
fn triangles_of(args: &SceneArgs) -> usize {
    args.triangles.unwrap_or(nearmiss_lab::scene::usual(&args.name))
}
