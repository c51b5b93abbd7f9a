//! Scenes that move on, frame after frame.

use super::{cloth_ball, flamenco, nbody, princess, room};
use nearmiss::Error;
use nearmiss::memory;
use nearmiss::mesh::{Body, Mesh, Positions, Problem};

/// The names that [`animation`] knows.
pub const ANIMATIONS: [&str; 4] = ["cloth-ball", "flamenco", "n-body", "princess"];

/// Most bytes that a triangle takes in an animation: points in doubles, their speeds, and what holds cloth together.
const OF_A_TRIANGLE: u64 = 600;

/// What is asked of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Triangles, about.
    pub triangles: usize,
    /// What its chances depend on.
    pub seed: u64,
    /// Whether cloth is kept from passing through itself and the body under it, by nearmiss's own continuous detection:
    /// no pair of triangles meets in any frame. Takes several detections a substep, ten substeps a frame: for small
    /// meshes. Without it cloth passes through itself freely, though not through a body.
    pub contact: bool,
}

/// A scene that is computed frame by frame, in memory: the first frame is there at once, each further one is the work of
/// [`Animation::advance`]. The same options give the same bits on every machine.
pub struct Animation {
    name: String,
    faces: Vec<[u32; 3]>,
    act: Box<dyn Act>,
    frame: u64,
    opening: u64,
}

/// What plays: positions now, and one frame on.
pub(super) trait Act {
    fn positions(&self) -> Vec<[f32; 3]>;
    fn advance(&mut self) -> Result<(), Error>;
}

impl Act for super::xpbd::World {
    fn positions(&self) -> Vec<[f32; 3]> {
        self.positions()
    }
    fn advance(&mut self) -> Result<(), Error> {
        self.advance()
    }
}

/// The animation `name` with about `triangles` triangles, without contact of cloth with itself.
///
/// # Errors
/// As [`animation_with`].
pub fn animation(name: &str, triangles: usize, seed: u64) -> Result<Animation, Error> {
    animation_with(name, Options { triangles, seed, contact: false })
}

/// The animation `name` as the options say. Cost: memory, and with contact two trees; no frame is computed yet.
///
/// # Errors
/// [`Problem::UnknownScene`] with the known names, [`Problem::NoTriangles`] for 0, [`Problem::TooMany`] above
/// [`super::MAX_TRIANGLES`], each as [`Error::Input`]; [`Error::InvalidArgument`] for contact in `n-body`, which has no cloth.
pub fn animation_with(name: &str, options: Options) -> Result<Animation, Error> {
    let Options { triangles, seed, contact } = options;
    let input = |problem| Error::Input { file: name.into(), problem };
    if !ANIMATIONS.contains(&name) {
        return Err(input(Problem::UnknownScene { known: ANIMATIONS.join(", ") }));
    }
    if triangles == 0 {
        return Err(input(Problem::NoTriangles));
    }
    room(name, triangles as u64)?;
    memory::require(&format!("the cloth or the balls of {name}"), triangles as u64 * OF_A_TRIANGLE)?;
    let (mut world, opening) = match name {
        "cloth-ball" => (cloth_ball::world(triangles, seed), cloth_ball::OPENING),
        "flamenco" => (flamenco::world(triangles, seed), flamenco::OPENING),
        "princess" => (princess::world(triangles, seed), princess::OPENING),
        _ if contact => {
            return Err(Error::InvalidArgument {
                what: format!("contact of cloth in {name}, which has none"),
                advice: "choose cloth-ball, flamenco or princess, or leave contact out".into(),
            });
        }
        _ => {
            let bodies = nbody::NBody::new(triangles, seed);
            let (faces, act) = (bodies.faces().to_vec(), Box::new(bodies));
            return Ok(Animation { name: name.into(), faces, act, frame: 0, opening: nbody::OPENING });
        }
    };
    if contact {
        world.keep_apart(name)?;
    }
    Ok(Animation {
        name: name.into(),
        faces: world.faces().to_vec(),
        act: Box::new(world),
        frame: 0,
        opening,
    })
}

impl Animation {
    /// The scene's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Three vertex indices a triangle: the same in all frames.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// The number of the present frame, from 0.
    pub fn frame(&self) -> u64 {
        self.frame
    }

    /// The frame from which on the scene is what it stands in for; before, cloth falls and gathers.
    pub fn opening(&self) -> u64 {
        self.opening
    }

    /// The positions of the present frame.
    pub fn positions(&self) -> Vec<[f32; 3]> {
        self.act.positions()
    }

    /// Goes on by `frames` frames.
    ///
    /// # Errors
    /// With contact, those of detection.
    pub fn advance(&mut self, frames: u64) -> Result<(), Error> {
        for _ in 0..frames {
            self.act.advance()?;
            self.frame += 1;
        }
        Ok(())
    }

    /// The present frame as a mesh. Copies.
    ///
    /// # Errors
    /// None in fact: positions stay finite.
    pub fn mesh(&self) -> Result<Mesh, Error> {
        Mesh::new(&self.name, Positions::F32(self.positions()), self.faces.clone())
    }

    /// The present frame, and goes on by one.
    ///
    /// # Errors
    /// As [`Animation::advance`].
    pub fn next_frame(&mut self) -> Result<Mesh, Error> {
        let mesh = self.mesh()?;
        self.advance(1)?;
        Ok(mesh)
    }

    /// The step from the present frame to the next as a moving body, and goes on by one.
    ///
    /// # Errors
    /// As [`Animation::advance`].
    pub fn next_step(&mut self) -> Result<Body, Error> {
        let t0 = self.next_frame()?;
        Body::moving(t0, self.mesh()?)
    }
}
