//! Sources of frames: a generated animation, or files.

use crate::scene;
use nearmiss::error::Error;
use nearmiss::memory;
use nearmiss::mesh::{Body, Mesh};
use nearmiss::words::counted;
use nearmiss_io::MeshFile;
use std::path::PathBuf;

/// The substitutes of the thesis's scenes, with the thesis's numbers of triangles.
pub const SCENES: [(&str, usize); 4] =
    [("flamenco", 49_000), ("princess", 40_000), ("cloth-ball", 92_230), ("n-body", 146_480)];

/// Frames of one mesh, in their order: at least two, all with the same faces.
pub struct Frames {
    /// The scene's name.
    pub scene: String,
    /// The frames.
    pub meshes: Vec<Mesh>,
}

impl Frames {
    /// Returns the bodies to test in turn: every frame or, if they move, every pair of consecutive
    /// frames.
    ///
    /// # Errors
    /// [`Error::Input`] if two frames have different meshes.
    pub fn bodies(&self, moves: bool) -> Result<Vec<Body>, Error> {
        if !moves {
            return Ok(self.meshes.iter().cloned().map(Body::deformable).collect());
        }
        self.meshes.windows(2).map(|pair| Body::moving(pair[0].clone(), pair[1].clone())).collect()
    }

    /// Returns the number of triangles of the mesh.
    pub fn triangles(&self) -> usize {
        self.meshes.first().map_or(0, Mesh::face_count)
    }

    fn new(scene: &str, meshes: Vec<Mesh>) -> Result<Frames, Error> {
        let frames = Frames { scene: scene.into(), meshes };
        if frames.meshes.len() < 2 {
            return Err(Error::InvalidArgument {
                what: format!("{scene} has {}", counted(frames.meshes.len() as u64, "frame", "frames")),
                advice: "a step needs two: give more files after --mesh, or a larger --frames".into(),
            });
        }
        // Every pair is checked, so that no measurement fails halfway.
        frames.bodies(true)?;
        Ok(frames)
    }
}

/// Returns `count` frames of an animation, one after the other, from its opening on: before, cloth
/// falls and gathers. Cost: the earlier frames are computed too.
///
/// # Errors
/// Errors of the scene; [`Error::InvalidArgument`] for fewer than two frames.
pub fn frames(name: &str, triangles: usize, seed: u64, count: usize) -> Result<Frames, Error> {
    let mut animation = scene::animation(name, triangles, seed)?;
    animation.advance(animation.opening())?;
    let mut meshes = vec![animation.mesh()?];
    let first = size_of_val(meshes[0].faces()) + meshes[0].vertex_count() * size_of::<[f32; 3]>();
    // Each frame is kept, and copied as a still body and as both ends of a step.
    memory::require(&format!("{count} frames of {name}"), (first as u64).saturating_mul(4 * count as u64))?;
    while meshes.len() < count {
        animation.advance(1)?;
        meshes.push(animation.mesh()?);
    }
    Frames::new(name, meshes)
}

/// Reads frames from files, in the given order.
///
/// # Errors
/// Errors of reading; [`Error::Input`] if two files are not frames of one mesh;
/// [`Error::InvalidArgument`] for one file.
pub fn read(scene: &str, files: &[PathBuf]) -> Result<Frames, Error> {
    let mut read = files.iter().map(|file| MeshFile::read(file)).collect::<Result<Vec<_>, _>>()?;
    for at in 1..read.len() {
        read[at] = read[at].clone().cut_as(&read[at - 1])?;
    }
    Frames::new(scene, read.into_iter().map(MeshFile::into_mesh).collect())
}
