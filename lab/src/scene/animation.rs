//! Scenes that continue, frame after frame.

use super::{cloth_ball, flamenco, nbody, princess, room};
use nearmiss::Error;
use nearmiss::memory;
use nearmiss::mesh::{Body, Mesh, Positions, Problem};

/// The names of the animations of [`animation`].
pub const ANIMATIONS: [&str; 4] = ["cloth-ball", "flamenco", "n-body", "princess"];

/// Most bytes per triangle of an animation: points in doubles, their speeds, and the links of
/// cloth.
const OF_A_TRIANGLE: u64 = 600;

/// Options of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Approximate number of triangles.
    pub triangles: usize,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Whether cloth is kept from passing through itself and the body under it, by nearmiss's own
    /// continuous detection. Then no pair of triangles meets in any frame. It takes several
    /// detections per substep, ten substeps per frame, so it is for small meshes. Without it cloth
    /// passes through itself freely, though not through a body.
    pub contact: bool,
}

/// A scene that is computed frame by frame, in memory. The first frame is available at once;
/// [`Animation::advance`] computes each further one. The same options give the same bits on every
/// machine.
pub struct Animation {
    name: String,
    faces: Vec<[u32; 3]>,
    act: Box<dyn Act>,
    frame: u64,
    opening: u64,
}

/// The motion of an animation: its current positions, and a step of one frame.
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

/// Makes the animation `name` with about `triangles` triangles, without contact of cloth with
/// itself.
///
/// # Errors
/// As [`animation_with`].
pub fn animation(name: &str, triangles: usize, seed: u64) -> Result<Animation, Error> {
    animation_with(name, Options { triangles, seed, contact: false })
}

/// Makes the animation `name` with these options. Cost: memory, and two trees with contact; no
/// frame is computed yet.
///
/// # Errors
/// [`Problem::UnknownScene`] with the known names, [`Problem::NoElements`] for 0,
/// [`Problem::TooMany`] above [`super::MAX_TRIANGLES`], each as [`Error::Input`];
/// [`Error::InvalidArgument`] for contact in `n-body`, which has no cloth.
pub fn animation_with(name: &str, options: Options) -> Result<Animation, Error> {
    let Options { triangles, seed, contact } = options;
    let input = |problem| Error::Input { file: name.into(), problem };
    if !ANIMATIONS.contains(&name) {
        return Err(input(Problem::UnknownScene { known: ANIMATIONS.join(", ") }));
    }
    if triangles == 0 {
        return Err(input(Problem::NoElements));
    }
    room(name, triangles as u64)?;
    memory::require(&format!("the cloth or the balls of {name}"), triangles as u64 * OF_A_TRIANGLE)?;
    let (mut world, opening) = match name {
        "cloth-ball" => (cloth_ball::world(triangles, seed), cloth_ball::OPENING),
        "flamenco" => (flamenco::world(triangles, seed), flamenco::OPENING),
        "princess" => (princess::world(triangles, seed), princess::OPENING),
        _ if contact => {
            return Err(Error::InvalidArgument {
                what: format!("the scene {name} has no cloth, so contact does not apply"),
                advice: "use cloth-ball, flamenco or princess, or leave contact out".into(),
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
    /// Returns the scene's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns three vertex indices per triangle: the same in all frames.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Returns the number of the current frame, from 0.
    pub fn frame(&self) -> u64 {
        self.frame
    }

    /// Returns the frame from which on the scene resembles its original; before, cloth falls and
    /// gathers.
    pub fn opening(&self) -> u64 {
        self.opening
    }

    /// Returns the positions of the current frame.
    pub fn positions(&self) -> Vec<[f32; 3]> {
        self.act.positions()
    }

    /// Advances by `frames` frames.
    ///
    /// # Errors
    /// With contact, errors of detection.
    pub fn advance(&mut self, frames: u64) -> Result<(), Error> {
        for _ in 0..frames {
            self.act.advance()?;
            self.frame += 1;
        }
        Ok(())
    }

    /// Returns the current frame as a mesh, a copy.
    ///
    /// # Errors
    /// None in practice: positions stay finite.
    pub fn mesh(&self) -> Result<Mesh, Error> {
        Mesh::new(&self.name, Positions::F32(self.positions()), self.faces.clone())
    }

    /// Returns the current frame, and advances by one.
    ///
    /// # Errors
    /// As [`Animation::advance`].
    pub fn next_frame(&mut self) -> Result<Mesh, Error> {
        let mesh = self.mesh()?;
        self.advance(1)?;
        Ok(mesh)
    }

    /// Returns the step from the current frame to the next as a moving body, and advances by one.
    ///
    /// # Errors
    /// As [`Animation::advance`].
    pub fn next_step(&mut self) -> Result<Body, Error> {
        let t0 = self.next_frame()?;
        Body::moving(t0, self.mesh()?)
    }
}
