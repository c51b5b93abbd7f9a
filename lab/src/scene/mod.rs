//! Generated scenes: for the README, the self-test, tests and benches.
//!
//! Those of [`FORMULAS`] have one or two frames. Those of [`ANIMATIONS`] continue forever, as an
//! [`Animation`]. [`Bodies`] are scenes of many bodies.
//!
//! A scene is the same, bit by bit, on every machine and with every version of every crate. Random
//! numbers come from our own [`Rng`]. Coordinates only use `+ - * /`, `sqrt`, `floor` and
//! comparisons in double precision, which IEEE 754 fixes, then one rounding to single. No `sin`,
//! `cos` or `cbrt`, which differ between systems.

mod animation;
mod balls;
mod bodies;
mod cloth_ball;
mod draped;
mod flamenco;
mod known;
mod nbody;
mod princess;
pub(crate) mod rng;
mod soup;
mod sphere;
#[cfg(test)]
mod tests;
mod turn;
mod xpbd;

pub use animation::{ANIMATIONS, Animation, Options, animation, animation_with};
pub use balls::balls;
pub use bodies::{Bodies, Move};
pub use draped::draped;
pub use known::{grid, grid_pairs, identical, line, single};
pub use rng::Rng;
pub use soup::{soup, threads};

use nearmiss::Error;
use nearmiss::memory;
use nearmiss::mesh::{Body, Mesh, Positions, Problem};

/// The names of the scenes of [`scene`].
pub const NAMES: [&str; 12] = [
    "balls",
    "cloth-ball",
    "draped",
    "flamenco",
    "grid",
    "identical",
    "line",
    "n-body",
    "princess",
    "single",
    "soup",
    "soup-moving",
];

/// Names of scenes made by formula, still or with the two ends of a step; the others are
/// [`ANIMATIONS`].
pub const FORMULAS: [&str; 8] =
    ["balls", "draped", "grid", "identical", "line", "single", "soup", "soup-moving"];

/// Names of scenes with random numbers, which follow from a seed.
pub const SEEDED: [&str; 7] =
    ["balls", "cloth-ball", "flamenco", "n-body", "princess", "soup", "soup-moving"];

/// Returns the default number of triangles of a scene: the thesis's number for its scenes, that of
/// UNC's cloth on a ball for the others.
pub fn usual(name: &str) -> usize {
    match name {
        "flamenco" => 49_000,
        "princess" => 40_000,
        "n-body" => 146_480,
        _ => 92_230,
    }
}

/// Most triangles of a generated scene, 2^27: with three vertices each they stay below the limits
/// of a mesh.
pub const MAX_TRIANGLES: u64 = 1 << 27;

/// Makes the scene `name` with about `triangles` triangles. `single` always has one; each generator
/// states its accuracy. `seed` changes the random scenes: `balls`, `soup`, `soup-moving`, and the
/// animations. An animation gives the step from its opening to the next frame; earlier frames are
/// computed first.
///
/// # Errors
/// [`Problem::UnknownScene`] with the known names, [`Problem::NoElements`] for 0,
/// [`Problem::TooMany`] above [`MAX_TRIANGLES`]; each as [`Error::Input`] with the scene's name for
/// a file.
pub fn scene(name: &str, triangles: usize, seed: u64) -> Result<Body, Error> {
    if triangles == 0 && NAMES.contains(&name) {
        return Err(Error::Input { file: name.into(), problem: Problem::NoElements });
    }
    match name {
        _ if ANIMATIONS.contains(&name) => {
            let mut animation = animation(name, triangles, seed)?;
            animation.advance(animation.opening())?;
            animation.next_step()
        }
        "balls" => {
            let (count, subdivisions) = balls::nearest(triangles);
            balls(count, subdivisions, seed)
        }
        "draped" => draped(triangles),
        "grid" => grid(known::nearest(triangles)),
        "identical" => identical(triangles),
        "line" => line(triangles),
        "single" => single(),
        "soup" => soup(triangles, seed, false),
        "soup-moving" => soup(triangles, seed, true),
        _ => Err(Error::Input {
            file: name.into(),
            problem: Problem::UnknownScene { known: NAMES.join(", ") },
        }),
    }
}

/// Most bytes per triangle while a scene is made: three vertices at two ends, in lists that double
/// as they grow.
const OF_A_TRIANGLE: u64 = 200;

/// Refuses more triangles than a scene may have, or than memory holds, before any allocation.
fn room(name: &str, triangles: u64) -> Result<(), Error> {
    if triangles > MAX_TRIANGLES {
        let problem = Problem::TooMany { what: "triangles", count: triangles, limit: MAX_TRIANGLES };
        return Err(Error::Input { file: name.into(), problem });
    }
    memory::require(&format!("the scene {name}"), triangles * OF_A_TRIANGLE)
}

/// Points and faces while a scene grows.
#[derive(Default)]
struct Builder {
    t0: Vec<[f32; 3]>,
    t1: Vec<[f32; 3]>,
    faces: Vec<[u32; 3]>,
}

impl Builder {
    /// Adds a vertex that stands still, or in a still scene; returns its index. `room` keeps
    /// indices below 2^32.
    fn vertex(&mut self, p: [f64; 3]) -> u32 {
        self.t0.push(p.map(|x| x as f32));
        self.t0.len() as u32 - 1
    }

    /// Adds a vertex that moves from `p` to `q`; returns its index.
    fn moving(&mut self, p: [f64; 3], q: [f64; 3]) -> u32 {
        self.t1.push(q.map(|x| x as f32));
        self.vertex(p)
    }

    /// Returns the body: moving if its vertices were added as moving.
    fn body(self, name: &str) -> Result<Body, Error> {
        if self.t1.is_empty() {
            return Ok(Body::deformable(Mesh::new(name, Positions::F32(self.t0), self.faces)?));
        }
        let t0 = Mesh::new(name, Positions::F32(self.t0), self.faces.clone())?;
        Body::moving(t0, Mesh::new(name, Positions::F32(self.t1), self.faces)?)
    }
}

/// Returns the smallest whole number whose cube is at least `n`.
fn cube_root_up(n: usize) -> usize {
    (1..).find(|k: &usize| k.saturating_pow(3) >= n).unwrap_or(1)
}

/// Returns the whole number nearest to the square root of `x`, at least 1.
fn square_root(x: f64) -> u32 {
    (x.sqrt() + 0.5).floor().clamp(1.0, 1e9) as u32
}
