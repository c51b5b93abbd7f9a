//! `scene`.

use super::args::SceneArgs;
use super::progress::during;
use crate::error::Error;
use std::process::ExitCode;

/// Writes a scene as PLY frames and says which.
pub fn scene(args: &SceneArgs) -> Result<ExitCode, Error> {
    let body = during("making the scene", || crate::scene::scene(&args.name, args.triangles, args.seed))?;
    let failed = |file: &std::path::Path, e: std::io::Error| Error::Output {
        file: file.display().to_string(),
        text: e.to_string(),
    };
    std::fs::create_dir_all(&args.out).map_err(|e| failed(&args.out, e))?;
    for (frame, mesh) in body.frames().iter().take(args.frames as usize).enumerate() {
        let path = args.out.join(format!("{}_t{frame}.ply", args.name));
        mesh.write_ply(&path)?;
        super::print(&format!("{}: {} triangles\n", path.display(), mesh.face_count()));
    }
    Ok(ExitCode::SUCCESS)
}
