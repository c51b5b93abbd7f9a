//! `lab scene`.

use crate::args::SceneArgs;
use crate::output::{self, Target, print};
use crate::progress::during;
use nearmiss::error::Error;
use nearmiss::mesh::Mesh;
use nearmiss::words::counted;
use nearmiss_io::encode_ply;
use nearmiss_lab::scene::{ANIMATIONS, Options, animation_with, scene as formula};
use std::path::PathBuf;
use std::process::ExitCode;

/// Writes a scene as PLY files and prints their names.
pub fn scene(args: &SceneArgs) -> Result<ExitCode, Error> {
    if ANIMATIONS.contains(&args.name.as_str()) { animated(args) } else { by_formula(args) }
}

fn by_formula(args: &SceneArgs) -> Result<ExitCode, Error> {
    // The number does not depend on the size.
    let has = formula(&args.name, 8, args.seed)?.frames().len() as u64;
    let asked = args.frames.map_or(has, u64::from);
    if asked > has {
        return Err(Error::InvalidArgument {
            what: format!("--frames must be at most {has} for the scene {}, got {asked}", args.name),
            advice: format!("use an animation: {}", ANIMATIONS.join(", ")),
        });
    }
    output::folder(&args.out)?;
    let body = during("making the scene", || formula(&args.name, triangles_of(args), args.seed))?;
    for (frame, mesh) in body.frames().iter().take(asked as usize).enumerate() {
        write(args, &format!("t{frame}"), mesh)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn animated(args: &SceneArgs) -> Result<ExitCode, Error> {
    let options = Options { triangles: triangles_of(args), seed: args.seed, contact: args.contact };
    output::folder(&args.out)?;
    let mut animation = animation_with(&args.name, options)?;
    during("making the scene", || {
        animation.advance(args.skip.unwrap_or(animation.opening()))?;
        Ok::<_, Error>(())
    })?;
    for frame in 0..args.frames.unwrap_or(2) {
        if frame > 0 {
            during("making the next frame", || animation.advance(1))?;
        }
        write(args, &format!("{frame:04}"), &animation.mesh()?)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// One frame.
fn write(args: &SceneArgs, frame: &str, mesh: &Mesh) -> Result<(), Error> {
    let path: PathBuf = args.out.join(format!("{}_{frame}.ply", args.name));
    Target::open(&path)?.write(|mut out| encode_ply(mesh, &mut out).map_err(|e| e.to_string()))?;
    let triangles = counted(mesh.face_count() as u64, "triangle", "triangles");
    print(&format!("{}: {triangles}\n", path.display()))
}

/// The triangles of `--triangles`, or the usual ones of the scene.
fn triangles_of(args: &SceneArgs) -> usize {
    args.triangles.unwrap_or(nearmiss_lab::scene::usual(&args.name))
}
